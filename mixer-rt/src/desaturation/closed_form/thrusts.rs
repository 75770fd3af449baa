//! The thrusts: f = C+ w + z N.
//!
//! Where z has room and the requested yaw is out of range at the start, z moves towards the z of
//! the largest yaw, by the part `(yaw - Y(start)) / (Y(top) - Y(start))` of the way. This makes the
//! thrusts a Lipschitz function of the request; moving z just far enough would not. Y is nearly
//! concave: where that part is not enough, a second step of twice the length follows.
//!
//! Where yaw does not reach what is needed of it, [`ClosedForm::retreat`] gives up thrust, then roll
//! and pitch.

use super::{ClosedForm, ClosedFormUnit, Request, ThrustLine};
use crate::{clamp, rolled};
use core::hint::black_box;

/// Most steps towards the largest yaw. The second is twice as long as a straight line asks for.
const CLIMBS: u32 = 2;

/// Most steps to where yaw reaches what is needed. Steps inwards are twice as long as a straight
/// line asks for.
const CROSSINGS: u32 = 3;

/// Share of the yaw of level flight that a reserve takes at most. The sides being concave, at least
/// the other half of roll and pitch is left.
const RESERVABLE: f32 = 0.5;

/// Room beyond the yaw needed that thrusts have which others are drawn to, as a share of the room
/// of level flight. It bounds how far thrusts move with the request. Where roll and pitch leave
/// less room they are cut, by about this share at most.
const MARGIN: f32 = 1.0 / 64.0;

/// Gain of yaw, in units of `yaw_rounding_nm`, from which z moves to the top in full. For a smaller
/// gain it moves a part of the way, so that z does not jump where the gain vanishes. That costs at
/// most a quarter of this gain, 0.025 % of the authority in yaw.
const GAIN: f32 = 100.0;

/// Yaw to keep, and what may be given up for it.
struct Kept {
    /// How far yaw has to reach, N m. The half of what level flight reaches, if that is less.
    needed: f32,
    /// Thrust is given up before roll and pitch, else all together.
    thrust_first: bool,
    /// `[roll, pitch, thrust]` with the roll and pitch of the request and a thrust that leaves yaw
    /// more room; none where already these have to be cut.
    roomy: Option<[f32; 3]>,
}

impl ClosedFormUnit {
    /// The least-norm thrust, N, for `[roll, pitch, thrust]`.
    #[inline(always)]
    pub(super) fn thrust(&self, wrench: &[f32; 3]) -> f32 {
        let [roll, pitch, thrust] = self.allocation;
        (roll * wrench[0] + pitch * wrench[1]) + thrust * wrench[2]
    }
}

/// How far yaw of the sign `sign` reaches.
#[inline(always)]
fn furthest([least, most]: [f32; 2], sign: f32) -> f32 {
    if sign < 0.0 { -least } else { most }
}

