//! Prints what a mix costs on a Cortex-M4F: `cargo run --release -p mixer-tests --bin counts [AIRFRAME..]`.
//!
//! Without arguments every file in `airframes/`; `regular-1` to `regular-8` and `tolerance-0.1` to
//! `tolerance-3e-5` are those of `examples/firmware/build/frames.rs`.

use std::process::ExitCode;

use mixer_tests::firmware::Toolchain;
use mixer_tests::{airframes, counts};

fn main() -> ExitCode {
    match print() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn print() -> Result<(), String> {
    let toolchain = Toolchain::find()?;
    let mut names: Vec<String> = std::env::args().skip(1).collect();
    if names.is_empty() {
        names = airframes().map_err(|error| format!("airframes/: {error}"))?;
    }
    println!(
        "{:<20} {:<10} {:>8} {:>10} {:>8} {:>8}",
        "airframe", "requests", "count", "mean", "worst", "stack_b"
    );
    for name in names {
        for count in counts::mixer(&toolchain, &name)? {
            let [roll, pitch, yaw, thrust, voltage_v] = count.dearest;
            println!("{name:<20} {count}  dearest {roll:e},{pitch:e},{yaw:e},{thrust:e},{voltage_v}");
        }
    }
    Ok(())
}
