//! Allocation: what is attainable is delivered, other requests are cut by priority.
//!
//! Every test here is without exceptions. How often drawn requests miss a promise - jumps, wrenches
//! short of what throttles give, of the optimum, or of a smaller request - is counted by the soak,
//! `tests/src/soak`, some seconds of which are `tests/soak.rs`.
//!
//! | file | holds the mixer to |
//! |---|---|
//! | `authority.rs` | an X12 against an X8 of the same real pair: as much yaw and thrust per unit |
//! | `optimum.rs` | linear programmes: frames in closed form reach the optimum |
//! | `regressions.rs`, `.toml` | requests that an earlier mixer answered badly, as data |
//! | `closed_loops.rs` | closed loops with one and two rotors out: a vehicle ends where it should |
//! | `failure.rs` | an X8 that loses a rotor: still flies |
//! | `properties.rs` | any layout and request: sound and truthful (proptest; `PROPTEST_CASES=1000` runs more) |
//! | `rotors_out.rs` | one and two rotors out, real pairs: nothing is reversed or exceeded |
//! | `degenerate.rs` | numbers that no controller sends |
//! | `power_bias.rs` | least power: the wrench stays, torques follow thrusts, fading before anything saturates |
//! | `yaw_reserve.rs` | a reserve of yaw: kept before thrust, never at the cost of roll and pitch |
//! | `shapes.rs` | the same on attainable sets that are not convex, real ones with `MIXER_BENCH_DATA` |
//! | `flags.rs` | attainable yaw is delivered without a flag, and shortages are flagged |
//! | `finite.rs` | no NaN on the way to the throttles, whose sign would depend on the processor |
#![allow(missing_docs)]

mod authority;
mod closed_loops;
mod degenerate;
mod failure;
// On other hosts `tools/cargo-mixer/tests/commands/library/exceptions.c` alone watches the exceptions.
#[cfg(target_arch = "x86_64")]
mod finite;
mod flags;
mod layout;
mod optimum;
mod power_bias;
mod properties;
mod regressions;
mod rotors_out;
mod shapes;
mod yaw_reserve;

use mixer_rt::Health;
use mixer_tests::frames::{self, Options, Place};
use mixer_tests::request::{Frame, Request};

/// Of the frames' `[voltage]`.
const REFERENCE_V: f32 = 14.8;

/// The number that an environment variable is set to, else `default`.
fn number(variable: &str, default: u64) -> u64 {
    let set = std::env::var(variable);
    set.map_or(default, |text| {
        text.parse().unwrap_or_else(|_| panic!("{variable} is a number"))
    })
}

/// With the rotors on these channels out.
fn out(channels: &[u8]) -> Health {
    let channels = channels.iter();
    channels.fold(Health::GOOD, |health, channel| health.with_failed(*channel))
}

fn place(position: [f64; 3], axis: [f64; 2], clockwise: bool) -> Place {
    Place {
        position,
        axis: [axis[0], axis[1], -1.0],
        clockwise,
    }
}

fn all_rotors(wrench: [f32; 4], volts: f32) -> Request {
    Request {
        wrench,
        volts,
        density: None,
        health: Health::GOOD,
    }
}

fn compile(places: &[Place], airmode: &'static str, yaw_reserve_nm: f64) -> Frame {
    let options = Options {
        airmode,
        yaw_reserve_nm,
        ..Options::default()
    };
    Frame::new(frames::compile(places, options).unwrap_or_else(|faults| panic!("{faults}")))
}

/// A frame whose units have another pair than the paper's.
fn compile_with_pair(pair: &str, places: &[Place], options: Options) -> Frame {
    let channels: Vec<usize> = (0..2 * places.len()).collect();
    let text = frames::toml_with_pair(pair, places, &channels, options);
    Frame::new(frames::compile_text(&text).unwrap_or_else(|faults| panic!("{faults}\n{text}")))
}
