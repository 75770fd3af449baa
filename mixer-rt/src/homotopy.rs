//! The least-norm attainable efforts of a wrench, followed along a path of wrenches.
//!
//! With y_i the efforts of unit i, c_i its reference efforts and A its attainable set, a convex polygon, the
//! problem at wrench w is
//!
//! ```text
//! least  sum |y_i - c_i|^2 / 2   with   sum B_i y_i = w,   y_i in A
//! ```
//!
//! Its Lagrangian splits by unit: with multipliers lambda in R^4 the efforts are the projections
//! `y_i = P_A(p_i)`, `p_i = c_i + B_i^T lambda`, and lambda solves `sum B_i P_A(c_i + B_i^T lambda) = w`. A
//! projection onto a polygon is piecewise affine ([`crate::attainable`]), so along a straight path w(t) lambda(t)
//! is piecewise affine too. Within a piece, with P_i the projection's derivative,
//!
//! ```text
//! J lambda' = w' - sum B_i P_i c_i',    J = sum B_i P_i B_i^T
//! ```
//!
//! and a piece ends where some p_i changes its face. Where J is singular and the right-hand side outside its
//! range, the wrench can go no further with these faces: lambda then moves along a null vector v of J with
//! v w' > 0, which changes no effort, until a face changes. If none ever does, v is the normal of a plane that
//! touches the attainable wrenches at w and parts them from the rest of the path: w is the exact end of what is
//! attainable on it.
//!
//! A row of the wrench may be slack: anywhere between two bounds, which may move. Its multiplier is zero between
//! the bounds, >= 0 at the lower and <= 0 at the upper one (the conditions of Karush, Kuhn and Tucker).
//!
//! Efforts are scaled by the set's `scale` and rows to unit length, so all numbers are of order one.

use crate::attainable::Face;
use crate::linear::{Solution, solve};
use crate::{AttainableSet, Edge, Pair, Quantity, Tables, ThrottleRange, Unit, sqrt};

/// Pieces of a path per unit before the mixer stops where it is (sound, but then perhaps not optimal): about
/// three times the largest number that random and adversarial requests on random frames have needed.
const PIECES_PER_UNIT: u32 = 24;
/// The same for a frame as a whole.
const PIECES: u32 = 32;

/// Rounding errors of J. With smallest pivot d they leave a share of NOISE / d of the multipliers' velocity wrong,
/// along a vector that efforts follow by sqrt(d): velocities below NOISE / sqrt(d) of it are rounding errors.
const NOISE: f32 = 3e-7;

/// Ways shorter than this, in scaled wrenches, are rounding errors.
const STANDING: f32 = 1e-6;

/// A unit that turns back to the face it came from after a smaller share of a piece has turned at once.
const TURNING: f32 = 1e-6;

/// Turns after which the unit's reference is moved.
const TURNS: u32 = 3;

/// Change of the scaled wrench that settling may bring.
const SETTLED: f32 = 5e-5;

/// What a unit keeps while the efforts are being found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Scratch {
    /// `[f, Q]` at the reference voltage, N and N m.
    pub(crate) efforts: [f32; 2],
    /// Which of its rotors work.
    pub(crate) rotors: Rotors,
    /// c_i, scaled.
    reference: [f32; 2],
    /// How far c_i is to move, scaled.
    pair: [f32; 2],
    face: Face,
}

/// Which rotors of a unit work.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Rotors {
    #[default]
    Both,
    Upper,
    Lower,
    None,
}

/// What is left of a unit's attainable set when a rotor is lost: the curve of the other one, with the lost one's
/// throttle at zero. Its chord stands for it.
#[derive(Clone, Copy, Debug)]
struct Chord {
    edge: [Edge; 1],
    centre: [f32; 2],
}

impl Chord {
    /// The chord from `low` to `high`, both `[f, Q]`.
    fn new(low: [f32; 2], high: [f32; 2], scale: [f32; 2]) -> Self {
        let start = [low[0] / scale[0], low[1] / scale[1]];
        let vector = [high[0] / scale[0] - start[0], high[1] / scale[1] - start[1]];
        let length = sqrt(vector[0] * vector[0] + vector[1] * vector[1]);
        Chord {
            edge: [Edge {
                start,
                along: vector.map(|part| part / length),
                length,
            }],
            centre: [start[0] + 0.5 * vector[0], start[1] + 0.5 * vector[1]],
        }
    }
}

