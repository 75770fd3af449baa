//! Priorities of a request that is not attainable.
//!
//! Each part of the request that may be given up has a cost per row; a row is scaled so that n units
//! have the authority n.
//!
//! | given up | from 0 to | cost |
//! |---|---|---|
//! | roll and pitch, jointly | what is asked | [`TORQUE`] |
//! | yaw up to the reserve | the smaller of the reserve and what is asked | [`RESERVED`] |
//! | thrust: too little | what is asked | [`MIDDLE`]; `roll-pitch-yaw`: [`LAST`] |
//! | thrust: too much | more than all rotors give | as too little; `disabled`: [`FORBIDDEN`] |
//! | yaw beyond the reserve | the rest of what is asked | [`LAST`]; `roll-pitch-yaw`: [`MIDDLE`] |
//! | with rotors out: yaw beyond the request, or the other way | all that there is | as the rest of yaw |
//!
//! Ratios of costs act as priorities, and bound how steep the answer is in the request: a share of a
//! higher priority is given up where that frees more of a lower one than their ratio.

use crate::{clamp, divisor, larger};

/// Costs per row.
pub(super) const LAST: f32 = 1.0;
pub(super) const MIDDLE: f32 = 20.0;
pub(super) const RESERVED: f32 = 90.0;
pub(super) const TORQUE: f32 = 400.0;
pub(super) const FORBIDDEN: f32 = 2000.0;

/// Freedom of allocation to change the thrust, with PX4's meaning of the word (`MC_AIRMODE`).
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
    /// True where yaw comes before thrust.
    #[inline]
    pub const fn is_yaw_first(self) -> bool {
        matches!(self, Airmode::RollPitchYaw)
    }
}

/// Priorities where a request is not attainable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Priorities {
    /// Freedom to change the thrust.
    pub airmode: Airmode,
    /// The yaw torque that comes before thrust, N m, >= 0.
    pub yaw_reserve_nm: f32,
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
    let largest = larger(roll.abs(), pitch.abs());
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
