//! The yaw of level flight with a rotor out, found by the mixer itself.

use mixer_rt::tables::{Airmode, LEVEL_YAWS, Priorities, REQUEST_LIMIT};
use mixer_rt::{Health, Wrench};

use crate::airframe::Airframe;
use crate::tables::MixerTables;

/// Share of the authority that level flight may miss of roll, pitch and thrust: what priorities trade.
const MISSED: f32 = 0.005;

/// The mixer that is asked: thrust comes before yaw, and no yaw is limited.
pub(crate) struct LevelYaw(MixerTables);

impl LevelYaw {
    pub(crate) fn new(tables: &MixerTables) -> LevelYaw {
        let mut tables = tables.clone();
        tables.priorities = Priorities {
            airmode: Airmode::RollPitch,
            yaw_reserve_nm: 0.0,
        };
        for unit in &mut tables.units {
            unit.level_yaw_nm = [[REQUEST_LIMIT; LEVEL_YAWS]; 2];
        }
        LevelYaw(tables)
    }

    /// Least and largest yaw (N m) of level flight at a thrust (N) and a voltage (V), the rotor of a channel out; `None`
    /// where there is no such flight, or yaw is not served.
    pub(crate) fn at(&self, volts: f32, thrust_n: f32, channel: u8) -> Option<[f64; 2]> {
        let [by_roll, by_pitch, by_yaw, by_thrust] = self.0.row_scale;
        let slack = MISSED * self.0.units.len() as f32;
        // More than all that there is.
        let yaw = |sense: f32| {
            let setpoint = Wrench {
                yaw_nm: sense * REQUEST_LIMIT,
                thrust_n,
                ..Wrench::default()
            };
            let health = Health::GOOD.with_failed(channel);
            let (_, achieved, _) = self.0.mix_with_health(&setpoint, volts, health).ok()?;
            let missed = [
                by_roll * achieved.roll_nm,
                by_pitch * achieved.pitch_nm,
                by_thrust * (achieved.thrust_n - thrust_n),
            ];
            let is_level = missed.iter().all(|missed| missed.abs() <= slack);
            is_level.then_some(achieved.yaw_nm.into())
        };
        if by_yaw == 0.0 {
            return None;
        }
        Some([yaw(-1.0)?, yaw(1.0)?])
    }
}

/// Of these least and largest yaws, N m, what there is in both senses; 0 where the vehicle turns by itself.
pub(crate) fn in_both_senses(yaw_nm: Option<[f64; 2]>) -> f64 {
    yaw_nm.map_or(0.0, |[least, most]| most.min(-least).max(0.0))
}

/// Writes the yaw that level flight has in either sense, by rotor and thrust; no limit where yaw is not served, or where
/// no thrust has level flight.
pub(crate) fn set(airframe: &Airframe, tables: &mut MixerTables) {
    let (asked, volts, most_n) = (
        LevelYaw::new(tables),
        airframe.reference_v() as f32,
        tables.level_n[1],
    );
    for unit in &mut tables.units {
        unit.level_yaw_nm = unit.channels.map(|channel| {
            let yaws: [_; LEVEL_YAWS] = std::array::from_fn(|k| {
                asked.at(volts, most_n * k as f32 / (LEVEL_YAWS - 1) as f32, channel)
            });
            match yaws.iter().all(Option::is_none) {
                true => [REQUEST_LIMIT; LEVEL_YAWS],
                false => yaws.map(|yaw| in_both_senses(yaw) as f32),
            }
        });
    }
}
