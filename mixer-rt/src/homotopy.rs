//! The attainable efforts nearest to a reference that give a wrench, followed along a path of wrenches.
//!
//! With y_i the efforts of unit i, c_i its reference efforts and A its attainable set, a polygon, the problem at wrench w
//! is
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
//! J lambda' = w',    J = sum B_i P_i B_i^T
//! ```
//!
//! and a piece ends where some p_i changes its face. Where J is singular and the right-hand side outside its
//! range, the wrench can go no further with these faces: lambda then moves along a null vector v of J with
//! v w' > 0, which changes no effort, until a face changes. If none ever does, v is the normal of a plane that
//! touches the attainable wrenches at w and parts them from the rest of the path: w is the exact end of what is
//! attainable on it.
//!
//! Where A bends inwards this holds of the edges on which the path is: it goes on from one to the next at a corner, and
//! ends where no way on is on the edges at hand.
//!
//! Any lambda is a start: it solves the problem at the wrench that its own efforts give.
//!
//! What is kept is not lambda but every p_i, by the coordinates of its region. So rounding errors amount to a slightly
//! different c_i, and neither move an effort nor turn a unit back at a border that it has just crossed.
//!
//! Efforts are scaled by the set's `scale`.

use crate::attainable::Face;
use crate::chord::{Rotors, Sets};
use crate::rows::{Bounds, Row, RowState, Turned};
use crate::scratch::Scratch;
use crate::{Tables, Unit, sqrt};

/// Pieces of a path per unit before the mixer stops where it is (sound, but then perhaps not optimal): far more than
/// the 60 or so in all that frames of six units with slightly tilted axes have needed.
const PIECES_PER_UNIT: u32 = 48;
/// The same for a frame as a whole.
const PIECES: u32 = 64;

/// Pieces per unit of the way straight to a request: what is attainable has hardly ever needed more.
const STRAIGHT_PIECES_PER_UNIT: u32 = 2;

/// Pieces in a row, per unit, that make no more way than rounding errors do, after which those of the wrench are no longer
/// made up for, and after as many more the path ends. More than five have only been seen where such errors turned units or
/// rows to and fro.
const STILL_PIECES_PER_UNIT: u32 = 5;

/// Rows nearer than this to where they are to be are there, once they are known to come no nearer.
const SETTLED: f32 = 3e-5;

/// Ways shorter than this, in rows, are rounding errors.
const STANDING: f32 = 1e-6;

/// A border from which the normal leads away by less than this counts as parallel to it.
const PARALLEL: f32 = 1e-5;

/// No row reaches this: rows have unit length, efforts are of order one.
const FAR: f32 = 16.0;

/// The last part of the way to the end of what is attainable on which efforts are eased into those at the end, as a share of
/// the way, or of the request where that is longer: a request changes by a share of itself. The longer the part is, the less
/// steep, and the more often the way to the end is looked at.
const EASE: f32 = 0.03;

/// Efforts that easing leaves further outside the attainable set than this, scaled, are not attainable.
const EASED_OUT: f32 = 1e-5;

/// Least-norm efforts nearer to the attainable set than this, scaled, leave less to easing.
const LEAST_NORM_NEAR: f32 = 0.05;

/// The efforts of all units on their way along a path of wrenches.
pub(crate) struct Homotopy<'h> {
    pub(crate) units: &'h [Unit],
    pub(crate) scratch: &'h mut [Scratch],
    pub(crate) sets: &'h Sets<'h>,
    /// `[k_f, k_Q]` times the scale of the sets.
    pub(crate) factors: [f32; 2],
    pub(crate) turned: Turned,
    pub(crate) rows: [Row; 4],
    pieces_left: u32,
    /// Whether hollows are noted: see [`crate::hollows`].
    pub(crate) looks_for_hollows: bool,
    /// The unit that has crossed a border last, and from where.
    pub(crate) left: Option<(usize, (Face, u8))>,
}

