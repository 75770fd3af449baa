//! The mathematics of one pair and of the frame: what is known before anything is fitted.
//!
//! `polynomial` is a tool; `pair_map` is the forward map, `injectivity` the proof that it can be
//! inverted, `effectiveness` M and M+ by `pseudo_inverse`, `voltage` the factors of thrust and torque.

pub mod effectiveness;
pub mod injectivity;
mod pair_map;
pub mod polynomial;
pub mod pseudo_inverse;
pub mod voltage;
pub mod wake;

pub use self::pair_map::PairMap;
