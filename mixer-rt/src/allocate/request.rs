//! The request in rows, and what may be short of it at what cost.
//!
//! Rows are those of the request: roll and pitch along it, across it, yaw in its sense, thrust. So a
//! slack is part of one row and adds to one element of the system's diagonal only; in the axes' own
//! rows that of roll and pitch fills a block whose determinant cancels in single precision. A row is
//! scaled so that n units have the authority n.
//!
//! Costs are those of [`priorities`](super::priorities). Nothing may be short across (roll, pitch): their
//! direction stays. Every slack ends at what is asked: with all rotors nothing is reversed or exceeded
//! while the rows are met.
//!
//! With rotors out yaw may be anything, at a cost per distance from what is asked: a rotor alone in its unit
//! has a torque that the others may not balance. The reserve then grows with the yaw asked,
//!
//! ```text
//! kept = yaw - LIMIT (1 - yaw / reserve)     for 0 <= yaw <= reserve
//! ```
//!
//! so that a request of the whole reserve has all of it, no thrust is given up for a trace of yaw, and nothing
//! jumps where the request changes its sense.

use super::priorities::{Airmode, FORBIDDEN, LAST, MIDDLE, RESERVED, TORQUE, limited};
use super::system::{Columns, Matrix};
use super::unknown::Unknown;
use crate::layout::Tables;
use crate::{divided, divisor, larger, smaller, sqrt};

/// Largest roll, pitch and yaw asked, in rows per unit: beyond all that units give.
const TORQUE_LIMIT: f32 = 1.2;
/// The range of thrust asked, likewise; an excess may reach beyond.
const THRUST_LIMITS: [f32; 2] = [-0.05, 1.05];
const EXCESS_LIMIT: f32 = 1.1;

/// Least width of a slack, rows.
const LEAST_WIDTH: f32 = 1e-3;

/// Slacks up to this count as none, rows: the barrier at its least weight leaves a quarter of it at
/// the least cost.
const NEGLIGIBLE: f32 = 2e-4;

/// Roll and pitch below this count as none, rows; their direction is then that of roll.
const LEVEL: f32 = 1e-12;

/// The slack of a row: its part that may be given up.
#[derive(Clone, Copy)]
pub(super) struct Slack {
    /// The share of the width that is given up.
    unknown: Unknown,
    /// Rows, signed.
    width: f32,
    /// Of the whole width, c_j w_j.
    cost: f32,
}

impl Slack {
    fn new(width: f32, cost: f32) -> Self {
        let width = larger(width, LEAST_WIDTH);
        Slack {
            unknown: Unknown::central(1.0),
            width,
            cost: cost * width,
        }
    }

    /// Of an excess in place of a shortage.
    fn opposite(self) -> Self {
        Slack {
            width: -self.width,
            ..self
        }
    }

    /// As [`Unknown::eliminate`]: takes the rest from the row, and adds to its diagonal.
    #[inline(always)]
    fn eliminate(&mut self, lambda: f32, mu: f32, missed: &mut f32, diagonal: &mut f32) -> f32 {
        let gap = self.unknown.eliminate(lambda * self.width - self.cost, None, mu);
        *missed -= (self.unknown.low + self.unknown.step) * self.width;
        *diagonal += self.unknown.response * self.width * self.width;
        gap
    }

    /// The step with a change of its row's multiplier.
    #[inline(always)]
    fn respond(&mut self, change: f32, most: &mut f32) {
        self.unknown.respond(self.width * change, most);
    }

    /// Rows given up. What the barrier leaves counts as none.
    #[inline(always)]
    fn amount(&self) -> f32 {
        let amount = self.unknown.low * self.width;
        if amount.abs() > NEGLIGIBLE { amount } else { 0.0 }
    }
}

/// A request in its rows.
pub(super) struct Request {
    /// Rows asked; no torque is negative.
    wanted: [f32; 4],
    /// The direction of (roll, pitch).
    direction: [f32; 2],
    /// The sense of yaw, 1 or -1.
    sense: f32,
    /// Of roll and pitch, of thrust, of thrust in excess, of yaw, of yaw within the reserve, of yaw in excess.
    slacks: [Slack; 6],
    /// Whether the last two take part: with a reserve, with rotors out.
    has_reserve: bool,
    may_exceed: bool,
}

