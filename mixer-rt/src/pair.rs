//! One coaxial pair: the efforts `[f, Q]` of two throttles, the throttles of two efforts, and a
//! rotor alone.

pub(crate) mod alone;
mod forward;
mod inverse;
mod kind;
pub(crate) mod rotors;

pub use alone::RotorAlone;
pub(crate) use forward::Expansion;
pub use forward::{Biquadratic, Cubic, Pair, Quantity, Quartic};
pub use inverse::{Coefficients, Inverse, PolynomialInverse, ThrottleRange, solve};
pub use kind::{Kinds, PairKind, Unlike};
