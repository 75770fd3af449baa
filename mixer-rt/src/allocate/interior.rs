//! An interior point method on the throttles, for requests that least norm cannot serve.
//!
//! ```text
//! least   sum_j c_j w_j s_j  +  rho/2 sum_i (t_i - t_i*)^2
//! over    t_i in (min, max) for every rotor that turns, s_j in (0, 1) for every slack
//! with    sum_i B_i y_i(t) + sum_j a_j s_j = w
//! ```
//!
//! t are throttles and t* those of least norm, y_i = (f, Q) what a unit gives by the forward map, and
//! a_j s_j what is given up of a row: s_j of the width w_j, at the cost c_j ([`request`](super::request)). So the answer
//! is the throttles nearest those of least norm among those that cut the request least, by priority,
//! over the true attainable sets, whatever their shape.
//!
//! An iteration is one step of Newton's method on the conditions of this with a barrier of weight mu on
//! every bound. All unknowns but the multipliers lambda of the four rows are eliminated in closed form,
//! each by itself ([`unknown`](super::unknown)):
//!
//! ```text
//! gain_i = (dy/dt_i)^T B^T lambda - rho (t_i - t_i*)        curvature_i = rho + max(-(d2y/dt_i2)^T B^T lambda, 0)
//! (sum B J R J^T B^T + sum a R a^T) change = w - sum B (y + J step) - sum a (s + step)
//! ```
//!
//! R are the responses. Mixed second derivatives are left out, and curvature counts only where it makes
//! the problem convex. All steps are cut to the same share, so that no unknown comes to its bound.
//!
//! The first run has [`ITERATIONS`]. Where a row is still missed, or the gap is still open, a second run ends with the
//! gap closed, after [`FURTHER`] at the latest; what is left of these follows where rows are missed with the gap closed.
//! The gap is the sum over all unknowns of what the gain is worth over the distance from the bound ahead. So the most work
//! is a product, which `cargo counts` states.
//!
//! Constants were chosen on 20,000 drawn requests per state of health, and on 50,000 pairs of requests
//! 1e-4 apart; `cargo soak` and the tests of `tests/allocation` show what they trade.

use super::closed_form::AllocationMethod;
use super::frame::Frame;
use super::request::Request;
use super::system::{Factors, Matrix, Products};
use super::unit::UnitState;
use super::unknown::Unknown;
use crate::pair::{Expansion, Kinds};
use crate::{divided, larger, rolled};

/// Iterations of the first run. Fewer leave more requests short, and make throttles step at the border of least
/// norm.
const ITERATIONS: u32 = 10;
/// Of the second run at most; most end after four or five.
const FURTHER: u32 = 9;
/// Of both.
pub const MOST_ITERATIONS: u32 = ITERATIONS + FURTHER;

/// The barrier's weight in the first iteration, and where iterations go on. From a larger weight the second run takes more
/// iterations to the same answers.
const FIRST_MU: f32 = 90.0;
const NEXT_MU: f32 = 2e-3;

/// Share of the authority up to which a row counts as met after the first iterations, and after the
/// further ones. The first is the stricter one, so that requests along a ramp do not go to and fro.
const MET: f32 = 1e-3;
const MET_AT_LAST: f32 = 2e-3;

/// Gap per unit up to which the first iterations have converged. Rows that are met say nothing of the optimum.
/// At this gap an answer costs at most 0.2 % of the authority of the last priority too much. Larger gaps leave steps of
/// the throttles, smaller ones take more iterations (`cargo jumps`).
const CLOSED: f32 = 2e-3;
/// The same that ends further ones.
const CLOSED_AT_LAST: f32 = 1e-3;

/// The fall of the barrier's weight from one iteration to the next, and its least. A smaller least
/// weight is not converged after ten iterations, and flags flicker; a larger one is short of the optimum.
/// The fall is (LEAST_MU / FIRST_MU)^(1 / (ITERATIONS - 1)), so that the last iteration has the least.
const FALL: f32 = 0.201_83;
const LEAST_MU: f32 = 5e-5;

/// Attraction of the throttles of least norm, per square of the throttle range. More gives up the last
/// priority to stay near them; less makes throttles step where yaw saturates.
const RHO: f32 = 0.15;

/// Share of the way to the nearest bound.
const SHARE: f32 = 0.97;

/// Throttles of least norm nearer to a bound count as so near, as a share of the range.
const CLOSE: f32 = 1e-3;

