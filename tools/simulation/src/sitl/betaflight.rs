//! Betaflight's interface for outside simulators (`src/platform/SIMULATOR/sitl.c`): motors in, state and sticks out, over UDP, in
//! the time of the wall clock. MSP tells what keeps it from arming.

use std::io::{Read, Write};
use std::net::{Ipv4Addr, TcpStream, UdpSocket};
use std::time::{Duration, Instant};

use super::flight::{End, Flight};
use super::link;
use super::pilot::Channels;
use super::sensors::Sensors;
use super::vehicle::{MOST_ROTORS, Throttles};
use super::world::World;

/// Betaflight's port of all motors, which it sends to; from there to those of the state and of the sticks, which it listens to.
pub const PORT: u16 = 9001;
const STATE: u16 = 2;
const STICKS: u16 = 3;

/// MSP's port.
const MSP: u16 = 5761;

/// `MSP_STATUS_EX`, and where in its answer the bytes of flight modes are counted.
const STATUS: u8 = 150;
const MODES: usize = 15;

/// Time of a step, microseconds, and of the sticks.
const STEP_US: u64 = 2000;
const STICKS_US: u64 = 10_000;

/// Silence after which Betaflight has gone.
const SILENCE: Duration = Duration::from_secs(10);

/// Behind real time by this a step is late, and where Betaflight's motors are as old.
const LATE: Duration = Duration::from_millis(20);

/// Share of late steps from which on a flight is not the mixer's: docs/simulator.md has what was measured.
const MOST_LATE: f64 = 0.001;

/// Reasons of `armingDisableFlagNames`, in its order; older versions have fewer, and in a build with the coaxial mixer one more comes
/// before the last, `ARM_SWITCH`.
const REASONS: [&str; 29] = [
    "NOGYRO",
    "FAILSAFE",
    "RXLOSS",
    "NOT_DISARMED",
    "BOXFAILSAFE",
    "RUNAWAY",
    "CRASH",
    "THROTTLE",
    "ANGLE",
    "BOOTGRACE",
    "NOPREARM",
    "LOAD",
    "CALIB",
    "CLI",
    "CMS",
    "BST",
    "MSP",
    "PARALYZE",
    "GPS",
    "RESCUE_SW",
    "DSHOT_TELEM",
    "REBOOT_REQD",
    "DSHOT_BBANG",
    "NO_ACC_CAL",
    "MOTOR_PROTO",
    "FLIP_SWITCH",
    "ALT_HOLD_SW",
    "POS_HOLD_SW",
    "AUTOPILOT_SW",
];

/// The port of the motors.
///
/// # Errors
/// A port that is taken.
pub fn listen(port: u16) -> Result<UdpSocket, String> {
    link::listen(port, None, "Betaflight", "")
}

/// Serves Betaflight until the flight ends.
///
/// # Errors
/// Betaflight has gone; a pilot who gives up; a flight in which too many steps came late.
pub fn serve(
    socket: &UdpSocket,
    port: u16,
    flight: &mut Flight,
    sensors: &mut Sensors,
    pulses: [f64; 2],
) -> Result<End, String> {
    let send = |further: u16, values: &[u8]| {
        // Nobody may be there yet.
        let _ = socket.send_to(values, (Ipv4Addr::LOCALHOST, port + further));
    };
    let (mut throttles, mut heard, mut late, mut steps) = (Throttles::zeros(), None::<Instant>, 0, 0);
    let mut bytes = [0; 512];
    let begun = Instant::now();
    loop {
        while let Ok(count) = socket.recv(&mut bytes) {
            if let Some(new) = motors(&bytes[..count], pulses) {
                throttles = new;
                if heard.replace(Instant::now()).is_none() {
                    eprintln!("Betaflight has connected");
                }
            }
        }
        if heard.is_some_and(|heard| heard.elapsed() > SILENCE) {
            return Err(format!("Betaflight has sent nothing for {} s", SILENCE.as_secs()));
        }
        let end = flight.advance(&throttles, STEP_US);
        send(STATE, &state(&flight.world, sensors));
        if flight.world.time_us.is_multiple_of(STICKS_US)
            && let Some(pilot) = &flight.pilot
        {
            send(STICKS, &sticks(flight.world.time_s(), &pilot.sticks()));
        }
        steps += 1;
        let is_behind = begun.elapsed() > Duration::from_micros(flight.world.time_us) + LATE;
        late += u64::from(is_behind || heard.is_some_and(|heard| heard.elapsed() > LATE));
        match end {
            Ok(None) => {}
            Ok(Some(end)) => {
                flight
                    .record
                    .note("steps that came 20 ms late or more, or with motors as old", late);
                return if is_late(late, steps) {
                    Err(behind(late, steps))
                } else {
                    Ok(end)
                };
            }
            Err(error) => return Err(error + &reasons().unwrap_or_default()),
        }
    }
}

/// Whether a flight is not the mixer's.
fn is_late(late: u64, steps: u64) -> bool {
    late as f64 > MOST_LATE * steps as f64
}

fn behind(late: u64, steps: u64) -> String {
    format!(
        "{late} of {steps} steps came 20 ms late or more, or with motors as old: sitl or Betaflight had no processor, and what was flown is \
         not the mixer's. On a machine with other work, run both under `chrt -f 50`"
    )
}

