//! PX4's interface for outside simulators: MAVLink's HIL messages over TCP, in lockstep.
//!
//! PX4 (`simulator_mavlink`) connects. Each `HIL_SENSOR` sets its clock; it answers with
//! `HIL_ACTUATOR_CONTROLS` once all of its modules have run. The first frames go without an answer:
//! PX4 gives none before its modules are up.

pub mod battery;
pub mod packets;

use std::io::{Read, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::time::{Duration, Instant};

use mavlink::dialects::common::MavMessage;

use self::battery::{BATTERY, battery};
use self::packets::{fix, is_armed, measured, throttles, truth};
use super::arguments::Arguments;
use super::flight::{End, Flight, Port};
use super::frames::{Frames, frame};
use super::link::{Link, is_silence};
use super::messages::heartbeat;
use super::pilot::{Stack, Station};
use super::record::Record;
use super::sensors::Sensors;
use super::vehicle::Throttles;

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

/// System and component of the simulator.
const SIMULATOR: [u8; 2] = [1, 51];

/// PX4's port of a simulator, and of its MAVLink for an offboard computer; instance 0.
const PORT: u16 = 4560;
const LINK: u16 = 14540;

/// Offboard, in which PX4 takes off by targets.
const STACK: Stack = Stack {
    guided: 6,
    mode_bit: 16,
    has_position: None,
    is_sent_up: false,
    level_thrust: None,
    battery: Some((BATTERY, battery)),
};

/// The port that PX4 connects to, and its pilot.
///
/// # Errors
/// A port that is taken.
pub fn open(arguments: &Arguments) -> Result<Port, String> {
    let link = Link::udp(arguments.link.unwrap_or(LINK))?;
    let port = arguments.port.unwrap_or(PORT);
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(|error| {
        format!("TCP port {port} for PX4: {error}; end what uses it, or give --port another one and start PX4 as that instance")
    })?;
    Ok(Port {
        name: "PX4 on TCP",
        address: listener.local_addr(),
        pilot: Box::new(Station::new(&STACK, link, arguments)),
        serve: Box::new(move |flight, sensors| serve(&listener, flight, sensors)),
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
}

/// Serves PX4 until the flight ends.
fn serve(listener: &TcpListener, flight: &mut Flight, sensors: &mut Sensors) -> Result<End, String> {
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
    };
    let end = px4.fly(flight, sensors);
    flight.record.note("malformed pieces", px4.frames.malformed);
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
            self.answer(world.time_us, &mut flight.record)?;
        }
        Ok(End::Done)
    }

    fn send(&mut self, message: &MavMessage) -> Result<(), String> {
        let frame = frame(&mut self.sequence, SIMULATOR, message);
        self.stream.write_all(&frame).map_err(vanished)
    }

    /// Waits for the outputs that follow the sample of `time_us`. Before PX4 answers at all, it is
    /// given real time to start.
    fn answer(&mut self, time_us: u64, record: &mut Record) -> Result<(), String> {
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
                if self.armed && record.note("armed steps without an answer", 1) == 1 {
                    eprintln!("PX4 has not answered within {} s: going on", PATIENCE.as_secs());
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
