//! What ArduPilot logs, by message.

use mixer_compiler::atmosphere::density;
use mixer_files::import::Stated;

use crate::flight::{Flight, Stack};
use crate::log::{Log, Series, Wanted};

const OUTPUTS: [&str; 14] = [
    "C1", "C2", "C3", "C4", "C5", "C6", "C7", "C8", "C9", "C10", "C11", "C12", "C13", "C14",
];

pub(crate) const WANTED: &Wanted = &[
    ("RCOU", &OUTPUTS),
    ("IMU", &["AccX", "AccY", "AccZ", "GyrX", "GyrY", "GyrZ"]),
    ("ATT", &["Roll", "Pitch"]),
    ("XKF1", &["VN", "VE", "VD"]),
    ("NKF1", &["VN", "VE", "VD"]),
    ("EV", &["Id"]),
    ("BAT", &["Volt"]),
    ("BARO", &["Press", "GndTemp", "Alt"]),
    ("RATE", &["ROut", "POut", "YOut", "AOut"]),
];

/// Events (`LogEvent`): disarmed, landed, flying.
const ON_THE_GROUND: [f64; 2] = [11.0, 18.0];
const FLYING: f64 = 28.0;

const ZERO_C: f64 = 273.15;
const LAPSE_K_M: f64 = 0.0065;

/// # Errors
/// What the log lacks.
pub(crate) fn flight(log: &Log, vehicle: &Stated, bench_us: [f64; 2]) -> Result<Flight, String> {
    let motors = vehicle.rotors.as_ref().map_or(vehicle.pins.len(), Vec::len);
    // As ArduPilot has them where no parameter says it.
    let pin_of = |motor: usize| {
        let pin = vehicle.pins.iter().find(|(_, of)| *of == motor);
        pin.map_or(motor, |(pin, _)| pin - 1)
    };
    let pins: Vec<&str> = (0..motors)
        .map(|motor| OUTPUTS.get(pin_of(motor)).copied())
        .collect::<Option<_>>()
        .ok_or("motors at outputs above 14 are not read: give them SERVO1_FUNCTION to SERVO14_FUNCTION")?;
    let outputs = log.series("RCOU", 0, &pins).filter(|_| motors > 0).ok_or(
        "the log has no `RCOU` with all motors' outputs, which says what they were told: set bit 10 of LOG_BITMASK",
    )?;
    let throttle = |us: &f64| (us - bench_us[0]) / (bench_us[1] - bench_us[0]);
    let force = log.series("IMU", 0, &["AccX", "AccY", "AccZ"]);
    let velocity = ["XKF1", "NKF1"]
        .into_iter()
        .find_map(|topic| log.series(topic, 0, &["VN", "VE", "VD"]));
    Ok(Flight {
        stack: Stack::ArduPilot,
        throttle: outputs.map(|row| row.iter().map(throttle).collect()),
        force: force.ok_or("the log has no accelerometer (`IMU`): set bit 18 of LOG_BITMASK")?,
        down: log.series("ATT", 0, &["Roll", "Pitch"]).map(|att| att.map(down)),
        velocity,
        rates: log.series("IMU", 0, &["GyrX", "GyrY", "GyrZ"]),
        landed: log.series("EV", 0, &["Id"]).and_then(|events| landed(&events)),
        voltage: log.series("BAT", 0, &["Volt"]),
        density: log.series("BARO", 0, &["Press", "GndTemp", "Alt"]).map(|air| {
            // The barometer's own temperature is the board's.
            air.map(|row| vec![density(row[0], row[1] + ZERO_C - LAPSE_K_M * row[2])])
        }),
        setpoint: log.series("RATE", 0, &["ROut", "POut", "YOut", "AOut"]),
        unallocated: None,
        failed: None,
        damage: log.damage.clone(),
    })
}

/// From roll and pitch, degrees.
fn down(angles: &[f64]) -> Vec<f64> {
    let [(sin_r, cos_r), (sin_p, cos_p)] =
        [angles[0], angles[1]].map(|angle| (libm::sin(angle.to_radians()), libm::cos(angle.to_radians())));
    vec![-sin_p, cos_p * sin_r, cos_p * cos_r]
}

/// From the events that say so; before the first the other way round. `None` where there are none.
fn landed(events: &Series) -> Option<Series> {
    let says = |event: f64| event == FLYING || ON_THE_GROUND.contains(&event);
    let row = |lands: bool| vec![f64::from(u8::from(lands))];
    let mut landed = Series::default();
    for (time_s, event) in events.rows().filter(|(_, event)| says(event[0])) {
        if landed.is_empty() {
            landed.push(0.0, row(event[0] == FLYING));
        }
        landed.push(time_s, row(event[0] != FLYING));
    }
    (!landed.is_empty()).then_some(landed)
}
