//! The data behind the tables and figures as CSV.

use std::io::Write;

use crate::flight::Flight;
use crate::mixer::Method;
use crate::table::Comparison;
use crate::vehicle::ROTORS;

/// Periods from one row of a flight's log to the next: 20 ms.
const EVERY: usize = 4;

/// Writes `names` and a throttle per rotor as a header, then rows of numbers; NaN is an empty field.
///
/// # Errors
/// What `to` cannot take.
pub fn write_rows(
    names: &str,
    rotors: usize,
    decimals: usize,
    rows: impl Iterator<Item = Vec<f64>>,
    to: impl Write,
) -> csv::Result<()> {
    let mut writer = csv::Writer::from_writer(to);
    let throttles = (0..rotors).map(|rotor| format!("throttle_{rotor}"));
    writer.write_record(names.split(',').map(str::to_owned).chain(throttles))?;
    for row in rows {
        let text = |value: f64| (!value.is_nan()).then(|| format!("{value:.decimals$}"));
        writer.write_record(row.into_iter().map(|value| text(value).unwrap_or_default()))?;
    }
    Ok(writer.flush()?)
}

/// Writes a flight: reference, what was flown, command, throttles, voltage; every 20 ms, SI units,
/// yaw in degrees.
///
/// # Errors
/// What `to` cannot take.
pub fn write_flight(flight: &Flight, to: impl Write) -> csv::Result<()> {
    let names = "time_s,reference_x_m,reference_y_m,reference_z_m,reference_yaw_deg,x_m,y_m,z_m,yaw_deg,\
                 roll_nm,pitch_nm,yaw_nm,thrust_n,voltage_v";
    let rows = flight.samples.iter().step_by(EVERY).map(|sample| {
        let parts: [&[f64]; 7] = [
            &[sample.time_s],
            sample.reference.position.as_slice(),
            &[sample.reference.yaw.to_degrees()],
            sample.position.as_slice(),
            &[sample.yaw.to_degrees()],
            sample.command.as_slice(),
            &[sample.voltage_v],
        ];
        [&parts.concat(), sample.throttle.as_slice()].concat()
    });
    write_rows(names, ROTORS, 6, rows, to)
}

/// Writes the figures of Table II and the hover thrust of every flight.
///
/// # Errors
/// What `to` cannot take.
pub fn write_tracking(comparisons: &[Comparison], to: impl Write) -> csv::Result<()> {
    let mut writer = csv::Writer::from_writer(to);
    let names = "scenario,seed,mixer,mse_x,mse_y,mse_z,mae_x,mae_y,mae_z,maxae_x,maxae_y,maxae_z,\
                 hover_thrust_per_weight,yaw_mae_deg,saturated_periods";
    writer.write_record(names.split(','))?;
    for comparison in comparisons {
        for pair in &comparison.flights {
            for method in Method::BOTH {
                let flight = pair.with(method);
                let mut record = vec![
                    comparison.scenario.to_string(),
                    pair.seed.to_string(),
                    method.to_string(),
                ];
                let rows = flight.tracking_error().rows();
                record.extend(rows.iter().flatten().map(|value| format!("{value:.6e}")));
                let means = [flight.hover_thrust(), flight.yaw_error().to_degrees()];
                record.extend(means.map(|value| format!("{value:.6}")));
                record.push(flight.saturated().to_string());
                writer.write_record(&record)?;
            }
        }
    }
    Ok(writer.flush()?)
}
