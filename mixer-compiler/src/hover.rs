//! The vehicle in hover, by the mixer itself: throttles, what is left of roll, pitch and yaw,
//! thrust over weight.

use mixer_rt::tables::{Airmode, Priorities, REQUEST_LIMIT};
use mixer_rt::{Health, Wrench};
use serde::ser::SerializeMap as _;
use serde::{Serialize, Serializer};

use crate::airframe::Axis;
use crate::compiled::Compiled;
use crate::diagnostic::{Code, Diagnostic, rounded};
use crate::model::scales;
use crate::tables::MixerTables;

/// How finely a largest torque is looked for.
#[derive(Clone, Copy, Debug)]
pub struct Search {
    /// Torques tried over the whole range. The largest that is delivered counts, whatever was
    /// missed before it.
    pub steps: usize,
    /// Halvings from there to the next one tried.
    pub halvings: usize,
}

impl Search {
    /// To a hundred-thousandth of the range.
    pub const FINE: Search = Search {
        steps: 24,
        halvings: 12,
    };

    /// The largest number up to `end` that is `delivered`, whatever is missed before it; 0 where
    /// not even 0 is.
    pub fn largest(self, end: f64, delivered: impl Fn(f64) -> bool) -> f64 {
        let step = end / self.steps as f64;
        let Some(last) = (0..=self.steps).rev().find(|&k| delivered(k as f64 * step)) else {
            return 0.0;
        };
        if last == self.steps {
            return end;
        }
        let (mut good, mut bad) = (last as f64 * step, (last + 1) as f64 * step);
        for _ in 0..self.halvings {
            let middle = 0.5 * (good + bad);
            if delivered(middle) {
                good = middle;
            } else {
                bad = middle;
            }
        }
        good
    }
}

/// The rotors of a layer in hover.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// `upper`, `lower` or `single`.
    pub layer: &'static str,
    /// Least and greatest throttle.
    pub throttle: [f64; 2],
    /// The outputs that have them.
    pub outputs: [usize; 2],
}

/// Keys as `upper_throttle` and `upper_outputs`.
fn by_layer<S: Serializer>(layers: &[Layer], serializer: S) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(None)?;
    for of in layers {
        map.serialize_entry(&format!("{}_throttle", of.layer), &of.throttle)?;
        map.serialize_entry(&format!("{}_outputs", of.layer), &of.outputs)?;
    }
    map.end()
}

/// Hover at one voltage.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct HoverAt {
    /// The voltage, V.
    pub voltage_v: Option<f64>,
    /// Upper, lower and single rotors, as far as there are any; empty where the weight is not carried.
    #[serde(flatten, serialize_with = "by_layer")]
    pub layers: Vec<Layer>,
    /// Least throttles, of each layer, where units give one standard deviation of their `uncertainty` more thrust than
    /// their model, and greatest ones where they give as much less; `None` without that table, or where the weight is
    /// then not carried.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub throttle_band: Option<[Vec<f64>; 2]>,
    /// Largest torques `[negative, positive]` about the served axes that are delivered with the
    /// weight, each alone, N m.
    pub margins: Vec<Margin>,
    /// With an upper, a lower and a single rotor out, of those the one that leaves least yaw in its weaker sense; empty where
    /// yaw is not served.
    pub rotor_out: Vec<RotorOut>,
}

/// Hover with a rotor out.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RotorOut {
    /// `upper`, `lower` or `single`.
    pub layer: &'static str,
    /// The rotor's output.
    pub output: usize,
    /// Least and largest yaw, N m; `None` where the weight is not carried level.
    pub yaw_nm: Option<[f64; 2]>,
    /// All outputs of the layer without which the weight is not carried level.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub not_level: Vec<usize>,
}

/// Share of the authority that hover with a rotor out may miss of roll, pitch and thrust: what priorities trade.
const MISSED: f32 = 0.005;

/// Least and largest yaw (N m) of level flight at a thrust (N) and a voltage (V), the rotor of a channel out, by a mixer in
/// which thrust comes before all of yaw; `None` where there is no such flight.
fn level_yaw(tables: &MixerTables, volts: f32, thrust_n: f32, channel: u8) -> Option<[f64; 2]> {
    let [by_roll, by_pitch, _, by_thrust] = tables.row_scale;
    let slack = MISSED * tables.units.len() as f32;
    let health = Health::GOOD.with_failed(channel);
    // More than all that there is.
    let yaw = |sense: f32| {
        let setpoint = Wrench {
            yaw_nm: sense * REQUEST_LIMIT,
            thrust_n,
            ..Wrench::default()
        };
        let (_, achieved, _) = tables.mix_with_health(&setpoint, volts, health).ok()?;
        let missed = [
            by_roll * achieved.roll_nm,
            by_pitch * achieved.pitch_nm,
            by_thrust * (achieved.thrust_n - thrust_n),
        ];
        let is_level = missed.iter().all(|missed| missed.abs() <= slack);
        is_level.then_some(achieved.yaw_nm.into())
    };
    Some([yaw(-1.0)?, yaw(1.0)?])
}

