//! `cargo mixer wrench`: throttles in, the wrench that they give out, by the airframe file's own
//! physics: the judge of any mixer.

use mixer_compiler::Compiled;
use mixer_compiler::airframe::{Airframe, Correction};
use mixer_rt::Health;

use crate::Done;
use crate::commands::mix::WRENCH;
use crate::rows::{self, Row, RowArgs, Task, fields, throttles};

/// What throttles give: CSV to CSV, from stdin to stdout row by row
///
/// In:  a header and rows of throttle_0.., one for each output, and, if there are such, voltage_v
///      and density_kg_m3, in any order. Without them the bench's voltage and density are taken.
/// Out: roll_nm, pitch_nm, yaw_nm, thrust_n by the units' polynomials and the laws of voltage and
///      density. Numbers read back to the same bits (f64).
///      A rotor that is out stands still, whatever its throttle.
///
/// A bad row is reported with its line on stderr and left out; the exit status is then 1. So is a
/// throttle outside 0 to 1, and a voltage or density outside the airframe's range.
#[derive(clap::Args, Debug)]
#[command(verbatim_doc_comment)]
pub struct WrenchArgs {
    #[command(flatten)]
    rows: RowArgs,
}

/// Throttles in, wrenches out.
pub const GIVEN: Task<f64> = Task {
    required: throttles,
    given: |_| WRENCH.map(str::to_owned).into(),
    answer: |compiled, health, row, _| Ok(fields(wrench(compiled, health, row)?)),
};

/// `[roll, pitch, yaw, thrust]` (N m, N) of a row of [`GIVEN`].
///
/// # Errors
/// A throttle outside 0 to 1, a voltage or a density outside the airframe's range.
pub fn wrench(compiled: &Compiled, health: Health, row: &Row<f64>) -> Result<[f64; 4], String> {
    let factors = factors(&compiled.airframe, row)?;
    Ok(compiled.physics().wrench(&row.values, factors, health))
}

/// `[f, Q]` (N, N m) of every unit, of a row of [`GIVEN`].
///
/// # Errors
/// As [`wrench`].
pub fn efforts(compiled: &Compiled, health: Health, row: &Row<f64>) -> Result<Vec<[f64; 2]>, String> {
    let [by_f, by_q] = factors(&compiled.airframe, row)?;
    let physics = compiled.physics();
    let units = 0..compiled.airframe.units.len();
    let efforts = units.map(|unit| physics.efforts(unit, &row.values, health));
    Ok(efforts.map(|[f, q]| [by_f * f, by_q * q]).collect())
}

/// `[k_f, k_Q]` of a row of throttles.
fn factors(airframe: &Airframe, row: &Row<f64>) -> Result<[f64; 2], String> {
    let mut throttles = row.values.iter().enumerate();
    if let Some((channel, throttle)) = throttles.find(|(_, throttle)| !(0.0..=1.0).contains(*throttle)) {
        return Err(format!("throttle_{channel} {throttle:?} is outside 0 to 1"));
    }
    let volts = within("voltage_v", row.voltage_v, airframe.voltage.as_ref())?;
    let density = within("density_kg_m3", row.density_kg_m3, airframe.air.as_ref())?;
    Ok(airframe.factors(volts, density))
}

/// A condition in its declared range, without a value that of the bench; what the file declares
/// nothing of is ignored.
fn within(name: &str, given: Option<f64>, correction: Option<&Correction>) -> Result<f64, String> {
    let Some(Correction {
        reference,
        range: [low, high],
        ..
    }) = correction
    else {
        return Ok(0.0);
    };
    let x = given.unwrap_or(*reference);
    if (low..=high).contains(&&x) {
        Ok(x)
    } else {
        Err(format!(
            "{name} {x:?} is outside the airframe's range, {low:?} to {high:?}"
        ))
    }
}

/// Runs the command.
pub fn run(args: &WrenchArgs) -> Done {
    rows::run(&args.rows, &GIVEN)
}
