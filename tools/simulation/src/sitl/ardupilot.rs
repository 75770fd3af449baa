//! ArduPilot's interface for outside simulators: pulse widths in, JSON out, over UDP.
//!
//! ArduPilot (`--model JSON`) sends a packet per step and waits for the answer. After a second
//! without one it sends the packet again, with the number that it had: it gets the same answer, and
//! no time passes. A number that goes back is an ArduPilot that has started anew.

use std::io::ErrorKind;
use std::net::UdpSocket;
use std::time::{Duration, Instant};

use nalgebra::Vector3;

use super::flight::{End, Flight};
use super::link::{self, is_silence};
use super::sensors::Sensors;
use super::vehicle::{MOST_ROTORS, Throttles};
use super::world::World;

/// First two bytes of a packet of 16, and of 32 channels.
const MAGIC_16: u16 = 18_458;
const MAGIC_32: u16 = 29_569;

/// Bytes before the channels.
const HEAD: usize = 8;

/// Steps per second that are taken; ArduPilot takes no step of 0.1 s or more.
const RATE_HZ: std::ops::RangeInclusive<u16> = 50..=10_000;

/// Silence in real time after which ArduPilot has gone: it repeats itself after a second.
const SILENCE: Duration = Duration::from_secs(10);

/// Longest wait for a packet in one go: until ArduPilot is there its port is tried this often.
const WAIT: Duration = Duration::from_millis(100);

/// ArduPilot's port of a simulator.
pub const PORT: u16 = 9002;

/// A port that ArduPilot may send to.
///
/// # Errors
/// A port that is taken.
pub fn listen(port: u16) -> Result<UdpSocket, String> {
    let mend = ", or give --port another one and start ArduPilot with --sim-port-out";
    link::listen(port, Some(WAIT), "ArduPilot", mend)
}

/// A packet of ArduPilot: steps per second, its number, a throttle per channel.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Packet {
    rate_hz: u16,
    count: u32,
    throttles: Throttles,
}

/// Serves ArduPilot until the flight ends.
///
/// # Errors
/// A client that vanishes, a pilot who gives up.
pub fn serve(
    socket: &UdpSocket,
    flight: &mut Flight,
    sensors: &mut Sensors,
    pulses: [f64; 2],
) -> Result<End, String> {
    let mut malformed = 0;
    let end = fly(socket, flight, sensors, pulses, &mut malformed);
    flight.record.note("malformed packets", malformed);
    end
}

fn fly(
    socket: &UdpSocket,
    flight: &mut Flight,
    sensors: &mut Sensors,
    pulses: [f64; 2],
    malformed: &mut u64,
) -> Result<End, String> {
    let mut bytes = [0; 1024];
    let mut last: Option<(u32, String)> = None;
    let mut heard = Instant::now();
    loop {
        let (count, from) = match socket.recv_from(&mut bytes) {
            Ok(received) => received,
            // A refused connection is that of the answer before: ArduPilot has gone, or will come back.
            Err(error) if is_silence(&error) || error.kind() == ErrorKind::ConnectionRefused => {
                if let Some(pilot) = &mut flight.pilot {
                    // ArduPilot does not start before somebody has connected.
                    pilot.connect();
                }
                if last.is_some() && heard.elapsed() > SILENCE {
                    return Err(format!("ArduPilot has sent nothing for {} s", SILENCE.as_secs()));
                }
                continue;
            }
            Err(error) => return Err(format!("no packet from ArduPilot: {error}")),
        };
        let Some(packet) = packet(&bytes[..count], pulses) else {
            *malformed += 1;
            if *malformed == 1 {
                eprintln!("a packet of {count} bytes is not ArduPilot's: passed over");
            }
            continue;
        };
        heard = Instant::now();
        let mut end = None;
        let answer = match last {
            Some((before, answer)) if before == packet.count => answer,
            before => {
                match before {
                    None => eprintln!("ArduPilot has connected, {} steps per second", packet.rate_hz),
                    Some((count, _)) if packet.count < count => {
                        eprintln!("ArduPilot has started anew, the vehicle is back on the ground");
                        flight.restart()?;
                    }
                    Some(_) => {}
                }
                let duration_us = 1_000_000 / u64::from(packet.rate_hz);
                end = flight.advance(&packet.throttles, duration_us)?;
                answer(&flight.world, sensors)
            }
        };
        // A loss is made good by ArduPilot's repetition.
        let _ = socket.send_to(answer.as_bytes(), from);
        if let Some(end) = end {
            return Ok(end);
        }
        last = Some((packet.count, answer));
    }
}

/// `None` of anything else.
fn packet(bytes: &[u8], [low, high]: [f64; 2]) -> Option<Packet> {
    let word = |at: usize| Some(u16::from_le_bytes(bytes.get(at..at + 2)?.try_into().ok()?));
    let channels = match word(0)? {
        MAGIC_16 => 16,
        MAGIC_32 => 32,
        _ => return None,
    };
    if bytes.len() != HEAD + 2 * channels {
        return None;
    }
    let mut throttles = Throttles::zeros();
    for channel in 0..channels.min(MOST_ROTORS) {
        let pulse = f64::from(word(HEAD + 2 * channel)?);
        // 0 is no pulse.
        throttles[channel] = ((pulse - low) / (high - low)).clamp(0.0, 1.0);
    }
    Some(Packet {
        rate_hz: word(2).filter(|rate_hz| RATE_HZ.contains(rate_hz))?,
        count: u32::from_le_bytes(bytes.get(4..8)?.try_into().ok()?),
        throttles,
    })
}

/// A line. ArduPilot looks for `"key":` and takes what follows: no blanks. The first newline is for
/// the first line: ArduPilot looks for a line between two of them.
fn answer(world: &World, sensors: &mut Sensors) -> String {
    let state = &world.state;
    let [acceleration, rate] = sensors.inertial(world);
    let q = state.attitude;
    let list = |vector: &Vector3<f64>| format!("[{:.9},{:.9},{:.9}]", vector.x, vector.y, vector.z);
    format!(
        "\n{{\"timestamp\":{:.6},\"imu\":{{\"gyro\":{},\"accel_body\":{}}},\"position\":{},\
         \"quaternion\":[{:.9},{:.9},{:.9},{:.9}],\"velocity\":{},\"battery\":{{\"voltage\":{:.4},\"current\":{:.4}}},\
         \"no_time_sync\":1}}\n",
        world.time_s(),
        list(&rate),
        list(&acceleration),
        list(&state.position),
        q.w,
        q.i,
        q.j,
        q.k,
        list(&state.velocity),
        world.voltage_v(),
        world.current_a(),
    )
}
