//! The compiled coaxial mixer.

use mixer_rt::{Mix, SetpointError, Wrench};

use super::airframe;

/// What a mix gives.
pub(crate) type Mixed = Result<Mix<{ airframe::CHANNELS }>, SetpointError>;

/// It has no state.
pub(crate) fn prepare() {}

#[inline(always)]
pub(crate) fn mix(setpoint: &Wrench, voltage_v: f32) -> Mixed {
    airframe::mix(setpoint, voltage_v)
}
