//! Least norm with all rotors: the efforts M+ u of eq. (8), inverted unit by unit.

use core::mem::replace;

use super::closed_form::AllocationMethod;
use super::frame::Frame;
use super::unit::UnitState;
use crate::clamp;
use crate::layout::Unit;
use crate::pair::Kinds;
use crate::rolled;

/// Shares that the guard tries of roll and pitch, and of yaw: with all rotors, and with rotors out. The first share is the
/// whole request, each further one half of the one before. Every try is a least norm more in the stated bound.
const TRIES: [[u32; 2]; 2] = [[3, 1], [2, 0]];

/// Times that the guard runs least norm, of whole frames and with rotors out.
pub const GUARD_LEAST_NORMS: [u32; 2] = [TRIES[0][0] + TRIES[0][1] + 1, TRIES[1][0] + TRIES[1][1] + 1];

impl<K: Kinds, S: AllocationMethod, const VERTICAL: bool> Frame<'_, '_, K, S, VERTICAL> {
    /// Efforts of least norm of a unit for a wrench (N m, N), at the reference voltage.
    #[inline(always)]
    pub(super) fn least_norm(&self, unit: &Unit, wrench: &[f32; 4]) -> [f32; 2] {
        let [f, q] = unit.efforts(wrench);
        [f * self.per_factor[0], q * self.per_factor[1]]
    }

    /// Writes the throttles of least norm of the rotors that turn, or near by where a unit cannot give its efforts. True
    /// where all can. A single rotor has a torque that follows from its thrust, as has one whose partner is out.
    #[inline(always)]
    pub(super) fn serve(&self, wrench: &[f32; 4], units: &mut [UnitState], is_whole: bool) -> bool {
        if is_whole && !K::MAY_BE_SINGLE {
            self.serve_by_least_norm(wrench, units)
        } else {
            self.serve_with_rotors_alone(wrench, units, is_whole)
        }
    }

    /// Writes the throttles of least norm, or near by where a unit cannot give its efforts. True where
    /// all can.
    #[inline(never)]
    fn serve_by_least_norm(&self, wrench: &[f32; 4], units: &mut [UnitState]) -> bool {
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
        self.tables
            .tolerance
            .allows(given, replace(&mut state.efforts, given))
    }

    /// The guard, where the interior point method has not met the rows: the largest share of roll and pitch, then of
    /// yaw, that least norm gives at the thrust asked. With all rotors that thrust is limited to that of level flight. The
    /// answer is one that the units give, whatever their sets. Where least norm gives no level flight, the method's answer stays.
    #[inline(never)]
    pub(super) fn guard(&self, wrench: &[f32; 4], units: &mut [UnitState], is_whole: bool) {
        let [roll, pitch, yaw, mut thrust] = *wrench;
        if is_whole {
            let [least, most] = self.tables.level_n.map(|end| end * self.factors[0]);
            thrust = clamp(thrust, least, most);
        }
        let share = |[torque, turn]: [f32; 2]| [torque * roll, torque * pitch, turn * yaw, thrust];
        let mut kept = [0.0; 2];
        for (axes, tries) in TRIES[usize::from(!is_whole)].into_iter().enumerate() {
            let mut step = 1.0;
            for _ in rolled(0..tries) {
                let mut more = kept;
                more[axes] += step;
                step *= 0.5;
                if more[axes] <= 1.0 && self.serve(&share(more), units, is_whole) {
                    kept = more;
                }
            }
        }
        if self.serve(&share(kept), units, is_whole) {
            return;
        }
        for (index, state) in rolled(units.iter_mut().enumerate()) {
            self.place(index, state);
        }
    }
}
