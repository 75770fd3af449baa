//! Per-axis saturation flags, for anti-windup.

use core::fmt;

use crate::Axis;

/// The side on which an axis is saturated.
///
/// ```
/// # use mixer_rt::{Axis, Direction, Saturation};
/// /// The integrator of one axis, held where the mixer cannot follow it.
/// fn integrate(state: f32, error: f32, axis: Axis, saturation: Saturation) -> f32 {
///     let direction = if error > 0.0 { Direction::Positive } else { Direction::Negative };
///     if saturation.is_saturated(axis, direction) { state } else { state + error }
/// }
/// assert_eq!(integrate(1.0, 0.5, Axis::Yaw, Saturation::from_bits(1 << 4)), 1.0);
/// assert_eq!(integrate(1.0, -0.5, Axis::Yaw, Saturation::from_bits(1 << 4)), 0.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Direction {
    /// Less was delivered than asked: the integrator must not grow further upwards.
    Positive,
    /// More was delivered than asked: the integrator must not grow further downwards.
    Negative,
}

/// What could not be delivered. Bit `2 * axis` is [`Direction::Positive`], bit `2 * axis + 1` is
/// [`Direction::Negative`], with roll 0, pitch 1, yaw 2, thrust 3; bit 8 says that the voltage was
/// clamped, bit 9 that the density was, or was not measured.
// Of 32 bits, so that a mix consists of whole words; see `SetpointError`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(from = "u16", into = "u16"))]
pub struct Saturation(u32);

impl Saturation {
    /// Everything was delivered.
    pub const NONE: Saturation = Saturation(0);
    pub(crate) const VOLTAGE: Saturation = Saturation(1 << 8);
    pub(crate) const DENSITY: Saturation = Saturation(1 << 9);

    /// The bits as documented on the type: 0..=0x3ff.
    #[inline]
    pub const fn bits(self) -> u16 {
        self.0 as u16
    }

    /// The inverse of [`Saturation::bits`]; unknown bits are dropped.
    #[inline]
    pub const fn from_bits(bits: u16) -> Self {
        Saturation(bits as u32 & 0x3ff)
    }

    /// True where anything was given up on this axis in this direction.
    #[inline]
    #[must_use]
    pub const fn is_saturated(self, axis: Axis, direction: Direction) -> bool {
        let bit = 2 * axis as u32 + direction as u32;
        self.0 & (1 << bit) != 0
    }

    /// True where any axis is saturated.
    #[inline]
    #[must_use]
    pub const fn any_axis(self) -> bool {
        self.0 & 0xff != 0
    }

    /// True where the voltage lay outside the airframe's range and was clamped into it.
    #[inline]
    #[must_use]
    pub const fn voltage_clamped(self) -> bool {
        self.0 & Self::VOLTAGE.0 != 0
    }

    /// True where the air's density lay outside the airframe's range and was clamped into it, or was
    /// NaN, infinite, zero or negative and taken as the bench's.
    #[inline]
    #[must_use]
    pub const fn density_clamped(self) -> bool {
        self.0 & Self::DENSITY.0 != 0
    }

    /// True where anything was given up on this axis, in either direction.
    #[inline]
    #[must_use]
    pub const fn is_flagged(self, axis: Axis) -> bool {
        self.0 & (3 << (2 * axis as u32)) != 0
    }

    /// The flags of both.
    #[inline]
    pub(crate) const fn with(self, other: Saturation) -> Self {
        Saturation(self.0 | other.0)
    }

    /// Flags every axis on which `achieved` misses `requested` by more than `tolerance`.
    #[inline]
    pub(crate) fn between(requested: &[f32; 4], achieved: &[f32; 4], tolerance: &[f32; 4]) -> Self {
        let mut bits = 0;
        let mut bit = 1;
        for ((requested, achieved), tolerance) in requested.iter().zip(achieved).zip(tolerance) {
            let missing = requested - achieved;
            if missing > *tolerance {
                bits |= bit;
            }
            if missing < -*tolerance {
                bits |= bit << 1;
            }
            bit <<= 2;
        }
        Saturation(bits)
    }
}

/// The saturated axes by name, `+` where less was delivered than asked and `-` where more was:
///
/// ```
/// # use mixer_rt::Saturation;
/// assert_eq!(Saturation::from_bits(0b1_0010_0001).to_string(), "roll+ yaw- voltage");
/// assert_eq!(Saturation::NONE.to_string(), "none");
/// ```
impl fmt::Display for Saturation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut separator = "";
        for axis in Axis::ALL {
            for (direction, sign) in [(Direction::Positive, '+'), (Direction::Negative, '-')] {
                if self.is_saturated(axis, direction) {
                    write!(f, "{separator}{axis}{sign}")?;
                    separator = " ";
                }
            }
        }
        for (flag, name) in [(Self::VOLTAGE, "voltage"), (Self::DENSITY, "density")] {
            if self.0 & flag.0 != 0 {
                write!(f, "{separator}{name}")?;
                separator = " ";
            }
        }
        if separator.is_empty() {
            f.write_str("none")?;
        }
        Ok(())
    }
}

#[cfg(feature = "serde")]
impl From<u16> for Saturation {
    fn from(bits: u16) -> Self {
        Saturation::from_bits(bits)
    }
}

#[cfg(feature = "serde")]
impl From<Saturation> for u16 {
    fn from(saturation: Saturation) -> Self {
        saturation.bits()
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for Saturation {
    fn format(&self, formatter: defmt::Formatter<'_>) {
        defmt::write!(formatter, "{}", defmt::Display2Format(self));
    }
}
