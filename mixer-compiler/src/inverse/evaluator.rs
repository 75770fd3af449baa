//! The evaluators of the inverse map that the compiler can emit.

pub mod cost;

use mixer_rt::TableSeed;

use crate::airframe::{Basis, Method};

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
        /// Steps on the forward map.
        refinement: Refinement,
    },
}

/// The terms of a seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeedForm {
    /// 1, x, y, xy.
    Bilinear,
    /// 1, x, y, xy, x2, y2.
    Quadratic,
    /// 1, x, y, xy, x2, y2, x2y, xy2.
    EightTerm,
    /// 1, x, y, xy, x2, y2, x2y, xy2, x3, y3.
    Cubic,
    /// Bilinear between 4 x 4 knots.
    Table,
}

/// What follows a seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refinement {
    /// Nothing.
    None,
    /// One Newton step.
    Newton,
    /// One Jacobian, two residuals (Shamanskii 1967).
    Shamanskii,
    /// Two Newton steps.
    Newton2,
}

impl Refinement {
    /// Jacobians, and residuals of each.
    pub fn steps(self) -> (u8, u8) {
        match self {
            Refinement::None => (0, 1),
            Refinement::Newton => (1, 1),
            Refinement::Shamanskii => (1, 2),
            Refinement::Newton2 => (2, 1),
        }
    }
}

const fn seeded(seed: SeedForm, refinement: Refinement) -> Evaluator {
    Evaluator::Seeded { seed, refinement }
}

/// What `method = "auto"` tries.
const CANDIDATES: [Evaluator; 23] = [
    Evaluator::Polynomial { degree: 2 },
    Evaluator::Polynomial { degree: 3 },
    seeded(SeedForm::Bilinear, Refinement::None),
    seeded(SeedForm::Quadratic, Refinement::None),
    seeded(SeedForm::EightTerm, Refinement::None),
    seeded(SeedForm::Cubic, Refinement::None),
    seeded(SeedForm::Table, Refinement::None),
    Evaluator::Polynomial { degree: 5 },
    seeded(SeedForm::Bilinear, Refinement::Newton),
    seeded(SeedForm::Quadratic, Refinement::Newton),
    seeded(SeedForm::EightTerm, Refinement::Newton),
    seeded(SeedForm::Cubic, Refinement::Newton),
    seeded(SeedForm::Table, Refinement::Newton),
    seeded(SeedForm::Bilinear, Refinement::Shamanskii),
    seeded(SeedForm::Quadratic, Refinement::Shamanskii),
    seeded(SeedForm::EightTerm, Refinement::Shamanskii),
    seeded(SeedForm::Cubic, Refinement::Shamanskii),
    seeded(SeedForm::Table, Refinement::Shamanskii),
    seeded(SeedForm::Bilinear, Refinement::Newton2),
    seeded(SeedForm::Quadratic, Refinement::Newton2),
    seeded(SeedForm::EightTerm, Refinement::Newton2),
    seeded(SeedForm::Cubic, Refinement::Newton2),
    seeded(SeedForm::Table, Refinement::Newton2),
];

impl Evaluator {
    /// The evaluators that a method allows, by what they cost with a pair of this basis: the order in which they are
    /// tried.
    pub fn candidates(method: &Method, basis: Basis) -> Vec<Evaluator> {
        let mut candidates = match method {
            Method::Auto => CANDIDATES.to_vec(),
            Method::Polynomial { degree } => vec![Evaluator::Polynomial {
                degree: *degree as u8,
            }],
            Method::Named(name) => CANDIDATES
                .into_iter()
                .filter(|evaluator| evaluator.name() == *name)
                .collect(),
        };
        candidates.sort_by_key(|evaluator| evaluator.cost(basis));
        candidates
    }

    /// The name in airframe files (`inverse.method`), reports and JSON.
    pub fn name(self) -> String {
        match self {
            Evaluator::Polynomial { .. } => "polynomial".to_owned(),
            Evaluator::Seeded { seed, refinement } => {
                let seed = match seed {
                    SeedForm::Bilinear => "bilinear",
                    SeedForm::Quadratic => "quadratic",
                    SeedForm::EightTerm => "eight-term",
                    SeedForm::Cubic => "cubic",
                    SeedForm::Table => "table",
                };
                let refinement = match refinement {
                    Refinement::None => "",
                    Refinement::Newton => "-newton",
                    Refinement::Shamanskii => "-shamanskii",
                    Refinement::Newton2 => "-newton2",
                };
                format!("{seed}{refinement}")
            }
        }
    }

    /// The name with its parameters, for people.
    pub fn description(self) -> String {
        match self {
            Evaluator::Polynomial { degree } => format!("polynomial in (f, Q) of degree {degree}"),
            Evaluator::Seeded { seed, refinement } => {
                let seed = match seed {
                    SeedForm::Bilinear => "bilinear",
                    SeedForm::Quadratic => "quadratic",
                    SeedForm::EightTerm => "8-term",
                    SeedForm::Cubic => "cubic",
                    SeedForm::Table => "4 x 4 table",
                };
                let refinement = match refinement {
                    Refinement::None => "",
                    Refinement::Newton => ", one Newton step",
                    Refinement::Shamanskii => ", one Jacobian with two residuals",
                    Refinement::Newton2 => ", 2 Newton steps",
                };
                format!("{seed} seed in root coordinates{refinement}")
            }
        }
    }
}

impl SeedForm {
    /// Number of coefficients per throttle.
    pub fn terms(self) -> usize {
        match self {
            SeedForm::Bilinear => 4,
            SeedForm::Quadratic => 6,
            SeedForm::EightTerm => 8,
            SeedForm::Cubic => 10,
            SeedForm::Table => 16,
        }
    }

    /// What the coefficients are multiplied by at (x, y), in the order of `mixer-rt`'s seeds; for a table, whose
    /// knots are at whole numbers from 0 to 3, the shares of its knots.
    pub fn row(self, x: f64, y: f64) -> Vec<f64> {
        if self == SeedForm::Table {
            return shares(x, y);
        }
        let (x2, y2) = (x * x, y * y);
        let all = [1.0, x, y, x * y, x2, y2, x2 * y, x * y2, x2 * x, y2 * y];
        all[..self.terms()].to_vec()
    }
}

/// Shares of the 4 x 4 knots in bilinear interpolation.
fn shares(x: f64, y: f64) -> Vec<f64> {
    let cell = |x: f64| (x as usize).min(TableSeed::LAST_CELL);
    let (i, j) = (cell(x), cell(y));
    let (a, b) = (x - i as f64, y - j as f64);
    let mut shares = vec![0.0; 16];
    for (knot, share) in [
        (0, (1.0 - a) * (1.0 - b)),
        (4, a * (1.0 - b)),
        (1, (1.0 - a) * b),
        (5, a * b),
    ] {
        shares[4 * i + j + knot] = share;
    }
    shares
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::airframe::EVALUATORS;

    #[test]
    fn every_name_of_the_file_is_an_evaluator() {
        let names: Vec<String> = CANDIDATES
            .iter()
            .map(|evaluator| evaluator.name())
            .filter(|name| name != "polynomial")
            .collect();
        for name in &names {
            assert!(EVALUATORS.contains(&name.as_str()), "{name}");
        }
        assert_eq!(names.len(), EVALUATORS.len());
    }
}
