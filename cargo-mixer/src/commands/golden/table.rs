//! Vectors as tables: setpoints with what the mixer makes of them, as CSV for reading and as
//! constants for the target.

use std::fmt::Write as _;

use mixer_compiler::Compiled;
use mixer_rt::{Health, Wrench};

use super::vectors::{RotorsOut, Vector};

/// One vector with what the mixer makes of it: the bits of the floats in the order of the header of
/// [`csv()`], `saturation` last.
pub type Row = Vec<u32>;

/// Rows with all rotors.
pub fn healthy(compiled: &Compiled, vectors: &[Vector]) -> Vec<Row> {
    vectors
        .iter()
        .map(|(setpoint, voltage_v)| row(compiled, setpoint, *voltage_v, Health::GOOD))
        .collect()
}

/// Rows with the output of the rotor that is out.
pub fn rotors_out(compiled: &Compiled, vectors: &[RotorsOut]) -> Vec<(u8, Row)> {
    vectors
        .iter()
        .map(|vector| {
            let health = Health::GOOD.with_failed(vector.failed);
            let row = row(compiled, &vector.setpoint, vector.voltage_v, health);
            (vector.failed, row)
        })
        .collect()
}

/// Rows as CSV: floats as the hexadecimal digits of their bits.
pub fn csv(compiled: &Compiled, rows: &[Row]) -> String {
    let mut table = columns(compiled).join(",") + "\n";
    for row in rows {
        push_cells(&mut table, row);
    }
    table
}

/// Rows with rotors out as CSV: `failed` is the output that is out.
pub fn rotors_out_csv(compiled: &Compiled, rows: &[(u8, Row)]) -> String {
    let mut table = format!("failed,{}\n", columns(compiled).join(","));
    for (failed, row) in rows {
        let _ = write!(table, "{failed},");
        push_cells(&mut table, row);
    }
    table
}

/// Both as constants of Rust, for a test on the target.
pub fn rust(compiled: &Compiled, rows: &[Row], rotors_out: &[(u8, Row)]) -> String {
    let name = &compiled.airframe.name;
    let columns = columns(compiled);
    let count = columns.len();
    let mut text = format!(
        "// Golden vectors of `{name}`, written by `cargo mixer golden`.\n\
         //\n\
         // A row holds the bits of {}, {}.\n\n",
        columns[..5].join(", "),
        columns[5..].join(", ")
    );
    let _ = writeln!(
        text,
        "/// All rotors turn.\npub(crate) static VECTORS: [[u32; {count}]; {}] = [",
        rows.len()
    );
    for row in rows {
        push_array(&mut text, "    ", row);
    }
    let by_rotor: Vec<_> = rotors_out.chunk_by(|(one, _), (other, _)| one == other).collect();
    let each = by_rotor.first().map_or(0, |rows| rows.len());
    let _ = writeln!(
        text,
        "];\n\n/// One rotor is out: its output, and rows.\n#[allow(dead_code)]\n\
         pub(crate) static ROTORS_OUT: [(u8, [[u32; {count}]; {each}]); {}] = [",
        by_rotor.len()
    );
    for rows in by_rotor {
        for (failed, _) in rows.iter().take(1) {
            let _ = writeln!(text, "    ({failed}, [");
        }
        for (_, row) in rows {
            push_array(&mut text, "        ", row);
        }
        text.push_str("    ]),\n");
    }
    text.push_str("];\n");
    text
}

fn columns(compiled: &Compiled) -> Vec<String> {
    let axes = ["roll_nm", "pitch_nm", "yaw_nm", "thrust_n"];
    let mut columns: Vec<String> = axes.map(str::to_owned).to_vec();
    columns.push("voltage_v".to_owned());
    columns.extend((0..compiled.airframe.rotors()).map(|channel| format!("throttle_{channel}")));
    columns.extend(axes.map(|axis| format!("achieved_{axis}")));
    columns.push("saturation".to_owned());
    columns
}

fn push_cells(table: &mut String, row: &Row) {
    let Some((saturation, floats)) = row.split_last() else {
        return;
    };
    for bits in floats {
        let _ = write!(table, "0x{bits:08x},");
    }
    let _ = writeln!(table, "{saturation}");
}

fn push_array(text: &mut String, indent: &str, row: &Row) {
    let cells: Vec<String> = row.iter().map(|bits| format!("{bits:#x}")).collect();
    let _ = writeln!(text, "{indent}[{}],", cells.join(", "));
}

fn row(compiled: &Compiled, setpoint: &Wrench, voltage_v: f32, health: Health) -> Row {
    let mut floats = setpoint.to_array().to_vec();
    floats.push(voltage_v);
    // Vectors are finite, so the mixer takes them; one that it refused would show as zeros.
    let (throttle, achieved, saturation) = compiled
        .tables
        .mix_with_health(setpoint, voltage_v, health)
        .unwrap_or_else(|_| {
            (
                vec![0.0; compiled.airframe.rotors()],
                Wrench::default(),
                Default::default(),
            )
        });
    floats.extend(throttle);
    floats.extend(achieved.to_array());
    let mut row: Row = floats.into_iter().map(f32::to_bits).collect();
    row.push(saturation.bits().into());
    row
}
