//! Vectors as tables: setpoints with what the mixer makes of them. Floats are the hexadecimal digits
//! of their bits.

use std::fmt::Write as _;

use mixer_compiler::Compiled;
use mixer_rt::{Health, Wrench};

use super::vectors::Vector;

/// A row per vector, with all rotors.
pub(super) fn healthy(compiled: &Compiled, vectors: &[Vector]) -> String {
    let mut table = header(compiled);
    for (setpoint, voltage_v) in vectors {
        push_row(&mut table, compiled, setpoint, *voltage_v, Health::GOOD);
    }
    table
}

/// A row per vector; `failed` is the output of the rotor that is out.
pub(super) fn rotors_out(compiled: &Compiled, vectors: &[(u8, Vector)]) -> String {
    let mut table = format!("failed,{}", header(compiled));
    for (failed, (setpoint, voltage_v)) in vectors {
        let _ = write!(table, "{failed},");
        let health = Health::GOOD.with_failed(*failed);
        push_row(&mut table, compiled, setpoint, *voltage_v, health);
    }
    table
}

fn header(compiled: &Compiled) -> String {
    let axes = ["roll_nm", "pitch_nm", "yaw_nm", "thrust_n"];
    let mut columns: Vec<String> = axes.map(str::to_owned).to_vec();
    columns.push("voltage_v".to_owned());
    columns.extend((0..compiled.airframe.rotors()).map(|channel| format!("throttle_{channel}")));
    columns.extend(axes.map(|axis| format!("achieved_{axis}")));
    columns.join(",") + ",saturation\n"
}

fn push_row(table: &mut String, compiled: &Compiled, setpoint: &Wrench, voltage_v: f32, health: Health) {
    let mixed = compiled.tables.mix_with_health(setpoint, voltage_v, health);
    // Vectors are finite, so the mixer takes them; one that it refused would show as zeros.
    let zeros = vec![0.0; compiled.airframe.rotors()];
    let refused = (zeros, Wrench::default(), Default::default());
    let (throttle, achieved, saturation) = mixed.unwrap_or(refused);
    let inputs = setpoint.to_array().into_iter().chain([voltage_v]);
    for value in inputs.chain(throttle).chain(achieved.to_array()) {
        let _ = write!(table, "0x{:08x},", value.to_bits());
    }
    let _ = writeln!(table, "{}", saturation.bits());
}
