//! What PX4 logs, by topic.

use super::ulog;
use crate::import::outputs::USUAL_US;
use crate::import::rotors::Stated;
use crate::review::flight::{Flight, Form};
use crate::review::log::{Channel, Log, Series};
use crate::stacks::stack::Stack;

/// PX4's ULog.
pub(crate) const FORM: Form = Form {
    magic: ulog::MAGIC,
    begin: ulog::MAGIC,
    log: |bytes| ulog::read(bytes, WANTED),
    flight,
};

#[rustfmt::skip]
const MOTORS: Channel = ("actuator_motors", &[
    "control[0]", "control[1]", "control[2]", "control[3]", "control[4]", "control[5]", "control[6]", "control[7]",
    "control[8]", "control[9]", "control[10]", "control[11]",
]);
const ACCELEROMETER: Channel = (
    "sensor_combined",
    &[
        "accelerometer_m_s2[0]",
        "accelerometer_m_s2[1]",
        "accelerometer_m_s2[2]",
    ],
);
const FILTERED: Channel = ("vehicle_acceleration", &["xyz[0]", "xyz[1]", "xyz[2]"]);
const GYROSCOPE: Channel = ("sensor_combined", &["gyro_rad[0]", "gyro_rad[1]", "gyro_rad[2]"]);
const ATTITUDE: Channel = ("vehicle_attitude", &["q[0]", "q[1]", "q[2]", "q[3]"]);
const VELOCITY: Channel = ("vehicle_local_position", &["vx", "vy", "vz"]);
const LANDED: Channel = ("vehicle_land_detected", &["landed"]);
const BATTERY: Channel = ("battery_status", &["voltage_v", "connected"]);
const CURRENT: Channel = ("battery_status", &["current_a", "discharged_mah"]);
const DENSITY: Channel = ("vehicle_air_data", &["rho"]);
const TORQUE: Channel = ("vehicle_torque_setpoint", &["xyz[0]", "xyz[1]", "xyz[2]"]);
const THRUST: Channel = ("vehicle_thrust_setpoint", &["xyz[2]"]);
#[rustfmt::skip]
const UNALLOCATED: Channel = ("control_allocator_status", &[
    "unallocated_torque[0]", "unallocated_torque[1]", "unallocated_torque[2]", "unallocated_thrust[2]",
]);
const FAILED: Channel = ("failure_detector_status", &["motor_failure_mask"]);
#[rustfmt::skip]
const SPEEDS: Channel = ("esc_status", &[
    "esc_online_flags", "esc[0].esc_rpm", "esc[1].esc_rpm", "esc[2].esc_rpm", "esc[3].esc_rpm", "esc[4].esc_rpm", "esc[5].esc_rpm",
    "esc[6].esc_rpm", "esc[7].esc_rpm", "esc[0].actuator_function", "esc[1].actuator_function", "esc[2].actuator_function",
    "esc[3].actuator_function", "esc[4].actuator_function", "esc[5].actuator_function", "esc[6].actuator_function",
    "esc[7].actuator_function",
]);

#[rustfmt::skip]
const WANTED: &[Channel] = &[
    MOTORS, ACCELEROMETER, FILTERED, GYROSCOPE, ATTITUDE, VELOCITY, LANDED, BATTERY, CURRENT, DENSITY, TORQUE, THRUST, UNALLOCATED,
    FAILED, SPEEDS,
];

/// A setpoint of which more than this was left out, in PX4's units, is cut.
const LEFT_OUT: f64 = 1e-3;

/// Rotors with a speed in `esc_status`, and the function of an output that drives the first motor.
const ESCS: usize = 8;
const MOTOR_1: f64 = 101.0;

/// Batteries that PX4 knows.
const BATTERIES: u8 = 4;

/// PX4's `DSHOT_MIN` where a log does not have it.
const DSHOT_MIN: f64 = 0.055;