impl<K: Kinds, S: AllocationMethod, const VERTICAL: bool> Frame<'_, '_, K, S, VERTICAL> {
    /// Cuts the request by priority; true where its rows are met. The units' throttles are those that
    /// the answer is drawn to.
    #[inline(never)]
    pub(super) fn cut(&self, wrench: &[f32; 4], units: &mut [UnitState], is_whole: bool) -> bool {
        let n = units.len() as f32;
        let scale = [self.per_factor[0], self.ratio];
        let mut request = Request::new(self.tables, wrench, n, scale, is_whole);
        self.aim(units);
        let mut lambda = self.begin(&request, units, is_whole);
        let (missed, gap, _) = self.iterate(&mut request, units, &mut lambda, FIRST_MU, ITERATIONS, 0.0);
        if is_met(&missed, MET * n) && gap <= CLOSED * n {
            return true;
        }
        let closed = CLOSED_AT_LAST * n;
        let (missed, _, left) = self.iterate(&mut request, units, &mut lambda, NEXT_MU, FURTHER, closed);
        let is_served = is_met(&missed, MET_AT_LAST * n);
        if is_served || left < 2 {
            return is_served;
        }
        // The gap has closed while rows are missed. One iteration less pays for one correction more.
        let (missed, ..) = self.iterate(&mut request, units, &mut lambda, LEAST_MU, left - 1, 0.0);
        is_met(&missed, MET_AT_LAST * n)
    }

    /// Puts the targets at the units' throttles, offset so that the bias of the barrier at its least weight
    /// cancels.
    #[inline(always)]
    fn aim(&self, units: &mut [UnitState]) {
        let (least, span) = (self.tables.throttle.min, self.span());
        let close = CLOSE * span;
        for unit in rolled(units) {
            for side in 0..2 {
                let (low, turns) = (unit.throttles[side] - least, unit.rotors.turns(side));
                let low = if turns { low } else { 0.5 * span };
                let (near, far) = (larger(low, close), larger(span - low, close));
                let pull = divided(near - far, near * far);
                unit.targets[side] = low + LEAST_MU / RHO * span * span * pull;
            }
        }
    }

    /// Turns the columns into the request's rows and puts the unknowns in the middle; the multipliers are 0. With rotors
    /// out, least norm has left the columns.
    #[inline(never)]
    fn begin(&self, request: &Request, units: &mut [UnitState], is_whole: bool) -> [f32; 4] {
        for (unit, table) in rolled(units.iter_mut().zip(self.tables.units)) {
            if is_whole {
                unit.columns = self.columns(table);
            }
            unit.columns = request.turned(&unit.columns);
            unit.unknowns = [Unknown::central(self.span()); 2];
        }
        [0.0; 4]
    }

    /// Runs iterations from the barrier's weight `mu` on, `most` at most or until the gap is below `closed` at the least
    /// weight, and corrects the throttles. Returns the residual of the rows, the gap before the last step, and how many
    /// iterations are left.
    #[inline(never)]
    fn iterate(
        &self,
        request: &mut Request,
        units: &mut [UnitState],
        lambda: &mut [f32; 4],
        mut mu: f32,
        most: u32,
        closed: f32,
    ) -> ([f32; 4], f32, u32) {
        let (mut system, mut gap) = (Factors::NONE, 0.0);
        let mut left = most;
        while left > 0 {
            left -= 1;
            let (matrix, missed, sum) = self.linearise(request, units, lambda, mu);
            gap = sum;
            system = Factors::of(&matrix);
            let change = system.solve(missed);
            for (lambda, change) in lambda.iter_mut().zip(change) {
                *lambda += change;
            }
            self.advance(request, units, &change);
            mu = larger(mu * FALL, LEAST_MU);
            if mu == LEAST_MU && gap < closed {
                break;
            }
        }
        self.correct(request, units, &system);
        (self.missed(request, units), gap, left)
    }

