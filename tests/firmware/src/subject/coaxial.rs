//! The compiled coaxial mixer.

use core::hint::black_box;

use mixer_rt::{Conditions, Health, Mix, SetpointError, Wrench};

use super::{ROTORS_OUT, airframe};

/// What a mix gives.
pub(crate) type Mixed = Result<Mix<{ airframe::CHANNELS }>, SetpointError>;

/// It has no state.
pub(crate) fn prepare() {}

#[inline(always)]
pub(crate) fn mix(setpoint: &Wrench, voltage_v: f32, health: Health) -> Mixed {
    // In thin air, which the compiler must not know.
    if let Some(air) = &airframe::TABLES.air {
        let conditions = Conditions::at_voltage(voltage_v).in_air(black_box(0.9 * air.reference));
        if ROTORS_OUT == 0 {
            airframe::mix(setpoint, conditions)
        } else {
            airframe::mix_with_health(setpoint, conditions, health)
        }
    } else if ROTORS_OUT == 0 {
        airframe::mix(setpoint, voltage_v)
    } else {
        airframe::mix_with_health(setpoint, voltage_v, health)
    }
}
