//! An independent oracle of desaturation: the same lexicographic problem as linear programs in f64.
//!
//! Efforts of unit i are a convex combination of points of the border of its attainable set, so the programs
//! range over the convex hull: what they attain is at least what is physically attainable.

use microlp::{ComparisonOp, OptimizationDirection, Problem, SolveOutcome, Variable};
use mixer_compiler::Compiled;
use mixer_compiler::model::PairMap;
use mixer_rt::Airmode;

/// Border points per edge of the throttle box.
const SAMPLES: usize = 12;

/// What a request is worth: the optimum of each step of DESIGN section 7.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Optimum {
    /// Share of roll and pitch.
    pub share: f64,
    /// Yaw, N m.
    pub yaw_nm: f64,
    /// Thrust, N.
    pub thrust_n: f64,
}

/// The lexicographic programs of one frame at one voltage.
pub struct Oracle {
    /// Per unit: contributions `[roll, pitch, yaw, thrust]` of the border points.
    corners: Vec<Vec<[f64; 4]>>,
    served: [bool; 4],
    airmode: Airmode,
    reserve: f64,
}

struct Program {
    problem: Problem,
    share: Variable,
    yaw: Variable,
    thrust: Variable,
}

impl Oracle {
    /// The programs of a compiled frame with correction `[k_f, k_Q]`.
    pub fn new(compiled: &Compiled, factors: [f64; 2]) -> Self {
        let airframe = &compiled.airframe;
        let pair = PairMap::new(&airframe.pair, &airframe.throttle);
        let border: Vec<[f64; 2]> = pair.border(SAMPLES).iter().map(|&t| pair.efforts(t)).collect();
        Self::over(compiled, factors, &border)
    }

    /// The programs over the mixer's own polygon: what it is to attain exactly.
    pub fn of_polygon(compiled: &Compiled, factors: [f64; 2]) -> Self {
        let corners = compiled.tables.attainable.corners();
        let border: Vec<[f64; 2]> = corners.iter().map(|corner| corner.map(f64::from)).collect();
        Self::over(compiled, factors, &border)
    }

    fn over(compiled: &Compiled, factors: [f64; 2], border: &[[f64; 2]]) -> Self {
        let airframe = &compiled.airframe;
        let n = airframe.units.len();
        let matrix = &compiled.effectiveness.matrix;
        let corners = (0..n)
            .map(|i| {
                border
                    .iter()
                    .map(|[f, q]| {
                        std::array::from_fn(|axis| {
                            matrix[(axis, i)] * factors[0] * f + matrix[(axis, n + i)] * factors[1] * q
                        })
                    })
                    .collect()
            })
            .collect();
        let served = std::array::from_fn(|axis| airframe.allocation.axes.iter().any(|a| *a as usize == axis));
        Oracle {
            corners,
            served,
            airmode: airframe.allocation.airmode,
            reserve: airframe.allocation.yaw_reserve_nm,
        }
    }

    fn program(&self, objective: [f64; 3], direction: [f64; 2], ranges: [(f64, f64); 3]) -> Program {
        let mut problem = Problem::new(OptimizationDirection::Maximize);
        let share = problem.add_var(objective[0], ranges[0]);
        let yaw = problem.add_var(objective[1], ranges[1]);
        let thrust = problem.add_var(objective[2], ranges[2]);
        let mut rows: [Vec<(Variable, f64)>; 4] = [
            vec![(share, -direction[0])],
            vec![(share, -direction[1])],
            vec![(yaw, -1.0)],
            vec![(thrust, -1.0)],
        ];
        for corners in &self.corners {
            let weights: Vec<Variable> = corners
                .iter()
                .map(|_| problem.add_var(0.0, (0.0, f64::INFINITY)))
                .collect();
            for (weight, corner) in weights.iter().zip(corners) {
                for (row, entry) in rows.iter_mut().zip(corner) {
                    row.push((*weight, *entry));
                }
            }
            let ones: Vec<(Variable, f64)> = weights.iter().map(|&w| (w, 1.0)).collect();
            problem.add_constraint(ones, ComparisonOp::Eq, 1.0);
        }
        for (row, served) in rows.into_iter().zip(self.served) {
            if served {
                problem.add_constraint(row, ComparisonOp::Eq, 0.0);
            }
        }
        Program {
            problem,
            share,
            yaw,
            thrust,
        }
    }

    /// The variables `[share, yaw, thrust]` at the maximum of `objective`, `None` where nothing is feasible.
    fn solve(&self, objective: [f64; 3], direction: [f64; 2], ranges: [(f64, f64); 3]) -> Option<[f64; 3]> {
        let Program {
            problem,
            share,
            yaw,
            thrust,
        } = self.program(objective, direction, ranges);
        let SolveOutcome::Solution(solution) = problem.solve().ok()? else {
            return None;
        };
        Some([solution[share], solution[yaw], solution[thrust]])
    }

    /// True where the wrench `[roll, pitch, yaw, thrust]` is attainable.
    pub fn attains(&self, [roll, pitch, yaw, thrust]: [f64; 4]) -> bool {
        self.solve(
            [0.0; 3],
            [roll, pitch],
            [(1.0, 1.0), (yaw, yaw), (thrust, thrust)],
        )
        .is_some()
    }

    /// The optimum of a request; `None` where not even roll = pitch = 0 is attainable with the yaw reserve.
    pub fn optimum(&self, [roll, pitch, yaw, thrust]: [f64; 4]) -> Option<Optimum> {
        const FREE: (f64, f64) = (-1e4, 1e4);
        // Room for the solver's own tolerance between one program and the next.
        const SLACK: f64 = 1e-7;
        let reserved = yaw.clamp(-self.reserve, self.reserve);
        let mut yaws = (yaw.min(reserved), yaw.max(reserved));
        let direction = [roll, pitch];
        let mut thrusts = FREE;
        if self.airmode == Airmode::Disabled {
            let [_, _, floor] = self.solve([0.0, 0.0, -1.0], direction, [(0.0, 0.0), yaws, FREE])?;
            thrusts.1 = thrust.max(floor + SLACK);
        }
        let mut shares = (0.0, 1.0);
        if direction != [0.0; 2] {
            let [share, ..] = self.solve([1.0, 0.0, 0.0], direction, [shares, yaws, thrusts])?;
            shares = ((share - SLACK).max(0.0), share);
        }
        // The nearest value of a variable: its range, clamped to.
        let nearest = |variable: usize, wanted: f64, ranges: [(f64, f64); 3]| -> Option<(f64, f64)> {
            let mut objective = [0.0; 3];
            objective[variable] = 1.0;
            let high = self.solve(objective, direction, ranges)?[variable];
            objective[variable] = -1.0;
            let low = self.solve(objective, direction, ranges)?[variable];
            let value = wanted.clamp(low.min(high), high.max(low));
            let (low, high) = ranges[variable];
            Some(((value - SLACK).max(low), (value + SLACK).min(high)))
        };
        if self.airmode == Airmode::RollPitchYaw {
            yaws = nearest(1, yaw, [shares, yaws, thrusts])?;
            thrusts = nearest(2, thrust, [shares, yaws, thrusts])?;
        } else {
            thrusts = nearest(2, thrust, [shares, yaws, thrusts])?;
            yaws = nearest(1, yaw, [shares, yaws, thrusts])?;
        }
        let middle = |(low, high): (f64, f64)| 0.5 * (low + high);
        Some(Optimum {
            share: shares.1,
            yaw_nm: middle(yaws),
            thrust_n: middle(thrusts),
        })
    }
}
