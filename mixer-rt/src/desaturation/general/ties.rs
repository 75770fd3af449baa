//! The choice among optima that tie: the one nearest the efforts of least norm.
//!
//! On frames whose units are alike many efforts serve a wrench equally well, and the simplex method
//! ends at a corner of these. What ties is, for every unit, the face of its polygon on which its gain
//! is largest but for the bias. The optimum nearest the efforts t is
//!
//! ```text
//! y_i = the point of face i nearest t_i + B_i^T mu       with mu so that sum_i B_i y_i = w
//! ```
//!
//! which Newton's method finds in mu: units within their faces make up its matrix.

use core::hint::black_box;

use super::simplex::Simplex;
use super::variable::{Position, Variable, corner, dot2};
use crate::desaturation::attainable::{CORNERS, Corner};
use crate::{clamp, divisor, rolled, sqrt};

/// Gains that differ by less than this, per length of the way, tie: twice what biases differ by.
const TIED: f32 = 1e-2;

/// Multipliers of roll and pitch, together, up to which units can tie.
const MOST_TIED: f32 = 0.1;

/// Beside the square of a way: so that the way of a unit at its corner, which is zero, can be divided
/// by.
const LEAST_SQUARE: f32 = 1e-12;

/// Newton steps, and how many rows are missed at most where they have arrived.
const STEPS: usize = 3;
const ARRIVED: f32 = 2e-5;

/// The least pivot of the matrix that is not rounding, as a share of a unit's column.
const LEAST_PIVOT: f32 = 1e-4;

impl Variable {
    /// True where the gain along a way is what it is at its corner but for the bias.
    #[inline(always)]
    fn ties(&self, way: [f32; 2]) -> bool {
        let fall = dot2(way, self.gain);
        fall * fall <= TIED * TIED * dot2(way, way)
    }

    /// Turns its position into the face that ties; returns the face's dimensions less the slots that
    /// it has in the basis.
    #[inline(always)]
    fn face(&mut self, corners: &[Corner; CORNERS]) -> u8 {
        let [[e0, e1], back] = corner(corners, self.corner).ways;
        match self.position {
            Position::Free => 0,
            Position::Edge => {
                self.way = 0;
                if self.ties([-e1, e0]) {
                    self.position = Position::Free;
                }
                u8::from(self.position == Position::Free)
            }
            Position::Corner => {
                let (ahead, back) = (self.ties([e0, e1]), self.ties(back));
                self.way = u8::from(!ahead);
                self.position = match (ahead, back) {
                    (true, true) => Position::Free,
                    (false, false) => Position::Corner,
                    _ => Position::Edge,
                };
                u8::from(ahead) + u8::from(back)
            }
        }
    }
}

/// The edge that efforts are furthest beyond: its start and its way; `None` where they are inside.
#[inline(never)]
fn edge_before(corners: &[Corner], efforts: [f32; 2]) -> Option<([f32; 2], [f32; 2])> {
    let mut furthest = 0.0;
    let mut found = None;
    for corner in corners {
        rolled();
        let beyond = corner.beyond(efforts);
        let square = dot2(corner.ways[0], corner.ways[0]);
        if beyond > 0.0 && beyond * beyond > furthest * square {
            furthest = beyond * beyond / divisor(square);
            found = Some((corner.at, corner.ways[0]));
        }
    }
    found
}

