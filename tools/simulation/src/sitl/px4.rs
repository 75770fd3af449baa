//! PX4's interface for outside simulators: MAVLink's HIL messages over TCP, in lockstep.
//!
//! PX4 (`simulator_mavlink`) connects. Each `HIL_SENSOR` sets its clock; it answers with
//! `HIL_ACTUATOR_CONTROLS` once all of its modules have run. The first frames go without an answer:
//! PX4 gives none before its modules are up.

use std::io::{Read, Write};
use std::iter::repeat;
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::time::{Duration, Instant};

use mavlink::dialects::common::{
    HIL_ACTUATOR_CONTROLS_DATA, HIL_GPS_DATA, HIL_SENSOR_DATA, HIL_STATE_QUATERNION_DATA,
    HilSensorUpdatedFlags, MavMessage, MavModeFlag,
};
use nalgebra::Vector3;

use super::flight::{End, Flight};
use super::frames::{Frames, frame};
use super::link::is_silence;
use super::messages::heartbeat;
use super::sensors::{Sensors, place};
use super::vehicle::{MOST_ROTORS, Throttles};
use super::world::World;

/// Time between samples, microseconds: PX4's start scripts count on 250 per second, and with more it
/// does not answer each.
const PERIOD_US: u64 = 4000;

/// Samples between two of magnetometer and barometer, 50 Hz, and of the satellite receiver, 10 Hz.
const SLOW: u64 = 5;
const FIX: u64 = 25;

/// Longest wait for an answer in real time: in flight, while PX4 is disarmed and may exchange its
/// modules, and before it has answered at all.
const PATIENCE: Duration = Duration::from_secs(2);
const DISARMED: Duration = Duration::from_millis(100);
const PERIOD: Duration = Duration::from_micros(PERIOD_US);

/// Bits of the fields of `HIL_SENSOR`: of acceleration and rates; of field, pressures, altitude and
/// temperature. The differential pressure, 0, is that of a sensor whose temperature PX4 takes for
/// the air's: it would take 15 degrees Celsius.
const INERTIAL_FIELDS: u32 = 0b11_1111;
const SLOW_FIELDS: u32 = 0b1_1111_1100_0000;

/// System and component of the simulator.
const SIMULATOR: [u8; 2] = [1, 51];

/// PX4's port of a simulator for instance 0.
pub const PORT: u16 = 4560;

/// A port that PX4 may connect to.
///
/// # Errors
/// A port that is taken.
pub fn listen(port: u16) -> Result<TcpListener, String> {
    TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(|error| {
        format!("TCP port {port} for PX4: {error}; end what uses it, or give --port another one and start PX4 as that instance")
    })
}

/// The connection to PX4.
struct Px4 {
    stream: TcpStream,
    frames: Frames,
    sequence: u8,
    throttles: Throttles,
    /// Whether PX4 has ever answered.
    answers: bool,
    armed: bool,
    unanswered: u64,
}

/// Serves PX4 until the flight ends.
///
/// # Errors
/// A client that vanishes, a pilot who gives up.
pub fn serve(listener: &TcpListener, flight: &mut Flight, sensors: &mut Sensors) -> Result<End, String> {
    let (stream, _) = listener
        .accept()
        .map_err(|error| format!("no connection from PX4: {error}"))?;
    // Small frames, each of which the other side waits for.
    let _ = stream.set_nodelay(true);
    eprintln!("PX4 has connected");
    let mut px4 = Px4 {
        stream,
        frames: Frames::default(),
        sequence: 0,
        throttles: Throttles::zeros(),
        answers: false,
        armed: false,
        unanswered: 0,
    };
    let end = px4.fly(flight, sensors);
    let record = &mut flight.record;
    record.note("armed steps without an answer", px4.unanswered);
    record.note("malformed pieces", px4.frames.malformed);
    end
}

impl Px4 {
    fn fly(&mut self, flight: &mut Flight, sensors: &mut Sensors) -> Result<End, String> {
        self.send(&heartbeat())?;
        for sample in 0u64.. {
            if let Some(end) = flight.advance(&self.throttles, PERIOD_US)? {
                return Ok(end);
            }
            let world = &flight.world;
            if sample.is_multiple_of(FIX) {
                self.send(&fix(world, sensors))?;
            }
            self.send(&truth(world))?;
            self.send(&measured(world, sensors, sample.is_multiple_of(SLOW)))?;
            self.answer(world.time_us)?;
        }
        Ok(End::Done)
    }

    fn send(&mut self, message: &MavMessage) -> Result<(), String> {
        let frame = frame(&mut self.sequence, SIMULATOR, message);
        self.stream.write_all(&frame).map_err(vanished)
    }

    /// Waits for the outputs that follow the sample of `time_us`. Before PX4 answers at all, it is
    /// given real time to start.
    fn answer(&mut self, time_us: u64) -> Result<(), String> {
        let patience = match (self.answers, self.armed) {
            (false, _) => PERIOD,
            (true, false) => DISARMED,
            (true, true) => PATIENCE,
        };
        let deadline = Instant::now() + patience;
        let mut bytes = [0; 4096];
        loop {
            for (_, message) in self.frames.by_ref() {
                if let MavMessage::HIL_ACTUATOR_CONTROLS(controls) = message {
                    self.armed = is_armed(&controls);
                    self.throttles = throttles(&controls);
                    self.answers = true;
                    if controls.time_usec >= time_us {
                        return Ok(());
                    }
                }
            }
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                if self.armed {
                    self.unanswered += 1;
                    if self.unanswered == 1 {
                        eprintln!("PX4 has not answered within {} s: going on", PATIENCE.as_secs());
                    }
                }
                return Ok(());
            }
            self.stream.set_read_timeout(Some(left)).map_err(vanished)?;
            match self.stream.read(&mut bytes) {
                Ok(0) => return Err("PX4 has closed the connection".to_owned()),
                Ok(count) => self.frames.push(&bytes[..count]),
                Err(error) if is_silence(&error) => {}
                Err(error) => return Err(vanished(error)),
            }
        }
    }
}

fn vanished(error: std::io::Error) -> String {
    format!("PX4 has gone: {error}")
}

fn is_armed(controls: &HIL_ACTUATOR_CONTROLS_DATA) -> bool {
    controls.mode.contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED)
}

/// PX4's outputs, all at rest unless it is armed.
fn throttles(controls: &HIL_ACTUATOR_CONTROLS_DATA) -> Throttles {
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

fn measured(world: &World, sensors: &mut Sensors, slow: bool) -> MavMessage {
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

fn fix(world: &World, sensors: &mut Sensors) -> MavMessage {
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

fn truth(world: &World) -> MavMessage {
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