impl<'h> Homotopy<'h> {
    /// Nowhere yet: [`Homotopy::prepare`] comes next.
    #[inline(always)]
    pub(crate) fn new<P, I, S>(
        tables: &'h Tables<'_, P, I, S>,
        sets: &'h Sets<'h>,
        factors: [f32; 2],
        request: [f32; 4],
        scratch: &'h mut [Scratch],
    ) -> Self {
        let scale = tables.attainable.scale;
        let factors = [factors[0] * scale[0], factors[1] * scale[1]];
        let (mut squares, mut allocated) = ([0.0; 4], [false; 4]);
        for (unit, scratch) in tables.units.iter().zip(scratch.iter()) {
            if scratch.rotors == Rotors::None {
                continue;
            }
            for (column, factor) in unit.effectiveness.iter().zip(factors) {
                for (square, entry) in squares.iter_mut().zip(column) {
                    *square += (factor * entry) * (factor * entry);
                }
            }
            for row in unit.allocation {
                for (allocated, entry) in allocated.iter_mut().zip(row) {
                    *allocated |= entry != 0.0;
                }
            }
        }
        let mut row_scale = [0.0; 4];
        for (scale, (square, allocated)) in row_scale.iter_mut().zip(squares.into_iter().zip(allocated)) {
            if allocated && square > 0.0 {
                *scale = 1.0 / sqrt(square);
            }
        }
        Homotopy {
            units: tables.units,
            scratch,
            sets,
            factors,
            turned: Turned::new(row_scale, request),
            rows: [Row::default(); 4],
            pieces_left: 0,
            looks_for_hollows: false,
            left: None,
        }
    }

    /// Gives the units their columns and references.
    pub(crate) fn prepare(&mut self, request: &[f32; 4]) {
        let is_tilted = !self.units.iter().all(Unit::is_vertical)
            && self.scratch.iter().all(|scratch| scratch.rotors == Rotors::Both);
        for (unit, scratch) in self.units.iter().zip(self.scratch.iter_mut()) {
            let effects = unit.effectiveness.into_iter().zip(self.factors);
            for (column, (effect, factor)) in scratch.columns.iter_mut().zip(effects) {
                *column = self.turned.rows(effect.map(|effect| effect * factor));
            }
        }
        self.refer(request, is_tilted);
    }

    fn units_times(&self, pieces: u32) -> u32 {
        pieces.saturating_mul(self.units.len() as u32)
    }

    /// Starts at the references, roll and pitch across the request held, the other rows slack.
    pub(crate) fn start(&mut self) {
        self.place(&[0.0; 4], RowState::Between);
        self.refill();
    }

    /// Allows as many pieces as all steps together may need.
    fn refill(&mut self) {
        self.pieces_left = self.units_times(PIECES_PER_UNIT).saturating_add(PIECES);
    }

    /// Goes straight to the rows `wanted`, from the efforts that would be nearest to the references if none were
    /// limited. False where it does not come to them or where that does not look worth while.
    pub(crate) fn follow_straight(&mut self, wanted: &[f32; 4]) -> bool {
        self.pieces_left = self.units_times(STRAIGHT_PIECES_PER_UNIT);
        self.place_near(wanted) && self.follow(wanted.map(Bounds::at), false) >= 1.0
    }

    /// The rows of a wrench.
    pub(crate) fn rows_of(&self, wrench: [f32; 4]) -> [f32; 4] {
        self.turned.rows(wrench)
    }

    /// Bounds of an axis in its row.
    pub(crate) fn bounds_of(&self, axis: usize, bounds: Bounds) -> Bounds {
        let scale = self.turned.scale.get(axis).copied().unwrap_or(0.0);
        Bounds {
            low: bounds.low * scale,
            high: bounds.high * scale,
        }
    }

    /// The present bounds of the rows.
    pub(crate) fn bounds(&self) -> [Bounds; 4] {
        self.rows.map(|row| row.bounds)
    }

    /// Holds `row` where it is, to be moved by the next path.
    pub(crate) fn hold(&mut self, row: usize) {
        if let Some(row) = self.rows.get_mut(row) {
            row.hold();
        }
    }