    /// Eliminates all unknowns: the system of the multipliers, what the rows miss after the steps, and the
    /// gap.
    #[inline(always)]
    fn linearise(
        &self,
        request: &mut Request,
        units: &mut [UnitState],
        lambda: &[f32; 4],
        mu: f32,
    ) -> (Matrix, [f32; 4], f32) {
        let (tables, least) = (self.tables, self.tables.throttle.min);
        let rho = RHO / (self.span() * self.span());
        let mut matrix = [0.0; 10];
        let (mut missed, mut gap) = request.eliminate(lambda, mu, &mut matrix);
        for (index, unit) in rolled(units.iter_mut().enumerate()) {
            let Expansion {
                mut value,
                slopes,
                curvatures,
            } = tables.expansion(index, unit.rotors, unit.unknowns.map(|at| least + at.low));
            let gain = Products::<VERTICAL>::gains(&unit.columns, lambda);
            let mut responses = [[0.0; 3]; 2];
            for side in 0..2 {
                let ([f, q], [f2, q2]) = (slopes[side], curvatures[side]);
                let unknown = &mut unit.unknowns[side];
                let more = gain[0] * f + gain[1] * q + rho * (unit.targets[side] - unknown.low);
                let curvature = -2.0 * (gain[0] * f2 + gain[1] * q2);
                gap += unknown.eliminate(more, Some(rho + larger(curvature, 0.0)), mu);
                value[0] += f * unknown.step;
                value[1] += q * unknown.step;
                let (by_f, by_q) = (unknown.response * f, unknown.response * q);
                responses[side] = [by_f * f, by_f * q, by_q * q];
            }
            unit.slopes = slopes;
            Products::<VERTICAL>::subtract(&unit.columns, value, &mut missed);
            let [upper, lower] = responses;
            let response = [upper[0] + lower[0], upper[1] + lower[1], upper[2] + lower[2]];
            Products::<VERTICAL>::add(&unit.columns, response, &mut matrix);
        }
        (matrix, missed, gap)
    }

    /// Completes all steps with the change of the multipliers, and goes the same share of each.
    #[inline(always)]
    fn advance(&self, request: &mut Request, units: &mut [UnitState], change: &[f32; 4]) {
        let mut most = SHARE;
        self.respond(units, change, &mut most);
        request.respond(change, &mut most);
        let share = SHARE / most;
        request.advance(share);
        advance(units, share);
    }

    /// Moves the throttles alone to meet the rows by the forward map, the slacks staying.
    #[inline(never)]
    fn correct(&self, request: &Request, units: &mut [UnitState], system: &Factors) {
        let change = system.solve(self.missed(request, units));
        for unknown in rolled(units.iter_mut().flat_map(|unit| &mut unit.unknowns)) {
            unknown.step = 0.0;
        }
        let mut most = SHARE;
        self.respond(units, &change, &mut most);
        advance(units, SHARE / most);
    }

    /// Adds the rotors' responses to a change of the multipliers to their steps; raises `most` to the
    /// largest step over its room.
    #[inline(always)]
    fn respond(&self, units: &mut [UnitState], change: &[f32; 4], most: &mut f32) {
        for unit in rolled(units) {
            let gain = Products::<VERTICAL>::gains(&unit.columns, change);
            for (unknown, [f, q]) in unit.unknowns.iter_mut().zip(&unit.slopes) {
                unknown.respond(f * gain[0] + q * gain[1], most);
            }
        }
    }

    /// Residual of the rows by the forward map.
    #[inline(never)]
    fn missed(&self, request: &Request, units: &mut [UnitState]) -> [f32; 4] {
        let mut missed = request.left();
        for (index, unit) in rolled(units.iter_mut().enumerate()) {
            self.place(index, unit);
            Products::<VERTICAL>::subtract(&unit.columns, unit.efforts, &mut missed);
        }
        missed
    }

    /// Writes a unit's throttles at its unknowns and what it gives there.
    #[inline(always)]
    pub(super) fn place(&self, index: usize, unit: &mut UnitState) {
        let range = &self.tables.throttle;
        for side in 0..2 {
            let throttle = range.clamp(range.min + unit.unknowns[side].low);
            unit.throttles[side] = if unit.rotors.turns(side) { throttle } else { 0.0 };
        }
        unit.efforts = self.tables.efforts(index, unit.rotors, unit.throttles);
    }
}

/// True where no row is missed by more than `most`.
#[inline(always)]
pub(super) fn is_met(missed: &[f32; 4], most: f32) -> bool {
    missed.iter().all(|row| row.abs() <= most)
}

/// Goes a share of the rotors' steps.
#[inline(always)]
fn advance(units: &mut [UnitState], share: f32) {
    for unit in rolled(units) {
        for unknown in &mut unit.unknowns {
            unknown.advance(share);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_iteration_has_the_least_weight() {
        let last = (1..ITERATIONS).fold(FIRST_MU, |mu, _| mu * FALL);
        assert!((last / LEAST_MU - 1.0).abs() < 1e-3, "{last}");
    }
}
