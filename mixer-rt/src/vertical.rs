//! Desaturation in closed form where all thrust axes are vertical and there are at most four units.
//!
//! Roll, pitch and thrust then depend on the units' thrusts alone, w = C f with w = (roll, pitch, thrust), and yaw
//! on their torques alone, yaw = sum s_i Q_i. So the order of priority falls apart into small problems:
//!
//! 1. The thrusts lie in [a, b]^n, so w lies in a zonotope, whose facets the compiler tabulates in pairs,
//!    `low <= d w <= high`. For a given direction of (roll, pitch) a facet is a line in the plane of (rho, thrust):
//!    the largest rho, and then the thrust nearest the request, are a linear program in two unknowns.
//! 2. f = C+ w + z N, where N spans the null space of C (n = 4; for n = 3 there is none). z is taken as near zero
//!    as [a, b] allows.
//! 3. With these thrusts the unit can give torques between Q_min(f) and Q_max(f), so yaw reaches
//!    `Y(f) = sum max(s_i Q)`. If the request is beyond, z is moved to where Y is largest: a concave function of one
//!    unknown. Y is concave, so the part `(yaw - Y(0)) / (Y(z) - Y(0))` of the way is enough, and the thrusts are
//!    a Lipschitz function of the request, which they would not be if z were moved just far enough.
//! 4. The torques are the least-norm ones, clipped; what that leaves of the yaw is shared in proportion to room.
//!
//! Near a corner of the zonotope yaw may not even reach zero (with all rotors at the ceiling every unit has the
//! torque Q(1, 1)). There the thrusts are drawn towards the middle until it does: thrust, roll and pitch give way
//! together, by less than the corner's torque is worth.

use crate::homotopy::Scratch;
use crate::{Airmode, Desaturation, Unit, clamp, sqrt};

/// `offset + slope f + bend sqrt(f + shift)`: the image of one edge of the throttle box. Exact for the
/// biquadratic basis, on whose edges f and Q are both quadratic in one throttle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// N m.
    pub offset: f32,
    /// N m per N.
    pub slope: f32,
    /// N m per square root of N.
    pub bend: f32,
    /// N.
    pub shift: f32,
}

impl Arc {
    #[inline(always)]
    fn root(&self, f: f32) -> f32 {
        let radicand = f + self.shift;
        sqrt(if radicand > LEAST_RADICAND {
            radicand
        } else {
            LEAST_RADICAND
        })
    }

    /// The torque at the thrust `f`.
    #[inline(always)]
    fn at(&self, f: f32) -> f32 {
        (self.offset + self.slope * f) + self.bend * self.root(f)
    }

    /// The torque at the thrust `f` and its derivative.
    #[inline(always)]
    fn tangent(&self, f: f32) -> (f32, f32) {
        let root = self.root(f);
        (
            (self.offset + self.slope * f) + self.bend * root,
            self.slope + 0.5 * self.bend / root,
        )
    }
}

/// Keeps an [`Arc`]'s derivative finite, N.
const LEAST_RADICAND: f32 = 1e-3;

/// One side of the attainable set, Q_min(f) or Q_max(f): two arcs that meet in a corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    /// The thrust at the corner, N.
    pub corner_n: f32,
    /// The arcs below and above it.
    pub arcs: [Arc; 2],
}

impl Side {
    #[inline(always)]
    fn arc(&self, f: f32) -> &Arc {
        let [below, above] = &self.arcs;
        if f < self.corner_n { below } else { above }
    }
}

/// Two facets of the attainable (roll, pitch, thrust), `low <= roll d[0] + pitch d[1] + thrust d[2] <= high`, at the
/// reference voltage. `d[2]` is 1 or 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facets {
    /// The normal.
    pub normal: [f32; 3],
    /// The bounds.
    pub bounds: [f32; 2],
}

/// What a frame with vertical axes and three or four units needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertical<'a> {
    /// Least and largest thrust of a unit, N.
    pub thrust_n: [f32; 2],
    /// Q_min(f).
    pub least_torque: Side,
    /// Q_max(f).
    pub largest_torque: Side,
    /// The attainable (roll, pitch, thrust).
    pub facets: &'a [Facets],
    /// N, one entry per unit; zeros where there is no null space.
    pub null: &'a [f32],
    /// Least thrust without torque, N.
    pub thrust_floor_n: f32,
    /// A thrust well inside the attainable set, N.
    pub thrust_middle_n: f32,
}

/// What an airframe's tables know about a shorter way to desaturate than the homotopy.
pub trait Shortcut {
    /// The shorter way, where there is one.
    fn vertical(&self) -> Option<&Vertical<'_>>;
}

