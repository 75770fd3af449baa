//! The numbers of an inverse map, whatever its form.

use mixer_rt::tables::{
    BilinearSeed, CubicSeed, Inverse, Pair, PolynomialInverse, QuadraticSeed, Quantity, RootCoordinates,
    Scalar, Seed, Seeded, ThrottleRange,
};

use crate::inverse::evaluator::SeedForm;
use crate::inverse::fit::FittedInverse;

/// An inverse in any form.
#[derive(Clone, Debug, PartialEq)]
pub enum InverseTable {
    /// [`PolynomialInverse`].
    Polynomial(PolynomialTable),
    /// [`Seeded`].
    Seeded {
        /// The coordinates.
        coordinates: RootCoordinates,
        /// The seed.
        seed: SeedTable,
        /// Newton steps.
        steps: u8,
    },
}

/// [`PolynomialInverse`] with its coefficients.
#[derive(Clone, Debug, PartialEq)]
pub struct PolynomialTable {
    /// Scale and offset of f.
    pub thrust: [f32; 2],
    /// Scale and offset of Q.
    pub torque: [f32; 2],
    /// Total degree.
    pub degree: u8,
    /// Coefficients of u and of l.
    pub coefficients: [Vec<f32>; 2],
}

impl PolynomialTable {
    /// The polynomials as `mixer-rt` reads them.
    pub(crate) fn view(&self) -> PolynomialInverse<'_> {
        let [upper, lower] = &self.coefficients;
        PolynomialInverse {
            thrust: self.thrust,
            torque: self.torque,
            degree: self.degree,
            upper,
            lower,
        }
    }
}

/// A seed in any form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SeedTable {
    /// Four terms per throttle.
    Bilinear(BilinearSeed),
    /// Six terms per throttle.
    Quadratic(QuadraticSeed),
    /// Ten terms per throttle.
    Cubic(CubicSeed),
}

impl SeedTable {
    /// Rounds the coefficients of u and of l.
    fn new(form: SeedForm, [upper, lower]: [&[f64]; 2]) -> Self {
        fn rounded<const TERMS: usize>(coefficients: &[f64]) -> [f32; TERMS] {
            std::array::from_fn(|index| coefficients.get(index).map_or(0.0, |&c| c as f32))
        }
        match form {
            SeedForm::Bilinear => SeedTable::Bilinear(BilinearSeed {
                upper: rounded(upper),
                lower: rounded(lower),
            }),
            SeedForm::Quadratic => SeedTable::Quadratic(QuadraticSeed {
                upper: rounded(upper),
                lower: rounded(lower),
            }),
            SeedForm::Cubic => SeedTable::Cubic(CubicSeed {
                upper: rounded(upper),
                lower: rounded(lower),
            }),
        }
    }
}

impl Seed for SeedTable {
    fn guess<S: Scalar>(&self, x: S, y: S) -> [S; 2] {
        match self {
            SeedTable::Bilinear(seed) => seed.guess(x, y),
            SeedTable::Quadratic(seed) => seed.guess(x, y),
            SeedTable::Cubic(seed) => seed.guess(x, y),
        }
    }
}

impl InverseTable {
    /// Rounds a fitted inverse.
    pub(crate) fn new(fitted: &FittedInverse) -> Self {
        match fitted {
            FittedInverse::Polynomial {
                degree,
                thrust,
                torque,
                coefficients,
            } => InverseTable::Polynomial(PolynomialTable {
                thrust: thrust.map(|x| x as f32),
                torque: torque.map(|x| x as f32),
                degree: *degree,
                coefficients: coefficients
                    .clone()
                    .map(|c| c.iter().map(|&x| x as f32).collect()),
            }),
            FittedInverse::Seeded {
                seed,
                steps,
                coordinates,
                coefficients: [upper, lower],
            } => InverseTable::Seeded {
                coordinates: RootCoordinates {
                    x: coordinates.x.map(|x| x as f32),
                    y: coordinates.y.map(|x| x as f32),
                },
                seed: SeedTable::new(*seed, [upper, lower]),
                steps: *steps,
            },
        }
    }

    /// Newton steps.
    pub fn steps(&self) -> u8 {
        match self {
            InverseTable::Polynomial(_) => 0,
            InverseTable::Seeded { steps, .. } => *steps,
        }
    }

    /// The throttles `[u, l]` before any step, not limited to the range.
    pub fn guess<S: Scalar>(&self, efforts: [S; 2]) -> [S; 2] {
        match self {
            InverseTable::Polynomial(polynomial) => polynomial.view().guess(efforts),
            InverseTable::Seeded {
                coordinates, seed, ..
            } => {
                let [x, y] = coordinates.at(efforts);
                seed.guess(x, y)
            }
        }
    }
}

impl<P: Quantity> Inverse<P> for &InverseTable {
    fn throttles(&self, pair: &Pair<P>, range: &ThrottleRange, efforts: [f32; 2]) -> [f32; 2] {
        fn seeded<P: Quantity, const STEPS: usize>(
            coordinates: RootCoordinates,
            seed: SeedTable,
            pair: &Pair<P>,
            range: &ThrottleRange,
            efforts: [f32; 2],
        ) -> [f32; 2] {
            Seeded::<SeedTable, STEPS> { coordinates, seed }.throttles(pair, range, efforts)
        }
        match self {
            InverseTable::Polynomial(polynomial) => polynomial.view().throttles(pair, range, efforts),
            InverseTable::Seeded {
                coordinates,
                seed,
                steps,
            } => {
                let evaluate = match steps {
                    0 => seeded::<P, 0>,
                    1 => seeded::<P, 1>,
                    _ => seeded::<P, 2>,
                };
                evaluate(*coordinates, *seed, pair, range, efforts)
            }
        }
    }
}
