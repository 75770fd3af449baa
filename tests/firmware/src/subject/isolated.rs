//! The mixers of `isolated_rotors`.

use mixer_rt::{Health, SetpointError, Wrench};

use super::{ISOLATED, airframe};

/// Throttles, and whether none was clipped.
pub(crate) type Mixed = Result<([f32; airframe::CHANNELS], bool), SetpointError>;

/// It has no state.
pub(crate) fn prepare() {}

#[inline(always)]
pub(crate) fn mix(setpoint: &Wrench, voltage_v: f32, _: Health) -> Mixed {
    let mut throttle = [0.0; airframe::CHANNELS];
    #[cfg(baseline = "conventional")]
    let within = ISOLATED.conventional(setpoint, voltage_v, &mut throttle)?;
    #[cfg(baseline = "sequential")]
    let within = ISOLATED.sequential(
        airframe::TABLES.priorities.airmode,
        setpoint,
        voltage_v,
        &mut throttle,
    )?;
    Ok((throttle, within))
}
