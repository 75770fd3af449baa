//! The workspace of one unit.

use core::hint::black_box;

use super::unknown::Unknown;
use crate::pair::rotors::Rotors;

/// State of one unit while a wrench is allocated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitState {
    /// Which of its rotors turn.
    pub(crate) rotors: Rotors,
    /// The answer: throttles `[u, l]`, 0 of a rotor that is out.
    pub(crate) throttles: [f32; 2],
    /// Efforts `[f, Q]`, N and N m at the reference voltage: those asked of the unit, then those that it
    /// gives at the throttles.
    pub(crate) efforts: [f32; 2],
    /// Rows per N of thrust and per N m of torque at this voltage.
    pub(super) columns: [[f32; 4]; 2],
    /// The rotors' throttles as unknowns.
    pub(super) unknowns: [Unknown; 2],
    /// `[f, Q]` per throttle of each rotor; of least power the first is its shift of the efforts.
    pub(super) slopes: [[f32; 2]; 2],
    /// Throttles that the answer is drawn to.
    pub(super) targets: [f32; 2],
    /// Of a single rotor: 2 f'' / f' of its thrust f over the throttle.
    pub(super) curvature_per_slope: f32,
}

impl UnitState {
    /// Throttles `[u, l]`.
    pub fn throttles(&self) -> [f32; 2] {
        self.throttles
    }

    /// Stops the rotors that are out.
    #[inline(always)]
    pub(super) fn stop_failed(&mut self) {
        for side in 0..2 {
            if !self.rotors.turns(side) {
                self.throttles[side] = 0.0;
            }
        }
    }
}

impl Default for UnitState {
    #[inline(always)]
    fn default() -> Self {
        // Known zeros would be written by a call of memset, which a bare-metal target may not have.
        let zero = black_box(0.0);
        UnitState {
            rotors: Rotors::BOTH,
            throttles: [zero; 2],
            efforts: [zero; 2],
            columns: [[zero; 4]; 2],
            unknowns: [Unknown::central(zero); 2],
            slopes: [[zero; 2]; 2],
            targets: [zero; 2],
            curvature_per_slope: zero,
        }
    }
}
