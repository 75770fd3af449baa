//! The attainable torques of a unit at each thrust, as `mixer-rt`'s closed form reads them: see
//! `mixer_rt::tables::Border`.
//!
//! With each thrust f a unit has the torques between the nearest points of the border above and
//! below the image of the throttle box's diagonal u = l, which runs through the set from the idle
//! corner to the full one. (Beside a corner where f falls along an edge of the throttle box the set
//! reaches further, behind a gap: that is given up.) Both sides are drawn by chords in equal cells
//! of thrust, lowered where a side bends inwards by what its chords would be outside.

use mixer_rt::tables::{Border, Cell, Grid};

use super::outline::outline;
use crate::model::PairMap;

/// Border points per edge of the throttle box.
const SAMPLES: usize = 1024;

/// Points of thrust per grid at which the sides are taken.
const POINTS: usize = 96;

/// Most cells of a grid; a divisor of [`POINTS`].
const MOST_CELLS: usize = 32;

/// What the cells may lose at any thrust, as a share of the largest torque: a grid has the fewest
/// cells for that, or the most there may be.
const LOSS: f64 = 2e-3;

/// What chords keep from the border for rounding, as a share of the largest torque.
const MARGIN: f64 = 1e-5;

/// Largest slope of a side, in its largest torque per largest thrust. Steeper ones make jumps of
/// the torque.
const STEEPEST: f64 = 16.0;

/// Largest loss of the cells, as a share of the largest torque. Beyond it the interior point method serves
/// the airframe better.
const MOST_LOST: f64 = 0.05;

/// Both sides, Q_max(f) and -Q_min(f), at thrusts between the corners, as shares of the largest
/// thrust and torque.
struct Sides {
    /// Where the grids begin and the last one ends.
    corners: [f64; 4],
    /// Thrusts, [`POINTS`] steps per grid.
    thrusts: Vec<f64>,
    torques: [Vec<f64>; 2],
}

/// A thrust, Q_max and -Q_min there.
type Section = [f64; 3];

/// The border without its cells, these, and the share of the attainable set's area that is outside
/// them; `None` where
/// thrust does not grow along the diagonal, or the cells lose much.
pub(super) fn border(pair: &PairMap) -> Option<(Border<'static>, Vec<Cell>, f64)> {
    let scale = pair.scale();
    let sides = Sides::new(pair)?;
    let mut sections: Vec<Section> = Vec::new();
    let mut starts = [0; 4];
    for grid in 0..3 {
        let first = grid * POINTS;
        let cells = if sides.corners[grid + 1] > sides.corners[grid] {
            let mut counts = (1..MOST_CELLS).filter(|cells| POINTS.is_multiple_of(*cells));
            counts
                .find(|&cells| sides.lost(first, cells) <= LOSS)
                .unwrap_or(MOST_CELLS)
        } else {
            0
        };
        let step = POINTS / cells.max(1);
        sections.extend((0..cells).map(|cell| sides.section(first + cell * step)));
        starts[grid + 1] = sections.len();
    }
    sections.push(sides.section(3 * POINTS));
    sides.lower(&mut sections);
    let lost = sides.largest_gap(&sections) + MARGIN;
    let is_empty = |[_, largest, least]: &Section| largest + least < -MARGIN;
    if lost > MOST_LOST || sections.iter().any(is_empty) {
        return None;
    }
    let grids = std::array::from_fn(|grid| {
        let cells = (starts[grid + 1] - starts[grid]) as f64;
        let [from, to] = [0, 1].map(|end| scale[0] * sides.corners[grid + end]);
        let per_n = if cells > 0.0 { cells / (to - from) } else { 0.0 };
        Grid {
            offset: (starts[grid] as f64 - from * per_n) as f32,
            per_n: per_n as f32,
        }
    });
    let area: f64 = sections
        .windows(2)
        .map(|ends| 0.5 * (ends[1][0] - ends[0][0]) * (ends[0][1] + ends[0][2] + ends[1][1] + ends[1][2]))
        .sum();
    let border = Border {
        corners_n: [1, 2].map(|k| (scale[0] * sides.corners[k]) as f32),
        grids,
        cells: &[],
        outlines: [0, 1].map(|k| outline(&sides.thrusts, &sides.torques[k], scale)),
        lost_nm: (lost * scale[1]) as f32,
    };
    let cells = cells(&sections, scale[1]);
    Some((border, cells, 1.0 - area / whole_area(pair)))
}

