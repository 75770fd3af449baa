//! How far throttles must move from one request to the next, whichever of the optimal efforts are chosen.

use microlp::{ComparisonOp, Error, OptimizationDirection, Problem, SolveOutcome, Variable};
use mixer_rt::{Airmode, Health};

use super::{Optimum, Oracle};
use crate::request::{Answer, Frame, Request};

/// By how much a row, as a share of the authority, may be off: the solver's rounding.
const OFF: f64 = 1e-7;

/// What a mixer in f32 may miss of a priority, as a share of the authority.
const ROUNDING: f64 = 4e-6;

/// A corner of a unit's polygon.
struct Corner {
    /// What it contributes to `[roll, pitch, yaw, thrust]`.
    wrench: [f64; 4],
    /// Throttles, linearised about those of the answer.
    throttles: [f64; 2],
}

/// The change of a throttle that the priorities themselves force between two requests at one voltage, all rotors working:
/// the least possible largest one between any optimal efforts of the one and any of the other, over the convex hulls of the
/// mixer's own polygons, about the throttles of `answer`. Where an optimum is so steep that the rounding error of a higher priority
/// forces more, that. `None` where a request has no optimum.
///
/// # Errors
/// The solver gave up.
pub fn forced(frame: &Frame, requests: [&Request; 2], answer: &Answer) -> Result<Option<f64>, Error> {
    let volts = requests[0].volts;
    let oracle = Oracle::of_polygons(frame, volts, Health::GOOD);
    let mut wrenches = [[0.0; 4]; 2];
    let mut forced = 0.0_f64;
    for (wrench, request) in wrenches.iter_mut().zip(requests) {
        let asked = served(frame, request);
        let Some(optimum) = oracle.optimum(asked)? else {
            return Ok(None);
        };
        *wrench = optimum.wrench(asked);
        for given in given_up(frame, asked, &optimum) {
            if let Some(rounded) = oracle.optimum_given(asked, Some(given))? {
                forced = forced.max(between(frame, volts, [*wrench, rounded.wrench(asked)], answer)?);
            }
        }
    }
    Ok(Some(forced.max(between(frame, volts, wrenches, answer)?)))
}

/// The request's axes that are served.
fn served(frame: &Frame, request: &Request) -> [f64; 4] {
    let mut asked = request.asked();
    for (asked, served) in asked.iter_mut().zip(frame.served()) {
        if !served {
            *asked = 0.0;
        }
    }
    asked
}

/// Share and next priority where [`ROUNDING`] is given up of the one or of the other.
fn given_up(frame: &Frame, asked: [f64; 4], optimum: &Optimum) -> [(f64, Option<f64>); 2] {
    let share = (0..2)
        .filter(|&axis| asked[axis] != 0.0)
        .map(|axis| frame.authority[axis] / asked[axis].abs())
        .fold(f64::INFINITY, f64::min);
    let less = if share.is_finite() { ROUNDING * share } else { 0.0 };
    let (value, axis) = match frame.allocation().airmode {
        Airmode::RollPitchYaw => (optimum.yaw_nm, 2),
        Airmode::Disabled | Airmode::RollPitch => (optimum.thrust_n, 3),
    };
    let away = ROUNDING * frame.authority[axis] * (value - asked[axis]).signum();
    [
        ((optimum.share - less).max(0.0), None),
        (optimum.share, Some(value + away)),
    ]
}

impl Optimum {
    /// Its wrench, `[roll, pitch, yaw, thrust]`, for what has been asked.
    fn wrench(&self, asked: [f64; 4]) -> [f64; 4] {
        [
            self.share * asked[0],
            self.share * asked[1],
            self.yaw_nm,
            self.thrust_n,
        ]
    }
}

/// The least possible largest change of a throttle between efforts that give the two wrenches.
fn between(frame: &Frame, volts: f32, wrenches: [[f64; 4]; 2], answer: &Answer) -> Result<f64, Error> {
    let physics = &frame.physics;
    let factors = physics.factors(volts);
    let n = physics.units();
    let corners = frame.compiled.tables.attainable.corners();
    let sets: Vec<Vec<Corner>> = (0..n)
        .map(|i| {
            let at = physics.channels[i].map(|channel| f64::from(answer.throttle[channel]));
            let [[fu, fl], [qu, ql]] = physics.pair.jacobian(at);
            let det = fu * ql - fl * qu;
            let inverse = [[ql / det, -fl / det], [-qu / det, fu / det]];
            corners
                .iter()
                .map(|corner| {
                    let efforts @ [f, q] = corner.map(f64::from);
                    Corner {
                        wrench: physics.contribution(i, efforts, factors),
                        throttles: inverse.map(|[by_f, by_q]| by_f * f + by_q * q),
                    }
                })
                .collect()
        })
        .collect();
    let mut problem = Problem::new(OptimizationDirection::Minimize);
    let change = problem.add_var(1.0, (0.0, f64::INFINITY));
    let mut moves: Vec<[Vec<(Variable, f64)>; 2]> = vec![[Vec::new(), Vec::new()]; n];
    let served = frame.served();
    for (wrench, sign) in wrenches.into_iter().zip([-1.0, 1.0]) {
        let mut rows: [Vec<(Variable, f64)>; 4] = Default::default();
        for (corners, moves) in sets.iter().zip(&mut moves) {
            let mut ones = Vec::new();
            for corner in corners {
                let weight = problem.add_var(0.0, (0.0, f64::INFINITY));
                ones.push((weight, 1.0));
                for ((row, entry), size) in rows.iter_mut().zip(corner.wrench).zip(frame.authority) {
                    row.push((weight, entry / size));
                }
                for (row, throttle) in moves.iter_mut().zip(corner.throttles) {
                    row.push((weight, sign * throttle));
                }
            }
            problem.add_constraint(ones, ComparisonOp::Eq, 1.0);
        }
        for (axis, row) in rows.into_iter().enumerate().filter(|(axis, _)| served[*axis]) {
            let value = wrench[axis] / frame.authority[axis];
            problem.add_constraint(row.clone(), ComparisonOp::Le, value + OFF);
            problem.add_constraint(row, ComparisonOp::Ge, value - OFF);
        }
    }
    for row in moves.into_iter().flatten() {
        for (op, sign) in [(ComparisonOp::Le, -1.0), (ComparisonOp::Ge, 1.0)] {
            let mut row = row.clone();
            row.push((change, sign));
            problem.add_constraint(row, op, 0.0);
        }
    }
    match problem.solve()? {
        SolveOutcome::Solution(solution) => Ok(solution.objective()),
        SolveOutcome::Interrupted(_) => Err(Error::InternalError("interrupted".to_owned())),
    }
}
