//! One linear programme: the best share of (roll, pitch), yaw or thrust that convex sets of
//! contributions allow.

use microlp::{ComparisonOp, Error, OptimizationDirection, Problem, SolveOutcome, Variable};

/// The price of letting a row go, per its size.
const PRICE: f64 = 1e3;

/// How much of a row, as a share of its size, may have been let go: rounding.
const LET_GO: f64 = 1e-6;

/// What counts as none of an axis, as a share of its size: sines of half a turn, which the solver would
/// divide by.
const ROUNDING: f64 = 1e-12;

/// A variable of a programme.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    /// The share of the (roll, pitch) asked.
    Share,
    /// Yaw, N m.
    Yaw,
    /// Thrust, N.
    Thrust,
}

/// What is wanted of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Goal {
    Highest(Quantity),
    Lowest(Quantity),
    Nearest(Quantity, f64),
}

/// Where the quantities are allowed to be, `(least, largest)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ranges {
    pub(super) share: (f64, f64),
    pub(super) yaw: (f64, f64),
    pub(super) thrust: (f64, f64),
}

/// The quantities at an optimum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Point {
    pub(super) share: f64,
    pub(super) yaw: f64,
    pub(super) thrust: f64,
    /// What was made largest, in the solver's units: a distance counts negative.
    pub(super) score: f64,
}

impl Point {
    pub(super) fn get(&self, quantity: Quantity) -> f64 {
        match quantity {
            Quantity::Share => self.share,
            Quantity::Yaw => self.yaw,
            Quantity::Thrust => self.thrust,
        }
    }
}

/// The sets that the units' contributions `[roll, pitch, yaw, thrust]` are taken from, by the
/// points whose convex combinations they are, and the axes that are looked at.
pub(super) struct Programme {
    pub(super) sets: Vec<Vec<[f64; 4]>>,
    pub(super) served: [bool; 4],
    /// (roll, pitch) at a share of one.
    pub(super) direction: [f64; 2],
    /// What each axis is about, N m and N: the solver sees numbers of order one.
    pub(super) size: [f64; 4],
}

impl Programme {
    /// The optimum, `None` where nothing is feasible.
    ///
    /// Where little is feasible or nothing the solver may make out neither. Then the rows are let
    /// go at a price, and feasible is what needs none of that.
    ///
    /// # Errors
    /// The solver gave up all the same.
    pub(super) fn solve(&self, goal: Goal, ranges: Ranges) -> Result<Option<Point>, Error> {
        match self.solve_with(goal, ranges, false) {
            Err(Error::InternalError(_)) => self.solve_with(goal, ranges, true),
            solved => solved,
        }
    }

    /// What one of a variable is worth: a share as much as its torque, so that the prices above are
    /// high everywhere.
    fn worth(&self, quantity: Quantity) -> f64 {
        match quantity {
            Quantity::Share => (0..2)
                .filter(|&axis| self.served[axis])
                .map(|axis| self.direction[axis].abs() / self.size[axis])
                .sum(),
            Quantity::Yaw | Quantity::Thrust => 1.0,
        }
    }

    fn solve_with(&self, goal: Goal, ranges: Ranges, elastic: bool) -> Result<Option<Point>, Error> {
        let mut problem = Problem::new(OptimizationDirection::Maximize);
        let coefficient = |quantity| match goal {
            Goal::Highest(wanted) if wanted == quantity => self.worth(quantity),
            Goal::Lowest(wanted) if wanted == quantity => -self.worth(quantity),
            _ => 0.0,
        };
        let over = |(low, high): (f64, f64), size: f64| (low / size, high / size);
        let [.., yaw_size, thrust_size] = self.size;
        let share = problem.add_var(coefficient(Quantity::Share), ranges.share);
        let yaw = problem.add_var(coefficient(Quantity::Yaw), over(ranges.yaw, yaw_size));
        let thrust = problem.add_var(coefficient(Quantity::Thrust), over(ranges.thrust, thrust_size));
        if let Goal::Nearest(quantity, wanted) = goal {
            let (variable, wanted) = match quantity {
                Quantity::Share => (share, wanted),
                Quantity::Yaw => (yaw, wanted / yaw_size),
                Quantity::Thrust => (thrust, wanted / thrust_size),
            };
            let worth = self.worth(quantity);
            let above = problem.add_var(-worth, (0.0, f64::INFINITY));
            let below = problem.add_var(-worth, (0.0, f64::INFINITY));
            problem.add_constraint(
                [(variable, 1.0), (above, -1.0), (below, 1.0)],
                ComparisonOp::Eq,
                wanted,
            );
        }
        let mut rows: [Vec<(Variable, f64)>; 4] = [
            vec![(share, -self.direction[0] / self.size[0])],
            vec![(share, -self.direction[1] / self.size[1])],
            vec![(yaw, -1.0)],
            vec![(thrust, -1.0)],
        ];
        for points in &self.sets {
            let mut ones = Vec::with_capacity(points.len());
            for point in points {
                let weight = problem.add_var(0.0, (0.0, f64::INFINITY));
                ones.push((weight, 1.0));
                for ((row, entry), size) in rows.iter_mut().zip(point).zip(self.size) {
                    let entry = entry / size;
                    if entry.abs() > ROUNDING {
                        row.push((weight, entry));
                    }
                }
            }
            problem.add_constraint(ones, ComparisonOp::Eq, 1.0);
        }
        let mut let_go = Vec::new();
        for (mut row, served) in rows.into_iter().zip(self.served) {
            if served {
                if elastic {
                    for sign in [1.0, -1.0] {
                        let part = problem.add_var(-PRICE, (0.0, f64::INFINITY));
                        row.push((part, sign));
                        let_go.push(part);
                    }
                }
                problem.add_constraint(row, ComparisonOp::Eq, 0.0);
            }
        }
        let solution = match problem.solve() {
            Ok(SolveOutcome::Solution(solution)) => solution,
            Ok(SolveOutcome::Interrupted(_)) => return Err(Error::InternalError("interrupted".to_owned())),
            Err(Error::Infeasible) => return Ok(None),
            Err(error) => return Err(error),
        };
        if let_go.into_iter().any(|part| solution[part] > LET_GO) {
            return Ok(None);
        }
        Ok(Some(Point {
            share: solution[share],
            yaw: yaw_size * solution[yaw],
            thrust: thrust_size * solution[thrust],
            score: solution.objective(),
        }))
    }
}
