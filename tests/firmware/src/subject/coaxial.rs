//! The compiled coaxial mixer.

use mixer_rt::{Health, Mix, SetpointError, Wrench};

use super::{ROTORS_OUT, airframe};

/// What a mix gives.
pub(crate) type Mixed = Result<Mix<{ airframe::CHANNELS }>, SetpointError>;

/// It has no state.
pub(crate) fn prepare() {}

#[inline(always)]
pub(crate) fn mix(setpoint: &Wrench, voltage_v: f32, health: Health) -> Mixed {
    if ROTORS_OUT == 0 {
        airframe::mix(setpoint, voltage_v)
    } else {
        airframe::mix_with_health(setpoint, voltage_v, health)
    }
}