impl RotorOut {
    /// Yaw in the weaker sense, N m; below 0 where the vehicle turns by itself.
    fn weaker_nm(&self) -> f64 {
        self.yaw_nm
            .map_or(f64::NEG_INFINITY, |[least, most]| most.min(-least))
    }

    /// That of each layer beside a thrust of `weight_n` N at a voltage, V; empty where yaw is not served.
    fn of(compiled: &Compiled, weight_n: f64, voltage_v: Option<f64>) -> Vec<RotorOut> {
        if !compiled.airframe.allocation.controls(Axis::Yaw) {
            return Vec::new();
        }
        let volts = voltage_v.unwrap_or(0.0) as f32;
        let mut tables = compiled.tables.clone();
        tables.priorities = Priorities {
            airmode: Airmode::RollPitch,
            yaw_reserve_nm: 0.0,
        };
        let worst = |(layer, outputs): (&'static str, Vec<usize>)| {
            let all = outputs.into_iter().map(|output| RotorOut {
                layer,
                output,
                yaw_nm: level_yaw(&tables, volts, weight_n as f32, output as u8),
                not_level: Vec::new(),
            });
            let all: Vec<RotorOut> = all.collect();
            let not_level = all
                .iter()
                .filter(|out| out.yaw_nm.is_none())
                .map(|out| out.output);
            let not_level = not_level.collect();
            let worst = all
                .into_iter()
                .min_by(|a, b| a.weaker_nm().total_cmp(&b.weaker_nm()))?;
            Some(RotorOut { not_level, ..worst })
        };
        compiled.airframe.layers().filter_map(worst).collect()
    }
}

/// What is left of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Margin {
    /// `roll`, `pitch` or `yaw`.
    pub axis: &'static str,
    /// Least and largest torque, N m.
    pub torque_nm: [f64; 2],
    /// What all units may be off together by one standard deviation of `[pair.uncertainty]`, N m;
    /// `None` without that table.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub band_nm: Option<f64>,
}

/// Warnings of hover: an axis that is left less than the pair may be
/// off by, and a rotor that is next to a limit, where those `told` do not say so by the weight.
pub(crate) fn warnings(compiled: &Compiled, told: &[Diagnostic]) -> Vec<Diagnostic> {
    const BY_WEIGHT: [Code; 4] = [
        Code::TooHeavy,
        Code::FloatsAtIdle,
        Code::HoversHigh,
        Code::TooLight,
    ];
    let is_explained = told.iter().any(|warning| BY_WEIGHT.contains(&warning.code));
    let warnings = margins(compiled).into_iter();
    warnings
        .chain(limits(compiled).filter(|_| !is_explained))
        .collect()
}

/// Share of the throttle's range within which a rotor is next to its end.
const NEXT_TO: f64 = 0.05;

/// A rotor that hovers next to idle or to the largest throttle, at the reference voltage.
fn limits(compiled: &Compiled) -> Option<Diagnostic> {
    let airframe = &compiled.airframe;
    let (min, max) = (airframe.throttle.min, airframe.throttle.max);
    let reference_v = airframe.voltage.as_ref().map(|voltage| voltage.reference);
    let at = HoverAt::new(compiled, airframe.weight_n()?, reference_v);
    let room = NEXT_TO * (max - min);
    let ends = at.layers.iter().flat_map(|layer| {
        let ([least, greatest], [lowest, highest]) = (layer.throttle, layer.outputs);
        let idle = (least - min < room).then_some(("idle", min, least, lowest));
        let full = (max - greatest < room).then_some(("throttle.max", max, greatest, highest));
        [full, idle]
    });
    let (name, limit, throttle, output) = ends.flatten().next()?;
    Some(airframe.diagnostic(
        Code::HoverAtLimit,
        "vehicle.mass_kg",
        format!("in hover output {output} is at a throttle of {throttle:.3}, next to {name}, {limit}"),
        "little is left of roll, pitch or yaw one way",
        "move the units about the centre of gravity (`check` prints every layer's throttles), or fly with another mass",
    ))
}