/// No shorter way: tilted axes, more than four units, or priorities that couple thrust and yaw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoShortcut;

impl Shortcut for NoShortcut {
    #[inline(always)]
    fn vertical(&self) -> Option<&Vertical<'_>> {
        None
    }
}

impl Shortcut for Vertical<'_> {
    #[inline(always)]
    fn vertical(&self) -> Option<&Vertical<'_>> {
        Some(self)
    }
}

impl Shortcut for Option<Vertical<'_>> {
    #[inline(always)]
    fn vertical(&self) -> Option<&Vertical<'_>> {
        self.as_ref()
    }
}

/// Steps of the search for the largest yaw: the tangents of a function of nearly straight pieces meet at its top.
const YAW_STEPS: u32 = 4;
/// Steps of the search for the largest rho: at most one per facet, hardly ever more than two.
const SHARE_STEPS: u32 = 6;
/// Steps of the retreat from a corner, each from the inside.
const RETREAT_STEPS: u32 = 3;

/// A request at the reference voltage.
#[derive(Clone, Copy)]
pub(crate) struct Request {
    pub(crate) roll: f32,
    pub(crate) pitch: f32,
    pub(crate) yaw: f32,
    pub(crate) thrust: f32,
}

/// How far yaw reaches: the sum of the units' largest s Q, and its derivative by z.
#[derive(Clone, Copy)]
struct Reach {
    yaw: f32,
    by_z: f32,
}

/// What the thrusts in the scratch allow.
#[derive(Clone, Copy)]
struct Room {
    /// True where all thrusts are within the range.
    thrusts: bool,
    /// True where the least-norm torques are attainable as well.
    torques: bool,
    /// Least and largest yaw, N m.
    yaw: [f32; 2],
}

