//! What evaluators cost on a Cortex-M4F, counted.

use super::{Evaluator, Refinement};
use crate::airframe::Basis;

/// Instructions per unit, by the name in airframe files (a polynomial's with its degree), with a biquadratic, a cubic
/// and a quartic pair. Counted in QEMU by
///
/// ```sh
/// cargo run --release -p mixer-tests --bin evaluators
/// ```
///
/// which prints these lines; the firmware test fails where they are no longer true.
pub const INSTRUCTIONS: [(&str, [u32; 3]); 23] = [
    ("polynomial-2", [80, 80, 80]),
    ("polynomial-3", [98, 98, 98]),
    ("polynomial-5", [148, 148, 148]),
    ("bilinear", [55, 55, 55]),
    ("bilinear-newton", [137, 143, 171]),
    ("bilinear-shamanskii", [186, 195, 260]),
    ("bilinear-newton2", [209, 220, 304]),
    ("quadratic", [63, 63, 63]),
    ("quadratic-newton", [145, 151, 179]),
    ("quadratic-shamanskii", [194, 203, 269]),
    ("quadratic-newton2", [217, 228, 312]),
    ("eight-term", [71, 71, 71]),
    ("eight-term-newton", [153, 159, 187]),
    ("eight-term-shamanskii", [202, 211, 277]),
    ("eight-term-newton2", [225, 236, 320]),
    ("cubic", [79, 79, 79]),
    ("cubic-newton", [161, 167, 195]),
    ("cubic-shamanskii", [210, 219, 285]),
    ("cubic-newton2", [233, 247, 328]),
    ("table", [92, 92, 92]),
    ("table-newton", [174, 180, 208]),
    ("table-shamanskii", [223, 232, 298]),
    ("table-newton2", [247, 260, 341]),
];

/// Cycles of a division or a square root beyond those of other instructions (Cortex-M4 Technical Reference Manual,
/// table 7-1: 14 for VDIV.F32 and VSQRT.F32, 1 for VADD.F32 and VMUL.F32).
const LONG: u32 = 13;

impl Evaluator {
    /// Instructions that one unit takes on a Cortex-M4F. `None` for polynomials of a degree that has not been counted.
    pub fn instructions(self, basis: Basis) -> Option<u32> {
        let column = Basis::ALL.iter().position(|&known| known == basis)?;
        let name = match self {
            Evaluator::Polynomial { degree } => format!("polynomial-{degree}"),
            Evaluator::Seeded { .. } => self.name(),
        };
        let (_, counts) = INSTRUCTIONS.iter().find(|(known, _)| *known == name)?;
        Some(counts[column])
    }

    /// About the cycles that one unit takes on a Cortex-M4F: instructions counted, and what divisions and roots take
    /// longer than others. `None` for polynomials of a degree that has not been counted.
    pub fn cost(self, basis: Basis) -> Option<u32> {
        Some(self.instructions(basis)? + LONG * self.divisions_and_roots())
    }

    /// One division per Jacobian: both residuals of Shamanskii's step share it.
    fn divisions_and_roots(self) -> u32 {
        match self {
            Evaluator::Polynomial { .. } => 0,
            Evaluator::Seeded { refinement, .. } => match refinement {
                Refinement::None => 2,
                Refinement::Newton | Refinement::Shamanskii => 3,
                Refinement::Newton2 => 4,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::airframe::Method;

    #[test]
    fn all_candidates_have_a_cost_and_stand_in_its_order() {
        for basis in Basis::ALL {
            let candidates = Evaluator::candidates(&Method::Auto, basis);
            assert_eq!(candidates.len(), INSTRUCTIONS.len());
            let costs: Vec<u32> = candidates
                .iter()
                .map(|evaluator| evaluator.cost(basis).unwrap_or_else(|| panic!("{evaluator:?}")))
                .collect();
            assert!(costs.is_sorted(), "{costs:?}");
        }
        assert_eq!(Evaluator::Polynomial { degree: 9 }.cost(Basis::Cubic), None);
    }
}
