//! `[allocation]`: the controlled axes, and their priorities where a request is not attainable.

pub use mixer_rt::{Axis, tables::Airmode};
use toml::Spanned;

use super::check::{LARGEST_EFFORT, word};
use crate::diagnostic::{Code, Diagnostic, number};
use crate::spec;

/// The words for airmodes in the file.
const AIRMODES: [(&str, Airmode); 3] = [
    ("disabled", Airmode::Disabled),
    ("roll-pitch", Airmode::RollPitch),
    ("roll-pitch-yaw", Airmode::RollPitchYaw),
];

/// Largest torque per thrust of a pair, N m per N: a propeller of 2 m with the other one at rest
/// has a tenth.
const LARGEST_POWER_BIAS: f64 = 1.0;

/// `[allocation]` with its defaults.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Allocation {
    /// Whether the thrust may rise for the attitude.
    pub airmode: Airmode,
    /// The controlled axes in the order of the wrench, each once, the thrust among them.
    pub axes: Vec<Axis>,
    /// Yaw torque kept available in both directions, N m, 0 to 1e6, and 0 where yaw is not
    /// controlled.
    pub yaw_reserve_nm: f64,
    /// Torque per thrust of every unit for the least power, N m per N at the reference voltage, -1
    /// to 1, and 0 where yaw is not controlled.
    pub power_bias_nm_per_n: f64,
}

impl Default for Allocation {
    fn default() -> Self {
        Self {
            airmode: Airmode::Disabled,
            axes: Axis::ALL.to_vec(),
            yaw_reserve_nm: 0.0,
            power_bias_nm_per_n: 0.0,
        }
    }
}

impl Allocation {
    /// Whether `axis` is controlled.
    pub fn controls(&self, axis: Axis) -> bool {
        self.axes.contains(&axis)
    }
}

pub(super) fn check(allocation: &spec::Allocation, faults: &mut Vec<Diagnostic>) -> Option<Allocation> {
    let default = Allocation::default();
    let airmode = match &allocation.airmode {
        Some(field) => word(field, "allocation.airmode", &AIRMODES, faults),
        None => Some(default.airmode),
    };
    let axes = match &allocation.axes {
        Some(field) => axes(field, faults),
        None => Some(default.axes),
    };
    let yaw_reserve_nm = match &allocation.yaw_reserve_nm {
        Some(field) => yaw_reserve(field, axes.as_deref(), faults),
        None => Some(default.yaw_reserve_nm),
    };
    let power_bias_nm_per_n = match &allocation.power_bias_nm_per_n {
        Some(field) => power_bias(field, axes.as_deref(), faults),
        None => Some(default.power_bias_nm_per_n),
    };
    Some(Allocation {
        airmode: airmode?,
        axes: axes?,
        yaw_reserve_nm: yaw_reserve_nm?,
        power_bias_nm_per_n: power_bias_nm_per_n?,
    })
}

fn axes(field: &Spanned<Vec<Spanned<String>>>, faults: &mut Vec<Diagnostic>) -> Option<Vec<Axis>> {
    let words = Axis::ALL.map(|axis| (axis.name(), axis));
    let before = faults.len();
    let fault =
        |place, message: String| Diagnostic::new(Code::ControlAxes, "allocation.axes", place, message);
    let mut axes = Vec::new();
    for written in field.get_ref() {
        let Some(axis) = word(written, "allocation.axes", &words, faults) else {
            continue;
        };
        if axes.contains(&axis) {
            faults.push(
                fault(written.span(), format!("`{}` is listed twice", axis.name()))
                    .label("again")
                    .help("list every controlled axis once"),
            );
        } else {
            axes.push(axis);
        }
    }
    if faults.len() > before {
        return None;
    }
    if !axes.contains(&Axis::Thrust) {
        let message = match field.get_ref().len() {
            0 => "`allocation.axes` is empty".to_string(),
            _ => {
                let names: Vec<_> = axes.iter().map(|axis| axis.name()).collect();
                format!("`allocation.axes` has {} and no thrust", names.join(", "))
            }
        };
        faults.push(
            fault(field.span(), message)
                .label("`thrust` must be among them")
                .help("leave out only what the units cannot produce, as in `axes = [\"yaw\", \"thrust\"]`"),
        );
        return None;
    }
    axes.sort();
    Some(axes)
}

fn yaw_reserve(field: &Spanned<f64>, axes: Option<&[Axis]>, faults: &mut Vec<Diagnostic>) -> Option<f64> {
    let reserve = *field.get_ref();
    let key = "allocation.yaw_reserve_nm";
    if !(0.0..=LARGEST_EFFORT).contains(&reserve) {
        faults.push(
            Diagnostic::new(
                Code::OutOfRange,
                key,
                field.span(),
                format!(
                    "`{key}` = {} is not between 0 and {}",
                    number(reserve),
                    number(LARGEST_EFFORT)
                ),
            )
            .label("must be 0 or more newton metres")
            .help("the reserve holds either way about zero yaw; write its size"),
        );
        return None;
    }
    if reserve > 0.0 && axes.is_some_and(|axes| !axes.contains(&Axis::Yaw)) {
        faults.push(
            Diagnostic::new(
                Code::YawReserve,
                key,
                field.span(),
                format!(
                    "a yaw reserve of {} N m without yaw in `allocation.axes`",
                    number(reserve)
                ),
            )
            .label("yaw is not controlled")
            .help("remove the reserve, or add `yaw` to `axes`"),
        );
        return None;
    }
    Some(reserve + 0.0)
}

fn power_bias(field: &Spanned<f64>, axes: Option<&[Axis]>, faults: &mut Vec<Diagnostic>) -> Option<f64> {
    let bias = *field.get_ref();
    let key = "allocation.power_bias_nm_per_n";
    if bias.abs() > LARGEST_POWER_BIAS {
        let help = if bias.abs() <= 1e3 * LARGEST_POWER_BIAS {
            format!("if mN m per N were meant, write {}", number(bias / 1e3))
        } else {
            "`cargo mixer identify` finds it from voltage and current; 0.002 to 0.02 are usual".to_string()
        };
        faults.push(
            Diagnostic::new(
                Code::OutOfRange,
                key,
                field.span(),
                format!("`{key}` = {} is not between -1 and 1", number(bias)),
            )
            .label("no pair has that torque per thrust")
            .help(help),
        );
        return None;
    }
    if bias != 0.0 && axes.is_some_and(|axes| !axes.contains(&Axis::Yaw)) {
        faults.push(
            Diagnostic::new(
                Code::PowerBias,
                key,
                field.span(),
                format!(
                    "a power bias of {} N m per N without yaw in `allocation.axes`",
                    number(bias)
                ),
            )
            .label("nothing would cancel these torques")
            .help("remove the bias, or add `yaw` to `axes`"),
        );
        return None;
    }
    Some(bias + 0.0)
}
