//! Mixes a short sequence of setpoints for the ISAE X8: hover, climb, roll, yaw, more yaw than
//! there is.

mixer_macros::airframe!("../../airframes/isae-x8.toml");

use mixer_rt::{SetpointError, Wrench};

const SETPOINTS: [[f32; 4]; 5] = [
    // roll, pitch, yaw (N m), thrust (N)
    [0.0, 0.0, 0.0, 31.0],
    [0.0, 0.0, 0.0, 45.0],
    [2.0, 0.0, 0.0, 31.0],
    [0.0, 0.0, 0.2, 31.0],
    [0.0, 0.0, 2.0, 31.0],
];

fn main() -> Result<(), SetpointError> {
    for setpoint in SETPOINTS.map(Wrench::from_array) {
        let mix = isae_x8::mix(&setpoint, 15.2)?;
        println!("asked     {:?}", setpoint.to_array());
        println!("achieved  {:.3?}", mix.achieved.to_array());
        println!("throttle  {:.3?}", mix.throttle);
        println!("saturated {}\n", mix.saturation.any_axis());
    }
    Ok(())
}
