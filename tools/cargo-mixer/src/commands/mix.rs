//! `cargo mixer mix`: setpoints in, throttles out, on the very tables that the macro emits.

use mixer_compiler::Compiled;
use mixer_compiler::dynamics::UNPROVEN;
use mixer_compiler::tables::{AnyMix, AnyState};
use mixer_rt::{Conditions, Health, SetpointError, Wrench};

use crate::Done;
use crate::rows::{self, Memory, Row, RowArgs, Task, fields, throttles};

/// Mixes setpoints: CSV to CSV, from stdin to stdout row by row
///
/// In:  a header and rows of roll_nm,pitch_nm,yaw_nm,thrust_n and, if there are such, voltage_v
///      and density_kg_m3, in any order. Without them the bench's voltage and density are taken.
/// Out: throttle_0.., achieved_roll_nm, achieved_pitch_nm, achieved_yaw_nm, achieved_thrust_n,
///      saturation. Numbers read back to the same bits (f32).
///      saturation is a sum: 1 roll, 4 pitch, 16 yaw, 64 thrust is achieved below the setpoint;
///      2, 8, 32, 128 above it; 256 the voltage was outside the airframe's range and clamped
///      into it; 512 the density was, or was NaN, infinite, 0 or less and taken as the bench's.
///      The throttle of a rotor that is out is 0.
///
/// With --dynamic the rows are those of one flight, with a column time_s as well: throttles for rotors that are under
/// way from speed to speed. A row's are taken to be held as long as it is after the row before; in the first row the
/// rotors turn as it asks. What is achieved, and saturation, are those of steady speeds.
///
/// A bad row is reported with its line on stderr and left out; the exit status is then 1.
#[derive(clap::Args, Debug)]
#[command(verbatim_doc_comment)]
pub struct MixArgs {
    #[command(flatten)]
    rows: RowArgs,
    /// The rows follow one another in time: a column time_s, s
    #[arg(long)]
    dynamic: bool,
}

/// The columns of a wrench, in the order of [`Wrench::to_array`].
pub(crate) const WRENCH: [&str; 4] = ["roll_nm", "pitch_nm", "yaw_nm", "thrust_n"];

/// Setpoints in, throttles out.
pub const MIX: Task<f32> = Task {
    required: |_| WRENCH.map(str::to_owned).into(),
    given: |airframe| {
        let achieved = WRENCH.map(|name| format!("achieved_{name}"));
        let rest = achieved.into_iter().chain(["saturation".to_owned()]);
        throttles(airframe).into_iter().chain(rest).collect()
    },
    answer: |compiled, health, row, _| {
        let mixed = mix(compiled, health, row).map_err(|error| error.to_string())?;
        Ok(answer(mixed))
    },
};

/// The rows of one flight in, throttles out.
const DYNAMIC: Task<f32> = Task {
    required: |_| WRENCH.into_iter().chain([TIME]).map(str::to_owned).collect(),
    answer: |compiled, health, row, memory| mix_dynamic(compiled, health, row, memory).map(answer),
    ..MIX
};

/// The column of the time.
const TIME: &str = "time_s";

fn answer((throttles, achieved, saturation): AnyMix) -> String {
    let numbers = throttles.into_iter().chain(achieved.to_array());
    format!("{},{}", fields(numbers), saturation.bits())
}

/// The setpoint of a row of [`MIX`].
pub fn setpoint(row: &Row<f32>) -> Wrench {
    let mut wrench = [0.0; 4];
    for (axis, value) in wrench.iter_mut().zip(&row.values) {
        *axis = *value;
    }
    Wrench::from_array(wrench)
}

/// Mixes a row of [`MIX`].
///
/// # Errors
/// A wrench or a voltage that is not finite.
pub fn mix(compiled: &Compiled, health: Health, row: &Row<f32>) -> Result<AnyMix, SetpointError> {
    let conditions = conditions(compiled, row);
    compiled
        .tables
        .mix_with_health(&setpoint(row), conditions, health)
}

fn conditions(compiled: &Compiled, row: &Row<f32>) -> Conditions {
    let reference_v = compiled.airframe.reference_v() as f32;
    let mut conditions = Conditions::at_voltage(row.voltage_v.unwrap_or(reference_v));
    conditions.density_kg_m3 = row.density_kg_m3;
    conditions
}

/// Mixes a row of one flight, whose last column is the time, s, after those that `memory` has.
///
/// # Errors
/// As [`mix`]; a time that is not finite, or not after the row before; an airframe without `mix_dynamic`.
pub fn mix_dynamic(
    compiled: &Compiled,
    health: Health,
    row: &Row<f32>,
    memory: &mut Memory,
) -> Result<AnyMix, String> {
    if compiled.dynamics.is_none() {
        return Err(format!("{}: {UNPROVEN}", compiled.airframe.name));
    }
    let time_s = row.values.last().copied().filter(|time_s| time_s.is_finite());
    let time_s = time_s.ok_or_else(|| format!("{TIME} is not finite"))?;
    let steady = mix(compiled, health, row).map_err(|error| error.to_string())?;
    let Some((last_s, state)) = memory else {
        let mut state = AnyState::default();
        state.worth[..steady.0.len()].copy_from_slice(&steady.0);
        *memory = Some((time_s, state));
        return Ok(steady);
    };
    if time_s <= *last_s {
        return Err(format!(
            "{TIME} {time_s:?} is not after that of the row before, {last_s:?}"
        ));
    }
    let conditions = conditions(compiled, row);
    let held_s = time_s - *last_s;
    let mixed = compiled
        .tables
        .mix_dynamic(state, &setpoint(row), conditions, health, held_s);
    *last_s = time_s;
    mixed.map_err(|error| error.to_string())
}

/// Runs the command.
pub fn run(args: &MixArgs) -> Done {
    rows::run(&args.rows, if args.dynamic { &DYNAMIC } else { &MIX })
}
