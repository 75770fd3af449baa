//! ArduPilot's interface for outside simulators: pulse widths in, JSON out, over UDP.
//!
//! ArduPilot (`--model JSON`) sends a packet per step and waits for the answer. After a second
//! without one it sends the packet again, with the number that it had: it gets the same answer, and
//! no time passes. A number that goes back is an ArduPilot that has started anew.

pub mod packets;

use std::io::ErrorKind;
use std::net::UdpSocket;
use std::time::{Duration, Instant};

use self::packets::{answer, packet};
use super::arguments::Arguments;
use super::flight::{End, Flight, Port};
use super::link::{self, Link, is_silence};
use super::pilot::{Stack, Station};
use super::sensors::Sensors;

/// Silence in real time after which ArduPilot has gone: it repeats itself after a second.
const SILENCE: Duration = Duration::from_secs(10);

/// Longest wait for a packet in one go: until ArduPilot is there its port is tried this often.
const WAIT: Duration = Duration::from_millis(100);

/// ArduPilot's port of a simulator, and its first serial port; instance 0.
const PORT: u16 = 9002;
const LINK: u16 = 5760;

/// Guided mode of Copter. A thrust setpoint of 0.5 is no climb.
const STACK: Stack = Stack {
    guided: 4,
    mode_bit: 0,
    has_position: Some("is using GPS"),
    is_sent_up: true,
    level_thrust: Some(0.5),
    battery: None,
};

/// The port that ArduPilot sends to, and its pilot.
///
/// # Errors
/// A port that is taken.
pub fn open(arguments: &Arguments) -> Result<Port, String> {
    let mend = ", or give --port another one and start ArduPilot with --sim-port-out";
    let socket = link::listen(arguments.port.unwrap_or(PORT), Some(WAIT), "ArduPilot", mend)?;
    let link = Link::tcp(arguments.link.unwrap_or(LINK));
    let pulses = arguments.pwm_range;
    Ok(Port {
        name: "ArduPilot on UDP",
        address: socket.local_addr(),
        pilot: Box::new(Station::new(&STACK, link, arguments)),
        serve: Box::new(move |flight, sensors| serve(&socket, flight, sensors, pulses)),
    })
}

/// Serves ArduPilot until the flight ends.
fn serve(
    socket: &UdpSocket,
    flight: &mut Flight,
    sensors: &mut Sensors,
    pulses: [f64; 2],
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
            if flight.record.note("malformed packets", 1) == 1 {
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