impl ClosedForm<'_> {
    /// Finds attainable thrusts, at most `ceiling` in sum, that bring the requested yaw into range
    /// if any do. Where yaw would be reversed or exceeded, or be short of `reserve`, they are drawn
    /// towards those of the total thrust `middle`. Returns their z on the lines of thrusts and the
    /// least and most yaw there; writes the lines with each unit's yaw.
    #[inline(always)]
    pub(super) fn attainable_thrusts(
        &self,
        request: &Request,
        reserve: f32,
        [ceiling, middle]: [f32; 2],
        lines: &mut [ThrustLine],
    ) -> (f32, [f32; 2]) {
        let (share, range) = self.share(request.roll, request.pitch, ceiling);
        let thrust = clamp(request.thrust, range[0], range[1]);
        let mut wrench = [share * request.roll, share * request.pitch, thrust];
        let [low, high] = self.null_range(lines, |unit, _| unit.thrust(&wrench));
        // Where the facets change roll, pitch or thrust, z has no room.
        let has_room = share == 1.0 && thrust == request.thrust;
        let mut z = clamp(0.0, low, if high > low { high } else { low });
        let mut reach = self.reach(lines, z);
        // The limit of yaw that the request violates, if any.
        let sign = if request.yaw > reach[1] {
            1.0
        } else if request.yaw < reach[0] {
            -1.0
        } else {
            return (z, reach);
        };
        let wanted = sign * request.yaw;
        if has_room && high > low {
            (z, reach) = self.climb(lines, sign, (z, reach), [low, high], wanted);
        }
        // Beyond zero yaw is reversed, beyond the request it is exceeded, up to the reserve it is
        // kept.
        let needed = if wanted < reserve { wanted } else { reserve };
        if needed - furthest(reach, sign) > self.yaw_rounding_nm {
            wrench[2] = clamp(middle, range[0], range[1]);
            let kept = Kept {
                needed,
                thrust_first: reserve > 0.0,
                roomy: if share == 1.0 { Some(wrench) } else { None },
            };
            (z, reach) = self.retreat(lines, sign, (z, reach), kept, middle);
        }
        (z, reach)
    }

    /// Moves z from a point where yaw does not reach `wanted` towards where it reaches furthest
    /// within `range`. Returns z and the least and most yaw there, and leaves what each unit gives
    /// of it.
    #[inline(always)]
    fn climb(
        &self,
        lines: &mut [ThrustLine],
        sign: f32,
        (mut z, mut reach): (f32, [f32; 2]),
        range: [f32; 2],
        wanted: f32,
    ) -> (f32, [f32; 2]) {
        let top = self.top(lines, sign, z, range);
        if top == z {
            return (z, reach);
        }
        let at_top = self.reach(lines, top);
        let most = furthest(at_top, sign);
        let whole = GAIN * self.yaw_rounding_nm;
        if most <= wanted && most - furthest(reach, sign) >= whole {
            return (top, at_top);
        }
        let mut ahead = 1.0;
        for _ in 0..black_box(CLIMBS) {
            let here = furthest(reach, sign);
            let gain = most - here;
            let mut part = if gain > 0.0 {
                ahead * (wanted - here) / gain
            } else {
                0.0
            };
            part = if part < 1.0 { part } else { 1.0 };
            part *= if gain < whole { gain / whole } else { 1.0 };
            z += part * (top - z);
            reach = self.reach(lines, z);
            let here = furthest(reach, sign);
            if here >= wanted || here >= most {
                break;
            }
            ahead = 2.0;
        }
        (z, reach)
    }

    /// Least and most yaw at `z` of the lines of thrusts; writes those of each unit there.
    #[inline(never)]
    pub(super) fn reach(&self, lines: &mut [ThrustLine], z: f32) -> [f32; 2] {
        let mut reach = [0.0, 0.0];
        for (unit, line) in self.units.iter().zip(lines) {
            let [middle, half] = self.border.torques(line.thrust(z));
            let middle = unit.spin * middle;
            (line.least, line.most) = (middle - half, middle + half);
            reach = [reach[0] + line.least, reach[1] + line.most];
        }
        reach
    }

    /// Lines from the thrusts `from` through the null space. Returns the range of z; its first end
    /// is the larger one where rounding leaves no range.
    #[inline(always)]
    fn null_range(
        &self,
        lines: &mut [ThrustLine],
        from: impl Fn(&ClosedFormUnit, &ThrustLine) -> f32,
    ) -> [f32; 2] {
        let (mut low, mut high) = (-f32::MAX, f32::MAX);
        for (unit, line) in self.units.iter().zip(lines) {
            rolled();
            let f = from(unit, line);
            (line.from, line.along) = (f, unit.null);
            if unit.per_null != 0.0 {
                let [from, to] = unit.ends.map(|end| (end - f) * unit.per_null);
                low = if from > low { from } else { low };
                high = if to < high { to } else { high };
            }
        }
        if high == f32::MAX {
            // There is no null space.
            return [0.0, 0.0];
        }
        [low, high]
    }

    /// Draws the thrusts, now at `z` where yaw reaches less than is needed, towards others until it
    /// reaches it: those of level flight with the thrust `middle_n`, or first those of `roomy`.
    /// Returns their z on the new lines and the least and most yaw there; writes the lines with
    /// each unit's yaw.
    ///
    /// ```text
    /// given ---- answer ---- roomy ---- level      yaw reaches `needed` at the answer,
    ///                                              and more than that at roomy and level
    /// ```
    ///
    /// `roomy` has the roll and pitch of the request and another thrust. Where it has too little
    /// room it is drawn towards level flight itself. So the steps are bounded: yaw grows by
    /// [`MARGIN`] at least on the way from the answer to `roomy`, the sides being concave.
    #[inline(never)]
    fn retreat(
        &self,
        lines: &mut [ThrustLine],
        sign: f32,
        (z, reach): (f32, [f32; 2]),
        kept: Kept,
        middle_n: f32,
    ) -> (f32, [f32; 2]) {
        for (unit, line) in self.units.iter().zip(lines.iter_mut()) {
            rolled();
            line.given = line.thrust(z);
            line.level = unit.allocation[2] * middle_n;
            line.from = line.level;
            line.along = line.given - line.from;
        }
        let given = furthest(reach, sign);
        let level = furthest(self.reach(lines, 0.0), sign);
        let most = RESERVABLE * if level > 0.0 { level } else { 0.0 };
        let needed = if kept.needed < most { kept.needed } else { most };
        if given >= needed {
            for line in lines.iter_mut() {
                rolled();
                (line.from, line.along) = (line.given, 0.0);
            }
            return (0.0, self.reach(lines, 0.0));
        }
        let ends = [level - needed, given - needed];
        if !kept.thrust_first {
            return self.crossing(lines, sign, needed, ends);
        }
        let (mut at, mut reach) = match kept.roomy {
            Some(wrench) => {
                let target = needed + MARGIN * (level - needed);
                let inside = self.roomy(lines, sign, &wrench, (z, target), level);
                self.crossing(lines, sign, needed, [inside - needed, ends[1]])
            }
            None => self.crossing(lines, sign, needed, ends),
        };
        // Where z has room again yaw may reach further, and the thrusts can be drawn out again.
        let [low, high] = self.null_range(lines, |_, line| line.thrust(at));
        if high > low {
            (at, reach) = (0.0, self.reach(lines, 0.0));
            (at, reach) = self.climb(lines, sign, (at, reach), [low, high], f32::MAX);
            for line in lines.iter_mut() {
                rolled();
                line.from = line.thrust(at);
                line.along = line.given - line.from;
            }
            let inside = furthest(reach, sign) - needed;
            (at, reach) = self.crossing(lines, sign, needed, [inside, ends[1]]);
        }
        (at, reach)
    }

    /// Writes lines from the thrusts of `wrench`, z as near the present one as can be, to those
    /// `given`. Where yaw does not reach `target` there they begin nearer to level flight, at which
    /// it reaches `level`. Returns how far yaw reaches at their beginning.
    #[inline(always)]
    fn roomy(
        &self,
        lines: &mut [ThrustLine],
        sign: f32,
        wrench: &[f32; 3],
        (z, target): (f32, f32),
        level: f32,
    ) -> f32 {
        let [low, high] = self.null_range(lines, |unit, _| unit.thrust(wrench));
        let mut at = clamp(z, low, if high > low { high } else { low });
        let mut reach = self.reach(lines, at);
        let short = target - furthest(reach, sign);
        if short > 0.0 {
            for line in lines.iter_mut() {
                rolled();
                line.along = line.thrust(at) - line.level;
                line.from = line.level;
            }
            (at, reach) = self.crossing(lines, sign, target, [level - target, -short]);
        }
        for line in lines.iter_mut() {
            rolled();
            line.from = line.thrust(at);
            line.along = line.given - line.from;
        }
        furthest(reach, sign)
    }

    /// Goes along the lines from 0 towards 1, as far as yaw reaches `needed`, which it exceeds by
    /// `inside` at 0 and by `outside` at 1. Returns the place and the least and most yaw there;
    /// writes each unit's yaw.
    ///
    /// A straight line crosses `needed` inside where the sides are concave: then a second one from
    /// there is nearer. Where they are not it may cross outside, by little: then the steps go
    /// inwards.
    #[inline(never)]
    fn crossing(
        &self,
        lines: &mut [ThrustLine],
        sign: f32,
        needed: f32,
        [inside, outside]: [f32; 2],
    ) -> (f32, [f32; 2]) {
        let inside = if inside > 0.0 { inside } else { 0.0 };
        // Outside by a little at least, so that no division is by zero.
        let least = -self.yaw_rounding_nm;
        let outside = if outside < least { outside } else { least };
        let mut at = inside / (inside - outside);
        for step in 0..black_box(CROSSINGS) {
            let reach = self.reach(lines, at);
            let here = furthest(reach, sign) - needed;
            if here < 0.0 {
                at *= clamp(1.0 + 2.0 * here / (inside - here), 0.0, 1.0);
            } else if step == 0 {
                at += (1.0 - at) * here / (here - outside);
            } else {
                return (at, reach);
            }
        }
        (at, self.reach(lines, at))
    }
}
