//! Golden outputs: what is held per airframe in `tests/golden/`, and how it is made.
//!
//! `<name>.rs` is the generated Rust, `<name>.report.txt` the report, `<name>.vectors.csv` setpoints with the bits
//! that the mixer gives. They are written by `cargo run -p mixer-tests --bin bless` only.

use std::fmt::Write as _;
use std::path::PathBuf;

use mixer_compiler::report::Report;
use mixer_compiler::{Compiled, Source};

use crate::{root, vectors};

/// The folder of the golden outputs.
pub fn folder() -> PathBuf {
    root().join("tests/golden")
}

/// Compiles `airframes/<name>.toml`.
///
/// # Errors
/// The file cannot be read or is refused.
pub fn compile(name: &str) -> Result<Compiled, String> {
    let path = format!("airframes/{name}.toml");
    let text = std::fs::read_to_string(root().join(&path)).map_err(|error| format!("{path}: {error}"))?;
    mixer_compiler::compile(&Source::new(path, text)).map_err(|faults| faults.to_string())
}

/// The golden outputs of one airframe: file name and content.
///
/// # Errors
/// As [`compile`].
pub fn outputs(name: &str) -> Result<Vec<(String, String)>, String> {
    let compiled = compile(name)?;
    Ok(vec![
        (format!("{name}.report.txt"), Report(&compiled).to_string()),
        (format!("{name}.rs"), compiled.rust()),
        (format!("{name}.vectors.csv"), vector_table(&compiled)),
    ])
}

/// All setpoints with what the mixer makes of them, floats as the hexadecimal digits of their bits.
fn vector_table(compiled: &Compiled) -> String {
    let mut table = String::from("roll_nm,pitch_nm,yaw_nm,thrust_n,voltage_v");
    for channel in 0..compiled.airframe.rotors() {
        let _ = write!(table, ",throttle_{channel}");
    }
    table.push_str(",achieved_roll_nm,achieved_pitch_nm,achieved_yaw_nm,achieved_thrust_n,saturation\n");
    for (setpoint, voltage_v) in vectors::setpoints(compiled) {
        // Vectors are finite, so the mixer takes them; one that it refused would be missed by the test on counts.
        let Ok((throttle, achieved, saturation)) = compiled.tables.mix(&setpoint, voltage_v) else {
            continue;
        };
        let floats = setpoint.to_array().into_iter().chain([voltage_v]).chain(throttle);
        for value in floats.chain(achieved.to_array()) {
            let _ = write!(table, "0x{:08x},", value.to_bits());
        }
        let _ = writeln!(table, "{}", saturation.bits());
    }
    table
}
