//! Serves PX4, ArduPilot and Betaflight as their outside simulator.

use std::process::ExitCode;

use clap::Parser;
use simulation::sitl::{self, arguments::Arguments};

fn main() -> ExitCode {
    match sitl::run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
