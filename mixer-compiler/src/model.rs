//! The mathematics of one pair and of the frame: what is known before anything is fitted.
//!
//! `polynomial` is a tool; `pair_map` is the forward map, `injectivity` the proof that it can be
//! inverted, `effectiveness` M and M+ by `pseudo_inverse`, `law` the factors of voltage and density.

pub mod effectiveness;
pub mod injectivity;
pub mod law;
mod pair_map;
pub mod polynomial;
pub mod pseudo_inverse;
pub mod wake;

pub use self::pair_map::PairMap;
