//! What ArduPilot logs, by message.

use mixer_compiler::atmosphere::{LAPSE, density};

use super::dataflash;
use crate::import::rotors::Stated;
use crate::review::flight::{Flight, Form};
use crate::review::log::{Channel, Log, Series};
use crate::stacks::stack::Stack;

/// ArduPilot's DataFlash log.
pub(crate) const FORM: Form = Form {
    magic: dataflash::MAGIC,
    begin: dataflash::BEGIN,
    log: |bytes| dataflash::read(bytes, WANTED),
    flight,
};

#[rustfmt::skip]
const OUTPUTS: Channel = ("RCOU", &[
    "C1", "C2", "C3", "C4", "C5", "C6", "C7", "C8", "C9", "C10", "C11", "C12", "C13", "C14",
]);
const ACCELEROMETER: Channel = ("IMU", &["AccX", "AccY", "AccZ"]);
const GYROSCOPE: Channel = ("IMU", &["GyrX", "GyrY", "GyrZ"]);
const ATTITUDE: Channel = ("ATT", &["Roll", "Pitch"]);
const VELOCITIES: [Channel; 2] = [("XKF1", &["VN", "VE", "VD"]), ("NKF1", &["VN", "VE", "VD"])];
const EVENTS: Channel = ("EV", &["Id"]);
const BATTERY: Channel = ("BAT", &["Volt"]);
const CURRENT: Channel = ("BAT", &["Curr", "CurrTot"]);
const SPEED: Channel = ("ESC", &["RPM"]);
const AIR: Channel = ("BARO", &["Press", "GndTemp", "Alt"]);
const FLAGS: [Channel; 3] = [("PIDR", &["Flags"]), ("PIDP", &["Flags"]), ("PIDY", &["Flags"])];

/// Bit 0 of the flags: the mixer cuts the axis (`AP_PIDInfo`'s `limit`).
const LIMIT: u64 = 1;

#[rustfmt::skip]
const WANTED: &[Channel] = &[
    OUTPUTS, ACCELEROMETER, GYROSCOPE, ATTITUDE, VELOCITIES[0], VELOCITIES[1], EVENTS, BATTERY, CURRENT, SPEED, AIR,
    FLAGS[0], FLAGS[1], FLAGS[2],
];

/// Events (`LogEvent`): disarmed, landed, flying.
const ON_THE_GROUND: [f64; 2] = [11.0, 18.0];
const FLYING: f64 = 28.0;

const ZERO_C: f64 = 273.15;

fn flight(mut log: Log, vehicle: &Stated, bench_us: [f64; 2]) -> Result<Flight, String> {
    let motors = vehicle.rotors.as_ref().map_or(vehicle.pins.len(), Vec::len);
    // As ArduPilot has them where no parameter says it.
    let pin_of = |motor: usize| {
        let pin = vehicle.pins.iter().find(|(_, of)| *of == motor);
        pin.map_or(motor, |(pin, _)| pin - 1)
    };
    let pins: Vec<usize> = (0..motors).map(pin_of).collect();
    let has_all = |outputs: &Series| {
        outputs
            .rows()
            .all(|(_, row)| pins.iter().all(|pin| *pin < row.len()))
    };
    let outputs = log.some(OUTPUTS, 0).filter(has_all).ok_or(
        "the log has no `RCOU` with all motors' outputs, which says what they were told: set bit 10 of LOG_BITMASK; of outputs above 14 it \
         says nothing",
    )?;
    let throttle = |us: f64| (us - bench_us[0]) / (bench_us[1] - bench_us[0]);
    let force = log.series(ACCELEROMETER, 0);
    Ok(Flight {
        stack: Stack::Ardupilot,
        throttle: outputs.map(|row| pins.iter().map(|pin| throttle(row[*pin])).collect()),
        force: force.ok_or("the log has no accelerometer (`IMU`): set bit 7 of LOG_BITMASK")?,
        down: log.series(ATTITUDE, 0).map(|att| att.map(down)),
        velocity: VELOCITIES
            .into_iter()
            .find_map(|velocity| log.series(velocity, 0)),
        rates: log.series(GYROSCOPE, 0),
        landed: log.series(EVENTS, 0).and_then(|events| landed(&events)),
        voltage: log.series(BATTERY, 0),
        current: log.series(CURRENT, 0),
        capacity_mah: log.parameters.get("BATT_CAPACITY").copied(),
        speeds: pins
            .iter()
            .map(|pin| log.series(SPEED, *pin as u8).unwrap_or_default())
            .collect(),
        density: log.series(AIR, 0).map(|air| {
            // The barometer's own temperature is the board's.
            air.map(|row| vec![density(row[0], row[1] + ZERO_C - LAPSE * row[2])])
        }),
        setpoint: None,
        cut: cut(&mut log),
        failed: None,
        damage: log.damage,
    })
}

/// By the flags of the rate controllers; of thrust nothing is logged.
fn cut(log: &mut Log) -> Option<Series> {
    let [roll, pitch, yaw] = FLAGS.map(|flags| log.series(flags, 0));
    let flags = roll?.with(&pitch?).with(&yaw?);
    Some(flags.map(|row| row.iter().map(|flags| (*flags as u64 & LIMIT) as f64).collect()))
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