/// The attainable sets of units with both rotors, the upper one alone and the lower one alone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sets<'a> {
    both: AttainableSet<'a>,
    upper: Chord,
    lower: Chord,
}

impl<'a> Sets<'a> {
    pub(crate) fn new<P: Quantity>(
        both: AttainableSet<'a>,
        pair: &Pair<P>,
        &ThrottleRange { min, max }: &ThrottleRange,
    ) -> Self {
        let chord = |low, high| Chord::new(pair.efforts(low), pair.efforts(high), both.scale);
        Sets {
            both,
            upper: chord([min, 0.0], [max, 0.0]),
            lower: chord([0.0, min], [0.0, max]),
        }
    }

    /// The set of a unit; `None` where neither rotor works.
    #[inline]
    fn of(&self, rotors: Rotors) -> Option<AttainableSet<'_>> {
        let chord = |chord: &'_ Chord| AttainableSet {
            scale: self.both.scale,
            centre: chord.centre,
            edges: &[],
        };
        match rotors {
            Rotors::Both => Some(self.both),
            Rotors::Upper => Some(AttainableSet {
                edges: &self.upper.edge,
                ..chord(&self.upper)
            }),
            Rotors::Lower => Some(AttainableSet {
                edges: &self.lower.edge,
                ..chord(&self.lower)
            }),
            Rotors::None => None,
        }
    }
}

/// Where a row of the wrench is allowed to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) low: f32,
    pub(crate) high: f32,
}

impl Bounds {
    /// Exactly `value`.
    pub(crate) const fn at(value: f32) -> Self {
        Bounds {
            low: value,
            high: value,
        }
    }

