//! The data behind the tables and figures as CSV.

use std::io::Write;

use crate::flight::Flight;
use crate::mixer::Method;
use crate::table::Comparison;
use crate::tracking::TrackingError;

/// Periods from one row of a flight's log to the next: 20 ms.
const EVERY: usize = 4;

/// Writes a flight: reference, what was flown, command, throttles, voltage; every 20 ms, SI units,
/// yaw in degrees.
///
/// # Errors
/// What `to` cannot take.
pub fn write_flight(flight: &Flight, to: impl Write) -> csv::Result<()> {
    let mut writer = csv::Writer::from_writer(to);
    let mut header = vec![
        "time_s",
        "reference_x_m",
        "reference_y_m",
        "reference_z_m",
        "reference_yaw_deg",
        "x_m",
        "y_m",
        "z_m",
        "yaw_deg",
        "roll_nm",
        "pitch_nm",
        "yaw_nm",
        "thrust_n",
        "voltage_v",
    ]
    .into_iter()
    .map(String::from)
    .collect::<Vec<_>>();
    let rotors = flight.samples.first().map_or(0, |sample| sample.throttle.len());
    header.extend((0..rotors).map(|channel| format!("throttle_{channel}")));
    writer.write_record(&header)?;
    for sample in flight.samples.iter().step_by(EVERY) {
        let reference = sample.reference.position.iter().copied();
        let values = std::iter::once(sample.time_s)
            .chain(reference)
            .chain([sample.reference.yaw.to_degrees()])
            .chain(sample.position.iter().copied())
            .chain([sample.yaw.to_degrees()])
            .chain(sample.command.iter().copied())
            .chain([sample.voltage_v])
            .chain(sample.throttle.iter().copied());
        writer.write_record(values.map(|value| format!("{value:.6}")))?;
    }
    writer.flush()?;
    Ok(())
}

/// Writes the figures of Table II and the hover thrust of every flight.
///
/// # Errors
/// What `to` cannot take.
pub fn write_tracking(comparisons: &[Comparison], to: impl Write) -> csv::Result<()> {
    let mut writer = csv::Writer::from_writer(to);
    let mut header = ["scenario", "seed", "mixer"].map(String::from).to_vec();
    for name in TrackingError::NAMES {
        header.extend(["x", "y", "z"].map(|axis| format!("{}_{axis}", name.to_lowercase())));
    }
    header.extend(["hover_thrust_per_weight", "yaw_mae_deg", "saturated_periods"].map(String::from));
    writer.write_record(&header)?;
    for comparison in comparisons {
        for pair in &comparison.flights {
            for method in [Method::Coaxial, Method::Conventional] {
                let flight = pair.with(method);
                let mut record = vec![
                    comparison.scenario.to_string(),
                    pair.seed.to_string(),
                    method.to_string(),
                ];
                let rows = flight.tracking_error().rows();
                record.extend(rows.iter().flatten().map(|value| format!("{value:.6e}")));
                record.push(format!("{:.6}", flight.hover_thrust()));
                record.push(format!("{:.6}", flight.yaw_error().to_degrees()));
                record.push(flight.saturated().to_string());
                writer.write_record(&record)?;
            }
        }
    }
    writer.flush()?;
    Ok(())
}
