//! Prints what every evaluator of the inverse map costs on a Cortex-M4F, per unit, as
//! `mixer-compiler/src/inverse/evaluator/cost.rs` states it: `cargo xtask
//! evaluators`.

use std::process::ExitCode;

use mixer_tests::evaluators;
use mixer_tests::firmware::Toolchain;

fn main() -> ExitCode {
    match Toolchain::find().and_then(|toolchain| evaluators::counted(&toolchain)) {
        Ok(counts) => {
            for (name, counts) in counts {
                println!("    ({name:?}, {counts:?}),");
            }
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
