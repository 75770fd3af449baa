//! What PX4 sends and reads: messages of MAVLink for simulators.

use std::iter::repeat;

use mavlink::dialects::common::{
    HIL_ACTUATOR_CONTROLS_DATA, HIL_GPS_DATA, HIL_SENSOR_DATA, HIL_STATE_QUATERNION_DATA,
    HilSensorUpdatedFlags, MavMessage, MavModeFlag,
};
use nalgebra::Vector3;

use crate::sitl::sensors::{Sensors, place};
use crate::sitl::vehicle::{MOST_ROTORS, Throttles};
use crate::sitl::world::World;

/// Bits of the fields of `HIL_SENSOR`: of acceleration and rates; of field, pressures, altitude and
/// temperature. The differential pressure, 0, is that of a sensor whose temperature PX4 takes for
/// the air's: it would take 15 degrees Celsius.
const INERTIAL_FIELDS: u32 = 0b11_1111;
const SLOW_FIELDS: u32 = 0b1_1111_1100_0000;

/// Whether PX4 is armed.
pub fn is_armed(controls: &HIL_ACTUATOR_CONTROLS_DATA) -> bool {
    controls.mode.contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED)
}

/// PX4's outputs, all at rest unless it is armed.
pub fn throttles(controls: &HIL_ACTUATOR_CONTROLS_DATA) -> Throttles {
    let outputs = controls.controls.iter().filter(|_| is_armed(controls));
    Throttles::from_iterator(
        outputs
            .map(|output| f64::from(*output))
            .chain(repeat(0.0))
            .take(MOST_ROTORS),
    )
}

fn floats(vector: &Vector3<f64>) -> [f32; 3] {
    vector.map(|value| value as f32).into()
}

/// What the sensors measure; the slow ones, magnetometer and barometer, not in every sample.
pub fn measured(world: &World, sensors: &mut Sensors, slow: bool) -> MavMessage {
    let [[xacc, yacc, zacc], [xgyro, ygyro, zgyro]] = sensors.inertial(world).map(|vector| floats(&vector));
    let slow = if slow { SLOW_FIELDS } else { 0 };
    let fields_updated = HilSensorUpdatedFlags::from_bits_truncate(INERTIAL_FIELDS | slow);
    let [xmag, ymag, zmag] = floats(&sensors.field(world));
    let [abs_pressure, pressure_alt, temperature] = sensors.air(world).map(|value| value as f32);
    MavMessage::HIL_SENSOR(HIL_SENSOR_DATA {
        time_usec: world.time_us,
        xacc,
        yacc,
        zacc,
        xgyro,
        ygyro,
        zgyro,
        xmag,
        ymag,
        zmag,
        abs_pressure,
        pressure_alt,
        temperature,
        fields_updated,
        ..HIL_SENSOR_DATA::DEFAULT
    })
}

/// Degrees in units of 1e-7, and millimetres.
fn scaled([latitude, longitude, altitude]: [f64; 3]) -> [i32; 3] {
    [latitude * 1e7, longitude * 1e7, altitude * 1e3].map(|value| value.round() as i32)
}

fn centimetres(velocity: &Vector3<f64>) -> [i16; 3] {
    velocity.map(|speed| (100.0 * speed).round() as i16).into()
}

/// What the satellite receiver measures.
pub fn fix(world: &World, sensors: &mut Sensors) -> MavMessage {
    let (place, velocity) = sensors.fix(world);
    let [lat, lon, alt] = scaled(place);
    let [vn, ve, vd] = centimetres(&velocity);
    let course = libm::atan2(velocity.y, velocity.x).to_degrees();
    MavMessage::HIL_GPS(HIL_GPS_DATA {
        time_usec: world.time_us,
        lat,
        lon,
        alt,
        eph: 30,
        epv: 40,
        vel: (100.0 * velocity.norm()) as u16,
        vn,
        ve,
        vd,
        cog: (100.0 * course.rem_euclid(360.0)) as u16 % 36_000,
        fix_type: 3,
        satellites_visible: 10,
        // Its yaw, 0, is not known.
        ..HIL_GPS_DATA::DEFAULT
    })
}

/// The true state, which PX4 logs.
pub fn truth(world: &World) -> MavMessage {
    let state = &world.state;
    let q = state.attitude;
    let [rollspeed, pitchspeed, yawspeed] = floats(&state.rate);
    let [lat, lon, alt] = scaled(place(&state.position, world.vehicle.altitude_m));
    let [vx, vy, vz] = centimetres(&state.velocity);
    // In thousandths of the standard gravity.
    let [xacc, yacc, zacc] = floats(&(world.specific_force * (1e3 / 9.806_65))).map(|a| a as i16);
    MavMessage::HIL_STATE_QUATERNION(HIL_STATE_QUATERNION_DATA {
        time_usec: world.time_us,
        attitude_quaternion: [q.w as f32, q.i as f32, q.j as f32, q.k as f32],
        rollspeed,
        pitchspeed,
        yawspeed,
        lat,
        lon,
        alt,
        vx,
        vy,
        vz,
        xacc,
        yacc,
        zacc,
        ..HIL_STATE_QUATERNION_DATA::DEFAULT
    })
}
