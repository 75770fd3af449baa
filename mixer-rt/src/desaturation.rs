//! Desaturation: what is given up when the least-norm efforts are not attainable.
//!
//! Start from a bare thrust at which every unit has room on all sides (the anchor), then walk along the least-norm
//! directions of roll and pitch, of the missing thrust and of yaw, in the order of priority, each as far as every
//! unit's attainable set allows:
//!
//! ```text
//! eta = M+ (0, 0, 0, anchor)
//! eta += s M+ (roll, pitch, 0, 0)           the largest s in [0, 1]: the direction of (roll, pitch) stays
//! eta += s M+ (0, 0, 0, thrust - anchor)    \ yaw first with airmode roll-pitch-yaw
//! eta += s M+ (0, 0, yaw, 0)                /
//! ```
//!
//! Every step is a share of what was asked, so no axis reverses; each is a bounded number of operations.

use crate::{Tables, Unit, clamp};

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

/// Limits and priorities of desaturation. Thrusts are in N at the reference voltage, with no torque asked; at
/// another voltage they are scaled by k_f.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Desaturation {
    /// What may happen to the thrust.
    pub airmode: Airmode,
    /// The least bare thrust that all units attain with least-norm efforts, N.
    pub thrust_floor_n: f32,
    /// The bare thrust about which roll and pitch have the most room, N.
    pub thrust_anchor_n: f32,
    /// The largest bare thrust that all units attain with least-norm efforts, N.
    pub thrust_ceiling_n: f32,
    /// The yaw torque that is kept available before roll and pitch, N m, >= 0.
    pub yaw_reserve_nm: f32,
}

/// The efforts of all units, at the reference voltage, on their way to the request.
struct Walk<'w, 'a, P, I> {
    tables: &'w Tables<'a, P, I>,
    /// `[1/k_f, 1/k_Q]`.
    per_factor: [f32; 2],
    efforts: &'w mut [[f32; 2]],
}

impl<P, I> Walk<'_, '_, P, I> {
    /// This unit's step for a part of the wrench, at the reference voltage.
    #[inline(always)]
    fn step(unit: &Unit, wrench: &[f32; 4], per_factor: [f32; 2]) -> [f32; 2] {
        let [f, q] = unit.efforts(wrench);
        [f * per_factor[0], q * per_factor[1]]
    }

    /// Goes to the least-norm efforts of `wrench`, attainable or not.
    fn start(&mut self, wrench: &[f32; 4]) {
        for (unit, efforts) in self.tables.units.iter().zip(self.efforts.iter_mut()) {
            *efforts = Self::step(unit, wrench, self.per_factor);
        }
    }

    /// Adds the largest attainable share of `wrench`; returns that share.
    fn advance(&mut self, wrench: &[f32; 4]) -> f32 {
        if *wrench == [0.0; 4] {
            return 1.0;
        }
        let mut share = 1.0;
        for (unit, efforts) in self.tables.units.iter().zip(self.efforts.iter()) {
            let step = Self::step(unit, wrench, self.per_factor);
            let clipped = self.tables.attainable.clip(*efforts, step);
            share = if clipped < share { clipped } else { share };
        }
        for (unit, efforts) in self.tables.units.iter().zip(self.efforts.iter_mut()) {
            let [f, q] = Self::step(unit, wrench, self.per_factor);
            efforts[0] += share * f;
            efforts[1] += share * q;
        }
        share
    }
}

/// Largest torque (N m) and thrust (N) that is looked at: far beyond any rotor, and small enough that no product
/// overflows.
const REQUEST_LIMIT: f32 = 1e6;

/// `request` within [`REQUEST_LIMIT`], with the direction of (roll, pitch) kept.
fn limited([roll, pitch, yaw, thrust]: [f32; 4]) -> [f32; 4] {
    let largest = if roll.abs() > pitch.abs() {
        roll.abs()
    } else {
        pitch.abs()
    };
    let share = if largest > REQUEST_LIMIT {
        REQUEST_LIMIT / largest
    } else {
        1.0
    };
    let limit = |value| clamp(value, -REQUEST_LIMIT, REQUEST_LIMIT);
    [roll * share, pitch * share, limit(yaw), limit(thrust)]
}

/// Replaces `efforts` (`[f, Q]` of each unit at the reference voltage) by attainable ones that serve `request`
/// (`[roll, pitch, yaw, thrust]`) in the order of priority. `factors` is `[k_f, k_Q]`.
pub(crate) fn desaturate<P, I>(
    tables: &Tables<'_, P, I>,
    request: [f32; 4],
    factors: [f32; 2],
    per_factor: [f32; 2],
    efforts: &mut [[f32; 2]],
) {
    let [roll, pitch, yaw, thrust] = limited(request);
    let limits = &tables.desaturation;
    let thrust = clamp(
        thrust,
        limits.thrust_floor_n * factors[0],
        limits.thrust_ceiling_n * factors[0],
    );
    let mut anchor = limits.thrust_anchor_n * factors[0];
    if limits.airmode == Airmode::Disabled && thrust < anchor {
        anchor = thrust;
    }
    let reserved = clamp(yaw, -limits.yaw_reserve_nm, limits.yaw_reserve_nm);

    let mut walk = Walk {
        tables,
        per_factor,
        efforts,
    };
    walk.start(&[0.0, 0.0, 0.0, anchor]);
    let kept = reserved * walk.advance(&[0.0, 0.0, reserved, 0.0]);
    walk.advance(&[roll, pitch, 0.0, 0.0]);
    let rest_of_thrust = [0.0, 0.0, 0.0, thrust - anchor];
    let rest_of_yaw = [0.0, 0.0, yaw - kept, 0.0];
    if limits.airmode == Airmode::RollPitchYaw {
        walk.advance(&rest_of_yaw);
        walk.advance(&rest_of_thrust);
    } else {
        walk.advance(&rest_of_thrust);
        walk.advance(&rest_of_yaw);
    }
}
