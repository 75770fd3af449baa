//! Mixers written by `build.rs`, and code that is generic over airframes.

use mixer_rt::{Airframe, Mix, SetpointError, Wrench};

include!(concat!(env!("OUT_DIR"), "/isae-x8.rs"));
include!(concat!(env!("OUT_DIR"), "/px4-y6.rs"));

/// Mixes for any airframe; `CHANNELS` follows from it.
fn mix_all<A, const CHANNELS: usize>(
    setpoints: &[Wrench],
    voltage_v: f32,
) -> Result<Vec<Mix<CHANNELS>>, SetpointError>
where
    A: Airframe<Mix = Mix<CHANNELS>>,
{
    setpoints
        .iter()
        .map(|setpoint| A::mix(setpoint, voltage_v))
        .collect()
}

fn main() -> Result<(), SetpointError> {
    let hover_and_roll = [[0.0, 0.0, 0.0, 31.0], [1.0, 0.0, 0.0, 31.0]].map(Wrench::from_array);
    print::<isae_x8::IsaeX8, _>(&mix_all::<isae_x8::IsaeX8, _>(&hover_and_roll, 14.8)?);
    print::<px4_y6::Px4Y6, _>(&mix_all::<px4_y6::Px4Y6, _>(&hover_and_roll, 14.8)?);
    Ok(())
}

fn print<A: Airframe, const CHANNELS: usize>(mixes: &[Mix<CHANNELS>]) {
    println!("{}, {CHANNELS} rotors", A::NAME);
    for mix in mixes {
        println!("  throttle {:.3?}", mix.throttle);
    }
}
