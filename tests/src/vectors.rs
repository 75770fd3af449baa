//! The setpoints of the golden vectors.

mod saturated;

use mixer_compiler::Compiled;
use mixer_compiler::model::PairMap;
use mixer_rt::Wrench;
use mixer_setpoints::{Ranges, Setpoints};

use saturated::Saturated;

/// Wrenches that random throttles give: attainable, by least norm or with the null space's help.
const ATTAINABLE: usize = 80;

/// Wrenches drawn about hover: what a controller asks for.
const ORDINARY: usize = 80;

/// Wrenches drawn from three times the attainable ranges, and special numbers.
const EXCESSIVE: usize = 80;

/// What a golden vector is of. The table holds the kinds in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Zero, single axes, thrusts to the ceiling and voltages beyond the range, chosen by hand.
    ByHand,
    /// Wrenches of random throttles at random voltages.
    Attainable,
    /// Wrenches about hover.
    Ordinary,
    /// Up to three times what is attainable on every axis, and special numbers.
    Excessive,
    /// One axis alone far beyond what there is.
    Alone,
    /// Several axes beyond what there is, all signs.
    Together,
    /// Torques with no thrust, with less than none and with next to none; torques next to none.
    Faint,
    /// Corners of the attainable set at both ends of the voltage's range, and a little inside and outside.
    Edge,
    /// Attainable, but not with least-norm efforts. None where there is no freedom left.
    NullSpace,
}

/// Setpoints and voltages with their kinds, always the same for one airframe, all finite.
pub fn by_kind(compiled: &Compiled) -> Vec<(Kind, Vec<(Wrench, f32)>)> {
    let saturated = Saturated::new(compiled);
    vec![
        (Kind::ByHand, by_hand(compiled)),
        (Kind::Attainable, attainable(compiled).take(ATTAINABLE).collect()),
        (Kind::Ordinary, drawn(compiled, 0.15, 1).take(ORDINARY).collect()),
        (Kind::Excessive, drawn(compiled, 3.0, 2).take(EXCESSIVE).collect()),
        (Kind::Alone, saturated.alone()),
        (Kind::Together, saturated.together()),
        (Kind::Faint, saturated.faint()),
        (Kind::Edge, saturated.edge()),
        (Kind::NullSpace, saturated.null_space()),
    ]
}

/// [`by_kind`] in one list.
pub fn setpoints(compiled: &Compiled) -> Vec<(Wrench, f32)> {
    by_kind(compiled).into_iter().flat_map(|(_, list)| list).collect()
}

/// Reference voltage and ends of the range; any numbers where the airframe ignores the voltage.
pub fn voltages(compiled: &Compiled) -> [f32; 3] {
    compiled
        .airframe
        .voltage
        .as_ref()
        .map_or([14.0, 12.0, 16.0], |voltage| {
            [voltage.reference_v, voltage.range_v[0], voltage.range_v[1]].map(|v| v as f32)
        })
}

/// The largest wrench on each axis: all units at their best, whatever the others lose.
fn largest(compiled: &Compiled) -> [f32; 4] {
    let pair = PairMap::new(&compiled.airframe.pair, &compiled.airframe.throttle);
    let [f, q] = pair.scale();
    let n = compiled.airframe.units.len();
    let matrix = &compiled.effectiveness.matrix;
    std::array::from_fn(|axis| {
        let row = matrix.row(axis);
        (0..n)
            .map(|i| row[i].abs() * f + row[n + i].abs() * q)
            .sum::<f64>() as f32
    })
}

/// Zero, each axis alone on both sides, thrusts to the ceiling, voltages beyond the range.
fn by_hand(compiled: &Compiled) -> Vec<(Wrench, f32)> {
    let [reference, low, high] = voltages(compiled);
    let size = largest(compiled);
    let mut list = vec![(Wrench::default(), reference)];
    for share in [0.02, 0.3, 0.6, 0.97, 1.2] {
        for voltage in [reference, low - 1.0, low, high, high + 1.0] {
            list.push((
                Wrench {
                    thrust_n: share * size[3],
                    ..Wrench::default()
                },
                voltage,
            ));
        }
        for axis in 0..3 {
            for torque in [-1.5, -0.2, 0.2, 1.5] {
                let mut wrench = [0.0, 0.0, 0.0, share * size[3]];
                wrench[axis] = torque * size[axis];
                list.push((Wrench::from_array(wrench), reference));
            }
        }
    }
    list
}

/// Wrenches of random throttles at random voltages.
pub fn attainable(compiled: &Compiled) -> impl Iterator<Item = (Wrench, f32)> {
    let pair = PairMap::new(&compiled.airframe.pair, &compiled.airframe.throttle);
    let [low, high] = pair.range().map(|throttle| throttle as f32);
    let n = compiled.airframe.units.len();
    let matrix = compiled.effectiveness.matrix.clone();
    let voltage = compiled.airframe.voltage.clone();
    let [_, low_v, high_v] = voltages(compiled);
    let ranges = Ranges {
        moments_nm: [0.0; 3],
        thrust_n: [low, high],
        voltage_v: [low_v, high_v],
    };
    // The generator's thrust serves as a source of throttles; its special numbers are left out.
    let mut throttles = Setpoints::new(3, ranges)
        .filter(move |s| (low..=high).contains(&s.wrench[3]) && (low_v..=high_v).contains(&s.voltage_v));
    std::iter::from_fn(move || {
        let mut wrench = [0.0; 4];
        let mut voltage_v = low_v;
        for i in 0..n {
            let (upper, lower) = (throttles.next()?, throttles.next()?);
            if i == 0 {
                voltage_v = upper.voltage_v;
            }
            let volts = f64::from(voltage_v);
            let [f, q] = pair.efforts([upper.wrench[3], lower.wrench[3]].map(f64::from));
            let (k_f, k_q) = voltage
                .as_ref()
                .map_or((1.0, 1.0), |v| (v.thrust_factor(volts), v.torque_factor(volts)));
            for (axis, sum) in wrench.iter_mut().enumerate() {
                *sum += matrix[(axis, i)] * k_f * f + matrix[(axis, n + i)] * k_q * q;
            }
        }
        Some((Wrench::from_array(wrench.map(|x| x as f32)), voltage_v))
    })
}

/// Wrenches drawn from `share` of the largest torques and, for small shares, thrusts about the middle.
fn drawn(compiled: &Compiled, share: f32, seed: u64) -> impl Iterator<Item = (Wrench, f32)> {
    let [_, low_v, high_v] = voltages(compiled);
    let [roll, pitch, yaw, thrust] = largest(compiled);
    let thrust_n = if share < 1.0 {
        [0.2 * thrust, 0.7 * thrust]
    } else {
        [-0.2 * thrust, 1.5 * thrust]
    };
    let ranges = Ranges {
        moments_nm: [roll, pitch, yaw].map(|torque| share * torque),
        thrust_n,
        voltage_v: [low_v, high_v],
    };
    Setpoints::new(seed, ranges)
        .filter(|s| s.wrench.iter().all(|value| value.is_finite()))
        .map(|s| (Wrench::from_array(s.wrench), s.voltage_v))
}
