//! The paper's manoeuvre: hover at constant x and y, steps in z, a yaw profile (Fig. 8, 9).
//!
//! The paper prints neither the times nor the yaw angles; it states a 1.5 m phase and a limited yaw
//! rate. Here z goes 1.0, 1.5, 1.0 m, and yaw goes to 90, 0, -90 and 0 degrees at 45 degrees/s
//! within the 1.5 m phase.

use std::ops::Range;

use nalgebra::Vector3;

/// Settling before the clock starts, s: the integrators find their trim and nothing is recorded.
pub const SETTLING_S: f64 = 30.0;

/// End of the manoeuvre, s.
pub const END_S: f64 = 100.0;

/// The hover before anything moves, s: where the thrust command is compared with the weight.
pub const HOVER_S: Range<f64> = 0.0..20.0;

/// The 1.5 m phase, s, without the first 10 s of the climb: where Table II considers z.
pub const HIGH_PHASE_S: Range<f64> = 30.0..80.0;

/// Altitude from a time on, (s, m).
const ALTITUDE: [(f64, f64); 3] = [(-SETTLING_S, 1.0), (20.0, 1.5), (80.0, 1.0)];

/// Yaw angle aimed at from a time on, (s, degrees).
const YAW: [(f64, f64); 4] = [(35.0, 90.0), (45.0, 0.0), (55.0, -90.0), (65.0, 0.0)];

/// Rate at which the yaw reference moves, degrees/s.
const YAW_RATE: f64 = 45.0;

/// What the vehicle is to follow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference {
    /// Position in the world, m; z is minus the altitude.
    pub position: Vector3<f64>,
    /// Yaw, rad.
    pub yaw: f64,
}

/// The reference at `time` seconds, from -[`SETTLING_S`] to [`END_S`].
pub fn reference(time: f64) -> Reference {
    let begun = ALTITUDE.iter().rev().find(|(start, _)| *start <= time);
    let altitude = begun.unwrap_or(&ALTITUDE[0]).1;
    let mut yaw = 0.0f64;
    for (start, angle) in YAW {
        let turned = (YAW_RATE * (time - start)).max(0.0);
        yaw += (angle - yaw).clamp(-turned, turned);
    }
    Reference {
        position: Vector3::new(0.0, 0.0, -altitude),
        yaw: yaw.to_radians(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reference_is_where_it_should_be() {
        let at = |time: f64| {
            let reference = reference(time);
            (-reference.position.z, reference.yaw.to_degrees().round())
        };
        assert_eq!(at(-SETTLING_S), (1.0, 0.0));
        assert_eq!(at(19.9), (1.0, 0.0));
        assert_eq!(at(20.0), (1.5, 0.0));
        assert_eq!(at(36.0), (1.5, 45.0));
        assert_eq!(at(40.0), (1.5, 90.0));
        assert_eq!(at(46.0), (1.5, 45.0));
        assert_eq!(at(60.0), (1.5, -90.0));
        assert_eq!(at(END_S), (1.0, 0.0));
    }
}
