//! One vehicle for the software in the loop of PX4 and ArduPilot.
//!
//! [`vehicle`] makes the plant of an airframe file, [`world`] has it on the ground or in the air,
//! [`sensors`] measures it. [`px4`] speaks the interface that the stack has for outside simulators;
//! [`pilot`] flies a [`plan`] by MAVLink; [`record`] holds the
//! truth, [`score`] makes the table of it.

pub mod arguments;
pub mod flight;
pub mod frames;
pub mod link;
pub mod pilot;
pub mod plan;
pub mod px4;
pub mod record;
pub mod score;
pub mod sensors;
pub mod vehicle;
pub mod world;

use std::fs::File;

use self::arguments::Arguments;
use self::flight::{End, Flight};
use self::link::Link;
use self::pilot::{Pilot, Stack};
use self::score::Score;
use self::sensors::Sensors;
use self::vehicle::Vehicle;

/// PX4's port of its MAVLink for an offboard computer, instance 0.
const PX4_LINK: u16 = 14540;

/// Serves a stack and writes what was flown.
///
/// # Errors
/// A file or a port that cannot be had, a client that vanishes, a flight that ends on the ground;
/// what was flown until then is written.
pub fn run(arguments: &Arguments) -> Result<(), String> {
    let vehicle = Vehicle::new(arguments)?;
    if let Some(failure) = arguments.fail.filter(|failure| failure.output >= vehicle.rotors) {
        let (output, last) = (failure.output, vehicle.rotors - 1);
        return Err(format!(
            "--fail: there is no output {output}, the vehicle has 0 to {last}"
        ));
    }
    eprintln!(
        "{}: {} rotors, {} kg, hover at a throttle of {:.4}",
        vehicle.name, vehicle.rotors, vehicle.mass_kg, vehicle.hover_throttle
    );
    let mut sensors = Sensors::new(arguments.noise, arguments.seed);
    let link = Link::udp(arguments.link.unwrap_or(PX4_LINK))?;
    let listener = px4::listen(arguments.port.unwrap_or(px4::PORT))?;
    let pilot = Pilot::new(Stack::Px4, link, arguments);
    let mut flight = Flight::new(vehicle, Some(pilot), arguments);
    if let Ok(address) = listener.local_addr() {
        eprintln!("waiting for PX4 on TCP port {}", address.port());
    }
    let end = px4::serve(&listener, &mut flight, &mut sensors, arguments.rate);
    if let Some(path) = &arguments.output {
        let written = File::create(path)
            .map_err(csv::Error::from)
            .and_then(|file| flight.record.write(file));
        written.map_err(|error| format!("{}: {error}", path.display()))?;
    }
    print!(
        "{}",
        Score::new(&flight.record, &flight.world.vehicle, flight.pilot.as_ref())
    );
    for (what, count) in &flight.record.counts {
        println!("{what}: {count}");
    }
    match end? {
        End::Done => Ok(()),
        End::Crashed(time_s) => Err(format!("the vehicle hit the ground at {time_s:.2} s")),
    }
}