impl Vertical<'_> {
    /// The side that takes yaw furthest where `spin` is the yaw per torque, in the direction looked at.
    #[inline(always)]
    fn side(&self, spin: f32) -> &Side {
        if spin < 0.0 {
            &self.least_torque
        } else {
            &self.largest_torque
        }
    }

    /// Writes the ranges of torque into the scratch.
    #[inline(never)]
    fn room(&self, units: &[Unit], scratch: &mut [Scratch], yaw: f32) -> Room {
        let [least, most] = self.thrust_n;
        let mut room = Room {
            thrusts: true,
            torques: true,
            yaw: [0.0; 2],
        };
        for (unit, scratch) in units.iter().zip(scratch.iter_mut()) {
            let f = scratch.efforts[0];
            room.thrusts &= f >= least && f <= most;
            let low = self.least_torque.arc(f).at(f);
            let high = self.largest_torque.arc(f).at(f);
            scratch.pair = [low, high];
            let q = unit.allocation[1][YAW] * yaw;
            room.torques &= q >= low && q <= high;
            let effect = yaw_effect(unit);
            let (from, to) = if effect > 0.0 { (low, high) } else { (high, low) };
            room.yaw[0] += effect * from;
            room.yaw[1] += effect * to;
        }
        room
    }

    /// How far yaw reaches in the direction of `sign` with the thrusts in the scratch, moved by `z` along N.
    #[inline(never)]
    fn reach(&self, units: &[Unit], scratch: &[Scratch], z: f32, sign: f32) -> Reach {
        let mut reach = Reach { yaw: 0.0, by_z: 0.0 };
        for ((unit, scratch), null) in units.iter().zip(scratch).zip(self.null) {
            let spin = sign * yaw_effect(unit);
            let f = scratch.efforts[0] + z * null;
            let (torque, slope) = self.side(spin).arc(f).tangent(f);
            reach.yaw += spin * torque;
            reach.by_z += spin * slope * null;
        }
        reach
    }

    /// The largest share of (roll, pitch) up to 1 that some thrust of at most `ceiling` allows, and the thrusts
    /// that it allows.
    #[inline(always)]
    fn share(&self, roll: f32, pitch: f32, ceiling: f32) -> (f32, [f32; 2]) {
        let mut share = 1.0;
        let mut range = [0.0, 0.0];
        for _ in 0..SHARE_STEPS {
            // Thrust bounds at this share, and their velocities.
            let (mut low, mut low_speed) = (-f32::MAX, 0.0);
            let (mut high, mut high_speed) = (ceiling, 0.0);
            let mut flat = 1.0;
            for Facets { normal, bounds } in self.facets {
                let speed = normal[0] * roll + normal[1] * pitch;
                let at = speed * share;
                if normal[2] == 0.0 {
                    let limit = if speed > 0.0 { bounds[1] } else { bounds[0] };
                    if at > bounds[1] || at < bounds[0] {
                        let most = limit / speed;
                        flat = if most < flat { most } else { flat };
                    }
                    continue;
                }
                if bounds[0] - at > low {
                    (low, low_speed) = (bounds[0] - at, -speed);
                }
                if bounds[1] - at < high {
                    (high, high_speed) = (bounds[1] - at, -speed);
                }
            }
            range = [low, high];
            if low <= high && share <= flat {
                break;
            }
            // Where these two lines meet: the gap closes as the share shrinks.
            let closing = low_speed - high_speed;
            let met = if closing > 0.0 {
                share - (low - high) / closing
            } else {
                0.0
            };
            let met = if low > high { met } else { share };
            let next = if met < flat { met } else { flat };
            share = if next > 0.0 { next } else { 0.0 };
        }
        if range[0] > range[1] {
            // Left by rounding only.
            range = [range[1], range[1]];
        }
        (share, range)
    }

    /// Writes attainable efforts for `request` into the scratch, which holds its least-norm thrusts.
    #[inline(always)]
    pub(crate) fn desaturate(
        &self,
        units: &[Unit],
        desaturation: &Desaturation,
        request: Request,
        scratch: &mut [Scratch],
    ) {
        let yaw = request.yaw;
        let mut room = self.room(units, scratch, yaw);
        if room.thrusts && room.torques {
            return;
        }
        if !(room.thrusts && yaw >= room.yaw[0] && yaw <= room.yaw[1]) {
            self.thrusts(units, desaturation, request, room.thrusts, scratch);
            room = self.room(units, scratch, yaw);
        }
        torques(units, scratch, yaw, room.yaw);
    }

    /// Replaces the thrusts in the scratch by attainable ones.
    #[inline(never)]
    fn thrusts(
        &self,
        units: &[Unit],
        desaturation: &Desaturation,
        request: Request,
        attainable: bool,
        scratch: &mut [Scratch],
    ) {
        let Request {
            roll,
            pitch,
            yaw,
            thrust,
        } = request;
        let ceiling = match desaturation.airmode {
            Airmode::Disabled if thrust > self.thrust_floor_n => thrust,
            Airmode::Disabled => self.thrust_floor_n,
            Airmode::RollPitch | Airmode::RollPitchYaw => f32::MAX,
        };
        let mut wrench = [roll, pitch, 0.0, thrust];
        if !attainable {
            let (share, [low, high]) = self.share(roll, pitch, ceiling);
            wrench = [share * roll, share * pitch, 0.0, clamp(thrust, low, high)];
        }
        // z as near zero as the range allows.
        let [least, most] = self.thrust_n;
        let (mut z_low, mut z_high) = (-f32::MAX, f32::MAX);
        for ((unit, scratch), null) in units.iter().zip(scratch.iter_mut()).zip(self.null) {
            let [f, _] = unit.efforts(&wrench);
            scratch.efforts[0] = f;
            if *null != 0.0 {
                let per_null = 1.0 / null;
                let (to_least, to_most) = ((least - f) * per_null, (most - f) * per_null);
                let (from, to) = if *null > 0.0 {
                    (to_least, to_most)
                } else {
                    (to_most, to_least)
                };
                z_low = if from > z_low { from } else { z_low };
                z_high = if to < z_high { to } else { z_high };
            }
        }
        let nearest = clamp(0.0, z_low, if z_high > z_low { z_high } else { z_low });
        self.move_along_null(scratch, nearest);

        let sign = if yaw < 0.0 { -1.0 } else { 1.0 };
        let wanted = sign * yaw;
        let here = self.reach(units, scratch, 0.0, sign);
        let mut reached = here.yaw;
        if here.yaw < wanted && z_high > z_low {
            let range = [z_low - nearest, z_high - nearest];
            let (top_z, top) = self.top(units, scratch, here, range, sign);
            let gain = top - here.yaw;
            if gain > 0.0 {
                let part = (wanted - here.yaw) / gain;
                self.move_along_null(scratch, if part < 1.0 { part * top_z } else { top_z });
                reached = top;
            }
        }
        let middle = if ceiling < self.thrust_middle_n {
            ceiling
        } else {
            self.thrust_middle_n
        };
        // Yaw may fail to reach zero, or, only where it reaches the request, to come down to it.
        let (sign, needed) = if reached < 0.0 {
            (sign, 0.0)
        } else {
            (-sign, -wanted)
        };
        if reached < 0.0 || reached >= wanted {
            self.retreat(units, scratch, sign, needed, middle);
        }
    }

    #[inline(never)]
    fn move_along_null(&self, scratch: &mut [Scratch], z: f32) {
        let [least, most] = self.thrust_n;
        for (scratch, null) in scratch.iter_mut().zip(self.null) {
            scratch.efforts[0] = clamp(scratch.efforts[0] + z * null, least, most);
        }
    }

    /// z within `range` and the yaw reached there, about the largest; `here` is at z = 0.
    #[inline(always)]
    fn top(
        &self,
        units: &[Unit],
        scratch: &[Scratch],
        here: Reach,
        range: [f32; 2],
        sign: f32,
    ) -> (f32, f32) {
        let end = if here.by_z > 0.0 { range[1] } else { range[0] };
        let (mut near, mut near_z) = (here, 0.0);
        let (mut far, mut far_z) = (self.reach(units, scratch, end, sign), end);
        let mut best = if far.yaw > near.yaw {
            (far_z, far.yaw)
        } else {
            (near_z, near.yaw)
        };
        for _ in 0..YAW_STEPS {
            let turn = near.by_z - far.by_z;
            // Still rising at the far end, or no turn to be seen.
            if turn == 0.0 || (far.by_z > 0.0) == (here.by_z > 0.0) {
                break;
            }
            let z = ((far.yaw - near.yaw) + (near.by_z * near_z - far.by_z * far_z)) / turn;
            let middle = self.reach(units, scratch, z, sign);
            if middle.yaw > best.1 {
                best = (z, middle.yaw);
            }
            if (middle.by_z > 0.0) == (here.by_z > 0.0) {
                (near, near_z) = (middle, z);
            } else {
                (far, far_z) = (middle, z);
            }
        }
        best
    }

    /// Draws the thrusts towards the middle until yaw reaches `needed` in the direction of `sign`.
    #[inline(always)]
    fn retreat(&self, units: &[Unit], scratch: &mut [Scratch], sign: f32, needed: f32, middle_n: f32) {
        let mut outside = self.reach(units, scratch, 0.0, sign).yaw - needed;
        if outside >= 0.0 {
            return;
        }
        let middle = [0.0, 0.0, 0.0, middle_n];
        let mut inside = -needed;
        for unit in units {
            let spin = sign * yaw_effect(unit);
            let [f, _] = unit.efforts(&middle);
            inside += spin * self.side(spin).arc(f).at(f);
        }
        // Yaw's reach is concave on the way, so a straight line between a point inside and one outside crosses
        // zero inside. Shares of the way out from the middle:
        let (mut inside_at, mut outside_at, mut present) = (0.0, 1.0, 1.0);
        for _ in 0..RETREAT_STEPS {
            let inner = if inside > 0.0 { inside } else { 0.0 };
            let at = inside_at + inner / (inner - outside) * (outside_at - inside_at);
            let change = at / present;
            for (unit, scratch) in units.iter().zip(scratch.iter_mut()) {
                let [f, _] = unit.efforts(&middle);
                scratch.efforts[0] = f + change * (scratch.efforts[0] - f);
            }
            present = at;
            if at <= 0.0 {
                return;
            }
            let now = self.reach(units, scratch, 0.0, sign).yaw - needed;
            if now >= 0.0 {
                (inside, inside_at) = (now, at);
            } else {
                (outside, outside_at) = (now, at);
            }
        }
    }
}

