//! `[allocation]`: the controlled axes, and their priorities where a request is not attainable.

pub use mixer_rt::{Axis, tables::Airmode};

use super::limits::LARGEST_EFFORT;
use crate::diagnostic::{Code, Diagnostic, number};
use crate::spec::keys::{Range, ValueKind, keys};
use crate::spec::{Fields, Spanned};

/// Largest torque per thrust of a pair, N m per N: a propeller of 2 m with the other one at rest
/// has a tenth.
const LARGEST_POWER_BIAS: f64 = 1.0;

const AIRMODES: [Airmode; 3] = [Airmode::Disabled, Airmode::RollPitch, Airmode::RollPitchYaw];

keys! { TABLE = "[allocation]":
    AIRMODE "airmode" = "\"disabled\"", ValueKind::Word(&["disabled", "roll-pitch", "roll-pitch-yaw"]),
        "For which torques the thrust may rise, with PX4's meaning; disabled without it.";
    AXES "axes" = "[\"roll\", \"pitch\", \"yaw\", \"thrust\"]", ValueKind::Words(&["roll", "pitch", "yaw", "thrust"]),
        "The served axes, all four without it; fewer for one or two units, which cannot produce all.";
    YAW_RESERVE_NM "yaw_reserve_nm" = "0.05", ValueKind::Number(Range::Within([0.0, LARGEST_EFFORT])),
        "Yaw torque that comes before thrust, N m.".default(0.0)
        .refusing("must be 0 or more newton metres", "the reserve holds either way about zero yaw; write its size");
    POWER_BIAS_NM_PER_N "power_bias_nm_per_n" = "0.005", ValueKind::Number(Range::Within([-LARGEST_POWER_BIAS, LARGEST_POWER_BIAS])),
        "Least power: torque per thrust of every unit while none is near its limits, N m per N.".default(0.0);
}

/// `[allocation]` with its defaults.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Allocation {
    /// Whether the thrust may rise for the attitude.
    pub airmode: Airmode,
    /// The controlled axes in the order of the wrench, each once, the thrust among them.
    pub axes: Vec<Axis>,
    /// Yaw torque that comes before thrust, N m, 0 to 1e6, and 0 where yaw is not
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

pub(super) fn read(table: &mut Fields<'_, '_>) -> Option<Allocation> {
    let default = Allocation::default();
    let airmode = table.word(&AIRMODE, &AIRMODES);
    let axes = match table.read(&AXES) {
        Some(field) => axes(table, &field),
        None => Some(default.axes),
    };
    let yaw_reserve_nm = yaw_reserve(table, axes.as_deref());
    let power_bias_nm_per_n = power_bias(table, axes.as_deref());
    Some(Allocation {
        airmode: airmode.unwrap_or(default.airmode),
        axes: axes?,
        yaw_reserve_nm: yaw_reserve_nm?,
        power_bias_nm_per_n: power_bias_nm_per_n?,
    })
}

fn axes(table: &mut Fields<'_, '_>, field: &Spanned<Vec<Spanned<String>>>) -> Option<Vec<Axis>> {
    let before = table.faults.len();
    let mut axes = Vec::new();
    for written in field.get_ref() {
        let Some(axis) = table.meaning(&AXES, written, &Axis::ALL) else {
            continue;
        };
        if axes.contains(&axis) {
            let message = format!("`{}` is listed twice", axis.name());
            let fault = Diagnostic::new(Code::ControlAxes, "allocation.axes", written.span(), message);
            table
                .faults
                .push(fault.label("again").help("list every controlled axis once"));
        } else {
            axes.push(axis);
        }
    }
    if table.faults.len() > before {
        return None;
    }
    if !axes.contains(&Axis::Thrust) {
        let names: Vec<_> = axes.iter().map(|axis| axis.name()).collect();
        let message = match names.as_slice() {
            [] => "`allocation.axes` is empty".to_string(),
            names => format!("`allocation.axes` has {} and no thrust", names.join(", ")),
        };
        let help = "leave out only what the units cannot produce, as in `axes = [\"yaw\", \"thrust\"]`";
        return table.refuse(
            &AXES,
            Code::ControlAxes,
            message,
            "`thrust` must be among them",
            help,
        );
    }
    axes.sort();
    Some(axes)
}

fn yaw_reserve(table: &mut Fields<'_, '_>, axes: Option<&[Axis]>) -> Option<f64> {
    let reserve = table.number(&YAW_RESERVE_NM)?;
    if reserve > 0.0 && !serves_yaw(axes) {
        let message = format!(
            "a yaw reserve of {} N m without yaw in `allocation.axes`",
            number(reserve)
        );
        let help = "remove the reserve, or add `yaw` to `axes`";
        return table.refuse(
            &YAW_RESERVE_NM,
            Code::YawReserve,
            message,
            "yaw is not controlled",
            help,
        );
    }
    Some(reserve)
}

fn power_bias(table: &mut Fields<'_, '_>, axes: Option<&[Axis]>) -> Option<f64> {
    let key = &POWER_BIAS_NM_PER_N;
    let bias = table.number(key)?;
    if bias.abs() > LARGEST_POWER_BIAS {
        let help = if bias.abs() <= 1e3 * LARGEST_POWER_BIAS {
            format!("if mN m per N were meant, write {}", number(bias / 1e3))
        } else {
            "`cargo mixer identify` finds it from voltage and current; 0.002 to 0.02 are usual".to_string()
        };
        let message = format!(
            "`allocation.power_bias_nm_per_n` = {} is not between -1 and 1",
            number(bias)
        );
        return table.refuse(
            key,
            Code::OutOfRange,
            message,
            "no pair has that torque per thrust",
            help,
        );
    }
    if bias != 0.0 && !serves_yaw(axes) {
        let message = format!(
            "a power bias of {} N m per N without yaw in `allocation.axes`",
            number(bias)
        );
        let help = "remove the bias, or add `yaw` to `axes`";
        return table.refuse(
            key,
            Code::PowerBias,
            message,
            "nothing would cancel these torques",
            help,
        );
    }
    Some(bias)
}

/// Whether yaw is among the axes, or may be where they were refused.
fn serves_yaw(axes: Option<&[Axis]>) -> bool {
    axes.is_none_or(|axes| axes.contains(&Axis::Yaw))
}
