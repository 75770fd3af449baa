//! The range of thrust without torques, by the mixer itself: a frame that cannot hover is refused.

use mixer_rt::tables::{Airmode, REQUEST_LIMIT};
use mixer_rt::{Axis, Direction, Saturation, Wrench};

use crate::airframe::Airframe;
use crate::diagnostic::{Code, Diagnostic};
use crate::tables::{AnyMix, MixerTables};

/// Halvings of the thrusts between one that is delivered and one that is not.
const HALVINGS: usize = 20;

/// Thrusts at which least norm is tried.
const STEPS: usize = 64;

/// Least and largest thrust without roll, pitch and yaw, N at the reference voltage, that the tables
/// deliver.
///
/// # Errors
/// A layout that cannot hover: at no thrust, or at a single one only, the served torques vanish.
pub(crate) fn thrust_range(airframe: &Airframe, tables: &MixerTables) -> Result<[f32; 2], Vec<Diagnostic>> {
    let range = attainable(airframe, tables).ok_or_else(|| {
        vec![airframe.diagnostic(
            Code::Hover,
            "unit",
            "no thrust is attainable without roll, pitch or yaw".to_owned(),
            "",
            "check positions, spins and thrust axes: the units must balance each other, each with a torque near zero",
        )]
    })?;
    Ok(delivered(airframe, tables, range))
}

/// The ends of level flight, which the interior point method comes next to; `None` where these are
/// not two.
fn attainable(airframe: &Airframe, tables: &MixerTables) -> Option<[f32; 2]> {
    // Thrust is given up before the torques, in as many steps as that takes.
    let mut tables = tables.clone();
    tables.priorities.airmode = Airmode::RollPitchYaw;
    tables.closed_form = None;
    let end = |thrust_n: f32| {
        let (_, achieved, saturation) = mix_bare(airframe, &tables, thrust_n)?;
        let mut axes = airframe.allocation.axes.iter();
        let is_level = axes.all(|&axis| axis == Axis::Thrust || !saturated(saturation, axis));
        is_level.then_some(achieved.thrust_n)
    };
    let range = [end(0.0)?, end(REQUEST_LIMIT)?];
    (range[0] < range[1]).then_some(range)
}

/// The range within these ends, or a little beyond, whose thrusts are delivered.
fn delivered(airframe: &Airframe, tables: &MixerTables, [floor, ceiling]: [f32; 2]) -> [f32; 2] {
    let is_delivered = |thrust_n: f32| {
        let mixed = mix_bare(airframe, tables, thrust_n);
        mixed.is_some_and(|(_, _, saturation)| !saturation.any_axis())
    };
    let end = |inside: f32, outside: f32| halved(inside, outside, &is_delivered);
    let (middle, margin) = (0.5 * (floor + ceiling), 0.1 * (ceiling - floor));
    [end(middle, floor - margin), end(middle, ceiling + margin)]
}

/// Least and largest thrust without torques, N at the reference voltage, that least norm delivers at
/// every voltage: the longest run of such thrusts. Both are 0 where there is none.
pub(crate) fn level(airframe: &Airframe, tables: &MixerTables) -> [f32; 2] {
    let factors: Vec<[f64; 2]> = airframe.voltage.as_ref().map_or(vec![[1.0; 2]], |voltage| {
        let [low, high] = voltage.range_v;
        let volts = [low, voltage.reference_v, high];
        volts.map(|volts| airframe.voltage_factors(volts)).to_vec()
    });
    let delivers = |thrust_n: f32| {
        factors.iter().all(|factors| {
            let wrench = [0.0, 0.0, 0.0, factors[0] as f32 * thrust_n];
            tables.least_norm(wrench, *factors).is_some()
        })
    };
    let lift: f32 = tables.units.iter().map(|unit| unit.effectiveness[0][3]).sum();
    let most = lift * tables.pair.efforts([tables.throttle.max; 2])[0];
    let at = |step: usize| most * step as f32 / STEPS as f32;
    let delivered: Vec<bool> = (0..=STEPS).map(|step| delivers(at(step))).collect();
    let mut best = 0..0;
    let mut first = 0;
    for (step, is_delivered) in delivered.into_iter().enumerate() {
        if !is_delivered {
            first = step + 1;
        } else if step + 1 - first > best.len() {
            best = first..step + 1;
        }
    }
    if best.is_empty() {
        return [0.0; 2];
    }
    let end = |inside: usize, outside: f32| halved(at(inside), outside, &delivers);
    [
        end(best.start, at(best.start) - at(1)),
        end(best.end - 1, at(best.end)),
    ]
}

/// The thrust (N) nearest `outside` that still counts as inside, by halving.
fn halved(mut inside: f32, mut outside: f32, is_inside: &dyn Fn(f32) -> bool) -> f32 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (inside + outside);
        if is_inside(middle) {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    inside
}

/// Throttles, achieved wrench and saturation of a request for thrust alone at the reference voltage.
fn mix_bare(airframe: &Airframe, tables: &MixerTables, thrust_n: f32) -> Option<AnyMix> {
    let setpoint = Wrench {
        thrust_n,
        ..Wrench::default()
    };
    tables.mix(&setpoint, airframe.reference_v() as f32).ok()
}

fn saturated(saturation: Saturation, axis: Axis) -> bool {
    [Direction::Positive, Direction::Negative]
        .into_iter()
        .any(|direction| saturation.is_saturated(axis, direction))
}
