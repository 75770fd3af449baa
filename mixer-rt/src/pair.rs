//! One coaxial pair: the efforts `[f, Q]` of two throttles, the throttles of two efforts, and a
//! rotor alone.

mod forward;
mod inverse;
mod kind;
pub(crate) mod rotors;
pub(crate) mod single;

pub(crate) use forward::Expansion;
pub use forward::{Biquadratic, Cubic, Pair, Quantity, Quartic};
pub use inverse::{Coefficients, Inverse, PolynomialInverse, ThrottleRange, solve};
pub use kind::{Kind, Unlike, WithSingleRotors};
pub use single::SingleRotor;
