//! The paper's pair, for examples and tests: Table I in the order of the biquadratic basis.

/// Coefficients of thrust, N.
pub const THRUST: [f64; 8] = [
    5.2075, -2.1892, 12.3604, -10.2432, 4.4427, 2.7640, 12.2092, 0.2363,
];
/// Coefficients of torque, N m.
pub const TORQUE: [f64; 8] = [-0.0673, -0.0606, -0.1312, 0.0953, 0.0364, -0.0907, 0.1441, 0.0720];
