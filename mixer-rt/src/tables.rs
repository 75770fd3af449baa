//! Contents of generated modules: the tables of one airframe, the forms that their parts have,
//! and the functions that mix by them. Firmware that calls a generated module needs nothing of
//! this, and no two versions of it need agree: [`FORMAT`] says which one a module was generated for.

/// Format of these types and functions. It counts up with every change that a generated module can
/// see; the module asserts it at compile time.
pub const FORMAT: u32 = 3;

pub use crate::allocate::closed_form::{
    AllocationMethod, Border, Cell, ClosedForm, ClosedFormUnit, Facets, Grid, Knot, NoClosedForm, Outline,
    Steep,
};
pub use crate::allocate::interior::MOST_ITERATIONS;
pub use crate::allocate::least_norm;
pub use crate::allocate::least_norm::GUARD_LEAST_NORMS;
pub use crate::allocate::priorities::{Airmode, Priorities, REQUEST_LIMIT};
pub use crate::allocate::unit::UnitState;
pub use crate::arithmetic::{Scalar, sqrt};
pub use crate::conditions::{Law, LawPiece};
pub use crate::dynamic::{Lag, follow_given, mix_dynamic};
pub use crate::layout::{NO_CHANNEL, Tables, Tolerance, Unit};
pub use crate::mix::{Sealed, by_channel, mix, mix_into};
pub use crate::pair::{
    Biquadratic, Coefficients, Cubic, Inverse, Kinds, Pair, PairKind, PolynomialInverse, Quantity, Quartic,
    RotorAlone, ThrottleRange, Unlike, solve,
};