/// The sections as `mixer-rt` reads them. The last cell goes on as the one before it, so that half
/// the width is negative beyond the largest thrust, as it is before the first cell.
fn cells(sections: &[Section], torque: f64) -> Vec<Cell> {
    let rounded: Vec<[f32; 2]> = sections
        .iter()
        .map(|[_, largest, least]| {
            let half = (0.5 * (largest + least)).max(0.0);
            [0.5 * (largest - least), half].map(|x| (torque * x) as f32)
        })
        .collect();
    let cell = |start: [f32; 2], [from, to]: [[f32; 2]; 2]| Cell {
        middle: [start[0], to[0] - from[0]],
        half: [start[1], to[1] - from[1]],
    };
    let mut cells: Vec<Cell> = rounded
        .windows(2)
        .map(|ends| cell(ends[0], [ends[0], ends[1]]))
        .collect();
    let last = rounded.len() - 1;
    cells.push(cell(rounded[last], [rounded[last - 1], rounded[last]]));
    cells
}

impl Sides {
    fn new(pair: &PairMap) -> Option<Sides> {
        let scale = pair.scale();
        let border = pair.scaled_border(SAMPLES);
        let diagonal: Vec<[f64; 2]> = pair
            .diagonal(SAMPLES)
            .map(|[f, q]| [f / scale[0], q / scale[1]])
            .collect();
        if diagonal.windows(2).any(|ends| ends[1][0] <= ends[0][0]) {
            return None;
        }
        let [low, high] = [border[0], border[2 * SAMPLES]];
        let corner = |k: usize| border[k][0].clamp(low[0], high[0]);
        let (a, b) = (corner(SAMPLES), corner(3 * SAMPLES));
        let corners = [low[0], a.min(b), a.max(b), high[0]];
        let mut thrusts: Vec<f64> = (0..3)
            .flat_map(|grid| {
                let [from, to] = [corners[grid], corners[grid + 1]];
                (0..POINTS).map(move |k| from + (to - from) * k as f64 / POINTS as f64)
            })
            .collect();
        thrusts.push(high[0]);
        let torques = [1.0, -1.0].map(|sign| side(&border, &diagonal, &thrusts, sign, [low[1], high[1]]));
        Some(Sides {
            corners,
            thrusts,
            torques,
        })
    }

    fn section(&self, point: usize) -> Section {
        [
            self.thrusts[point],
            self.torques[0][point],
            self.torques[1][point],
        ]
    }

    /// What chords in as many cells of the grid that starts at point `first` lose at most.
    fn lost(&self, first: usize, cells: usize) -> f64 {
        let step = POINTS / cells;
        let mut sections: Vec<Section> = (0..=cells)
            .map(|cell| self.section(first + cell * step))
            .collect();
        self.lower(&mut sections);
        self.largest_gap(&sections)
    }

    /// Lowers sections until their chords are inside. The border's first and last section, where
    /// both sides meet, stay.
    fn lower(&self, sections: &mut [Section]) {
        let ends = [self.thrusts[0], self.thrusts[3 * POINTS]];
        let is_end = |section: &Section| ends.contains(&section[0]);
        for side in 0..2 {
            let mut by = vec![0.0f64; sections.len()];
            for cell in 0..sections.len() - 1 {
                let [from, to] = [sections[cell], sections[cell + 1]];
                for (above, part) in self.above(from, to, side) {
                    // A chord with an end that stays turns about it.
                    let [start, end] = match (is_end(&from), is_end(&to)) {
                        (true, false) => [0.0, -above / part],
                        (false, true) => [-above / (1.0 - part), 0.0],
                        _ => [-above; 2],
                    };
                    by[cell] = by[cell].max(start);
                    by[cell + 1] = by[cell + 1].max(end);
                }
            }
            for (section, by) in sections.iter_mut().zip(by) {
                section[1 + side] -= by + if is_end(section) { 0.0 } else { MARGIN };
            }
        }
    }

