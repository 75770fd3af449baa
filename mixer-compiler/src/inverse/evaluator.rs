//! The evaluators of the inverse map that the compiler can emit.

pub mod cost;

use crate::airframe::{METHODS, Method};

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
        /// Newton steps, 1 or 2.
        steps: u8,
    },
}

/// The terms of a seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeedForm {
    /// 1, x, y, xy.
    Bilinear,
    /// 1, x, y, xy, x2, y2.
    Quadratic,
    /// 1, x, y, xy, x2, y2, x2y, xy2, x3, y3.
    Cubic,
}

/// The evaluators that `method = "auto"` tries, by their cost: the order is that of any basis, and of
/// their names in [`METHODS`].
const CANDIDATES: [Evaluator; 6] = [
    seeded(SeedForm::Bilinear, 1),
    seeded(SeedForm::Quadratic, 1),
    seeded(SeedForm::Cubic, 1),
    seeded(SeedForm::Bilinear, 2),
    seeded(SeedForm::Quadratic, 2),
    seeded(SeedForm::Cubic, 2),
];

const fn seeded(seed: SeedForm, steps: u8) -> Evaluator {
    Evaluator::Seeded { seed, steps }
}

impl Evaluator {
    /// The evaluators that a method allows, by what they cost: the order in which they are tried.
    pub fn candidates(method: &Method) -> Vec<Evaluator> {
        match method {
            Method::Auto => CANDIDATES.to_vec(),
            Method::Polynomial { degree } => vec![Evaluator::Polynomial {
                degree: *degree as u8,
            }],
            Method::Named(name) => CANDIDATES
                .into_iter()
                .filter(|evaluator| evaluator.name() == name)
                .collect(),
        }
    }

    /// The name in airframe files (`inverse.method`), reports and JSON.
    pub fn name(self) -> &'static str {
        let [_, polynomial, seeded @ ..] = &METHODS;
        let index = CANDIDATES.iter().position(|candidate| *candidate == self);
        index
            .and_then(|index| seeded.get(index).copied())
            .unwrap_or(polynomial)
    }

    /// The name with its parameters, for people.
    pub fn description(self) -> String {
        match self {
            Evaluator::Polynomial { degree } => format!("polynomial in (f, Q) of degree {degree}"),
            Evaluator::Seeded { seed, steps } => {
                let newton = if steps == 1 {
                    "one Newton step"
                } else {
                    "2 Newton steps"
                };
                format!("{} seed in root coordinates, {newton}", seed.name())
            }
        }
    }
}

impl SeedForm {
    /// In names of evaluators.
    fn name(self) -> &'static str {
        match self {
            SeedForm::Bilinear => "bilinear",
            SeedForm::Quadratic => "quadratic",
            SeedForm::Cubic => "cubic",
        }
    }

    /// Number of coefficients per throttle.
    pub(crate) fn terms(self) -> usize {
        match self {
            SeedForm::Bilinear => 4,
            SeedForm::Quadratic => 6,
            SeedForm::Cubic => 10,
        }
    }

    /// The terms at (x, y), in the order of `mixer-rt`'s coefficients.
    pub(crate) fn row(self, x: f64, y: f64) -> Vec<f64> {
        let (x2, y2) = (x * x, y * y);
        let all = [1.0, x, y, x * y, x2, y2, x2 * y, x * y2, x2 * x, y2 * y];
        all[..self.terms()].to_vec()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_of_the_file_is_its_evaluator() {
        assert_eq!(METHODS.len(), 2 + CANDIDATES.len());
        for evaluator in CANDIDATES {
            let Evaluator::Seeded { seed, steps } = evaluator else {
                panic!("{evaluator:?} has no seed");
            };
            let newton = ["newton", "newton2"][usize::from(steps) - 1];
            assert_eq!(evaluator.name(), format!("{}-{newton}", seed.name()));
        }
        assert_eq!(Evaluator::Polynomial { degree: 3 }.name(), "polynomial");
    }
}
