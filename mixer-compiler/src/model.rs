//! The mathematics of one pair and of the frame: what is known before anything is fitted.
//!
//! `polynomial`, `bernstein` and `interval` are tools; `pair_map` is the forward map, `injectivity`
//! the proof that it can be inverted, `effectiveness` M and M+, `voltage` the factors of thrust and
//! torque.

pub mod bernstein;
pub mod effectiveness;
pub mod injectivity;
pub mod interval;
mod pair_map;
pub mod polynomial;
pub mod voltage;

pub use self::pair_map::PairMap;
