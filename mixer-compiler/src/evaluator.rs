//! The evaluators of the inverse map that the compiler can emit, cheapest first.

use crate::airframe::Method;

/// A form of the inverse map; `mixer-rt` has the code of each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Evaluator {
    /// The paper's polynomial in (f, Q) of this total degree.
    Polynomial {
        /// Total degree, >= 1.
        degree: u8,
    },
    /// A seed in root coordinates, then Newton steps.
    Seeded {
        /// Form of the seed.
        seed: SeedForm,
        /// Newton steps, 0 to 2.
        steps: u8,
    },
}

/// The terms of a seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeedForm {
    /// 1, x, y, xy.
    Bilinear,
    /// 1, x, y, xy, x2, y2, x2y, xy2.
    EightTerm,
}

const fn seeded(seed: SeedForm, steps: u8) -> Evaluator {
    Evaluator::Seeded { seed, steps }
}

/// What `method = "auto"` tries, by instructions per unit on a Cortex-M4F (counted in QEMU, `tests/firmware.rs`).
/// Polynomials above degree 5 cost more than a seed and a Newton step and are worse by an order of magnitude.
const CANDIDATES: [Evaluator; 9] = [
    Evaluator::Polynomial { degree: 2 },
    Evaluator::Polynomial { degree: 3 },
    seeded(SeedForm::Bilinear, 0),
    seeded(SeedForm::EightTerm, 0),
    Evaluator::Polynomial { degree: 5 },
    seeded(SeedForm::Bilinear, 1),
    seeded(SeedForm::EightTerm, 1),
    seeded(SeedForm::Bilinear, 2),
    seeded(SeedForm::EightTerm, 2),
];

impl Evaluator {
    /// The evaluators that a method allows, in the order in which they are tried.
    pub fn candidates(method: &Method) -> Vec<Evaluator> {
        match method {
            Method::Auto => CANDIDATES.to_vec(),
            Method::Polynomial { degree } => vec![Evaluator::Polynomial {
                degree: *degree as u8,
            }],
            Method::Named(name) => CANDIDATES
                .into_iter()
                .filter(|evaluator| evaluator.name() == *name)
                .collect(),
        }
    }

    /// The name in airframe files (`inverse.method`), reports and JSON.
    pub fn name(self) -> &'static str {
        match self {
            Evaluator::Polynomial { .. } => "polynomial",
            Evaluator::Seeded {
                seed: SeedForm::Bilinear,
                steps: 0,
            } => "bilinear",
            Evaluator::Seeded {
                seed: SeedForm::Bilinear,
                steps: 1,
            } => "bilinear-newton",
            Evaluator::Seeded {
                seed: SeedForm::Bilinear,
                ..
            } => "bilinear-newton2",
            Evaluator::Seeded {
                seed: SeedForm::EightTerm,
                steps: 0,
            } => "eight-term",
            Evaluator::Seeded {
                seed: SeedForm::EightTerm,
                steps: 1,
            } => "eight-term-newton",
            Evaluator::Seeded {
                seed: SeedForm::EightTerm,
                ..
            } => "eight-term-newton2",
        }
    }

    /// The name with its parameters, for people.
    pub fn description(self) -> String {
        match self {
            Evaluator::Polynomial { degree } => format!("polynomial in (f, Q) of degree {degree}"),
            Evaluator::Seeded { seed, steps } => {
                let seed = match seed {
                    SeedForm::Bilinear => "bilinear seed",
                    SeedForm::EightTerm => "8-term seed",
                };
                match steps {
                    0 => format!("{seed} in root coordinates"),
                    1 => format!("{seed} in root coordinates, one Newton step"),
                    _ => format!("{seed} in root coordinates, {steps} Newton steps"),
                }
            }
        }
    }
}

impl SeedForm {
    /// Number of terms.
    pub fn terms(self) -> usize {
        match self {
            SeedForm::Bilinear => 4,
            SeedForm::EightTerm => 8,
        }
    }

    /// The terms at (x, y), in the order of `mixer-rt`'s seeds; those beyond [`SeedForm::terms`] are not used.
    pub fn monomials(self, x: f64, y: f64) -> [f64; 8] {
        [1.0, x, y, x * y, x * x, y * y, x * x * y, x * y * y]
    }
}
