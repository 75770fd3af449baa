//! The self-test: golden vectors, and setpoints that are refused, with the bits that the command line
//! gives for them.

use std::fmt::Write as _;

use crate::vectors::{self, Vector};
use mixer_compiler::Compiled;
use mixer_compiler::tables::AnyState;
use mixer_rt::{Conditions, Health, Wrench};

use crate::library::airframe::Airframe;
use crate::library::header::{VERSION, fill};

/// One in so many golden vectors: the table goes into the firmware's flash.
const EVERY: usize = 3;

/// `M_selftest.c`.
pub(crate) fn text(airframe: &Airframe, health: bool, dynamic: bool) -> String {
    let Airframe { compiled, module, .. } = airframe;
    let rows = rows(compiled);
    let mut table = String::new();
    for (index, (wrench, conditions)) in rows.iter().enumerate() {
        let failed = health.then(|| mask(index, compiled.airframe.rotors()));
        row(&mut table, compiled, wrench, *conditions, failed);
    }
    // At the bench's density by the function that takes none.
    let mix = format!(
        "rows[i].in[5] == {:#x}u\n            ? {module}_mix(&setpoint, in[4], &out)\n            : {module}_mix_in(&setpoint, &conditions, &out)",
        (compiled.airframe.reference_density() as f32).to_bits()
    );
    let call = if health {
        format!(
            "rows[i].failed != 0u\n            ? {module}_mix_in_with_health(&setpoint, &conditions, rows[i].failed, &out)\n            : {mix}"
        )
    } else {
        mix
    };
    let field = if health { "    uint64_t failed;\n" } else { "" };
    fill(
        include_str!("templates/selftest.c"),
        &[
            ("FAILED", &field),
            ("CALL", &call),
            ("TABLE", &table),
            (
                "WORTH",
                &if dynamic {
                    worth(compiled, &rows)
                } else {
                    String::new()
                },
            ),
            (
                "MORE",
                &if dynamic {
                    include_str!("templates/dynamic.c").replace("@M@", module)
                } else {
                    String::new()
                },
            ),
            ("PREFIX", &airframe.prefix()),
            ("VERSION", &VERSION),
            ("M", module),
        ],
    )
}

/// What the rotors are worth after all rows, from rest, each held for 4 ms.
fn worth(compiled: &Compiled, rows: &[Vector]) -> String {
    let mut state = AnyState::default();
    for (wrench, conditions) in rows {
        // One that is refused leaves the state as it was.
        let _ = compiled
            .tables
            .mix_dynamic(&mut state, wrench, *conditions, Health::GOOD, 0.004);
    }
    let worth = &state.worth[..compiled.airframe.rotors()];
    let bits = worth.iter().map(|worth| format!("{:#x}u", worth.to_bits()));
    format!(
        "\n/* What the rotors are worth after all rows, each held for 4 ms. */\nstatic const uint32_t worth[] = {{{}}};\n",
        itertools::join(bits, ", ")
    )
}

/// One row of the table. A `health` row has a mask.
fn row(
    table: &mut String,
    compiled: &Compiled,
    wrench: &Wrench,
    conditions: Conditions,
    failed: Option<u64>,
) {
    let health = Health::from_bits(failed.unwrap_or(0));
    let (status, out) = match compiled.tables.mix_with_health(wrench, conditions, health) {
        Ok((throttles, achieved, saturation)) => {
            let floats = throttles.into_iter().chain(achieved.to_array());
            let mut bits: Vec<u32> = floats.map(f32::to_bits).collect();
            bits.push(u32::from(saturation.bits()));
            (0, bits)
        }
        Err(error) => (error.status(), vec![0; compiled.airframe.rotors() + 5]),
    };
    let list = |bits: &[u32]| -> String {
        let words = bits.iter().map(|bits| format!("{bits:#x}u"));
        itertools::join(words, ", ")
    };
    let [roll, pitch, yaw, thrust] = wrench.to_array().map(f32::to_bits);
    let [volts, density] =
        [conditions.voltage_v, conditions.density_kg_m3.unwrap_or_default()].map(f32::to_bits);
    let input = list(&[roll, pitch, yaw, thrust, volts, density]);
    let failed = failed.map_or(String::new(), |mask| format!("{mask:#x}u, "));
    let output = list(&out);
    let _ = writeln!(table, "    {{{{{input}}}, {failed}{status}, {{{output}}}}},");
}

/// Which rotors are out in a row: none, one or two.
fn mask(index: usize, rotors: usize) -> u64 {
    match index % 3 {
        0 => 0,
        1 => 1 << (index / 3 % rotors),
        _ => 1 << (index / 3 % rotors) | 1 << (index / 7 % rotors),
    }
}

/// A choice of the golden vectors; densities that are none; setpoints and voltages that are refused.
fn rows(compiled: &Compiled) -> Vec<Vector> {
    let mut rows: Vec<Vector> = vectors::healthy(compiled).into_iter().step_by(EVERY).collect();
    let finite = Wrench::from_normalised([0.1, 0.1, 0.1, 0.4], &compiled.scale());
    let volts = compiled
        .airframe
        .voltage
        .as_ref()
        .map_or(12.0, |law| law.reference as f32);
    let density = compiled
        .airframe
        .air
        .as_ref()
        .map_or(0.0, |law| law.reference as f32);
    let conditions = Conditions::at_voltage(volts).in_air(density);
    for density in [f32::NAN, f32::INFINITY, 0.0, -1.0] {
        rows.push((finite, conditions.in_air(density)));
    }
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for axis in 0..4 {
            let mut wrench = finite.to_array();
            wrench[axis] = bad;
            rows.push((Wrench::from_array(wrench), conditions));
        }
        rows.push((finite, Conditions::at_voltage(bad).in_air(density)));
    }
    rows
}
