//! Mixers written by `build.rs`, and code that is generic over airframes.

use mixer_rt::{Airframe, Outputs, SetpointError, Wrench};

include!(concat!(env!("OUT_DIR"), "/isae-x8.rs"));
include!(concat!(env!("OUT_DIR"), "/px4-y6.rs"));

fn main() -> Result<(), SetpointError> {
    let hover_and_roll = [[0.0, 0.0, 0.0, 31.0], [1.0, 0.0, 0.0, 31.0]].map(Wrench::from_array);
    print::<isae_x8::IsaeX8>(&hover_and_roll, 14.8)?;
    print::<px4_y6::Px4Y6>(&hover_and_roll, 14.8)
}

/// Mixes for any airframe and prints the throttles.
fn print<A: Airframe>(setpoints: &[Wrench], voltage_v: f32) -> Result<(), SetpointError> {
    println!("{}, {} rotors", A::NAME, A::CHANNELS);
    for setpoint in setpoints {
        println!("  throttle {:.3?}", A::mix(setpoint, voltage_v)?.throttle());
    }
    Ok(())
}