    /// Moves the bounds of `row` out or in to `bounds` as long as these contain the present value.
    pub(crate) fn bound(&mut self, row: usize, bounds: Bounds) {
        if let Some(row) = self.rows.get_mut(row)
            && row.state == RowState::Between
        {
            row.bounds = bounds.within(FAR).including(row.value);
        }
    }

    /// Keeps the efforts, scaled, in the scratch.
    pub(crate) fn keep_efforts(&mut self) {
        for scratch in self.scratch.iter_mut() {
            scratch.efforts = match self.sets.of(scratch.rotors, &scratch.chord) {
                Some(set) => set.project(&scratch.point),
                None => [0.0; 2],
            };
        }
    }

    /// Turns the efforts in the scratch into N and N m at the reference voltage.
    pub(crate) fn unscale_efforts(&mut self) {
        for scratch in self.scratch.iter_mut() {
            if let Some(set) = self.sets.of(scratch.rotors, &scratch.chord) {
                let [f, q] = scratch.efforts;
                scratch.efforts = [f * set.scale[0], q * set.scale[1]];
            }
        }
    }

    /// Moves held rows and the bounds of slack rows straight towards `target`, as far as attainable; returns the
    /// share of the way that was made. `presses`: where the way has ended, what comes next stays there.
    pub(crate) fn follow(&mut self, target: [Bounds; 4], presses: bool) -> f32 {
        let mut target = target.map(|target| target.within(FAR));
        if self
            .rows
            .iter()
            .zip(&target)
            .all(|(row, target)| row.suits(target))
        {
            for (row, target) in self.rows.iter_mut().zip(target) {
                row.bounds = target;
            }
            return 1.0;
        }
        self.left = None;
        for row in &mut self.rows {
            row.choose_side();
        }
        let length = self.rows.iter().zip(&target).fold(0.0, |sum, (row, target)| {
            sum + (target.low - row.bounds.low).abs() + (target.high - row.bounds.high).abs()
        });
        let mut share = 0.0;
        let (mut still, mut settled) = (0, false);
        loop {
            let left = 1.0 - share;
            if left <= 0.0 {
                return 1.0;
            }
            // Velocities per remaining way: the bounds reach the target when `made` = 1.
            let mut drift = target;
            for (drift, row) in drift.iter_mut().zip(&self.rows) {
                *drift = Bounds {
                    low: significant(drift.low - row.bounds.low),
                    high: significant(drift.high - row.bounds.high),
                };
            }
            if drift.iter().all(|drift| *drift == Bounds::at(0.0)) {
                return 1.0;
            }
            let Some(pieces_left) = self.pieces_left.checked_sub(1) else {
                return share;
            };
            self.pieces_left = pieces_left;
            let Some(made) = self.piece(&drift, presses) else {
                self.stay();
                return share;
            };
            still = if significant(made * left * length) > 0.0 {
                0
            } else {
                still + 1
            };
            if still > self.units_times(STILL_PIECES_PER_UNIT) {
                if settled {
                    self.stay();
                    return share;
                }
                self.settle(&mut target);
                (settled, still) = (true, 0);
            }
            share += made * left;
        }
    }

