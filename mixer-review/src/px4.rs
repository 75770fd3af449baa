//! What PX4 logs, by topic.

use mixer_files::import::Stated;

use crate::flight::{Flight, Stack, USUAL_US};
use crate::log::{Log, Series, Wanted};

pub(crate) const WANTED: &Wanted = &[
    (
        "actuator_motors",
        &[
            "control[0]",
            "control[1]",
            "control[2]",
            "control[3]",
            "control[4]",
            "control[5]",
            "control[6]",
            "control[7]",
            "control[8]",
            "control[9]",
            "control[10]",
            "control[11]",
        ],
    ),
    (
        "sensor_combined",
        &[
            "accelerometer_m_s2[0]",
            "accelerometer_m_s2[1]",
            "accelerometer_m_s2[2]",
            "gyro_rad[0]",
            "gyro_rad[1]",
            "gyro_rad[2]",
        ],
    ),
    ("vehicle_acceleration", &["xyz[0]", "xyz[1]", "xyz[2]"]),
    ("vehicle_attitude", &["q[0]", "q[1]", "q[2]", "q[3]"]),
    ("vehicle_local_position", &["vx", "vy", "vz"]),
    ("vehicle_land_detected", &["landed"]),
    ("battery_status", &["voltage_v", "connected"]),
    ("vehicle_air_data", &["rho"]),
    ("vehicle_torque_setpoint", &["xyz[0]", "xyz[1]", "xyz[2]"]),
    ("vehicle_thrust_setpoint", &["xyz[2]"]),
    (
        "control_allocator_status",
        &[
            "unallocated_torque[0]",
            "unallocated_torque[1]",
            "unallocated_torque[2]",
            "unallocated_thrust[2]",
        ],
    ),
    ("failure_detector_status", &["motor_failure_mask"]),
];

/// Batteries that PX4 knows.
const BATTERIES: u8 = 4;

/// PX4's `DSHOT_MIN` where a log does not have it.
const DSHOT_MIN: f64 = 0.055;

/// # Errors
/// What the log lacks.
pub(crate) fn flight(log: &Log, vehicle: &Stated, bench_us: [f64; 2]) -> Result<Flight, String> {
    let motors = log.numbered("actuator_motors", "control[{}]", 0);
    let motors: Vec<&str> = motors.iter().map(String::as_str).collect();
    let motors = log.series("actuator_motors", 0, &motors).filter(|_| !motors.is_empty()).ok_or(
        "the log has no `actuator_motors`, which says what the motors were told: PX4 logs it by default since 1.13 (SDLOG_PROFILE)",
    )?;
    let pulses = pulses_us(log, vehicle);
    let factor = log.parameter("THR_MDL_FAC", 0.0);
    let on_bench = |control: &f64| {
        let us = pulses[0] + curve(factor, *control) * (pulses[1] - pulses[0]);
        (us - bench_us[0]) / (bench_us[1] - bench_us[0])
    };
    let accelerometer = [
        "accelerometer_m_s2[0]",
        "accelerometer_m_s2[1]",
        "accelerometer_m_s2[2]",
    ];
    let force = log.series("sensor_combined", 0, &accelerometer);
    let force = force.or_else(|| log.series("vehicle_acceleration", 0, &["xyz[0]", "xyz[1]", "xyz[2]"]));
    let torque = log.series("vehicle_torque_setpoint", 0, &["xyz[0]", "xyz[1]", "xyz[2]"]);
    let thrust = log.series("vehicle_thrust_setpoint", 0, &["xyz[2]"]);
    let status = [
        "unallocated_torque[0]",
        "unallocated_torque[1]",
        "unallocated_torque[2]",
        "unallocated_thrust[2]",
    ];
    Ok(Flight {
        stack: Stack::Px4,
        throttle: motors.map(|row| row.iter().map(on_bench).collect()),
        force: force
            .ok_or("the log has no accelerometer: neither `sensor_combined` nor `vehicle_acceleration`")?,
        down: log
            .series("vehicle_attitude", 0, &["q[0]", "q[1]", "q[2]", "q[3]"])
            .map(|q| q.map(down)),
        velocity: log.series("vehicle_local_position", 0, &["vx", "vy", "vz"]),
        rates: log.series(
            "sensor_combined",
            0,
            &["gyro_rad[0]", "gyro_rad[1]", "gyro_rad[2]"],
        ),
        landed: log.series("vehicle_land_detected", 0, &["landed"]),
        voltage: (0..BATTERIES).find_map(|battery| voltage(log, battery)),
        density: log.series("vehicle_air_data", 0, &["rho"]),
        setpoint: torque
            .zip(thrust)
            .map(|(torque, thrust)| with_thrust(&torque, &thrust)),
        unallocated: log.series("control_allocator_status", 0, &status),
        failed: log.series("failure_detector_status", 0, &["motor_failure_mask"]),
        damage: log.damage.clone(),
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
    let is_dshot =
        |(name, value): (&String, &f64)| name.starts_with("PWM_") && name.contains("_TIM") && *value < -1.0;
    match log.parameters.iter().any(is_dshot) {
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
fn voltage(log: &Log, battery: u8) -> Option<Series> {
    let both = log.series("battery_status", battery, &["voltage_v", "connected"]);
    let is_connected = |series: &Series| series.rows().any(|(_, row)| row[1] != 0.0 && row[0] > 0.0);
    Some(both.filter(is_connected)?.map(|row| vec![row[0]]))
}

fn with_thrust(torque: &Series, thrust: &Series) -> Series {
    let mut all = Series::default();
    for (time_s, row) in torque.rows() {
        if let Some(thrust) = thrust.at(time_s) {
            all.push(time_s, row.iter().copied().chain([-thrust[0]]).collect());
        }
    }
    all
}
