//! From setpoint and voltage to throttles and the achieved wrench.

use crate::desaturation::desaturate;
use crate::voltage::Correction;
use crate::{Axis, Inverse, Quantity, Saturation, SetpointError, Tables, Wrench};

/// What a mix gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mix<const CHANNELS: usize> {
    /// Throttle per output channel, each within the airframe's range.
    pub throttle: [f32; CHANNELS],
    /// The wrench that these throttles give by the airframe's model, at the given voltage.
    pub achieved: Wrench,
    /// What could not be delivered.
    pub saturation: Saturation,
}

/// Mixes for an airframe of `UNITS` units and `CHANNELS` = 2 `UNITS` rotors. `voltage_v` is the battery's present
/// voltage, V; an airframe without `[voltage]` ignores it.
///
/// # Errors
/// A setpoint or voltage that is infinite or NaN: see [`SetpointError`].
#[inline(always)]
pub fn mix<const UNITS: usize, const CHANNELS: usize, P: Quantity, I: Inverse<P>>(
    tables: &Tables<'_, P, I>,
    setpoint: &Wrench,
    voltage_v: f32,
) -> Result<Mix<CHANNELS>, SetpointError> {
    let mut efforts = [[0.0; 2]; UNITS];
    let mut throttle = [tables.throttle.min; CHANNELS];
    let (achieved, saturation) = mix_into(tables, setpoint, voltage_v, &mut efforts, &mut throttle)?;
    Ok(Mix {
        throttle,
        achieved,
        saturation,
    })
}

/// [`mix`] into buffers, for layouts whose size is known only at run time: `efforts` takes one `[f, Q]` per unit
/// (at the reference voltage), `throttle` one value per channel. Units or channels beyond a buffer's end are left
/// out.
///
/// # Errors
/// As [`mix`]; the buffers are then as they were.
#[inline(always)]
pub fn mix_into<P: Quantity, I: Inverse<P>>(
    tables: &Tables<'_, P, I>,
    setpoint: &Wrench,
    voltage_v: f32,
    efforts: &mut [[f32; 2]],
    throttle: &mut [f32],
) -> Result<(Wrench, Saturation), SetpointError> {
    let request = setpoint.to_array();
    for (value, axis) in request.iter().zip(Axis::ALL) {
        if !value.is_finite() {
            return Err(SetpointError::NonFinite(axis));
        }
    }
    let Correction { factors, clamped } = Correction::at(tables.voltage.as_ref(), voltage_v)?;
    let per_factor = factors.map(|factor| 1.0 / factor);

    for (unit, efforts) in tables.units.iter().zip(efforts.iter_mut()) {
        let [f, q] = unit.efforts(&request);
        *efforts = [f * per_factor[0], q * per_factor[1]];
    }
    let (mut achieved, delivered) = invert(tables, factors, efforts, throttle);
    if !delivered {
        desaturate(tables, request, factors, per_factor, efforts);
        (achieved, _) = invert(tables, factors, efforts, throttle);
    }
    let saturation = Saturation::between(&request, &achieved, &tables.tolerance.wrench);
    Ok((
        Wrench::from_array(achieved),
        saturation.with_voltage_clamped(clamped),
    ))
}

/// Writes the throttles of all units for `efforts`; returns the wrench `[roll, pitch, yaw, thrust]` that they give
/// and whether every unit gives its efforts within the tolerance.
#[inline(always)]
fn invert<P: Quantity, I: Inverse<P>>(
    tables: &Tables<'_, P, I>,
    factors: [f32; 2],
    efforts: &[[f32; 2]],
    throttle: &mut [f32],
) -> ([f32; 4], bool) {
    let mut achieved = [0.0; 4];
    let mut delivered = true;
    for (unit, efforts) in tables.units.iter().zip(efforts) {
        let throttles = tables.inverse.throttles(&tables.pair, &tables.throttle, *efforts);
        for (channel, value) in unit.channels.iter().zip(throttles) {
            if let Some(slot) = throttle.get_mut(usize::from(*channel)) {
                *slot = value;
            }
        }
        let given = tables.pair.efforts(throttles);
        for ((given, efforts), tolerance) in given.iter().zip(efforts).zip(tables.tolerance.efforts) {
            let missed = given - efforts;
            delivered &= missed <= tolerance && missed >= -tolerance;
        }
        for ((effect, factor), given) in unit.effectiveness.iter().zip(factors).zip(given) {
            let given = factor * given;
            for (achieved, effect) in achieved.iter_mut().zip(effect) {
                *achieved += effect * given;
            }
        }
    }
    (achieved, delivered)
}

/// An airframe's mixer as a type, for code that is generic over airframes. The compiler implements it.
pub trait Airframe {
    /// The name in the airframe file.
    const NAME: &'static str;
    /// [`Mix`] for the airframe's number of channels.
    type Mix;

    /// As [`mix`].
    ///
    /// # Errors
    /// As [`mix`].
    fn mix(setpoint: &Wrench, voltage_v: f32) -> Result<Self::Mix, SetpointError>;
}