/// The torques for `yaw`, as far as the thrusts allow: the least-norm ones, clipped to the ranges in the scratch, and
/// what is missing then in proportion to the room that is left. `range` is the least and the largest yaw.
#[inline(never)]
fn torques(units: &[Unit], scratch: &mut [Scratch], yaw: f32, range: [f32; 2]) {
    let mut given = 0.0;
    for (unit, scratch) in units.iter().zip(scratch.iter_mut()) {
        let [least, most] = scratch.pair;
        let q = clamp(unit.allocation[1][YAW] * yaw, least, most);
        scratch.efforts[1] = q;
        given += yaw_effect(unit) * q;
    }
    let missing = yaw - given;
    let upwards = missing > 0.0;
    let room = if upwards {
        range[1] - given
    } else {
        range[0] - given
    };
    let part = if room == 0.0 {
        0.0
    } else {
        clamp(missing / room, 0.0, 1.0)
    };
    for (unit, scratch) in units.iter().zip(scratch.iter_mut()) {
        let [least, most] = scratch.pair;
        let limit = if (yaw_effect(unit) > 0.0) == upwards {
            most
        } else {
            least
        };
        scratch.efforts[1] += part * (limit - scratch.efforts[1]);
    }
}

const YAW: usize = 2;

/// N m of yaw per N m of this unit's torque: 1 or -1.
#[inline(always)]
fn yaw_effect(unit: &Unit) -> f32 {
    unit.effectiveness[1][YAW]
}
