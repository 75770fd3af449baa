//! The reference efforts: what the efforts are nearest to, among those that give the wrench.
//!
//! With vertical axes the least-norm efforts and the centres of the sets differ by some `B^T lambda`, so the efforts
//! nearest to either are the same. With tilted axes they are not. There the reference is between the two: the least-norm
//! efforts where these are attainable, which makes them the result, and the centres where these are far from it.

use crate::homotopy::Homotopy;
use crate::linear::{Gram, Solution};
use crate::rows::{Bounds, RowState};

/// Distance from the attainable set, scaled, beyond which least-norm efforts have no say.
const LEAST_NORM_REACH: f32 = 0.2;

impl Homotopy<'_> {
    /// How much of the way from the centres to the least-norm efforts of `request` the reference goes: all of it
    /// where those are attainable, so that they are the result, and none where they are far from it.
    fn least_norm_part(&self, request: &[f32; 4]) -> f32 {
        let mut part = 1.0;
        for (unit, scratch) in self.units.iter().zip(self.scratch.iter()) {
            if let Some(set) = self.sets.of(scratch.rotors, &scratch.chord) {
                let [f, q] = unit.efforts(request);
                let distance = set.locate([f / self.factors[0], q / self.factors[1]]).distance();
                let near = 1.0 - distance / LEAST_NORM_REACH;
                part = if near < part { near } else { part };
            }
        }
        part
    }

    /// The multipliers that draw the reference nearest to the centres.
    fn towards_centres(&self, request: &[f32; 4], part: f32) -> [f32; 4] {
        let mut gram = Gram::default();
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
            for column in scratch.columns {
                gram.add(column);
            }
        }
        match gram.solve(wrench) {
            Solution::Regular(multipliers) => multipliers,
            Solution::Inconsistent(_) => [0.0; 4],
        }
    }

    /// Puts every unit at its reference, pulled near to the centre of its set; roll and pitch across the request
    /// held, the other rows slack.
    pub(crate) fn start(&mut self, request: [f32; 4], is_tilted: bool) {
        let part = if is_tilted {
            self.least_norm_part(&request)
        } else {
            0.0
        };
        let pull = if part > 0.0 {
            self.towards_centres(&request, part)
        } else {
            [0.0; 4]
        };
        for (unit, scratch) in self.units.iter().zip(self.scratch.iter_mut()) {
            if let Some(set) = self.sets.of(scratch.rotors, &scratch.chord) {
                let mut reference = set.centre;
                if part > 0.0 {
                    let least = unit.efforts(&request);
                    let step = scratch.step(&pull);
                    for (((reference, least), factor), step) in
                        reference.iter_mut().zip(least).zip(self.factors).zip(step)
                    {
                        *reference += part * (least / factor - *reference) + step;
                    }
                }
                scratch.point = set.locate(reference);
            }
        }
        let wrench = self.actual();
        for (row, value) in self.rows.iter_mut().zip(wrench) {
            row.value = value;
            row.bounds = Bounds::at(value);
        }
        let [along, _, yaw, thrust] = &mut self.rows;
        for row in [along, yaw, thrust] {
            row.state = RowState::Between;
        }
    }
}