/// Hover leaves less of an axis than the pair may be off by, at the lowest voltage.
fn margins(compiled: &Compiled) -> Vec<Diagnostic> {
    let airframe = &compiled.airframe;
    let Some(weight_n) = airframe.weight_n().filter(|_| {
        airframe
            .views()
            .all(|view| view.of.measured().uncertainty.is_some())
    }) else {
        return Vec::new();
    };
    let lowest_v = airframe.voltage.as_ref().map(|voltage| voltage.range[0]);
    let at = HoverAt::new(compiled, weight_n, lowest_v);
    let warning = |margin: &Margin| {
        let [least, largest] = margin.torque_nm;
        let left = largest.min(-least);
        let band = margin.band_nm.filter(|band| left < *band)?;
        let message = format!(
            "hover leaves {} N m of {}, and the model of the pair may be off by {} N m",
            rounded(left),
            margin.axis,
            rounded(band)
        );
        Some(airframe.diagnostic(
            Code::MarginBelowBand,
            "vehicle.mass_kg",
            message,
            "perhaps nothing is left",
            "measure the pair (docs/bench.md), or fly with less mass",
        ))
    };
    at.margins.iter().filter_map(warning).collect()
}

impl HoverAt {
    /// What is left beside a thrust of `weight_n` N at a voltage, V; any where the airframe ignores
    /// it.
    pub fn new(compiled: &Compiled, weight_n: f64, voltage_v: Option<f64>) -> Self {
        let tables = &compiled.tables;
        // Throttles where all of the wrench is delivered.
        let mix = |wrench: [f64; 4]| {
            let setpoint = Wrench::from_array(wrench.map(|x| x as f32));
            let (throttle, _, saturation) = tables.mix(&setpoint, voltage_v.unwrap_or(0.0) as f32).ok()?;
            (!saturation.any_axis()).then_some(throttle)
        };
        let served = [Axis::Roll, Axis::Pitch, Axis::Yaw]
            .into_iter()
            .filter(|&axis| compiled.airframe.allocation.controls(axis));
        let Some(throttles) = mix([0.0, 0.0, 0.0, weight_n]) else {
            return HoverAt {
                voltage_v,
                ..HoverAt::default()
            };
        };
        let layers = |throttles: &[f32]| -> Vec<Layer> {
            let of = |(layer, all): (&'static str, Vec<usize>)| {
                let all = || all.iter().copied();
                let by_throttle = |a: &usize, b: &usize| throttles[*a].total_cmp(&throttles[*b]);
                let outputs = [all().min_by(by_throttle)?, all().max_by(by_throttle)?];
                let throttle = outputs.map(|output| f64::from(throttles[output]));
                Some(Layer {
                    layer,
                    throttle,
                    outputs,
                })
            };
            compiled.airframe.layers().filter_map(of).collect()
        };
        let band = |axis: Axis| band(compiled, axis, voltage_v);
        let throttle_band = band(Axis::Thrust).and_then(|off| {
            let at = |thrust: f64, end: usize| {
                let throttles = mix([0.0, 0.0, 0.0, thrust])?;
                Some(layers(&throttles).iter().map(|of| of.throttle[end]).collect())
            };
            Some([at(weight_n - off, 0)?, at(weight_n + off, 1)?])
        });
        let margins = served.map(|axis| {
            let largest = largest_torque(compiled, axis);
            let reach = |sign: f64| {
                let delivered = |torque: f64| {
                    let mut wrench = [0.0, 0.0, 0.0, weight_n];
                    wrench[axis as usize] = sign * torque;
                    mix(wrench).is_some()
                };
                sign * Search::FINE.largest(largest, delivered)
            };
            Margin {
                axis: axis.name(),
                torque_nm: [reach(-1.0), reach(1.0)],
                band_nm: band(axis),
            }
        });
        HoverAt {
            voltage_v,
            layers: layers(&throttles),
            throttle_band,
            margins: margins.collect(),
            rotor_out: RotorOut::of(compiled, weight_n, voltage_v),
        }
    }
}

/// A torque that no throttles exceed: all units at their largest thrust and torque.
fn largest_torque(compiled: &Compiled, axis: Axis) -> f64 {
    let factors = crate::model::law::largest_factors(&compiled.airframe);
    compiled
        .effectiveness
        .largest(axis as usize, &scales(&compiled.airframe, factors))
}

/// What an axis is off by where every unit misses its model by one standard deviation, all to the
/// same end: units of one pair have one model, so their errors go together. N or N m; `None` without
/// `[pair.uncertainty]`.
pub fn band(compiled: &Compiled, axis: Axis, voltage_v: Option<f64>) -> Option<f64> {
    let airframe = &compiled.airframe;
    let [k_f, k_q] = voltage_v.map_or([1.0; 2], |volts| airframe.voltage_factors(volts));
    let units = airframe.units.iter().zip(scales(airframe, [1.0; 2]));
    let off = units.map(|(unit, [f, q])| {
        let uncertainty = airframe.kind_of(unit).measured().uncertainty?;
        Some([
            0.01 * uncertainty.thrust_percent * k_f * f,
            0.01 * uncertainty.torque_percent * k_q * q,
        ])
    });
    let off: Vec<[f64; 2]> = off.collect::<Option<_>>()?;
    Some(compiled.effectiveness.largest(axis as usize, &off))
}