impl Simplex<'_> {
    /// Finds the units' faces; true where more than one optimum is on them. That is so only where
    /// roll and pitch are not short: their multipliers tell units apart.
    #[inline(never)]
    pub(super) fn is_tied(&mut self) -> bool {
        let [roll, pitch, ..] = self.multipliers;
        if roll.abs() + pitch.abs() > MOST_TIED {
            return false;
        }
        let mut more = 0;
        for variable in self.variables.iter_mut() {
            rolled();
            if variable.position != Position::Free {
                variable.gain = [0, 1].map(|k| variable.gain[k] + self.step * variable.rate[k]);
            }
            more += variable.face(self.problem.set.corners);
        }
        more > 0
    }

    /// Moves the units to the optimum nearest the efforts that are in their rates, or leaves them
    /// where Newton's method does not arrive.
    #[inline(never)]
    pub(super) fn move_to_nearest(&mut self) {
        let problem = self.problem;
        let mut given = [0.0; 4];
        for (variable, unit) in self.variables.iter().zip(problem.units) {
            rolled();
            problem.subtract(unit, variable.at.map(|part| -part), &mut given);
        }
        let mut multipliers = [0.0; 4];
        for _ in 0..STEPS {
            rolled();
            let mut missed = given;
            let mut matrix = [[0.0; 4]; 4];
            for (variable, unit) in self.variables.iter_mut().zip(problem.units) {
                rolled();
                let pull = problem.gains(unit, &multipliers);
                let wanted = [0, 1].map(|k| variable.rate[k] + pull[k]);
                let edge = match variable.position {
                    Position::Corner => Some((variable.at, [0.0; 2])),
                    Position::Edge => {
                        let from = corner(problem.set.corners, variable.corner).at;
                        Some((from, variable.way(problem.set.corners).0))
                    }
                    Position::Free => edge_before(problem.set.polygon(), wanted),
                };
                // Where the unit is free to move: nowhere, along a way, or anywhere.
                let mut free = [[1.0, 0.0], [0.0, 1.0]];
                variable.gain = wanted;
                if let Some((from, way)) = edge {
                    let per_square = 1.0 / (dot2(way, way) + LEAST_SQUARE);
                    let along = dot2([0, 1].map(|k| wanted[k] - from[k]), way) * per_square;
                    let share = clamp(along, 0.0, 1.0);
                    variable.gain = [0, 1].map(|k| from[k] + share * way[k]);
                    let part = if share == along { sqrt(per_square) } else { 0.0 };
                    free = [way.map(|way| part * way), [0.0; 2]];
                }
                problem.subtract(unit, variable.gain, &mut missed);
                for way in free {
                    rolled();
                    let mut column = [0.0; 4];
                    problem.subtract(unit, way, &mut column);
                    for (row, part) in black_box(matrix.as_mut_slice()).iter_mut().zip(column) {
                        rolled();
                        for (entry, other) in row.iter_mut().zip(column) {
                            *entry += part * other;
                        }
                    }
                }
            }
            if missed.iter().all(|row| row.abs() <= ARRIVED) {
                for variable in self.variables.iter_mut() {
                    rolled();
                    variable.at = variable.gain;
                }
                return;
            }
            let step = solve(matrix, missed);
            for (multiplier, part) in multipliers.iter_mut().zip(step) {
                *multiplier += part;
            }
        }
    }
}

/// Gauss's elimination of a symmetric matrix that is not negative; zero where it is singular.
#[inline(never)]
fn solve(mut matrix: [[f32; 4]; 4], mut rows: [f32; 4]) -> [f32; 4] {
    for k in black_box(0)..4 {
        rolled();
        let pivot_row = matrix[k & 3];
        let pivot = pivot_row[k & 3];
        let per_pivot = if pivot > LEAST_PIVOT {
            1.0 / divisor(pivot)
        } else {
            0.0
        };
        let pivot_row = pivot_row.map(|entry| entry * per_pivot);
        let share = rows[k & 3] * per_pivot;
        for i in 0..4 {
            rolled();
            let part = matrix[i & 3][k & 3];
            rows[i & 3] -= part * share;
            for (entry, other) in matrix[i & 3].iter_mut().zip(pivot_row) {
                *entry -= part * other;
            }
        }
        (matrix[k & 3], rows[k & 3]) = (pivot_row, share);
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::super::variable::dot;
    use super::*;

    #[test]
    fn a_matrix_of_full_rank_is_solved() {
        let matrix = [
            [4.0, 1.0, 0.5, 0.0],
            [1.0, 3.0, 0.0, 0.25],
            [0.5, 0.0, 2.0, 0.5],
            [0.0, 0.25, 0.5, 1.0],
        ];
        let x = [1.0, -2.0, 0.5, 3.0];
        let rows = matrix.map(|row| dot(&row, &x));
        let solved = solve(matrix, rows);
        assert!(
            solved.iter().zip(x).all(|(a, b)| (a - b).abs() < 1e-5),
            "{solved:?}"
        );
    }

    #[test]
    fn a_singular_matrix_leaves_what_it_cannot_tell_apart_at_zero() {
        let column = [1.0, 0.0, 2.0, 0.0];
        let matrix = [0, 1, 2, 3].map(|row| column.map(|part| part * column[row]));
        let solved = solve(matrix, column.map(|part| 3.0 * part));
        let given = matrix.map(|row| dot(&row, &solved));
        assert!(
            given.iter().zip(column).all(|(a, b)| (a - 3.0 * b).abs() < 1e-5),
            "{solved:?}"
        );
    }
}
