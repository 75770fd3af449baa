//! The reference efforts: what the efforts are nearest to, among those that give the wrench.
//!
//! With vertical axes the least-norm efforts and the centres of the sets differ by some `B^T lambda`, so the efforts
//! nearest to either are the same. With tilted axes they are not. There the reference is between the two: the least-norm
//! efforts where these are attainable, which makes them the result, and the centres where these are far from it.

use crate::attainable::Point;
use crate::homotopy::Homotopy;
use crate::linear::Moments;
use crate::rows::{ACROSS, Bounds, Row, RowState};

/// Distance from the attainable set, scaled, beyond which least-norm efforts have no say.
const LEAST_NORM_REACH: f32 = 0.2;

/// Limited efforts that miss the request by more than this, in rows, are not worth a way straight to it.
const NEAR: f32 = 0.3;

impl Homotopy<'_> {
    /// How far, scaled, the least-norm efforts of `request` are from attainable: the unit furthest off.
    pub(crate) fn least_norm_distance(&self, request: &[f32; 4]) -> f32 {
        let mut furthest = 0.0;
        for (unit, scratch) in self.units.iter().zip(self.scratch.iter()) {
            if let Some(set) = self.sets.of(scratch.rotors, &scratch.chord) {
                let [f, q] = unit.efforts(request);
                let distance = set.distance([f / self.factors[0], q / self.factors[1]]);
                furthest = if distance > furthest { distance } else { furthest };
            }
        }
        furthest
    }

    /// The multipliers that draw the reference nearest to the centres.
    fn towards_centres(&self, request: &[f32; 4], part: f32) -> [f32; 4] {
        let mut moments = Moments::default();
        let mut wrench = [0.0; 4];
        for (unit, scratch) in self.units.iter().zip(self.scratch.iter()) {
            let Some(set) = self.sets.of(scratch.rotors, &scratch.chord) else {
                continue;
            };
            let least = unit.efforts(request);
            let way = [
                part * (set.centre[0] - least[0] / self.factors[0]),
                part * (set.centre[1] - least[1] / self.factors[1]),
            ];
            scratch.add(way, &mut wrench);
            for column in &scratch.columns {
                moments.add(column);
            }
        }
        let factors = moments.factors(moments.spanned());
        factors.map_or([0.0; 4], |factors| factors.solve(wrench))
    }

    /// Keeps every unit's reference, pulled near to the centre of its set, in the place of its efforts.
    pub(crate) fn refer(&mut self, request: &[f32; 4], is_tilted: bool) {
        let part = if is_tilted {
            // All of the way from the centres to least-norm efforts that are attainable, so that they are the result.
            1.0 - self.least_norm_distance(request) / LEAST_NORM_REACH
        } else {
            0.0
        };
        let pull = if part > 0.0 {
            self.towards_centres(request, part)
        } else {
            [0.0; 4]
        };
        for (unit, scratch) in self.units.iter().zip(self.scratch.iter_mut()) {
            if let Some(set) = self.sets.of(scratch.rotors, &scratch.chord) {
                let mut reference = set.centre;
                if part > 0.0 {
                    let least = unit.efforts(request);
                    let step = scratch.step(&pull);
                    for (((reference, least), factor), step) in
                        reference.iter_mut().zip(least).zip(self.factors).zip(step)
                    {
                        *reference += part * (least / factor - *reference) + step;
                    }
                }
                scratch.efforts = reference;
            }
        }
    }

    /// Has the ends of paths note the hollows that hold units back, if no rotor is out: else no one asks for them.
    pub(crate) fn look_for_hollows(&mut self) {
        for scratch in self.scratch.iter_mut() {
            scratch.hollow = [None; 2];
        }
        self.looks_for_hollows = !self.scratch.iter().any(|scratch| scratch.rotors.is_single());
    }

    /// Keeps the efforts of the best end for the references, and a corner of the unit's set for that of the unit.
    pub(crate) fn refer_beside_best(&mut self, unit: usize, corner: u8) {
        for (index, scratch) in self.scratch.iter_mut().enumerate() {
            if let Some(set) = self.sets.of(scratch.rotors, &scratch.chord) {
                scratch.efforts = if index == unit {
                    set.corner(corner)
                } else {
                    [scratch.best[0] / set.scale[0], scratch.best[1] / set.scale[1]]
                };
            }
        }
    }

    /// Keeps a unit in its corner, come what may.
    pub(crate) fn pin(&mut self, unit: usize, corner: u8) {
        if let Some(scratch) = self.scratch.get_mut(unit) {
            scratch.point = Point::pinned(corner);
        }
    }

    /// Puts every unit where `multipliers` draw it from its reference. Roll and pitch across the request are held, the
    /// other rows as `others` says.
    pub(crate) fn place(&mut self, multipliers: &[f32; 4], others: RowState) {
        for scratch in self.scratch.iter_mut() {
            if let Some(set) = self.sets.of(scratch.rotors, &scratch.chord) {
                let (reference, step) = (scratch.efforts, scratch.step(multipliers));
                scratch.point = set.locate([reference[0] + step[0], reference[1] + step[1]]);
            }
        }
        let rows = self.actual();
        for (row, value) in self.rows.iter_mut().zip(rows) {
            *row = Row {
                state: others,
                value,
                bounds: Bounds::at(value),
                multiplier: 0.0,
            };
        }
        self.rows[ACROSS].state = RowState::Held;
        self.left = None;
    }

    /// Puts every unit where the efforts would be nearest to the references if none were limited, all rows held. False
    /// where these, limited, miss `wanted` by far.
    #[inline(never)]
    pub(crate) fn place_near(&mut self, wanted: &[f32; 4]) -> bool {
        self.place(&[0.0; 4], RowState::Held);
        let (moments, rows) = self.survey();
        let Some(factors) = moments.factors(moments.spanned()) else {
            return false;
        };
        let mut way = *wanted;
        for (way, row) in way.iter_mut().zip(rows) {
            *way -= row;
        }
        self.place(&factors.solve(way), RowState::Held);
        let missed = self
            .rows
            .iter()
            .zip(wanted)
            .map(|(row, wanted)| wanted - row.value);
        missed.fold(0.0, |sum: f32, missed| sum + missed.abs()) < NEAR
    }
}