    /// How far a side is above the chord between two sections at the points in their cell, and
    /// where in the cell these are.
    fn above(&self, from: Section, to: Section, side: usize) -> impl Iterator<Item = (f64, f64)> {
        let first = self.thrusts.partition_point(|&f| f <= from[0]);
        let end = self.thrusts.partition_point(|&f| f < to[0]);
        let [a, b] = [from[1 + side], to[1 + side]];
        (first..end).map(move |k| {
            let part = (self.thrusts[k] - from[0]) / (to[0] - from[0]);
            (self.torques[side][k] - (a + part * (b - a)), part)
        })
    }

    /// The most that a side is above its chords.
    fn largest_gap(&self, sections: &[Section]) -> f64 {
        let mut most = 0.0f64;
        for ends in sections.windows(2) {
            for side in 0..2 {
                let gaps = self.above(ends[0], ends[1], side).map(|(above, _)| above);
                most = gaps.fold(most, f64::max);
            }
        }
        most
    }
}

/// The nearest points of a closed `border` above the diagonal, `sign` Q, at the `thrusts`; at both
/// ends the torques `ends`.
fn side(border: &[[f64; 2]], diagonal: &[[f64; 2]], thrusts: &[f64], sign: f64, ends: [f64; 2]) -> Vec<f64> {
    let n = border.len();
    let middle: Vec<f64> = thrusts.iter().map(|&f| sign * linear(diagonal, f)).collect();
    let mut torques = vec![f64::INFINITY; thrusts.len()];
    for k in 0..n {
        let (mut a, mut b) = (border[k], border[(k + 1) % n]);
        if a[0] > b[0] {
            (a, b) = (b, a);
        }
        let from = thrusts.partition_point(|&f| f < a[0]);
        for j in from..thrusts.len() {
            if thrusts[j] > b[0] {
                break;
            }
            let q = sign * between(a, b, thrusts[j]);
            if q >= middle[j] {
                torques[j] = torques[j].min(q);
            }
        }
    }
    for (torque, middle) in torques.iter_mut().zip(&middle) {
        if torque.is_infinite() {
            *torque = *middle;
        }
    }
    let last = thrusts.len() - 1;
    (torques[0], torques[last]) = (sign * ends[0], sign * ends[1]);
    for k in 1..=last {
        torques[k] = torques[k].min(torques[k - 1] + STEEPEST * (thrusts[k] - thrusts[k - 1]));
    }
    for k in (1..=last).rev() {
        torques[k - 1] = torques[k - 1].min(torques[k] + STEEPEST * (thrusts[k] - thrusts[k - 1]));
    }
    torques
}

/// The line through `a` and `b` at `f`; `a` where they are at the same.
fn between(a: [f64; 2], b: [f64; 2], f: f64) -> f64 {
    let share = if b[0] > a[0] {
        (f - a[0]) / (b[0] - a[0])
    } else {
        0.0
    };
    a[1] + share * (b[1] - a[1])
}

/// The polyline through `points`, in the order of f, at `f`.
fn linear(points: &[[f64; 2]], f: f64) -> f64 {
    let next = points
        .partition_point(|point| point[0] < f)
        .clamp(1, points.len() - 1);
    between(points[next - 1], points[next], f)
}

/// The attainable set's area, as a share of the rectangle of the largest thrust and torque.
fn whole_area(pair: &PairMap) -> f64 {
    let border = pair.scaled_border(SAMPLES);
    let ends = border.iter().cycle().skip(1);
    let twice: f64 = border
        .iter()
        .zip(ends)
        .map(|(a, b)| a[0] * b[1] - a[1] * b[0])
        .sum();
    0.5 * twice
}
