//! Betaflight's interface for outside simulators (`src/platform/SIMULATOR/sitl.c`): motors in, state and sticks out, over UDP, in
//! the time of the wall clock, which is Betaflight's. MSP tells what keeps it from arming.

pub mod arming;
pub mod packets;
pub mod sticks;

use std::net::{Ipv4Addr, UdpSocket};
use std::time::{Duration, Instant};

use self::arming::reasons;
use self::packets::{channels, motors, state};
use self::sticks::Sticks;
use super::arguments::Arguments;
use super::flight::{End, Flight, Port};
use super::link;
use super::sensors::Sensors;
use super::vehicle::Throttles;

/// Betaflight's port of all motors, which it sends to; from there to those of the state and of the sticks, which it listens to.
const PORT: u16 = 9001;
const STATE: u16 = 2;
const STICKS: u16 = 3;

/// Time of a step, microseconds, and of the sticks.
const STEP_US: u64 = 2000;
const STICKS_US: u64 = 10_000;

/// Silence after which Betaflight has gone.
const SILENCE: Duration = Duration::from_secs(10);

/// Behind the clock by this a step is late, and where Betaflight's motors are as old.
const LATE: Duration = Duration::from_millis(20);

/// The name under which the record counts late steps.
const LATE_STEPS: &str = "steps that came 20 ms late or more, or with motors as old";

/// Share of late steps from which on a flight is not the mixer's: docs/simulator.md has what was measured.
const MOST_LATE: f64 = 0.001;

/// The port of the motors, and a pilot with sticks.
///
/// # Errors
/// A port that is taken; a speed that is not that of the wall clock.
pub fn open(arguments: &Arguments, hover_throttle: f64) -> Result<Port, String> {
    if (arguments.speed - 1.0).abs() > 0.0 {
        return Err("--speed: Betaflight's clock is the wall's; leave the option out".to_owned());
    }
    let port = arguments.port.unwrap_or(PORT);
    let socket = link::listen(port, None, "Betaflight", "")?;
    let pulses = arguments.pwm_range;
    Ok(Port {
        name: "Betaflight on UDP",
        address: socket.local_addr(),
        pilot: Box::new(Sticks::new(hover_throttle, arguments)),
        serve: Box::new(move |flight, sensors| serve(&socket, port, flight, sensors, pulses)),
    })
}

/// Serves Betaflight until the flight ends, in which not too many steps came late.
fn serve(
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
            send(STICKS, &channels(flight.world.time_s(), &pilot.sticks()));
        }
        steps += 1;
        let is_behind = begun.elapsed() > Duration::from_micros(flight.world.time_us) + LATE;
        late += u64::from(is_behind || heard.is_some_and(|heard| heard.elapsed() > LATE));
        match end {
            Ok(None) => {}
            Ok(Some(end)) => {
                flight.record.note(LATE_STEPS, late);
                return in_time(late, steps).map(|()| end);
            }
            Err(error) => return Err(error + &reasons().unwrap_or_default()),
        }
    }
}

/// Refuses a flight that is not the mixer's.
fn in_time(late: u64, steps: u64) -> Result<(), String> {
    if late as f64 <= MOST_LATE * steps as f64 {
        return Ok(());
    }
    Err(format!(
        "{late} of {steps} {LATE_STEPS}: sitl or Betaflight had no processor, and what was flown is \
         not the mixer's. End other work, or give both a real-time priority (`chrt -f 50`)"
    ))
}

#[cfg(test)]
mod tests {
    use super::in_time;

    #[test]
    fn a_thousandth_of_the_steps_may_be_late() {
        assert_eq!(in_time(50, 50_000), Ok(()));
        let refusal = in_time(51, 50_000).unwrap_err();
        assert!(refusal.starts_with("51 of 50000 steps"), "{refusal}");
    }
}
