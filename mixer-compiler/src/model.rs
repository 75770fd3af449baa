//! The mathematics of one unit and of the frame: what is known before anything is fitted.
//!
//! `polynomial` is a tool; `pair_map` is the forward map, `injectivity` the proof that it can be
//! inverted, `effectiveness` M and M+ by `pseudo_inverse`, `law` the factors of voltage and
//! density, `physics` the wrench of given throttles.

pub mod effectiveness;
pub mod injectivity;
pub mod law;
mod pair_map;
mod physics;
pub mod polynomial;
pub mod pseudo_inverse;
pub mod wake;

pub use self::pair_map::{PairMap, equal_throttle, maps, mean, scales};
pub use self::physics::Physics;

/// The range of torque per thrust, m, beyond which no propeller is: open ones of 4 to 40 inch with an ample
/// margin.
pub const TORQUE_PER_THRUST_M: [f64; 2] = [0.002, 0.12];

/// The range of Q over the largest f of one unit, m: 0.016 to 0.034 on maps of 11 to 22 inch. It is
/// about the propeller's diameter over 17, so that these limits stand for 4 to 40 inch. The nearest
/// unit that may be mistaken, pounds of force, is a factor of 4.4 away.
pub const TORQUE_SPAN_M: [f64; 2] = [0.005, 0.065];

/// The power of the throttle with which thrust at one voltage grows along equal throttles, from the middle to full: 1.3 to 2.05
/// on runs of four laboratories, the least of speed controllers that shape their throttle; about 1 where something linearised it.
pub const GROWTH: [f64; 2] = [1.25, 2.2];
