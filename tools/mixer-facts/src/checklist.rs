//! What to look at on the bench before the first flight: which output drives which rotor, how it
//! turns, and which outputs rise for roll, pitch, yaw and thrust. Mirrored spins and exchanged
//! channels are found so.

use std::collections::BTreeMap;
use std::fmt;

use mixer_rt::Wrench;

use mixer_compiler::Compiled;
use mixer_compiler::airframe::{Airframe, Axis, Spin, Unit};
use mixer_compiler::model::scales;

/// Share of an axis' size that is asked: small enough to be delivered in full.
const ASKED: f64 = 0.02;

/// Change of a throttle that counts, as a share of the largest change.
const COUNTS: f32 = 0.1;

/// Distance from the axes within which a unit is on them, as a share of the longest arm.
const ON_AXIS: f64 = 0.05;

/// The check list of a compiled airframe; its `Display` is the text.
#[derive(Clone, Copy, Debug)]
pub struct Checklist<'a>(pub &'a Compiled);

impl fmt::Display for Checklist<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("on the bench    propellers off, outputs one by one; spins as seen from above\n")?;
        let units = &self.0.airframe.units;
        for (index, unit) in units.iter().enumerate() {
            let rotors = unit.rotors().map(|rotor| {
                let (channel, spin) = (rotor.channel, rotor.spin.in_words());
                format!("output {channel} {}, {spin}", rotor.layer)
            });
            let rotors = itertools::join(rotors, "; ");
            writeln!(f, "  unit {index:<9} {}: {rotors}", place(unit, units))?;
        }
        for axis in Axis::ALL {
            if let Some(rises) = self.rises_in_words(axis, 0) {
                let (command, motion) = (format!("+{}", axis.name()), motion(axis));
                writeln!(f, "  {command:<14} raises outputs {rises} ({motion})")?;
            }
        }
        Ok(())
    }
}

/// How the vehicle moves where the axis is asked.
pub fn motion(axis: Axis) -> &'static str {
    match axis {
        Axis::Roll => "right side down",
        Axis::Pitch => "nose up",
        Axis::Yaw => "nose right",
        Axis::Thrust => "up",
    }
}

impl Checklist<'_> {
    /// Where a unit is among the others: `front right`.
    pub fn place(&self, unit: &Unit) -> String {
        place(unit, &self.0.airframe.units)
    }

    /// The outputs by how much they rise, most of all first: `4, 6 by 0.021; 1, 3 by 0.019`, counted from `first` on.
    pub fn rises_in_words(&self, axis: Axis, first: usize) -> Option<String> {
        let mut by_rise: BTreeMap<i32, Vec<String>> = BTreeMap::new();
        for (output, rise) in self.rises(axis)? {
            let thousandths = (1000.0 * rise).round() as i32;
            by_rise
                .entry(-thousandths)
                .or_default()
                .push((output + first).to_string());
        }
        let groups = by_rise
            .into_iter()
            .map(|(rise, outputs)| format!("{} by {:.3}", outputs.join(", "), -f64::from(rise) / 1000.0));
        Some(itertools::join(groups, "; "))
    }

    /// The outputs that rise where 2 % of the axis' size is asked, in order, each with the rise of
    /// its throttle; `None` where it is not served or not delivered.
    pub fn rises(&self, axis: Axis) -> Option<Vec<(usize, f32)>> {
        let compiled = self.0;
        if !compiled.airframe.allocation.controls(axis) {
            return None;
        }
        let [floor, ceiling] = compiled.thrust_range_n;
        let base = Wrench {
            thrust_n: floor + 0.4 * (ceiling - floor),
            ..Wrench::default()
        };
        let mut asked = base.to_array();
        asked[axis as usize] += (ASKED * size(compiled, axis)) as f32;
        let [before, after] = [base, Wrench::from_array(asked)].map(|wrench| throttles(compiled, &wrench));
        let (before, after) = (before?, after?);
        let changes = after.iter().zip(&before).map(|(a, b)| a - b);
        let largest = changes.clone().fold(0.0, f32::max);
        let mut changes: Vec<(usize, f32)> = changes.enumerate().collect();
        changes.retain(|(_, change)| *change > COUNTS * largest);
        Some(changes)
    }
}

/// The mixer's throttles at the reference voltage.
fn throttles(compiled: &Compiled, wrench: &Wrench) -> Option<Vec<f32>> {
    let volts = compiled.airframe.reference_v() as f32;
    let mixed = compiled.tables.mix(wrench, volts).ok();
    mixed.map(|(throttle, ..)| throttle)
}

/// The largest thrust, or a torque in proportion to what the units' efforts make of the axis.
fn size(compiled: &Compiled, axis: Axis) -> f64 {
    let scales = scales(&compiled.airframe, [1.0; 2]);
    compiled.effectiveness.largest(axis as usize, &scales)
}

/// Outputs of the upper and of the lower rotor of a unit; `None` of the lower one of a single rotor.
pub type Outputs = (usize, Option<usize>);

/// Every unit in words: its place, its outputs, and how its upper rotor spins, by place, spin and outputs:
/// `front right: outputs 0 and 4 (upper cw)`, `rear: output 2 (single ccw)`.
pub fn in_words(units: &[([f64; 3], Spin, Outputs)]) -> Vec<String> {
    let places: Vec<[f64; 3]> = units.iter().map(|(place, ..)| *place).collect();
    let each = units.iter().map(|(position_m, spin, (upper, lower))| {
        let (place, spin) = (place_among(*position_m, &places), spin.name());
        match lower {
            Some(lower) => format!("{place}: outputs {upper} and {lower} (upper {spin})"),
            None => format!("{place}: output {upper} (single {spin})"),
        }
    });
    each.collect()
}

/// [`in_words`] of a frame, with the kind of each unit where they differ.
pub fn frame(airframe: &Airframe) -> Vec<String> {
    let units = airframe.units.iter();
    let places = units.clone().map(|unit| {
        let outputs = (unit.upper_channel, unit.lower_channel);
        (unit.position_m, unit.upper_spin, outputs)
    });
    let told = in_words(&places.collect::<Vec<_>>()).into_iter().zip(units);
    told.map(|(told, unit)| told + &airframe.named_kind(unit))
        .collect()
}

/// Where a unit is among the others: `front right`.
fn place(unit: &Unit, units: &[Unit]) -> String {
    let places: Vec<[f64; 3]> = units.iter().map(|unit| unit.position_m).collect();
    place_among(unit.position_m, &places)
}

fn place_among([x, y, _]: [f64; 3], places: &[[f64; 3]]) -> String {
    let longest = places
        .iter()
        .fold(0.0f64, |longest, [x, y, _]| longest.max(x.abs()).max(y.abs()));
    let side = |offset: f64, positive, negative| match offset {
        x if x.abs() <= ON_AXIS * longest => None,
        x => Some(if x > 0.0 { positive } else { negative }),
    };
    match (side(x, "front", "rear"), side(y, "right", "left")) {
        (Some(along), Some(across)) => format!("{along} {across}"),
        (Some(only), None) | (None, Some(only)) => only.to_owned(),
        (None, None) => "centre".to_owned(),
    }
}
