//! Priorities of desaturation, the highest first, and the limit of requests.
//!
//! ```text
//! 1. roll and pitch      the largest rho in [0, 1] such that rho (roll, pitch) is attainable
//! 2. thrust, then yaw    each the attainable value nearest the request
//!    (airmode roll-pitch-yaw: yaw, then thrust)
//! ```
//!
//! Yaw is never reversed and never exceeds the request; its reserve is kept before everything else.
//! With airmode disabled the thrust does not exceed the request, or the least thrust that the idle
//! and the yaw allow, if that is more.

pub(crate) mod attainable;
pub(crate) mod closed_form;
pub(crate) mod general;
pub(crate) mod power_bias;

use crate::{clamp, divisor};

/// What desaturation may do to the thrust, with PX4's meaning of the word (`MC_AIRMODE`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Airmode {
    /// Roll and pitch may lower the thrust, nothing may raise it.
    Disabled,
    /// Roll and pitch may lower or raise the thrust; yaw may not.
    RollPitch,
    /// Roll, pitch and yaw may lower or raise the thrust.
    RollPitchYaw,
}

impl Airmode {
    /// True where roll and pitch may raise the thrust.
    #[inline]
    pub const fn may_raise_thrust(self) -> bool {
        !matches!(self, Airmode::Disabled)
    }

    /// True where yaw comes before thrust.
    #[inline]
    pub const fn is_yaw_first(self) -> bool {
        matches!(self, Airmode::RollPitchYaw)
    }
}

/// Priorities of desaturation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Desaturation {
    /// What may happen to the thrust.
    pub airmode: Airmode,
    /// The yaw torque that is kept available before roll and pitch, N m, >= 0.
    pub yaw_reserve_nm: f32,
    /// Work of the general path at most while all rotors work. Where it does not suffice, the
    /// request is served from stored level flight by least norm, as far as that goes.
    pub budget: Budget,
}

/// Work of the simplex method at most.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// Pivots.
    pub pivots: u8,
    /// Moves of units and shortages to other corners of their sets. Where these are used up, pivots
    /// take shorter steps.
    pub flips: u8,
}

impl Budget {
    /// Rounds at most in which the curves of single rotors take the place of their chords.
    pub const ROUNDS: u8 = 3;

    /// Work for a programme with rotors out of a frame of so many units; `is_decided` where the
    /// throttles of single rotors stay.
    pub const fn with_rotors_out(units: usize, is_decided: bool) -> Self {
        let each = if is_decided { 4 } else { 7 };
        // Frames have no more units than these: 64 channels.
        let units = if units < 32 { units as u8 } else { 31 };
        Budget {
            pivots: each + units,
            flips: each * units,
        }
    }
}

/// Requests are limited to this torque (N m) and thrust (N), small enough that no product overflows.
/// The compiler refuses airframes that give more, so a request beyond is never attainable and always
/// flagged.
pub const REQUEST_LIMIT: f32 = 1e5;

/// True where `request` is finite and within [`REQUEST_LIMIT`].
#[inline(always)]
pub(crate) fn is_bounded(request: &[f32; 4]) -> bool {
    // The sign shifted out, numbers are ordered as their bits are.
    let limit = REQUEST_LIMIT.to_bits() << 1;
    request.iter().all(|value| value.to_bits() << 1 <= limit)
}

/// A request within a limit of roll and pitch, whose direction is kept, one of yaw, and a range of
/// thrust.
#[inline(never)]
pub(crate) fn limited(
    [roll, pitch, yaw, thrust]: [f32; 4],
    limit: f32,
    most_yaw: f32,
    [least, most]: [f32; 2],
) -> [f32; 4] {
    let largest = if roll.abs() > pitch.abs() {
        roll.abs()
    } else {
        pitch.abs()
    };
    let share = if largest > limit {
        limit / divisor(largest)
    } else {
        1.0
    };
    [
        roll * share,
        pitch * share,
        clamp(yaw, -most_yaw, most_yaw),
        clamp(thrust, least, most),
    ]
}
