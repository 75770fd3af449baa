//! What evaluators cost on a Cortex-M4F, counted.

use super::Evaluator;
use crate::airframe::Basis;

/// Instructions per unit, by the name in airframe files (a polynomial's with its degree), with a
/// biquadratic, a cubic and a quartic pair. Counted in QEMU by
///
/// ```sh
/// cargo xtask evaluators
/// ```
///
/// which prints these lines; the firmware test fails where they are no longer true.
pub const INSTRUCTIONS: [(&str, [u32; 3]); 9] = [
    ("polynomial-2", [80, 80, 80]),
    ("polynomial-3", [98, 98, 98]),
    ("polynomial-5", [148, 148, 148]),
    ("bilinear-newton", [137, 143, 171]),
    ("bilinear-newton2", [209, 220, 304]),
    ("quadratic-newton", [145, 151, 179]),
    ("quadratic-newton2", [217, 228, 312]),
    ("cubic-newton", [161, 167, 195]),
    ("cubic-newton2", [233, 247, 328]),
];

/// Cycles of a division or a square root beyond those of other instructions (Cortex-M4 Technical
/// Reference Manual, table 7-1: 14 for VDIV.F32 and VSQRT.F32, 1 for VADD.F32 and VMUL.F32).
const LONG: u32 = 13;

impl Evaluator {
    /// Instructions that one unit takes on a Cortex-M4F. `None` for polynomials of a degree that
    /// has not been counted.
    pub fn instructions(self, basis: Basis) -> Option<u32> {
        let column = Basis::ALL.iter().position(|&known| known == basis)?;
        let name = match self {
            Evaluator::Polynomial { degree } => format!("polynomial-{degree}"),
            Evaluator::Seeded { .. } => self.name().to_owned(),
        };
        let (_, counts) = INSTRUCTIONS.iter().find(|(known, _)| *known == name)?;
        Some(counts[column])
    }

    /// About the cycles that one unit takes on a Cortex-M4F: instructions counted, and what
    /// divisions and roots take longer than others. `None` for polynomials of a degree that has not
    /// been counted.
    pub fn cost(self, basis: Basis) -> Option<u32> {
        Some(self.instructions(basis)? + LONG * self.divisions_and_roots())
    }

    /// Two roots of the coordinates, one division per Newton step.
    fn divisions_and_roots(self) -> u32 {
        match self {
            Evaluator::Polynomial { .. } => 0,
            Evaluator::Seeded { steps, .. } => 2 + u32::from(steps),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::airframe::Method;

    #[test]
    fn candidates_stand_in_the_order_of_their_cost() {
        for basis in Basis::ALL {
            let candidates = Evaluator::candidates(&Method::Auto);
            let costs: Vec<u32> = candidates
                .iter()
                .map(|evaluator| evaluator.cost(basis).unwrap_or_else(|| panic!("{evaluator:?}")))
                .collect();
            assert!(costs.is_sorted(), "{costs:?}");
        }
        assert_eq!(Evaluator::Polynomial { degree: 9 }.cost(Basis::Cubic), None);
    }
}
