//! What runs under both executors: a yaw rate loop in front of the mixer, and the bench that it
//! flies on.
//!
//! The loop takes normalised gains, stops its integral where the mixer says that yaw is saturated,
//! and mixes with the last voltage that was measured.

use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m_semihosting::hprintln;
use mixer_rt::{Axis, Direction, Saturation, Wrench};

use crate::board::Pulses;
use crate::control::{Battery, Cycle, MotorControl};

mixer_macros::airframe!("../../airframes/isae-x8.toml");

/// Of the loop.
pub(crate) const RATE_HZ: u32 = 400;
/// The battery is measured so many times slower.
pub(crate) const CYCLES_PER_MEASUREMENT: u32 = 10;
/// A tenth of a second without a usable setpoint stops the rotors.
const PATIENCE: u32 = RATE_HZ / 10;
const PERIOD_S: f32 = 1.0 / RATE_HZ as f32;

const PROPORTIONAL: f32 = 0.2;
const INTEGRAL_PER_S: f32 = 0.1;

/// The battery's voltage between the task that measures it and the loop.
pub(crate) struct Voltage {
    /// V, as bits.
    last: AtomicU32,
}

impl Voltage {
    /// What was measured, V. Nothing but a positive number counts.
    pub(crate) fn measured(&self, voltage_v: f32) {
        if voltage_v.is_finite() && voltage_v > 0.0 {
            self.last.store(voltage_v.to_bits(), Ordering::Relaxed);
        }
    }
}

/// At first the reference voltage of the airframe.
pub(crate) static VOLTAGE: Voltage = Voltage {
    last: AtomicU32::new(14.8_f32.to_bits()),
};

impl Battery for &Voltage {
    fn voltage_v(&mut self) -> f32 {
        f32::from_bits(self.last.load(Ordering::Relaxed))
    }
}

/// Yaw rate loop, mixer, rotors, and the vehicle that turns.
pub(crate) struct RateLoop {
    motors: MotorControl<8, Pulses<8>, &'static Voltage>,
    cycle: u32,
    /// Yaw rate of the vehicle, rad/s, and the most of it.
    rate: f32,
    most: f32,
    /// Normalised torque.
    integral: f32,
    saturation: Saturation,
    saturated: u32,
    held: u32,
    disarmed: u32,
}

impl RateLoop {
    pub(crate) fn new() -> Self {
        RateLoop {
            motors: MotorControl::new(isae_x8::mix, Pulses::new(), &VOLTAGE, PATIENCE),
            cycle: 0,
            rate: 0.0,
            most: 0.0,
            integral: 0.0,
            saturation: Saturation::default(),
            saturated: 0,
            held: 0,
            disarmed: 0,
        }
    }

    /// One cycle; `false` at the end of the flight.
    pub(crate) fn cycle(&mut self) -> bool {
        let torque = self.torque(
            bench::rate_setpoint(self.cycle),
            bench::gyro(self.cycle, self.rate),
        );
        let setpoint = Wrench::from_normalised([0.0, 0.0, torque, bench::HOVER], &isae_x8::SCALE);
        match self.motors.cycle(&setpoint) {
            Cycle::Mixed { achieved, saturation } => {
                self.saturation = saturation;
                self.saturated += u32::from(saturation.is_saturated(Axis::Yaw, Direction::Positive));
                self.rate += achieved.yaw_nm / bench::YAW_INERTIA_KG_M2 * PERIOD_S;
                self.most = self.most.max(self.rate);
            }
            Cycle::Held => self.held += 1,
            Cycle::Disarmed => self.disarmed += 1,
        }
        self.cycle += 1;
        self.cycle < bench::CYCLES
    }

    /// Normalised torque of the PI controller. Its integral stops where the rotors could not follow
    /// it.
    fn torque(&mut self, setpoint: f32, rate: f32) -> f32 {
        let error = setpoint - rate;
        let wound_up = (error > 0.0 && self.saturation.is_saturated(Axis::Yaw, Direction::Positive))
            || (error < 0.0 && self.saturation.is_saturated(Axis::Yaw, Direction::Negative));
        if error.is_finite() && !wound_up {
            self.integral += INTEGRAL_PER_S * error * PERIOD_S;
        }
        PROPORTIONAL * error + self.integral
    }

    pub(crate) fn report(&self) {
        hprintln!(
            "yaw {} mrad/s of 4000, at most {}; saturated {}, held {}, disarmed {} of {} cycles at {} mV",
            (1000.0 * self.rate) as i32,
            (1000.0 * self.most) as i32,
            self.saturated,
            self.held,
            self.disarmed,
            self.cycle,
            (1000.0 * (&VOLTAGE).voltage_v()) as i32
        );
        hprintln!("pulses {:?} us", self.motors.outputs().width_us);
    }
}

/// In place of pilot, gyroscope and airframe: a yaw step beyond what the rotors give, and a
/// gyroscope that fails.
mod bench {
    use super::{PERIOD_S, RATE_HZ};

    pub(super) const CYCLES: u32 = 4 * RATE_HZ;
    pub(super) const YAW_INERTIA_KG_M2: f32 = 0.12;
    /// Normalised thrust of a vehicle of 3.2 kg.
    pub(super) const HOVER: f32 = 0.3165;

    /// rad/s.
    pub(super) fn rate_setpoint(cycle: u32) -> f32 {
        if cycle as f32 * PERIOD_S < 0.1 { 0.0 } else { 4.0 }
    }

    /// Three samples are lost, and all of the last quarter of a second.
    pub(super) fn gyro(cycle: u32, rate: f32) -> f32 {
        match cycle {
            800..803 | 1500.. => f32::NAN,
            _ => rate,
        }
    }
}
