//! Thrust or torque of a pair, rounded, whatever its basis.

use mixer_rt::tables::{Biquadratic, Cubic, Quantity, Quartic, Scalar};

use crate::airframe::Basis;

/// A quantity in any basis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum QuantityTable {
    /// Eight terms.
    Biquadratic(Biquadratic),
    /// Nine terms.
    Cubic(Cubic),
    /// Fourteen terms.
    Quartic(Quartic),
}

impl QuantityTable {
    /// Rounds the coefficients of a quantity.
    pub(super) fn new(basis: Basis, coefficients: &[f64]) -> Self {
        fn rounded<const TERMS: usize>(coefficients: &[f64]) -> [f32; TERMS] {
            std::array::from_fn(|index| coefficients.get(index).map_or(0.0, |&c| c as f32))
        }
        match basis {
            Basis::Biquadratic => QuantityTable::Biquadratic(Biquadratic(rounded(coefficients))),
            Basis::Cubic => QuantityTable::Cubic(Cubic(rounded(coefficients))),
            Basis::Quartic => QuantityTable::Quartic(Quartic(rounded(coefficients))),
        }
    }

    /// The coefficients in the order of the airframe file.
    pub(crate) fn coefficients(&self) -> &[f32] {
        match self {
            QuantityTable::Biquadratic(quantity) => &quantity.0,
            QuantityTable::Cubic(quantity) => &quantity.0,
            QuantityTable::Quartic(quantity) => &quantity.0,
        }
    }
}

impl Quantity for QuantityTable {
    fn value<S: Scalar>(&self, u: S, l: S) -> S {
        match self {
            QuantityTable::Biquadratic(quantity) => quantity.value(u, l),
            QuantityTable::Cubic(quantity) => quantity.value(u, l),
            QuantityTable::Quartic(quantity) => quantity.value(u, l),
        }
    }

    fn expansion<S: Scalar>(&self, u: S, l: S) -> [S; 5] {
        match self {
            QuantityTable::Biquadratic(quantity) => quantity.expansion(u, l),
            QuantityTable::Cubic(quantity) => quantity.expansion(u, l),
            QuantityTable::Quartic(quantity) => quantity.expansion(u, l),
        }
    }
}
