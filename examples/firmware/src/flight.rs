//! The flight of the example: what a rate controller would ask for.

use mixer_rt::Wrench;

/// The wrench that a rate controller would ask for in cycle `cycle` of the flight; `None` after
/// landing.
///
/// Hover, roll and pitch, a full yaw step, three lost estimates (held), hover again, and an
/// estimator that fails for good (disarmed).
pub(crate) fn setpoint(cycle: u32) -> Option<Wrench> {
    let hover = Wrench {
        roll_nm: 0.0,
        pitch_nm: 0.0,
        yaw_nm: 0.0,
        thrust_n: 40.0,
    };
    let lost = Wrench {
        yaw_nm: f32::NAN,
        ..hover
    };
    match cycle {
        0..400 => Some(hover),
        400..600 => Some(Wrench {
            roll_nm: 1.5,
            pitch_nm: -0.75,
            ..hover
        }),
        600..800 => Some(Wrench { yaw_nm: 2.0, ..hover }),
        800..803 => Some(lost),
        803..1200 => Some(hover),
        1200..1300 => Some(lost),
        _ => None,
    }
}