    /// Near the end of what is attainable, eases the efforts of `request`, which has been reached, into those at the end.
    ///
    /// The efforts nearest to the reference are steep where several edges are almost dependent: with the last bit of
    /// what is attainable they cross whole edges. At the end itself there is no choice. So on the last part, [`EASE`], of the
    /// ray from the wrench of the sets' centres through that of the request the efforts go over into straight ones between
    /// the centres and the ray's end, which give the same wrench. Efforts that are all but least norm stay, since where
    /// they are just attainable these are the result.
    ///
    /// Between two efforts a set that bends inwards may be left out: then the nearest efforts that are attainable.
    pub(crate) fn ease(&mut self, request: &[f32; 4]) {
        let mut centre = [0.0; 4];
        for scratch in self.scratch.iter() {
            if let Some(set) = self.sets.of(scratch.rotors, &scratch.chord) {
                scratch.add(set.centre, &mut centre);
            }
        }
        self.refill();
        let mut beyond = self.bounds();
        let (mut size, mut way) = (0.0, 0.0);
        for (wrench, centre) in beyond.iter().zip(centre) {
            size += wrench.low.abs();
            way += (wrench.low - centre).abs();
        }
        // A way that is next to nothing has no direction; all of it once more is far enough.
        let part = if way > EASE * size {
            crate::clamp(EASE * size / way, EASE, 1.0)
        } else {
            1.0
        };
        for (beyond, centre) in beyond.iter_mut().zip(centre) {
            *beyond = Bounds::at(beyond.low + part * (beyond.low - centre));
        }
        let share = self.follow(beyond, false);
        if share >= 1.0 {
            return;
        }
        let inwards = 1.0 / (1.0 + share * part);
        let straight =
            (1.0 - share) * crate::clamp(self.least_norm_distance(request) / LEAST_NORM_NEAR, 0.0, 1.0);
        let mut is_attainable = true;
        for scratch in self.scratch.iter_mut() {
            if let Some(set) = self.sets.of(scratch.rotors, &scratch.chord) {
                let end = set.project(&scratch.point);
                for ((effort, end), centre) in scratch.efforts.iter_mut().zip(end).zip(set.centre) {
                    *effort += straight * (centre + inwards * (end - centre) - *effort);
                }
                is_attainable &= set.distance(scratch.efforts) <= EASED_OUT;
            }
        }
        if !is_attainable {
            self.place(&[0.0; 4], RowState::Held);
            self.refill();
            self.follow(self.rows_of(*request).map(Bounds::at), false);
            self.keep_efforts();
        }
    }

    /// Keeps what comes next on the face of the attainable wrenches whose `normal` the path has ended at: any multiple of
    /// it may be added to the multipliers, and infinitely much is. The velocities are still in the scratch.
    pub(crate) fn press(&mut self, normal: &[f32; 4]) {
        let far = |speed: f32| if speed > PARALLEL { f32::INFINITY } else { 0.0 };
        for scratch in self.scratch.iter_mut() {
            let velocity = scratch.pair;
            let direction = scratch.step(normal);
            if let Some(set) = self.sets.of(scratch.rotors, &scratch.chord) {
                if self.looks_for_hollows
                    && scratch.hollow == [None; 2]
                    && !scratch.point.is_pressed()
                    && direction.iter().any(|part| part.abs() > PARALLEL)
                {
                    scratch.hollow = set.hollow(&scratch.point, direction);
                }
                match scratch.point.face {
                    Face::Interior => {}
                    Face::Edge => set.shift(&mut scratch.point, [0.0, far(velocity[1])]),
                    Face::Corner => set.shift(&mut scratch.point, velocity.map(far)),
                }
            }
        }
        // A slack row whose bound has a part in it will not be released again.
        for (row, pull) in self.rows.iter_mut().zip(normal) {
            if row.state != RowState::Between && pull.abs() > PARALLEL {
                row.hold();
            }
        }
    }

    /// Takes the wrench of the present efforts for that of the held rows, and for the target of those that are there but
    /// for rounding errors.
    fn settle(&mut self, target: &mut [Bounds; 4]) {
        self.stay();
        for (row, target) in self.rows.iter().zip(target) {
            if row.state == RowState::Held && (row.value - target.low).abs() < SETTLED {
                *target = row.bounds;
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

    /// The rows of the present efforts.
    pub(crate) fn actual(&self) -> [f32; 4] {
        let mut rows = [0.0; 4];
        for scratch in self.scratch.iter() {
            if let Some(set) = self.sets.of(scratch.rotors, &scratch.chord) {
                scratch.add(set.project(&scratch.point), &mut rows);
            }
        }
        rows
    }
}

/// `way`, or 0 where it is a rounding error.
#[inline]
pub(crate) fn significant(way: f32) -> f32 {
    if way.abs() > STANDING { way } else { 0.0 }
}
