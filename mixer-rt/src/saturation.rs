//! Per-axis saturation flags, for anti-windup.

use crate::Axis;

/// The side on which an axis is saturated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Less was delivered than asked: the integrator must not grow further upwards.
    Positive,
    /// More was delivered than asked: the integrator must not grow further downwards.
    Negative,
}

/// What could not be delivered. Bit `2 * axis` is [`Direction::Positive`], bit `2 * axis + 1` is
/// [`Direction::Negative`], with roll 0, pitch 1, yaw 2, thrust 3; bit 8 says that the voltage was clamped.
// Of 32 bits, so that a mix consists of whole words; see `SetpointError`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Saturation(u32);

impl Saturation {
    /// Everything was delivered.
    pub const NONE: Saturation = Saturation(0);
    const VOLTAGE: u32 = 1 << 8;

    /// The bits as documented on the type: 0..=0x1ff.
    #[inline]
    pub const fn bits(self) -> u16 {
        self.0 as u16
    }

    /// The inverse of [`Saturation::bits`]; unknown bits are dropped.
    #[inline]
    pub const fn from_bits(bits: u16) -> Self {
        Saturation(bits as u32 & 0x1ff)
    }

    /// True where anything was given up on this axis in this direction.
    #[inline]
    pub const fn is_saturated(self, axis: Axis, direction: Direction) -> bool {
        let bit = 2 * axis as u32 + direction as u32;
        self.0 & (1 << bit) != 0
    }

    /// True where any axis is saturated.
    #[inline]
    pub const fn any_axis(self) -> bool {
        self.0 & 0xff != 0
    }

    /// True where the voltage lay outside the airframe's range and was clamped into it.
    #[inline]
    pub const fn voltage_clamped(self) -> bool {
        self.0 & Self::VOLTAGE != 0
    }

    #[inline]
    pub(crate) fn with_voltage_clamped(self, clamped: bool) -> Self {
        Saturation(self.0 | if clamped { Self::VOLTAGE } else { 0 })
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
