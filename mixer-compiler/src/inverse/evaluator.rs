//! The forms of the inverse map that the compiler can emit: polynomials of `mixer_rt::tables`.

use crate::airframe::{Basis, Method};

/// A form of the inverse map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Evaluator {
    /// The paper's: a polynomial in (f, Q) of this total degree, at least 1.
    Polynomial {
        /// Total degree.
        degree: u8,
    },
    /// A polynomial in root coordinates, then Newton steps.
    Seed {
        /// Total degree.
        degree: u8,
        /// Newton steps, 1 or 2.
        steps: u8,
    },
}

/// The seeds that `method = "auto"` tries. The first three each won on more than one in twenty of the
/// public maps in the three bases; the last serves maps close to their fold.
const SEEDS: [Evaluator; 4] = [seed(2, 1), seed(3, 1), seed(2, 2), seed(3, 2)];

/// Instructions that one unit takes with each of [`SEEDS`] on a Cortex-M4F, with a biquadratic, a cubic
/// and a quartic pair. The order of their cost is that of any basis.
const INSTRUCTIONS: [[u32; 3]; 4] = [[145, 151, 179], [161, 167, 195], [217, 228, 312], [233, 247, 328]];

/// Cycles of a division or a square root beyond those of other instructions (Cortex-M4 Technical
/// Reference Manual, table 7-1: 14 for VDIV.F32 and VSQRT.F32, 1 for VADD.F32 and VMUL.F32).
const LONG: u32 = 13;

const fn seed(degree: u8, steps: u8) -> Evaluator {
    Evaluator::Seed { degree, steps }
}

impl Evaluator {
    /// The forms that a method allows, by their cost: the cheapest, and the others. `least` is that of the cheapest of
    /// [`SEEDS`] that will do.
    pub(crate) fn candidates(method: Method, least: usize) -> (Evaluator, &'static [Evaluator]) {
        match method {
            Method::Auto => (SEEDS[least], &SEEDS[least + 1..]),
            Method::Polynomial { degree } => (Evaluator::Polynomial { degree: degree as u8 }, &[]),
        }
    }

    /// Its place among [`SEEDS`]; 0 of the paper's.
    pub(crate) fn place(self) -> usize {
        SEEDS.iter().position(|&seed| seed == self).unwrap_or(0)
    }

    /// Total degree of the polynomial.
    pub fn degree(self) -> u8 {
        match self {
            Evaluator::Polynomial { degree } | Evaluator::Seed { degree, .. } => degree,
        }
    }

    /// Newton steps after it.
    pub fn steps(self) -> u8 {
        match self {
            Evaluator::Polynomial { .. } => 0,
            Evaluator::Seed { steps, .. } => steps,
        }
    }

    /// The name in reports and JSON.
    pub fn name(self) -> String {
        match self {
            Evaluator::Polynomial { degree } => format!("polynomial-{degree}"),
            Evaluator::Seed { degree, steps } => format!("seed-{degree}-newton-{steps}"),
        }
    }

    /// The form in words.
    pub fn description(self) -> String {
        match self {
            Evaluator::Polynomial { degree } => format!("polynomial in (f, Q) of degree {degree}"),
            Evaluator::Seed { degree, steps } => {
                let newton = if steps == 1 {
                    "one Newton step"
                } else {
                    "2 Newton steps"
                };
                format!("polynomial of degree {degree} in root coordinates, {newton}")
            }
        }
    }

    /// Instructions that one unit takes on a Cortex-M4F; `None` for the paper's polynomials.
    pub fn instructions(self, basis: Basis) -> Option<u32> {
        let row = SEEDS.iter().position(|&seed| seed == self)?;
        let column = Basis::ALL.iter().position(|&known| known == basis)?;
        Some(INSTRUCTIONS[row][column])
    }

    /// About the cycles that they take: two roots and a division per step take longer than other
    /// instructions.
    pub fn cost(self, basis: Basis) -> Option<u32> {
        Some(self.instructions(basis)? + LONG * (2 + u32::from(self.steps())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn candidates_stand_in_the_order_of_their_cost() {
        for basis in Basis::ALL {
            let (cheapest, others) = Evaluator::candidates(Method::Auto, 0);
            let candidates = std::iter::once(&cheapest).chain(others);
            let costs: Vec<u32> = candidates
                .map(|evaluator| evaluator.cost(basis).unwrap_or_else(|| panic!("{evaluator:?}")))
                .collect();
            assert!(costs.is_sorted(), "{costs:?}");
        }
        assert_eq!(Evaluator::Polynomial { degree: 9 }.cost(Basis::Cubic), None);
    }
}
