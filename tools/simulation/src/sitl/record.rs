//! The true flight, sample by sample.

use std::collections::BTreeMap;
use std::io::Write;

use nalgebra::Vector3;

use super::pilot::Pilot;
use super::plan::Target;
use super::vehicle::Throttles;
use super::world::World;
use crate::log::write_rows;

/// Time between samples, microseconds, and samples per row of the CSV.
const PERIOD_US: u64 = 4000;
const EVERY: usize = 5;

/// A moment of the flight.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Simulated time, s.
    pub time_s: f64,
    /// Time of the manoeuvre, s.
    pub manoeuvre_s: Option<f64>,
    /// What is asked for.
    pub target: Option<Target>,
    /// Position and velocity, m and m/s, north, east, down.
    pub position: Vector3<f64>,
    /// See `position`.
    pub velocity: Vector3<f64>,
    /// Roll, pitch, yaw, rad.
    pub euler: Vector3<f64>,
    /// Angular rate in the body, rad/s.
    pub rate: Vector3<f64>,
    /// Thrust of all rotors, N.
    pub thrust_n: f64,
    /// Voltage under load, V.
    pub voltage_v: f64,
    /// Current, A.
    pub current_a: f64,
    /// Thrust setpoint that the stack reports, 0 to 1; NaN before.
    pub thrust_setpoint: f64,
    /// Commanded throttles, one per rotor.
    pub throttles: Vec<f64>,
}

/// All samples, and what was counted beside them.
#[derive(Clone, Debug, Default)]
pub struct Record {
    /// In the order of time.
    pub samples: Vec<Sample>,
    /// Counts; those above 0 deserve a line.
    pub counts: BTreeMap<&'static str, u64>,
    next_us: u64,
}

impl Record {
    /// Takes a sample where one is due.
    pub fn take(&mut self, world: &World, pilot: Option<&dyn Pilot>, command: &Throttles) {
        if world.time_us < self.next_us {
            return;
        }
        self.next_us = world.time_us + PERIOD_US;
        let (state, time_s) = (&world.state, world.time_s());
        self.samples.push(Sample {
            time_s,
            manoeuvre_s: pilot.and_then(|pilot| pilot.manoeuvre_s(time_s)),
            target: pilot.and_then(|pilot| pilot.wanted(time_s)),
            position: state.position,
            velocity: state.velocity,
            euler: world.euler(),
            rate: state.rate,
            thrust_n: world.thrust_n(),
            voltage_v: world.voltage_v(),
            current_a: world.current_a(),
            thrust_setpoint: pilot.map_or(f64::NAN, |pilot| pilot.thrust_setpoint()),
            throttles: command.as_slice()[..world.vehicle.rotors].to_vec(),
        });
    }

    /// Counts on; how many there are.
    pub fn note(&mut self, what: &'static str, more: u64) -> u64 {
        let count = self.counts.entry(what).or_default();
        *count += more;
        *count
    }

    /// Writes every fifth sample, 20 ms from row to row; what is not known is empty.
    ///
    /// # Errors
    /// What `to` cannot take.
    pub fn write(&self, to: impl Write) -> csv::Result<()> {
        let names = "time_s,manoeuvre_s,target_x_m,target_y_m,target_up_m,target_yaw_deg,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,\
                     roll_deg,pitch_deg,yaw_deg,p_rad_s,q_rad_s,r_rad_s,thrust_n,voltage_v,current_a,thrust_setpoint";
        let rotors = self.samples.first().map_or(0, |sample| sample.throttles.len());
        let rows = self.samples.iter().step_by(EVERY).map(|sample| {
            let target = sample
                .target
                .map(|target| [target.offset.as_slice(), &[target.yaw_deg]].concat());
            let parts: [&[f64]; 9] = [
                &[sample.time_s, sample.manoeuvre_s.unwrap_or(f64::NAN)],
                target.as_deref().unwrap_or(&[f64::NAN; 4]),
                sample.position.as_slice(),
                sample.velocity.as_slice(),
                &<[f64; 3]>::from(sample.euler.map(f64::to_degrees)),
                sample.rate.as_slice(),
                &[sample.thrust_n, sample.voltage_v, sample.current_a],
                &[sample.thrust_setpoint],
                &sample.throttles,
            ];
            parts.concat()
        });
        write_rows(names, rotors, 5, rows, to)
    }
}
