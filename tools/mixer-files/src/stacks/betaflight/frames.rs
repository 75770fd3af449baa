//! Betaflight's frames of coaxial pairs.

/// Betaflight's coaxial tables (`mixerOctoX8`, `mixerOctoX8P`, `mixerY6`): roll, pitch, yaw; throttle is 1. The
/// second half of the motors is under the first. The command line has `OCTOX8P` since 2025.12.
#[rustfmt::skip]
pub(crate) const TABLES: [(&str, &[[f64; 3]]); 3] = [
    ("OCTOX8", &[
        [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0], [1.0, 1.0, 1.0], [1.0, -1.0, -1.0],
        [-1.0, 1.0, 1.0], [-1.0, -1.0, -1.0], [1.0, 1.0, -1.0], [1.0, -1.0, 1.0],
    ]),
    ("OCTOX8P", &[
        [0.0, 1.0, -1.0], [-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, -1.0, -1.0],
        [0.0, 1.0, 1.0], [-1.0, 0.0, -1.0], [1.0, 0.0, -1.0], [0.0, -1.0, 1.0],
    ]),
    ("Y6", &[
        [0.0, 1.333_333, 1.0], [-1.0, -0.666_667, -1.0], [1.0, -0.666_667, -1.0],
        [0.0, 1.333_333, -1.0], [-1.0, -0.666_667, 1.0], [1.0, -0.666_667, 1.0],
    ]),
];
