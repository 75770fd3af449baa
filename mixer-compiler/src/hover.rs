//! The range of bare thrust, mixed with the very tables that are emitted: a frame that cannot hover is refused.

use mixer_rt::{Airmode, Axis, Direction, Saturation, Wrench};

use crate::airframe::Airframe;
use crate::diagnostic::{Code, Diagnostic};
use crate::tables::MixerTables;

/// More thrust than any airframe has, N.
const BEYOND_N: f32 = 1e5;

/// Least and largest thrust without roll, pitch and yaw, N at the reference voltage.
///
/// # Errors
/// A layout that cannot hover: at no thrust, or at a single one only, the served torques vanish.
pub(crate) fn thrust_range(airframe: &Airframe, tables: &MixerTables) -> Result<[f32; 2], Vec<Diagnostic>> {
    // Where thrust gives way to the torques.
    let mut tables = tables.clone();
    tables.desaturation.airmode = Airmode::RollPitchYaw;
    let voltage_v = airframe
        .voltage
        .as_ref()
        .map_or(0.0, |voltage| voltage.reference_v as f32);
    let bare = |thrust_n: f32| {
        let setpoint = Wrench {
            thrust_n,
            ..Wrench::default()
        };
        let (_, achieved, saturation) = tables.mix(&setpoint, voltage_v).ok()?;
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

fn saturated(saturation: Saturation, axis: Axis) -> bool {
    [Direction::Positive, Direction::Negative]
        .into_iter()
        .any(|direction| saturation.is_saturated(axis, direction))
}
