//! The range of bare thrust and level flight at its ends, by the mixer itself: a frame that cannot
//! hover is refused.

use mixer_rt::tables::{Airmode, Budget, REQUEST_LIMIT};
use mixer_rt::{Axis, Direction, Saturation, Wrench};

use crate::airframe::{Airframe, Unit};
use crate::diagnostic::{Code, Diagnostic};
use crate::model::PairMap;
use crate::tables::{AnyMix, LevelFlightTable, MixerTables, Parts};

/// Halvings of the thrusts between one that is delivered and one that is not.
const HALVINGS: usize = 24;

/// Share by which the polygon is drawn in for level flight. With tilted axes level flight depends on
/// the voltage: this is room to correct it.
const ROOM: f32 = 0.03;

/// Least and largest thrust without roll, pitch and yaw, N at the reference voltage, within the
/// polygon that the general path knows of the attainable set. Then level flight there; with tilted
/// axes inside the polygon by [`ROOM`] where the frame has as much.
///
/// # Errors
/// A layout that cannot hover: at no thrust, or at a single one only, the served torques vanish.
pub(crate) fn thrust_range(parts: &Parts<'_>) -> Result<([f32; 2], LevelFlightTable), Vec<Diagnostic>> {
    // Thrust is given up before the torques, in as many steps as that takes.
    let (airframe, pair) = (parts.airframe, parts.pair);
    let mut tables = MixerTables::new(parts, LevelFlightTable::default(), None);
    tables.desaturation.airmode = Airmode::RollPitchYaw;
    tables.desaturation.budget = Budget {
        pivots: u8::MAX,
        flips: u8::MAX,
    };
    let level = level_flight(airframe, pair, &tables).ok_or_else(|| {
        vec![airframe.diagnostic(
            Code::Hover,
            "unit",
            "no thrust is attainable without roll, pitch or yaw".to_owned(),
            "",
            "check positions, spins and thrust axes: the units must balance each other, each with a torque near zero",
        )]
    })?;
    let range_n = level.thrust_n;
    if tables.is_vertical {
        return Ok((range_n, level));
    }
    tables.attainable = tables.attainable.drawn_in(ROOM);
    Ok((range_n, level_flight(airframe, pair, &tables).unwrap_or(level)))
}

/// Level flight at the least and the largest thrust; `None` where these are not two.
fn level_flight(airframe: &Airframe, pair: &PairMap, tables: &MixerTables) -> Option<LevelFlightTable> {
    let end = |thrust_n: f32| {
        let (throttle, achieved, saturation) = mix_bare(airframe, tables, thrust_n)?;
        let mut axes = airframe.allocation.axes.iter();
        let is_level = axes.all(|&axis| axis == Axis::Thrust || !saturated(saturation, axis));
        let efforts = |unit: &Unit| {
            let throttles = [unit.upper_channel, unit.lower_channel].map(|channel| throttle[channel]);
            pair.efforts(throttles.map(f64::from))
        };
        let efforts: Vec<[f64; 2]> = airframe.units.iter().map(efforts).collect();
        is_level.then_some((achieved.thrust_n, efforts))
    };
    let ((least_n, at_least), (largest_n, at_largest)) = (end(0.0)?, end(REQUEST_LIMIT)?);
    let efforts: Vec<[[f64; 2]; 2]> = at_least.into_iter().zip(at_largest).map(Into::into).collect();
    let level = || LevelFlightTable::new([least_n, largest_n], &efforts, tables.attainable.scale);
    (least_n < largest_n).then(level)
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
                Some((_, achieved, saturation)) if !saturation.any_axis() => {
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

/// Throttles, achieved wrench and saturation of a request for thrust alone at the reference voltage.
fn mix_bare(airframe: &Airframe, tables: &MixerTables, thrust_n: f32) -> Option<AnyMix> {
    let voltage_v = airframe.reference_v() as f32;
    let setpoint = Wrench {
        thrust_n,
        ..Wrench::default()
    };
    tables.mix(&setpoint, voltage_v).ok()
}

fn saturated(saturation: Saturation, axis: Axis) -> bool {
    [Direction::Positive, Direction::Negative]
        .into_iter()
        .any(|direction| saturation.is_saturated(axis, direction))
}
