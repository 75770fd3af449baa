//! The yaw of level flight with a rotor out, found by the mixer itself.

use mixer_rt::tables::{Airmode, LEVEL_YAWS, Priorities, REQUEST_LIMIT};
use mixer_rt::{Health, Wrench};

use crate::airframe::Airframe;
use crate::tables::MixerTables;

/// Share of the authority that level flight may miss of roll, pitch and thrust: what priorities trade.
const MISSED: f32 = 0.005;

/// Least and largest yaw (N m) of level flight at a thrust (N) and the reference voltage, the rotor of a channel out; `None`
/// where there is no such flight, or yaw is not served.
pub(crate) fn level_yaw(
    tables: &MixerTables,
    reference_v: f32,
    thrust_n: f32,
    channel: u8,
) -> Option<[f32; 2]> {
    // Thrust comes before yaw, and yaw is asked beyond all that there is.
    let mut tables = tables.clone();
    tables.priorities = Priorities {
        airmode: Airmode::RollPitch,
        yaw_reserve_nm: 0.0,
    };
    for unit in &mut tables.units {
        unit.level_yaw_nm = [[REQUEST_LIMIT; LEVEL_YAWS]; 2];
    }
    let [by_roll, by_pitch, by_yaw, by_thrust] = tables.rows;
    let slack = MISSED * tables.units.len() as f32;
    let yaw = |sense: f32| {
        let setpoint = Wrench {
            yaw_nm: sense * REQUEST_LIMIT,
            thrust_n,
            ..Wrench::default()
        };
        let health = Health::GOOD.with_failed(channel);
        let (_, achieved, _) = tables.mix_with_health(&setpoint, reference_v, health).ok()?;
        let missed = [
            by_roll * achieved.roll_nm,
            by_pitch * achieved.pitch_nm,
            by_thrust * (achieved.thrust_n - thrust_n),
        ];
        missed
            .iter()
            .all(|missed| missed.abs() <= slack)
            .then_some(achieved.yaw_nm)
    };
    if by_yaw == 0.0 {
        return None;
    }
    Some([yaw(-1.0)?, yaw(1.0)?])
}

/// Writes the yaw that level flight has in either sense, by rotor and thrust; no limit where yaw is not served, or where
/// no thrust has level flight.
pub(crate) fn set(airframe: &Airframe, tables: &mut MixerTables) {
    let reference_v = airframe.reference_v() as f32;
    let found = tables.units.iter().map(|unit| {
        unit.channels.map(|channel| {
            let yaws: [_; LEVEL_YAWS] = std::array::from_fn(|k| {
                let thrust_n = tables.level_n[1] * k as f32 / (LEVEL_YAWS - 1) as f32;
                level_yaw(tables, reference_v, thrust_n, channel)
            });
            match yaws.iter().all(Option::is_none) {
                true => [REQUEST_LIMIT; LEVEL_YAWS],
                false => yaws.map(|yaw| yaw.map_or(0.0, |[least, most]| most.min(-least).max(0.0))),
            }
        })
    });
    let found: Vec<_> = found.collect();
    for (unit, level_yaw_nm) in tables.units.iter_mut().zip(found) {
        unit.level_yaw_nm = level_yaw_nm;
    }
}
