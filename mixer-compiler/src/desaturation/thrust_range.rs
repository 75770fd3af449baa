//! The range of bare thrust, by the mixer itself: a frame that cannot hover is refused.

use mixer_rt::{Axis, Direction, Saturation, Wrench, tables::Airmode};

use crate::airframe::Airframe;
use crate::diagnostic::{Code, Diagnostic};
use crate::tables::MixerTables;

/// More thrust than any airframe has, N.
const BEYOND_N: f32 = 1e5;

/// Halvings of the thrusts between one that is delivered and one that is not.
const HALVINGS: usize = 24;

/// Least and largest thrust without roll, pitch and yaw, N at the reference voltage, within the
/// polygon that the general path knows of the attainable set.
///
/// # Errors
/// A layout that cannot hover: at no thrust, or at a single one only, the served torques vanish.
pub(crate) fn thrust_range(airframe: &Airframe, tables: &MixerTables) -> Result<[f32; 2], Vec<Diagnostic>> {
    // In this airmode thrust is given up before the torques.
    let mut tables = tables.clone();
    tables.desaturation.airmode = Airmode::RollPitchYaw;
    let bare = |thrust_n: f32| {
        let (achieved, saturation) = mix_bare(airframe, &tables, thrust_n)?;
        let level = airframe
            .allocation
            .axes
            .iter()
            .filter(|&&axis| axis != Axis::Thrust)
            .all(|&axis| !saturated(saturation, axis));
        level.then_some(achieved.thrust_n)
    };
    match (bare(0.0), bare(BEYOND_N)) {
        (Some(floor), Some(ceiling)) if floor < ceiling => Ok([floor, ceiling]),
        _ => Err(vec![airframe.diagnostic(
            Code::Hover,
            "unit",
            "no thrust is attainable without roll, pitch or yaw".to_owned(),
            "",
            "check positions, spins and thrust axes: the units must balance each other, each with a torque near zero",
        )]),
    }
}

/// [`thrust_range`] of the tables that are emitted. Their closed form may cover more of the
/// attainable set than the polygon: the search goes outwards from the ends `within` the polygon.
pub(crate) fn delivered_range(
    airframe: &Airframe,
    tables: &MixerTables,
    within @ [floor, ceiling]: [f32; 2],
) -> [f32; 2] {
    if tables.closed_form.is_none() {
        return within;
    }
    let end = |mut inside: f32, mut outside: f32| {
        let mut reached = inside;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            match mix_bare(airframe, tables, middle) {
                Some((achieved, saturation)) if !saturation.any_axis() => {
                    (inside, reached) = (middle, achieved.thrust_n);
                }
                _ => outside = middle,
            }
        }
        reached
    };
    let span = ceiling - floor;
    [end(floor, floor - span), end(ceiling, ceiling + span)]
}

/// Achieved wrench and saturation of a request for thrust alone at the reference voltage.
fn mix_bare(airframe: &Airframe, tables: &MixerTables, thrust_n: f32) -> Option<(Wrench, Saturation)> {
    let voltage_v = airframe.reference_v() as f32;
    let setpoint = Wrench {
        thrust_n,
        ..Wrench::default()
    };
    let (_, achieved, saturation) = tables.mix(&setpoint, voltage_v).ok()?;
    Some((achieved, saturation))
}

fn saturated(saturation: Saturation, axis: Axis) -> bool {
    [Direction::Positive, Direction::Negative]
        .into_iter()
        .any(|direction| saturation.is_saturated(axis, direction))
}