impl Request {
    /// The request `[roll, pitch, yaw, thrust]` (N m, N; bounded) for n units, `is_whole` where all rotors
    /// turn. `per_thrust` is 1 / k_f, `ratio` k_Q / k_f.
    #[inline(never)]
    pub(super) fn new<K, S>(
        tables: &Tables<'_, K, S>,
        wrench: &[f32; 4],
        n: f32,
        [per_thrust, ratio]: [f32; 2],
        is_whole: bool,
    ) -> Self {
        let rows = tables.row_scale.map(|row| row * per_thrust);
        let mut asked = *wrench;
        for (asked, row) in asked.iter_mut().zip(rows) {
            *asked *= row;
        }
        let limit = TORQUE_LIMIT * n;
        let yaw_limit = limit * larger(ratio, 1.0);
        let thrusts = THRUST_LIMITS.map(|end| end * n);
        let [roll, pitch, turn, thrust] = limited(asked, limit, yaw_limit, thrusts);
        let is_level = roll.abs() < LEVEL && pitch.abs() < LEVEL;
        let [roll, pitch] = if is_level { [LEVEL, 0.0] } else { [roll, pitch] };
        let along = sqrt(roll * roll + pitch * pitch);
        let per_along = 1.0 / divisor(along);
        let (sense, turn) = if turn < 0.0 { (-1.0, -turn) } else { (1.0, turn) };
        let reserve = tables.priorities.yaw_reserve_nm * rows[2];
        let asked_of_it = smaller(reserve, turn);
        // How far yaw may go the other way.
        let far = if is_whole { 0.0 } else { yaw_limit };
        let kept = asked_of_it - far * (1.0 - divided(asked_of_it, divisor(reserve)));
        let airmode = tables.priorities.airmode;
        let [thrust_cost, yaw_cost] = if airmode.is_yaw_first() {
            [LAST, MIDDLE]
        } else {
            [MIDDLE, LAST]
        };
        let excess_cost = if airmode == Airmode::Disabled {
            FORBIDDEN
        } else {
            thrust_cost
        };
        Request {
            wanted: [along, 0.0, turn, thrust],
            direction: [roll * per_along, pitch * per_along],
            sense,
            slacks: [
                Slack::new(along, TORQUE),
                Slack::new(thrust, thrust_cost),
                Slack::new(EXCESS_LIMIT * n - thrust, excess_cost).opposite(),
                Slack::new(turn - kept, yaw_cost),
                Slack::new(far + kept, RESERVED),
                Slack::new(yaw_limit - turn, yaw_cost).opposite(),
            ],
            has_reserve: reserve > 0.0,
            may_exceed: !is_whole,
        }
    }

    /// Columns of the axes' rows as those of the request's.
    #[inline(always)]
    pub(super) fn turned(&self, columns: &Columns) -> Columns {
        let [along, across] = self.direction;
        columns.map(|[roll, pitch, yaw, thrust]| {
            [
                along * roll + across * pitch,
                along * pitch - across * roll,
                self.sense * yaw,
                thrust,
            ]
        })
    }

    /// Eliminates the slacks: takes them from the rows wanted, and adds to the system's diagonal. Returns
    /// the rows, and the sum of the gaps.
    #[inline(always)]
    pub(super) fn eliminate(&mut self, lambda: &[f32; 4], mu: f32, matrix: &mut Matrix) -> ([f32; 4], f32) {
        let mut missed = self.wanted;
        let [torque, little, much, yaw, kept, more] = &mut self.slacks;
        let mut gap = torque.eliminate(lambda[0], mu, &mut missed[0], &mut matrix[0]);
        gap += yaw.eliminate(lambda[2], mu, &mut missed[2], &mut matrix[7]);
        gap += little.eliminate(lambda[3], mu, &mut missed[3], &mut matrix[9]);
        gap += much.eliminate(lambda[3], mu, &mut missed[3], &mut matrix[9]);
        if self.has_reserve {
            gap += kept.eliminate(lambda[2], mu, &mut missed[2], &mut matrix[7]);
        }
        if self.may_exceed {
            gap += more.eliminate(lambda[2], mu, &mut missed[2], &mut matrix[7]);
        }
        (missed, gap)
    }

    /// Steps with a change of the multipliers; raises `most` to the largest step over its room.
    #[inline(always)]
    pub(super) fn respond(&mut self, change: &[f32; 4], most: &mut f32) {
        let [torque, little, much, yaw, kept, more] = &mut self.slacks;
        torque.respond(change[0], most);
        yaw.respond(change[2], most);
        little.respond(change[3], most);
        much.respond(change[3], most);
        if self.has_reserve {
            kept.respond(change[2], most);
        }
        if self.may_exceed {
            more.respond(change[2], most);
        }
    }

    /// Goes a share of the steps.
    #[inline(always)]
    pub(super) fn advance(&mut self, share: f32) {
        for slack in &mut self.slacks {
            slack.unknown.advance(share);
        }
    }

    /// The rows wanted less the slacks.
    #[inline(always)]
    pub(super) fn left(&self) -> [f32; 4] {
        let [along, across, turn, thrust] = self.wanted;
        let [torque, little, much, mut yaw, kept, more] = self.slacks.each_ref().map(Slack::amount);
        if self.has_reserve {
            yaw += kept;
        }
        if self.may_exceed {
            yaw += more;
        }
        [along - torque, across, turn - yaw, thrust - (little + much)]
    }
}
