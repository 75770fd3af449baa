//! Which rotor works in the wake, told by the torque of the pair.
//!
//! The wake unloads the lower rotor, so that at equal throttles the upper one takes more torque:
//! with Q = Q_lower - Q_upper the mean of Q over the throttle box is negative. Exchanged rotors
//! and a torque of the other sign both turn the sign of this mean; one alone makes det J negative,
//! both together leave it positive. So the two signs tell which of the two happened.

/// Size of the mean torque, in shares of the largest, from which its sign tells the wake. 159 fits
/// of real maps have -0.143 to -0.039 (`tools/cargo-mixer/tests/commands/maps_warn.rs`), with the rotors exchanged
/// the same above zero; the paper's own table is between, at +0.015.
const TELLS: f64 = 0.025;

/// Points per side of the grid of the mean.
const GRID: u32 = 32;

/// What the torque says of the order of the rotors, where det J is positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wake {
    /// The lower rotor is in the wake.
    Below,
    /// The rotor that is called the upper one is in the wake.
    Above,
    /// The torque does not tell.
    Unknown,
}

/// The mean of a torque over the box `[low, high]` squared, in shares of its largest size.
pub fn mean_torque(torque: impl Fn([f64; 2]) -> f64, [low, high]: [f64; 2]) -> f64 {
    let at = |k: u32| low + (high - low) * f64::from(k) / f64::from(GRID);
    let (mut sum, mut largest) = (0.0, 0.0f64);
    for (i, j) in (0..=GRID).flat_map(|i| (0..=GRID).map(move |j| (i, j))) {
        let q = torque([at(i), at(j)]);
        sum += q;
        largest = largest.max(q.abs());
    }
    if largest > 0.0 {
        sum / f64::from((GRID + 1) * (GRID + 1)) / largest
    } else {
        0.0
    }
}

impl Wake {
    /// What a mean torque says, as [`mean_torque`] gives it.
    pub fn of_torque(mean: f64) -> Wake {
        match mean {
            mean if mean < -TELLS => Wake::Below,
            mean if mean > TELLS => Wake::Above,
            _ => Wake::Unknown,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_wake_is_on_the_side_of_the_smaller_torque() {
        let pair = |u: f64, l: f64| 0.16 * l * l - 0.2 * u * u;
        let told = |torque: &dyn Fn([f64; 2]) -> f64| Wake::of_torque(mean_torque(torque, [0.1, 1.0]));
        assert_eq!(told(&|[u, l]| pair(u, l)), Wake::Below);
        // Both rotors and sign: det J stays positive.
        assert_eq!(told(&|[u, l]| -pair(l, u)), Wake::Above);
        assert_eq!(told(&|[u, l]| 0.2 * (l * l - u * u)), Wake::Unknown);
        assert_eq!(told(&|_| 0.0), Wake::Unknown);
    }
}
