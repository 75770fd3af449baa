//! Vectors as tables: setpoints with what the mixer makes of them. Floats are the hexadecimal digits
//! of their bits. A density stands only in the tables of airframes with `[air]`, as in the setpoints of
//! `cargo mixer mix`.

use std::fmt::Write as _;

use crate::vectors::Vector;
use mixer_compiler::Compiled;
use mixer_rt::{Health, Wrench};

/// A row per vector, with all rotors.
pub(super) fn healthy(compiled: &Compiled, vectors: &[Vector]) -> String {
    let mut table = header(compiled);
    for vector in vectors {
        push_row(&mut table, compiled, vector, Health::GOOD);
    }
    table
}

/// A row per vector; `failed` has the outputs of the rotors that are out, `+` between them.
pub(super) fn rotors_out(compiled: &Compiled, vectors: &[(Health, Vector)]) -> String {
    let mut table = format!("failed,{}", header(compiled));
    let rotors = compiled.airframe.rotors() as u8;
    for (health, vector) in vectors {
        let failed = (0..rotors).filter(|channel| health.has_failed(*channel));
        let failed = failed.map(|channel| channel.to_string());
        let _ = write!(table, "{},", itertools::join(failed, "+"));
        push_row(&mut table, compiled, vector, *health);
    }
    table
}

fn header(compiled: &Compiled) -> String {
    let axes = ["roll_nm", "pitch_nm", "yaw_nm", "thrust_n"];
    let mut columns: Vec<String> = axes.map(str::to_owned).to_vec();
    columns.push("voltage_v".to_owned());
    if compiled.airframe.air.is_some() {
        columns.push("density_kg_m3".to_owned());
    }
    columns.extend((0..compiled.airframe.rotors()).map(|channel| format!("throttle_{channel}")));
    columns.extend(axes.map(|axis| format!("achieved_{axis}")));
    columns.join(",") + ",saturation\n"
}

fn push_row(table: &mut String, compiled: &Compiled, vector: &Vector, health: Health) {
    let (setpoint, conditions) = vector;
    let mixed = compiled.tables.mix_with_health(setpoint, *conditions, health);
    // Vectors are finite, so the mixer takes them; one that it refused would show as zeros.
    let zeros = vec![0.0; compiled.airframe.rotors()];
    let refused = (zeros, Wrench::default(), Default::default());
    let (throttle, achieved, saturation) = mixed.unwrap_or(refused);
    let density = compiled.airframe.air.as_ref().and(conditions.density_kg_m3);
    let inputs = setpoint.to_array().into_iter();
    let inputs = inputs.chain([conditions.voltage_v]).chain(density);
    for value in inputs.chain(throttle).chain(achieved.to_array()) {
        let _ = write!(table, "0x{:08x},", value.to_bits());
    }
    let _ = writeln!(table, "{}", saturation.bits());
}
