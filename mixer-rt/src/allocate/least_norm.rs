//! Least norm with all rotors: the efforts M+ u of eq. (8), inverted unit by unit.
//!
//! M+ has a single rotor's torque in proportion to its thrust, which it is not quite. What it differs by is taken
//! from the wrench, which moves the thrusts, and so on: the differences fall by a constant factor, of some hundredths,
//! from one pass to the next. Each pass has one step along every single rotor's curve. The compiler bounds what is
//! left, and gives a frame as many passes as its tolerances need.

use core::mem::replace;

use super::closed_form::AllocationMethod;
use super::frame::Frame;
use super::unit::UnitState;
use crate::clamp;
use crate::layout::Unit;
use crate::pair::{Inverse, Quantity};
use crate::rolled;

impl<P: Quantity, I: Inverse, S: AllocationMethod<P>, const VERTICAL: bool> Frame<'_, '_, P, I, S, VERTICAL> {
    /// Efforts of least norm of a unit for a wrench (N m, N), at the reference voltage.
    #[inline(always)]
    pub(super) fn least_norm(&self, unit: &Unit, wrench: &[f32; 4]) -> [f32; 2] {
        let [f, q] = unit.efforts(wrench);
        [f * self.per_factor[0], q * self.per_factor[1]]
    }

    /// Writes the throttles of least norm of a whole frame, or near by where a unit cannot give its efforts. True where
    /// all can.
    #[inline(always)]
    pub(super) fn serve(&self, wrench: &[f32; 4], units: &mut [UnitState]) -> bool {
        if S::MAY_HAVE_SINGLE_ROTORS {
            self.serve_with_single_rotors(wrench, units)
        } else {
            self.serve_by_least_norm(wrench, units)
        }
    }

    /// [`Self::serve_by_least_norm`] with single rotors among the units.
    #[inline(never)]
    fn serve_with_single_rotors(&self, wrench: &[f32; 4], units: &mut [UnitState]) -> bool {
        let (tables, range) = (self.tables, &self.tables.throttle);
        let mut asked = *wrench;
        for pass in rolled(0..tables.closed_form.passes()) {
            let mut next = *wrench;
            for (index, (state, unit)) in rolled(units.iter_mut().zip(tables.units).enumerate()) {
                let Some(curve) = tables.curve_of(index) else {
                    continue;
                };
                let [f, q] = self.least_norm(unit, &asked);
                let from = if pass == 0 {
                    curve.start(range, f)
                } else {
                    state.throttles[0]
                };
                let [throttle, torque] = curve.parabola(range, from, f);
                state.throttles = [throttle, 0.0];
                unit.add_wrench([0.0, q - torque], self.factors, &mut next);
            }
            asked = next;
        }
        let mut is_served = true;
        for (index, (state, unit)) in rolled(units.iter_mut().zip(tables.units).enumerate()) {
            state.efforts = self.least_norm(unit, &asked);
            is_served &= match tables.curve_of(index) {
                None => self.invert(index, state),
                Some(curve) => {
                    let given = curve.efforts(state.throttles[0]);
                    state.efforts[1] = given[1];
                    self.gives(given, state)
                }
            };
        }
        is_served
    }

    /// Writes the throttles of least norm, or near by where a unit cannot give its efforts. True where
    /// all can.
    #[inline(never)]
    pub(super) fn serve_by_least_norm(&self, wrench: &[f32; 4], units: &mut [UnitState]) -> bool {
        let mut is_served = true;
        for (index, (state, unit)) in rolled(units.iter_mut().zip(self.tables.units).enumerate()) {
            state.efforts = self.least_norm(unit, wrench);
            is_served &= self.invert(index, state);
        }
        is_served
    }

    /// Writes a unit's throttles for the efforts asked; true where it gives them.
    #[inline(always)]
    pub(super) fn invert(&self, index: usize, state: &mut UnitState) -> bool {
        let tables = self.tables;
        state.throttles = tables.throttles_of(index, state.efforts);
        self.gives(tables.efforts_of(index, state.throttles), state)
    }

    /// Notes what a unit gives; true where it is what was asked, within the inverse map's tolerance.
    #[inline(always)]
    pub(super) fn gives(&self, given: [f32; 2], state: &mut UnitState) -> bool {
        let [thrust, torque] = self.tables.tolerance.efforts;
        let asked = replace(&mut state.efforts, given);
        (given[0] - asked[0]).abs() <= thrust && (given[1] - asked[1]).abs() <= torque
    }

    /// The guard for whole frames, where the interior point method has not met the rows: least norm for
    /// level flight at the attainable thrust nearest the one asked. It is sound whatever the sets, for it is
    /// delivered. Where a frame has no level flight by least norm, the method's answer stays.
    #[inline(never)]
    pub(super) fn level(&self, thrust: f32, units: &mut [UnitState]) {
        let [least, most] = self.tables.level_n.map(|end| end * self.factors[0]);
        if self.serve(&[0.0, 0.0, 0.0, clamp(thrust, least, most)], units) {
            return;
        }
        for (index, state) in rolled(units.iter_mut().enumerate()) {
            self.place(index, state);
        }
    }
}
