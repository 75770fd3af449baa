//! The self-test: setpoints with the bits that the command line gives for them.

use std::fmt::Write as _;

use mixer_compiler::Compiled;
use mixer_compiler::airframe::Correction;
use mixer_rt::{Conditions, Health, SetpointError, Wrench};

use crate::airframe::Airframe;
use crate::header::{VERSION, fill};

/// Rows of random setpoints.
const RANDOM: usize = 96;

/// Thrusts of the regular rows as shares of full thrust.
const THRUSTS: [f32; 6] = [0.0, 0.1, 0.3, 0.45, 0.7, 1.2];
/// Torques of the regular rows as shares of a normalised setpoint's unit.
const TORQUES: [f32; 4] = [-1.5, -0.1, 0.1, 1.5];

/// `M_selftest.c`.
pub(crate) fn text(airframe: &Airframe, health: bool) -> String {
    let Airframe { compiled, module, .. } = airframe;
    let rows = setpoints(compiled);
    let mut table = String::new();
    for (index, (wrench, conditions)) in rows.iter().enumerate() {
        let failed = health.then(|| mask(index, compiled.airframe.rotors()));
        row(&mut table, compiled, wrench, *conditions, failed);
    }
    // At the bench's density by the function that takes none.
    let mix = format!(
        "in[5] == {}_REFERENCE_DENSITY_KG_M3\n            ? {module}_mix(&setpoint, in[4], &out)\n            : {module}_mix_in(&setpoint, &conditions, &out)",
        airframe.prefix()
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
            ("PREFIX", &airframe.prefix()),
            ("VERSION", &VERSION),
            ("M", module),
        ],
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
    let health = (0..64u8)
        .filter(|channel| (failed.unwrap_or(0) >> channel) & 1 != 0)
        .fold(Health::GOOD, Health::with_failed);
    let (status, out) = match compiled.tables.mix_in(wrench, conditions, health) {
        Ok((throttles, achieved, saturation)) => {
            let floats = throttles.into_iter().chain(achieved.to_array());
            let mut bits: Vec<u32> = floats.map(f32::to_bits).collect();
            bits.push(u32::from(saturation.bits()));
            (0, bits)
        }
        Err(SetpointError::NonFinite(axis)) => (1 + axis as u8, vec![0; compiled.airframe.rotors() + 5]),
        Err(SetpointError::NonFiniteVoltage) => (5, vec![0; compiled.airframe.rotors() + 5]),
    };
    let list = |bits: &[u32]| -> String {
        let words: Vec<String> = bits.iter().map(|bits| format!("{bits:#x}u")).collect();
        words.join(", ")
    };
    let [roll, pitch, yaw, thrust] = wrench.to_array().map(f32::to_bits);
    let [volts, density] = [conditions.voltage_v, conditions.density_kg_m3].map(f32::to_bits);
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

/// Setpoints and conditions: every axis alone, at once, in and far out of what is attainable, and not
/// finite.
fn setpoints(compiled: &Compiled) -> Vec<(Wrench, Conditions)> {
    let unit = compiled.scale();
    let airframe = &compiled.airframe;
    // At the reference, at both ends and beyond; one that is not there is ignored.
    let values = |correction: &Option<Correction>| match correction {
        Some(correction) => {
            let [low, high] = correction.range.map(|x| x as f32);
            vec![correction.reference as f32, low, high, 0.9 * low, 1.1 * high]
        }
        None => vec![12.0],
    };
    let mut densities = values(&airframe.air);
    densities.extend([f32::NAN, f32::INFINITY, 0.0, -1.0]);
    let (mut voltages, mut densities) = (
        values(&airframe.voltage).into_iter().cycle(),
        densities.into_iter().cycle(),
    );
    let mut conditions = std::iter::from_fn(move || {
        Some(Conditions {
            voltage_v: voltages.next()?,
            density_kg_m3: densities.next()?,
        })
    });
    let mut rows = Vec::new();
    let mut push = |normalised: [f32; 4]| {
        let setpoint = Wrench::from_normalised(normalised, &unit);
        rows.extend(conditions.next().map(|conditions| (setpoint, conditions)));
    };
    for thrust in THRUSTS {
        push([0.0, 0.0, 0.0, thrust]);
        for axis in 0..3 {
            for torque in TORQUES {
                let mut normalised = [0.0, 0.0, 0.0, thrust];
                normalised[axis] = torque;
                push(normalised);
            }
        }
    }
    let mut random = Random(1);
    for _ in 0..RANDOM {
        let torque = random.below_one() * 1.5;
        let mut torques = || torque * (2.0 * random.below_one() - 1.0);
        let [roll, pitch, yaw] = [torques(), torques(), torques()];
        push([roll, pitch, yaw, 1.2 * random.below_one()]);
    }
    let at = |voltage_v| compiled.tables.view().at_reference_density(voltage_v);
    let finite = Wrench::from_normalised([0.1, 0.1, 0.1, 0.4], &unit);
    for axis in 0..4 {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let mut wrench = finite.to_array();
            wrench[axis] = bad;
            rows.push((Wrench::from_array(wrench), at(12.0)));
        }
    }
    rows.extend([f32::NAN, f32::INFINITY].map(|voltage| (finite, at(voltage))));
    rows
}

/// Numerical Recipes' generator: always the same rows.
struct Random(u32);

impl Random {
    fn below_one(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 8) as f32 / (1 << 24) as f32
    }
}