    /// These bounds, made wide enough for `value`.
    pub(crate) fn including(self, value: f32) -> Self {
        Bounds {
            low: if value < self.low { value } else { self.low },
            high: if value > self.high { value } else { self.high },
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RowState {
    /// Wherever the efforts put it; no multiplier.
    Between,
    /// At the lower bound, multiplier >= 0.
    AtLow,
    /// At the upper bound, multiplier <= 0.
    AtHigh,
    /// Moved by the path.
    Held,
}

/// One row of the wrench, scaled.
#[derive(Clone, Copy, Debug)]
struct Row {
    state: RowState,
    value: f32,
    bounds: Bounds,
    multiplier: f32,
}

/// The efforts of all units on their way along a path of wrenches.
pub(crate) struct Homotopy<'h> {
    units: &'h [Unit],
    scratch: &'h mut [Scratch],
    sets: &'h Sets<'h>,
    /// `[k_f, k_Q]`.
    factors: [f32; 2],
    /// Per row of the wrench: the factor that gives B its unit length; 0 for an axis that is not allocated.
    row_scale: [f32; 4],
    rows: [Row; 4],
    pieces_left: u32,
    /// The unit that changed its face last, the face it left, and how often it has turned back at once.
    last: (usize, Face),
    turns: u32,
}

/// What ends a piece.
enum Event {
    /// The path's end.
    Arrival,
    Face(usize, Face),
    Row(usize, RowState),
}

impl<'h> Homotopy<'h> {
    /// Starts with every unit at the centre of its set, where all multipliers are zero; roll and pitch held, yaw
    /// and thrust slack without bounds.
    pub(crate) fn from_centres<P, I, S>(
        tables: &'h Tables<'_, P, I, S>,
        sets: &'h Sets<'h>,
        factors: [f32; 2],
        scratch: &'h mut [Scratch],
    ) -> Self {
        let row = |state| Row {
            state,
            value: 0.0,
            bounds: Bounds::at(0.0),
            multiplier: 0.0,
        };
        let mut homotopy = Homotopy {
            units: tables.units,
            scratch,
            sets,
            factors,
            row_scale: [1.0; 4],
            rows: [
                RowState::Held,
                RowState::Held,
                RowState::Between,
                RowState::Between,
            ]
            .map(row),
            pieces_left: PIECES,
            last: (usize::MAX, Face::Interior),
            turns: 0,
        };
        homotopy.start();
        homotopy
    }

    fn start(&mut self) {
        let (mut squares, mut allocated, mut wrench) = ([0.0; 4], [false; 4], [0.0; 4]);
        for (unit, scratch) in self.units.iter().zip(self.scratch.iter_mut()) {
            self.pieces_left = self.pieces_left.saturating_add(PIECES_PER_UNIT);
            let Some(set) = self.sets.of(scratch.rotors) else {
                continue;
            };
            scratch.reference = set.centre;
            scratch.face = set.central_face();
            let columns = columns(unit, &set, self.factors, &[1.0; 4]);
            for (column, centre) in columns.iter().zip(set.centre) {
                for ((square, wrench), entry) in squares.iter_mut().zip(&mut wrench).zip(column) {
                    *square += entry * entry;
                    *wrench += entry * centre;
                }
            }
            for row in unit.allocation {
                for (allocated, entry) in allocated.iter_mut().zip(row) {
                    *allocated |= entry != 0.0;
                }
            }
        }
        for (scale, (square, allocated)) in self.row_scale.iter_mut().zip(squares.into_iter().zip(allocated))
        {
            *scale = if allocated && square > 0.0 {
                1.0 / sqrt(square)
            } else {
                0.0
            };
        }
        for ((row, wrench), scale) in self.rows.iter_mut().zip(wrench).zip(self.row_scale) {
            row.value = scale * wrench;
            row.bounds = Bounds::at(row.value);
        }
    }

    /// The present wrench `[roll, pitch, yaw, thrust]`, N m and N.
    pub(crate) fn wrench(&self) -> [f32; 4] {
        let mut wrench = self.rows.map(|row| row.value);
        for (wrench, scale) in wrench.iter_mut().zip(self.row_scale) {
            *wrench = if scale > 0.0 { *wrench / scale } else { 0.0 };
        }
        wrench
    }

    /// Sets the bounds of slack rows, which must contain the present wrench; held rows stay.
    pub(crate) fn bound(&mut self, bounds: [Bounds; 4]) {
        for ((row, bounds), scale) in self.rows.iter_mut().zip(bounds).zip(self.row_scale) {
            if row.state != RowState::Held {
                row.bounds = scaled(bounds, scale).including(row.value);
            }
        }
    }

    /// The present bounds of yaw and thrust, N m and N.
    pub(crate) fn slack_bounds(&self) -> [Bounds; 2] {
        let [.., yaw, thrust] = self.rows;
        let [.., yaw_scale, thrust_scale] = self.row_scale;
        [(yaw, yaw_scale), (thrust, thrust_scale)].map(|(row, scale)| {
            let per_scale = if scale > 0.0 { 1.0 / scale } else { 0.0 };
            scaled(row.bounds, per_scale)
        })
    }

    /// Holds `axis` (index in the wrench) where it is, to be moved by the next path.
    pub(crate) fn hold(&mut self, axis: usize) {
        if let Some(row) = self.rows.get_mut(axis) {
            row.state = RowState::Held;
            row.bounds = Bounds::at(row.value);
        }
    }

    /// Moves held rows and the bounds of slack rows straight towards `target`, as far as attainable; returns the
    /// share of the way that was made.
    pub(crate) fn follow(&mut self, target: [Bounds; 4]) -> f32 {
        self.advance(target, false)
    }

    /// Moves the reference from the centres to the least-norm efforts of the present wrench: where those are
    /// attainable they are the result. Kept only if rounding errors let the wrench stay as it is.
    pub(crate) fn settle(&mut self) {
        let before = self.actual();
        self.move_reference();
        let after = self.actual();
        let stays = before
            .iter()
            .zip(after)
            .all(|(before, after)| (before - after).abs() < SETTLED);
        if stays {
            self.write_efforts();
        }
    }

    fn move_reference(&mut self) {
        let wrench = self.wrench();
        for (unit, scratch) in self.units.iter().zip(self.scratch.iter_mut()) {
            if let Some(set) = self.sets.of(scratch.rotors) {
                let mut efforts = unit.efforts(&wrench);
                for ((effort, factor), scale) in efforts.iter_mut().zip(self.factors).zip(set.scale) {
                    *effort /= factor * scale;
                }
                scratch.pair = [
                    efforts[0] - scratch.reference[0],
                    efforts[1] - scratch.reference[1],
                ];
            }
        }
        let target = self.rows.map(|row| row.bounds);
        let mut here = target;
        for (bounds, scale) in here.iter_mut().zip(self.row_scale) {
            let per_scale = if scale > 0.0 { 1.0 / scale } else { 0.0 };
            *bounds = scaled(*bounds, per_scale);
        }
        self.advance(here, true);
    }

    /// Writes the efforts, N and N m at the reference voltage, into the scratch.
    pub(crate) fn write_efforts(&mut self) {
        let multipliers = self.rows.map(|row| row.multiplier);
        for (unit, scratch) in self.units.iter().zip(self.scratch.iter_mut()) {
            let Some(set) = self.sets.of(scratch.rotors) else {
                scratch.efforts = [0.0; 2];
                continue;
            };
            let columns = columns(unit, &set, self.factors, &self.row_scale);
            let [f, q] = set.project(scratch.face, pulled(scratch.reference, &columns, &multipliers));
            scratch.efforts = [f * set.scale[0], q * set.scale[1]];
        }
    }

    fn advance(&mut self, target: [Bounds; 4], with_reference: bool) -> f32 {
        let mut share = 0.0;
        self.turns = 0;
        loop {
            let left = 1.0 - share;
            if left <= 0.0 {
                return 1.0;
            }
            let Some(pieces_left) = self.pieces_left.checked_sub(1) else {
                return share;
            };
            self.pieces_left = pieces_left;
            // Velocities per remaining way: the bounds reach the target when `made` = 1.
            let mut drift = target;
            for ((drift, row), scale) in drift.iter_mut().zip(&self.rows).zip(self.row_scale) {
                let target = scaled(*drift, scale);
                *drift = Bounds {
                    low: significant(target.low - row.bounds.low),
                    high: significant(target.high - row.bounds.high),
                };
            }
            let standing = drift.iter().all(|drift| *drift == Bounds::at(0.0));
            if standing && !with_reference {
                return 1.0;
            }
            let reference_share = if with_reference { left } else { 0.0 };
            let Some(made) = self.piece(&drift, reference_share) else {
                self.stay();
                return share;
            };
            share += made * left;
        }
    }

    /// Moves the reference of a unit whose point is on the border between two faces, where rounding errors find
    /// either wrong, so that the point comes to lie in the midst of its present face. This changes the norm that
    /// is least by a little, but no effort.
    fn decide(&mut self, index: usize) {
        let multipliers = self.rows.map(|row| row.multiplier);
        let (Some(unit), Some(scratch)) = (self.units.get(index), self.scratch.get_mut(index)) else {
            return;
        };
        if let Some(set) = self.sets.of(scratch.rotors) {
            let columns = columns(unit, &set, self.factors, &self.row_scale);
            let point = pulled(scratch.reference, &columns, &multipliers);
            let within = set.amid(scratch.face, point);
            for ((reference, within), point) in scratch.reference.iter_mut().zip(within).zip(point) {
                *reference += within - point;
            }
        }
    }

    /// Takes the wrench of the present efforts for that of the held rows: at the end of what is attainable
    /// rounding errors cannot be made up for.
    fn stay(&mut self) {
        let wrench = self.actual();
        for (row, wrench) in self.rows.iter_mut().zip(wrench) {
            if row.state == RowState::Held {
                row.value = wrench;
                row.bounds = Bounds::at(wrench);
            }
        }
    }

    /// The wrench of the present efforts, scaled.
    fn actual(&self) -> [f32; 4] {
        let multipliers = self.rows.map(|row| row.multiplier);
        let mut wrench = [0.0; 4];
        for (unit, scratch) in self.units.iter().zip(self.scratch.iter()) {
            let Some(set) = self.sets.of(scratch.rotors) else {
                continue;
            };
            let columns = columns(unit, &set, self.factors, &self.row_scale);
            let point = set.project(scratch.face, pulled(scratch.reference, &columns, &multipliers));
            for ((wrench, by_f), by_q) in wrench.iter_mut().zip(columns[0]).zip(columns[1]) {
                *wrench += by_f * point[0] + by_q * point[1];
            }
        }
        wrench
    }

    /// One piece of the path towards `drift` from the present bounds, with the reference moving by
    /// `reference_share` of the step in the scratch. Returns the share made, `None` where there is no way on.
    fn piece(&mut self, drift: &[Bounds; 4], reference_share: f32) -> Option<f32> {
        let multipliers = self.rows.map(|row| row.multiplier);
        // J and the right-hand side; rows between their bounds have no part in either.
        let active = self.rows.map(|row| row.state != RowState::Between);
        let (mut j, mut b, mut wrench) = ([[0.0; 4]; 4], [0.0; 4], [0.0; 4]);
        for ((b, row), drift) in b.iter_mut().zip(&self.rows).zip(drift) {
            *b = match row.state {
                RowState::Between => 0.0,
                RowState::AtHigh => drift.high,
                RowState::AtLow | RowState::Held => drift.low,
            };
        }
        for (unit, scratch) in self.units.iter().zip(self.scratch.iter()) {
            let Some(set) = self.sets.of(scratch.rotors) else {
                continue;
            };
            let columns = columns(unit, &set, self.factors, &self.row_scale);
            let point = set.project(scratch.face, pulled(scratch.reference, &columns, &multipliers));
            for ((wrench, by_f), by_q) in wrench.iter_mut().zip(columns[0]).zip(columns[1]) {
                *wrench += by_f * point[0] + by_q * point[1];
            }
            let moved = scratch.pair.map(|step| reference_share * step);
            let moved = if reference_share > 0.0 {
                set.project_step(scratch.face, moved)
            } else {
                [0.0; 2]
            };
            for (index, ((row, b), is_active)) in j.iter_mut().zip(b.iter_mut()).zip(active).enumerate() {
                if !is_active {
                    continue;
                }
                let pull = columns.map(|column| column.get(index).copied().unwrap_or(0.0));
                *b -= pull[0] * moved[0] + pull[1] * moved[1];
                let projected = set.project_step(scratch.face, pull);
                for (((value, f), q), is_active) in row.iter_mut().zip(columns[0]).zip(columns[1]).zip(active)
                {
                    if is_active {
                        *value += f * projected[0] + q * projected[1];
                    }
                }
            }
        }
        // What rounding has done so far is made up for on the way.
        let mut correction = [0.0; 4];
        for (((row, correction), wrench), is_active) in
            self.rows.iter_mut().zip(&mut correction).zip(wrench).zip(active)
        {
            if is_active {
                *correction = significant(row.value - wrench);
            } else {
                row.value = wrench;
            }
        }
        let (solution, least_pivot) = solve(j, b, correction);
        let (velocity, moving) = match solution {
            Solution::Regular(velocity) => (velocity, 1.0),
            Solution::Inconsistent(direction) => (direction, 0.0),
        };
        let noise = NOISE / sqrt(least_pivot) * velocity.iter().fold(0.0, |sum, v| sum + v.abs());

        // The first event: of the faces, ..
        let (mut limit, mut event) = if moving > 0.0 {
            (1.0, Some(Event::Arrival))
        } else {
            (f32::MAX, None)
        };
        let mut value_velocity = [0.0; 4];
        for (index, (unit, scratch)) in self.units.iter().zip(self.scratch.iter()).enumerate() {
            let Some(set) = self.sets.of(scratch.rotors) else {
                continue;
            };
            let columns = columns(unit, &set, self.factors, &self.row_scale);
            let point = pulled(scratch.reference, &columns, &multipliers);
            let reference_step = scratch.pair.map(|step| moving * reference_share * step);
            let reference_step = if reference_share > 0.0 {
                reference_step
            } else {
                [0.0; 2]
            };
            let step = pulled(reference_step, &columns, &velocity);
            if let Some((share, face)) = set.crossing(scratch.face, point, step, limit, noise) {
                limit = share;
                event = Some(Event::Face(index, face));
            }
            let [f, q] = set.project_step(scratch.face, step);
            for ((value, by_f), by_q) in value_velocity.iter_mut().zip(columns[0]).zip(columns[1]) {
                *value += by_f * f + by_q * q;
            }
        }
        // .. of the slack rows.
        for (index, (((row, drift), speed), pull)) in self
            .rows
            .iter()
            .zip(drift)
            .zip(value_velocity)
            .zip(velocity)
            .enumerate()
        {
            let mut falls = |height: f32, speed: f32, state: RowState| {
                if speed < -noise {
                    let share = if height > 0.0 { height / -speed } else { 0.0 };
                    if share < limit {
                        limit = share;
                        event = Some(Event::Row(index, state));
                    }
                }
            };
            match row.state {
                RowState::Held => {}
                RowState::AtLow => falls(row.multiplier, pull, RowState::Between),
                RowState::AtHigh => falls(-row.multiplier, -pull, RowState::Between),
                RowState::Between => {
                    falls(
                        row.value - row.bounds.low,
                        speed - moving * drift.low,
                        RowState::AtLow,
                    );
                    falls(
                        row.bounds.high - row.value,
                        moving * drift.high - speed,
                        RowState::AtHigh,
                    );
                }
            }
        }
        let event = event?;

        let stands = limit < TURNING;
        let made = moving * limit;
        for (((row, drift), pull), speed) in self.rows.iter_mut().zip(drift).zip(velocity).zip(value_velocity)
        {
            row.multiplier += limit * pull;
            row.bounds.low += made * drift.low;
            row.bounds.high += made * drift.high;
            row.value = match row.state {
                RowState::Between => row.value + limit * speed,
                RowState::AtHigh => row.bounds.high,
                RowState::AtLow | RowState::Held => row.bounds.low,
            };
        }
        if reference_share > 0.0 && made > 0.0 {
            for scratch in self.scratch.iter_mut() {
                for (reference, step) in scratch.reference.iter_mut().zip(scratch.pair) {
                    *reference += made * reference_share * step;
                }
            }
        }
        match event {
            Event::Arrival => {}
            Event::Face(index, face) => {
                if let Some(scratch) = self.scratch.get_mut(index) {
                    self.turns = if stands && self.last == (index, face) {
                        self.turns + 1
                    } else {
                        0
                    };
                    self.last = (index, scratch.face);
                    scratch.face = face;
                    if self.turns > TURNS {
                        self.turns = 0;
                        self.decide(index);
                    }
                }
            }
            Event::Row(index, state) => {
                if let Some(row) = self.rows.get_mut(index) {
                    row.state = state;
                    if state == RowState::Between {
                        row.multiplier = 0.0;
                    }
                }
            }
        }
        Some(if matches!(event, Event::Arrival) {
            1.0
        } else {
            made
        })
    }
}

/// `way`, or 0 where it is a rounding error.
#[inline]
fn significant(way: f32) -> f32 {
    if way.abs() > STANDING { way } else { 0.0 }
}

#[inline]
fn scaled(bounds: Bounds, scale: f32) -> Bounds {
    Bounds {
        low: bounds.low * scale,
        high: bounds.high * scale,
    }
}

/// B_i: the columns of M for this unit's thrust and torque, in scaled efforts and rows.
#[inline]
fn columns(unit: &Unit, set: &AttainableSet<'_>, factors: [f32; 2], row_scale: &[f32; 4]) -> [[f32; 4]; 2] {
    let mut columns = unit.effectiveness;
    for ((column, factor), scale) in columns.iter_mut().zip(factors).zip(set.scale) {
        let factor = factor * scale;
        for (entry, row_scale) in column.iter_mut().zip(row_scale) {
            *entry *= factor * row_scale;
        }
    }
    columns
}

/// `point` + B_i^T `multipliers`.
#[inline]
fn pulled(point: [f32; 2], columns: &[[f32; 4]; 2], multipliers: &[f32; 4]) -> [f32; 2] {
    let mut point = point;
    for (point, column) in point.iter_mut().zip(columns) {
        for (entry, multiplier) in column.iter().zip(multipliers) {
            *point += entry * multiplier;
        }
    }
    point
}
