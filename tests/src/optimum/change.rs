//! How far throttles must move from one request to the next, whichever of the optimal efforts are
//! chosen.

use microlp::{ComparisonOp, Error, OptimizationDirection, Problem, SolveOutcome, Variable};
use mixer_rt::{Health, tables::Airmode};
use nalgebra::{Matrix2, Vector2};

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

/// The change of a throttle that the priorities themselves force between two requests at one
/// voltage, all rotors working: the least possible largest one between any optimal efforts of the
/// one and any of the other, over the convex hulls of the mixer's own polygons, about the throttles
/// of `answer`. Where an optimum is so steep that the rounding error of a higher priority forces
/// more, that. `None` where a request has no optimum.
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

/// True where two answers to requests at one voltage, all rotors working, are optima that lie
/// apart, so that any choice of the best must jump: each is the best over the mixer's own polygons,
/// but for rounding, and half way between the throttles of the two nothing is as good for either
/// request.
///
/// # Errors
/// The solver gave up.
pub fn parted(frame: &Frame, requests: [&Request; 2], answers: [&Answer; 2]) -> Result<bool, Error> {
    let volts = requests[0].volts;
    let throttles = answers.map(|answer| answer.throttle.iter().copied().map(f64::from).collect::<Vec<_>>());
    let pairs = throttles[0].iter().zip(&throttles[1]);
    let middle: Vec<f64> = pairs.map(|(a, b)| a.midpoint(*b)).collect();
    let reach = 0.25 * f64::from(answers[0].change(answers[1]));
    let near = |throttles: &[f64]| Oracle::of_polygons_near(frame, throttles, volts, reach);
    let exact = Oracle::of_exact_polygons(frame, volts, Health::GOOD);
    let between = near(&middle);
    for (request, throttles) in requests.into_iter().zip(&throttles) {
        let asked = served(frame, request);
        let Some(ranges) = exact.allowed(asked)? else {
            return Ok(false);
        };
        let of = |oracle: &Oracle| oracle.optimum_within(asked, ranges, None);
        let (Some(best), Some(own)) = (of(&exact)?, of(&near(throttles))?) else {
            return Ok(false);
        };
        if best.is_better_than(&own, frame, asked, ROUNDING) {
            return Ok(false);
        }
        if let Some(between) = of(&between)?
            && !own.is_better_than(&between, frame, asked, OFF)
        {
            return Ok(false);
        }
    }
    Ok(true)
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
    /// True where it is better than another by more than `margin`, a share of the authority, in the
    /// order of priority.
    fn is_better_than(&self, other: &Optimum, frame: &Frame, asked: [f64; 4], margin: f64) -> bool {
        let short = |optimum: &Optimum| {
            let wrench = optimum.wrench(asked);
            let [roll, pitch, yaw, thrust] = std::array::from_fn(|axis| {
                if frame.served()[axis] {
                    (wrench[axis] - asked[axis]).abs() / frame.authority[axis]
                } else {
                    0.0
                }
            });
            match frame.allocation().airmode {
                Airmode::RollPitchYaw => [roll.max(pitch), yaw, thrust],
                Airmode::Disabled | Airmode::RollPitch => [roll.max(pitch), thrust, yaw],
            }
        };
        let pairs = short(self).into_iter().zip(short(other));
        let mut differences = pairs.map(|(own, other): (f64, f64)| other - own);
        differences
            .find(|difference| difference.abs() > margin)
            .is_some_and(|difference| difference > 0.0)
    }

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

/// The derivative of a unit's efforts by its throttles.
pub(super) fn by_throttles(frame: &Frame, throttles: [f64; 2]) -> Matrix2<f64> {
    Matrix2::from(frame.physics.pair.jacobian(throttles)).transpose()
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
            let by_efforts = by_throttles(frame, at).try_inverse().unwrap_or_default();
            corners
                .iter()
                .map(|corner| {
                    let efforts = corner.map(f64::from);
                    Corner {
                        wrench: physics.contribution(i, efforts, factors),
                        throttles: (by_efforts * Vector2::from(efforts)).into(),
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
