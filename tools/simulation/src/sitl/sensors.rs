//! What the sensors of the vehicle measure, with noise.
//!
//! Sizes of the noise are those of PX4's jMAVSim, rounded; biases are left out.

use mixer_compiler::atmosphere;
use nalgebra::Vector3;
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::SeedableRng;

use super::world::World;
use crate::air::normal;

/// Standard deviations at a share of 1.
const ACCELERATION_M_S2: f64 = 0.05;
const RATE_RAD_S: f64 = 0.01;
const FIELD_GAUSS: f64 = 0.005;
const PRESSURE_HPA: f64 = 0.01;
const POSITION_M: f64 = 0.1;
const VELOCITY_M_S: f64 = 0.05;

/// Least share for magnetometer and barometer: PX4 takes readings for stale that do not change.
const LEAST_SHARE: f64 = 0.02;

/// Home: latitude and longitude, degrees.
const HOME: [f64; 2] = [47.397_742, 8.545_594];

/// The earth's field there, gauss, north, east, down.
const FIELD: Vector3<f64> = Vector3::new(0.214_75, 0.007_97, 0.428_17);

/// Radius of the earth, m.
const EARTH_M: f64 = 6_371_000.0;

/// The sensors and their noise.
#[derive(Clone, Debug)]
pub struct Sensors {
    share: f64,
    source: Pcg64Mcg,
}

impl Sensors {
    /// Sensors with a share of the usual noise; equal seeds give equal noise.
    pub fn new(share: f64, seed: u64) -> Sensors {
        Sensors {
            share,
            // Another sequence than that of the rotors' spread.
            source: Pcg64Mcg::seed_from_u64(seed ^ 0x5e_45_05),
        }
    }

    fn noise(&mut self, size: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| size * normal(&mut self.source))
    }

    /// Accelerometer, m/s2, and gyroscope, rad/s, in the body.
    pub fn inertial(&mut self, world: &World) -> [Vector3<f64>; 2] {
        let [force, rate] = [ACCELERATION_M_S2, RATE_RAD_S].map(|size| self.noise(self.share * size));
        [world.specific_force + force, world.state.rate + rate]
    }

    /// Magnetometer, gauss in the body.
    pub fn field(&mut self, world: &World) -> Vector3<f64> {
        world.state.rotation().inverse() * FIELD + self.noise(self.share.max(LEAST_SHARE) * FIELD_GAUSS)
    }

    /// Barometer, by the standard atmosphere: pressure, hPa, the altitude over the sea that it stands for, m, and the temperature,
    /// degrees Celsius.
    pub fn air(&mut self, world: &World) -> [f64; 3] {
        let altitude_m = world.vehicle.altitude_m - world.state.position.z;
        let noise = self.share.max(LEAST_SHARE) * PRESSURE_HPA * normal(&mut self.source);
        let pressure_hpa = 0.01 * atmosphere::pressure_at(altitude_m) + noise;
        let stands_for_m = (1.0 - libm::pow(pressure_hpa / 1013.25, 1.0 / 5.255_88)) / 2.255_77e-5;
        [
            pressure_hpa,
            stands_for_m,
            atmosphere::temperature_at(altitude_m) - 273.15,
        ]
    }

    /// Satellite receiver: [`place`], and velocity, m/s, north, east, down.
    pub fn fix(&mut self, world: &World) -> ([f64; 3], Vector3<f64>) {
        let [position, velocity] = [POSITION_M, VELOCITY_M_S].map(|size| self.noise(self.share * size));
        let state = &world.state;
        (
            place(&(state.position + position), world.vehicle.altitude_m),
            state.velocity + velocity,
        )
    }
}

/// Latitude and longitude in degrees and altitude in m of a position north, east, down of home, which is at an altitude.
pub fn place(position: &Vector3<f64>, altitude_m: f64) -> [f64; 3] {
    let [latitude, longitude] = HOME;
    let east = position.y / (EARTH_M * libm::cos(latitude.to_radians()));
    [
        latitude + (position.x / EARTH_M).to_degrees(),
        longitude + east.to_degrees(),
        altitude_m - position.z,
    ]
}