/// `servo_packet_raw`: their number, two bytes between, and single-precision pulse widths, us.
fn motors(bytes: &[u8], [low, high]: [f64; 2]) -> Option<Throttles> {
    let pulses = bytes.get(4..)?.chunks_exact(4);
    let mut throttles = Throttles::zeros();
    for (throttle, pulse) in throttles.iter_mut().zip(pulses).take(MOST_ROTORS) {
        let pulse = f64::from(f32::from_le_bytes(pulse.try_into().ok()?));
        *throttle = ((pulse - low) / (high - low)).clamp(0.0, 1.0);
    }
    Some(throttles)
}

/// Betaflight runs its clock by the ratio of two packets' times and the time between their arrivals, unless the times are equal:
/// two that come in a burst would put it forward, until it takes its receiver for lost.
const NO_TIME: f64 = 0.0;

/// `fdm_packet`: time, angular rate with yaw negated, specific force, attitude, velocity, longitude, latitude and altitude, all of
/// the body's and the world's axes forward or north, right or east, down, and the pressure, Pa.
fn state(world: &World, sensors: &mut Sensors) -> Vec<u8> {
    let ([force, rate], q) = (sensors.inertial(world), world.state.attitude);
    let altitude_m = world.vehicle.altitude_m - world.state.position.z;
    let values = [
        &[NO_TIME, rate.x, rate.y, -rate.z][..],
        force.as_slice(),
        &[q.w, q.i, q.j, q.k],
        world.state.velocity.as_slice(),
        &[0.0, 0.0, altitude_m, 100.0 * sensors.air(world)[0]],
    ];
    values
        .concat()
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect()
}

/// `rc_packet`: time, s, and 16 pulse widths, us.
fn sticks(time_s: f64, channels: &Channels) -> Vec<u8> {
    let widths = channels.iter().flat_map(|width| width.to_le_bytes());
    time_s.to_le_bytes().into_iter().chain(widths).collect()
}

/// What keeps Betaflight from arming, by MSP.
fn reasons() -> Option<String> {
    let mut stream = TcpStream::connect((Ipv4Addr::LOCALHOST, MSP)).ok()?;
    stream.set_read_timeout(Some(Duration::from_secs(1))).ok()?;
    stream.write_all(&[b'$', b'M', b'<', 0, STATUS, STATUS]).ok()?;
    let mut bytes = Vec::new();
    // The answer is all that comes within the time.
    let _ = stream.take(64).read_to_end(&mut bytes);
    let at = bytes.windows(3).position(|head| head == b"$M>")?;
    let data = bytes.get(at + 5..)?;
    let at = MODES + 1 + usize::from(*data.get(MODES)?);
    let (count, flags) = (usize::from(*data.get(at)?), data.get(at + 1..at + 5)?);
    let flags = u32::from_le_bytes(flags.try_into().ok()?);
    Some(format!("; Betaflight says: {}", held(count, flags)))
}

/// Names of the `flags` of `count`. The last is the switch, which says that another holds.
fn held(count: usize, flags: u32) -> String {
    const COAXIAL: &str = "the coaxial mixer (`status` of the CLI says why)";
    let name = |bit: usize| match REASONS.get(bit) {
        // A name in a build without the coaxial mixer.
        Some(reason) if bit + 2 == count => format!("{reason} or {COAXIAL}"),
        Some(reason) => (*reason).to_owned(),
        None => COAXIAL.to_owned(),
    };
    let bits = (0..count.saturating_sub(1)).filter(|bit| flags >> bit & 1 == 1);
    bits.map(name).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;
    use crate::sitl::arguments::Arguments;
    use crate::sitl::vehicle::Vehicle;

    #[test]
    fn packets_are_those_of_betaflight() {
        let mut packet = vec![8, 0, 0, 0];
        packet.extend(
            [1000f32, 1500.0, 2000.0, 2500.0]
                .iter()
                .flat_map(|pulse| pulse.to_le_bytes()),
        );
        let throttles = motors(&packet, [1000.0, 2000.0]).unwrap();
        assert_eq!(throttles.as_slice()[..5], [0.0, 0.5, 1.0, 1.0, 0.0]);
        assert_eq!(motors(&packet[..3], [1000.0, 2000.0]), None);
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/simulator/x8.toml");
        let arguments = Arguments::try_parse_from(["sitl", file, "--betaflight"]).unwrap();
        let mut world = World::new(Vehicle::new(&arguments).unwrap());
        world.state.rate = nalgebra::Vector3::new(0.1, 0.2, 0.3);
        let bytes = state(&world, &mut Sensors::new(0.0, 1));
        let values: Vec<f64> = bytes
            .chunks(8)
            .map(|value| f64::from_le_bytes(value.try_into().unwrap()))
            .collect();
        assert_eq!(values.len(), 18);
        assert_eq!(values[..4], [NO_TIME, 0.1, 0.2, -0.3]);
        assert!(
            (values[6] + 9.80665).abs() < 1e-9 && values[7] == 1.0,
            "{values:?}"
        );
        let of_master = held(31, 1 << 29 | 1 << 30 | 1 << 7);
        assert_eq!(
            of_master,
            "THROTTLE, the coaxial mixer (`status` of the CLI says why)"
        );
        let of_4_5 = held(27, 1 << 25 | 1 << 26);
        assert!(of_4_5.starts_with("FLIP_SWITCH or the coaxial mixer"), "{of_4_5}");
        assert_eq!(held(26, 1 << 2 | 1 << 25), "RXLOSS");
        assert!(!is_late(50, 50_000) && is_late(51, 50_000));
        let bytes = sticks(4.5, &[1500; 16]);
        assert_eq!((bytes.len(), &bytes[8..10]), (40, &[0xdc, 0x05][..]));
    }
}
