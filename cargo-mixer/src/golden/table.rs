//! Vectors as tables: setpoints with what the mixer makes of them, floats as the hexadecimal digits of their bits.

use std::fmt::Write as _;

use mixer_compiler::Compiled;
use mixer_rt::{Health, Wrench};

use super::vectors::RotorsOut;

/// All setpoints with what the mixer makes of them.
pub fn healthy(compiled: &Compiled, vectors: &[(Wrench, f32)]) -> String {
    let mut table = header(compiled, "");
    for (setpoint, voltage_v) in vectors {
        row(&mut table, compiled, setpoint, *voltage_v, Health::GOOD);
    }
    table
}

/// The same with rotors out: `failed` is the output that is out.
pub fn rotors_out(compiled: &Compiled, vectors: &[RotorsOut]) -> String {
    let mut table = header(compiled, "failed,");
    for vector in vectors {
        let _ = write!(table, "{},", vector.failed);
        let health = Health::GOOD.with_failed(vector.failed);
        row(&mut table, compiled, &vector.setpoint, vector.voltage_v, health);
    }
    table
}

fn header(compiled: &Compiled, first: &str) -> String {
    let mut table = format!("{first}roll_nm,pitch_nm,yaw_nm,thrust_n,voltage_v");
    for channel in 0..compiled.airframe.rotors() {
        let _ = write!(table, ",throttle_{channel}");
    }
    table.push_str(",achieved_roll_nm,achieved_pitch_nm,achieved_yaw_nm,achieved_thrust_n,saturation\n");
    table
}

fn row(table: &mut String, compiled: &Compiled, setpoint: &Wrench, voltage_v: f32, health: Health) {
    let floats = setpoint.to_array().into_iter().chain([voltage_v]);
    let mixed = compiled.tables.mix_with_health(setpoint, voltage_v, health);
    // Vectors are finite, so the mixer takes them; one that it refused would show as a row without throttles.
    let (throttle, achieved, saturation) = match mixed {
        Ok((throttle, achieved, saturation)) => (throttle, Some(achieved), saturation.bits()),
        Err(_) => (Vec::new(), None, 0),
    };
    let achieved = achieved.into_iter().flat_map(|achieved| achieved.to_array());
    for value in floats.chain(throttle).chain(achieved) {
        let _ = write!(table, "0x{:08x},", value.to_bits());
    }
    let _ = writeln!(table, "{saturation}");
}
