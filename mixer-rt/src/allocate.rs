//! From a wrench to throttles.
//!
//! **The throttles nearest those of least norm among those that cut the request least, by priority:**
//!
//! ```text
//! 1. roll and pitch, jointly scaled       their direction stays
//! 2. yaw up to the reserve
//! 3. thrust, nearest the request          airmode `roll-pitch-yaw`: after 4
//! 4. the rest of yaw
//! 5. yaw as it comes                      only with rotors out, where no level flight has the yaw asked
//! ```
//!
//! With airmode `disabled` no priority raises the thrust above the request, or above what level flight
//! needs.
//!
//! Where least norm gives the request, that is the answer; what cannot be given has two methods:
//!
//! ```text
//! all rotors     least norm, eq. (8)                                  allocate/least_norm.rs
//!                up to four vertical units: in closed form            allocate/closed_form.rs
//!                else an interior point method on the throttles       allocate/interior.rs
//! rotors out     nearest the whole frame's least norm                 allocate/rotors_out.rs
//!                else the interior point method
//! ```

pub(crate) mod closed_form;
pub(crate) mod interior;
mod least_norm;
pub(crate) mod power_bias;
mod priorities;
mod rotors_out;
mod system;
pub(crate) mod unit;
mod unknown;

use core::hint::black_box;

use crate::layout::{Tables, Unit};
use crate::pair::{Inverse, Quantity};
use crate::{clamp, divisor};
use system::Columns;
use unit::UnitState;

/// What allocation may do to the thrust, with PX4's meaning of the word (`MC_AIRMODE`).
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
    /// What may happen to the thrust.
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

#[inline(always)]
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// A frame at one voltage, `VERTICAL` where all axes are.
struct Frame<'a, 't, P, I, S, const VERTICAL: bool> {
    tables: &'a Tables<'t, P, I, S>,
    /// `[k_f, k_Q]`.
    factors: [f32; 2],
    /// `[1 / k_f, 1 / k_Q]`.
    per_factor: [f32; 2],
    /// k_Q / k_f: rows are those of thrusts and torques over k_f.
    ratio: f32,
}

/// Writes throttles that serve `wrench` (`[roll, pitch, yaw, thrust]`, bounded) into the units' states,
/// which hold the rotors that turn. `factors` is `[k_f, k_Q]`. `is_whole` tells that all rotors turn. True
/// where these are the throttles of least norm, with all rotors.
#[inline(never)]
pub(crate) fn allocate<P: Quantity, I: Inverse<P>, S, const VERTICAL: bool>(
    tables: &Tables<'_, P, I, S>,
    wrench: &[f32; 4],
    factors: [f32; 2],
    units: &mut [UnitState],
    is_whole: bool,
) -> bool {
    // With the tables or the number of units known the compiler would write every loop over them out.
    let (tables, units) = black_box((tables, units));
    let frame = Frame::<_, _, _, VERTICAL>::new(tables, factors);
    if is_whole {
        if frame.serve_by_least_norm(wrench, units) {
            return true;
        }
        if !frame.cut(wrench, units, is_whole) {
            frame.retreat(wrench, units);
        }
    } else if !frame.serve_with_rotors_out(wrench, units) {
        frame.cut(wrench, units, is_whole);
    }
    false
}

impl<'a, 't, P, I, S, const VERTICAL: bool> Frame<'a, 't, P, I, S, VERTICAL> {
    #[inline(always)]
    fn new(tables: &'a Tables<'t, P, I, S>, factors: [f32; 2]) -> Self {
        let per_product = 1.0 / (factors[0] * factors[1]);
        let per_factor = [factors[1] * per_product, factors[0] * per_product];
        Frame {
            tables,
            factors,
            per_factor,
            ratio: factors[1] * per_factor[0],
        }
    }

    /// From idle to the ceiling.
    #[inline(always)]
    fn span(&self) -> f32 {
        self.tables.throttle.max - self.tables.throttle.min
    }

    /// A unit's columns in the rows of the axes.
    #[inline(always)]
    fn columns(&self, unit: &Unit) -> Columns {
        let [by_thrust, by_torque] = unit.effectiveness;
        let rows = self.tables.rows;
        [
            [0, 1, 2, 3].map(|axis| by_thrust[axis] * rows[axis]),
            [0, 1, 2, 3].map(|axis| self.ratio * by_torque[axis] * rows[axis]),
        ]
    }
}