fn flight(mut log: Log, vehicle: &Stated, bench_us: [f64; 2]) -> Result<Flight, String> {
    let motors = log.some(MOTORS, 0).ok_or(
        "the log has no `actuator_motors`, which says what the motors were told: PX4 logs it by default since 1.13 (SDLOG_PROFILE)",
    )?;
    let pulses = pulses_us(&log, vehicle);
    let factor = log.parameter("THR_MDL_FAC", 0.0);
    let on_bench = |control: &f64| {
        let us = pulses[0] + curve(factor, *control) * (pulses[1] - pulses[0]);
        (us - bench_us[0]) / (bench_us[1] - bench_us[0])
    };
    let force = log.series(ACCELEROMETER, 0).or_else(|| log.series(FILTERED, 0));
    let (torque, thrust) = (log.series(TORQUE, 0), log.series(THRUST, 0));
    let battery = (0..BATTERIES).find_map(|battery| Some((battery, voltage(&mut log, battery)?)));
    let (number, voltage) = battery.map_or((0, None), |(number, voltage)| (number, Some(voltage)));
    Ok(Flight {
        stack: Stack::Px4,
        throttle: motors.map(|row| row.iter().map(on_bench).collect()),
        force: force
            .ok_or("the log has no accelerometer: neither `sensor_combined` nor `vehicle_acceleration`")?,
        down: log.series(ATTITUDE, 0).map(|q| q.map(down)),
        velocity: log.series(VELOCITY, 0),
        rates: log.series(GYROSCOPE, 0),
        landed: log.series(LANDED, 0),
        voltage,
        current: log.series(CURRENT, number),
        capacity_mah: log
            .parameters
            .get(&format!("BAT{}_CAPACITY", number + 1))
            .copied(),
        density: log.series(DENSITY, 0),
        speeds: log.some(SPEEDS, 0).map_or_else(Vec::new, |escs| {
            (0..ESCS).map(|motor| speed(&escs, motor)).collect()
        }),
        setpoint: torque.zip(thrust).map(|(torque, thrust)| {
            let upward = thrust.map(|row| vec![-row[0]]);
            torque.with(&upward)
        }),
        cut: log.series(UNALLOCATED, 0).map(|left| {
            left.map(|row| {
                row.iter()
                    .map(|x| f64::from(u8::from(x.abs() > LEFT_OUT)))
                    .collect()
            })
        }),
        failed: log.series(FAILED, 0),
        damage: log.damage,
    })
}

/// What PX4's outputs make of a motor's command (`FunctionMotors`): the throttle whose thrust
/// is f x^2 + (1 - f) x with f = `THR_MDL_FAC`.
fn curve(factor: f64, control: f64) -> f64 {
    if factor <= 0.0 || factor > 1.0 {
        return control;
    }
    let half = 0.5 * (1.0 - factor) / factor;
    (half * half + control.max(0.0) / factor).sqrt() - half
}

/// Pulse widths of a command of 0 and 1, microseconds; of DShot those that have the same throttle.
fn pulses_us(log: &Log, vehicle: &Stated) -> [f64; 2] {
    match vehicle.is_dshot {
        true => [1000.0 + 1000.0 * log.parameter("DSHOT_MIN", DSHOT_MIN), 2000.0],
        false => vehicle.pulses_us.unwrap_or(USUAL_US),
    }
}

/// The third row of the rotation from body to earth.
fn down(q: &[f64]) -> Vec<f64> {
    let [w, x, y, z] = [q[0], q[1], q[2], q[3]];
    vec![
        2.0 * (x * z - w * y),
        2.0 * (y * z + w * x),
        w * w - x * x - y * y + z * z,
    ]
}

/// Of a battery that is connected.
fn voltage(log: &mut Log, battery: u8) -> Option<Series> {
    let is_connected = |series: &Series| series.rows().any(|(_, row)| row[1] != 0.0 && row[0] > 0.0);
    let both = log.series(BATTERY, battery).filter(is_connected)?;
    Some(both.map(|row| vec![row[0]]))
}

/// Of a motor, rpm, while its controller is online; that of the same number in logs that do not say which is whose.
fn speed(escs: &Series, motor: usize) -> Series {
    let mut speed = Series::default();
    for (time_s, row) in escs.rows() {
        let drives = |esc: &usize| {
            row.get(1 + ESCS + esc)
                .is_some_and(|function| *function == MOTOR_1 + motor as f64)
        };
        let esc = if row.len() > 1 + ESCS {
            (0..ESCS).find(drives)
        } else {
            Some(motor)
        };
        let online = esc.filter(|esc| (row[0] as u64 >> esc) & 1 == 1);
        if let Some(rpm) = online.and_then(|esc| row.get(1 + esc)) {
            speed.push(time_s, vec![rpm.abs()]);
        }
    }
    speed
}
