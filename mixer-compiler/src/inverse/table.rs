//! The numbers of an inverse map, rounded.

use mixer_rt::tables::{Inverse, Pair, PolynomialInverse, Quantity, Scalar, ThrottleRange};

use super::evaluator::Evaluator;

/// A [`PolynomialInverse`] of any degree and number of steps.
#[derive(Clone, Debug, PartialEq)]
pub struct InverseTable {
    /// Its degree and steps.
    pub(crate) evaluator: Evaluator,
    /// [`PolynomialInverse::forms`].
    pub(crate) forms: [[f32; 3]; 2],
    /// Coefficients of the upper and of the lower throttle.
    pub(crate) coefficients: [Vec<f32>; 2],
}

impl InverseTable {
    /// Rounds the linear forms and the coefficients of both throttles.
    pub(super) fn new(evaluator: Evaluator, forms: [[f64; 3]; 2], coefficients: [Vec<f64>; 2]) -> Self {
        InverseTable {
            evaluator,
            forms: forms.map(|factors| factors.map(|x| x as f32)),
            coefficients: coefficients.map(|c| c.into_iter().map(|x| x as f32).collect()),
        }
    }

    /// The inverse as `mixer-rt` reads it, of `STEPS` Newton steps.
    fn with<const STEPS: usize>(&self) -> PolynomialInverse<&[f32], STEPS> {
        let [upper, lower] = &self.coefficients;
        PolynomialInverse {
            forms: self.forms,
            upper,
            lower,
        }
    }

    /// The throttles `[u, l]` before any step, not limited to the range.
    pub(crate) fn guess<S: Scalar>(&self, efforts: [S; 2]) -> [S; 2] {
        match self.evaluator.steps() {
            0 => self.with::<0>().guess(efforts),
            _ => self.with::<1>().guess(efforts),
        }
    }
}

impl Inverse for &InverseTable {
    fn throttles<P: Quantity>(&self, pair: &Pair<P>, range: &ThrottleRange, efforts: [f32; 2]) -> [f32; 2] {
        (**self).throttles(pair, range, efforts)
    }
}

impl Inverse for InverseTable {
    fn throttles<P: Quantity>(&self, pair: &Pair<P>, range: &ThrottleRange, efforts: [f32; 2]) -> [f32; 2] {
        match self.evaluator.steps() {
            0 => self.with::<0>().throttles(pair, range, efforts),
            1 => self.with::<1>().throttles(pair, range, efforts),
            _ => self.with::<2>().throttles(pair, range, efforts),
        }
    }
}
