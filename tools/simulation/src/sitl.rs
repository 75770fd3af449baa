//! One vehicle for the software in the loop of PX4, ArduPilot and Betaflight.
//!
//! [`vehicle`] makes the plant of an airframe file, [`world`] has it on the ground or in the air,
//! [`sensors`] measures it. [`px4`], [`ardupilot`] and [`betaflight`] speak the interfaces
//! that the stacks have for outside simulators, a folder each; [`pilot`] flies a [`plan`] by MAVLink, [`betaflight::sticks`] by
//! sticks; [`record`] holds the truth, [`score`] makes the table of it.

pub mod ardupilot;
pub mod arguments;
pub mod betaflight;
pub mod flight;
pub mod frames;
pub mod link;
pub mod messages;
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
use self::score::Score;
use self::sensors::Sensors;
use self::vehicle::Vehicle;

/// The file of `--output`, made before the flight, so that nothing flown is lost, and after
/// the ports are had, so that an earlier flight is not lost to a busy one.
fn file(arguments: &Arguments) -> Result<Option<File>, String> {
    let Some(path) = &arguments.output else {
        return Ok(None);
    };
    let inputs = std::iter::once(&arguments.airframe).chain(&arguments.map);
    let place = path.canonicalize().ok();
    if place.is_some() && inputs.into_iter().any(|input| input.canonicalize().ok() == place) {
        return Err(format!(
            "{} is an airframe file that is flown: give -o another name",
            path.display()
        ));
    }
    let file = File::create(path).map_err(|error| format!("{}: {error}", path.display()));
    file.map(Some)
}

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
    let [lead_s, lag_s] = [vehicle.rotor.lead_s, vehicle.rotor.lag_s()];
    eprintln!(
        "{}: {} rotors (T {lead_s:.3} s, lag {lag_s:.3} s), {} kg, hover at a throttle of {:.4}",
        vehicle.name, vehicle.rotors, vehicle.mass_kg, vehicle.hover_throttle
    );
    let mut sensors = Sensors::new(arguments.noise, arguments.seed);
    let port = if arguments.px4 {
        px4::open(arguments)?
    } else if arguments.betaflight {
        betaflight::open(arguments, vehicle.hover_throttle)?
    } else {
        ardupilot::open(arguments)?
    };
    let output = file(arguments)?;
    if let Ok(address) = port.address {
        eprintln!("waiting for {} port {}", port.name, address.port());
    }
    // PX4 has its battery by the pilot's link, without a manoeuvre, too.
    let is_flown = arguments.px4 || arguments.fly.is_some();
    let mut flight = Flight::new(vehicle, is_flown.then_some(port.pilot), arguments);
    let end = (port.serve)(&mut flight, &mut sensors);
    if let (Some(path), Some(file)) = (&arguments.output, output) {
        let written = flight.record.write(file);
        written.map_err(|error| format!("{}: {error}", path.display()))?;
        eprintln!("wrote {}", path.display());
    }
    print!("{}", Score::new(&flight));
    for (what, count) in flight.record.counts.iter().filter(|(_, count)| **count > 0) {
        println!("{what}: {count}");
    }
    match end? {
        End::Done => Ok(()),
        End::Crashed(time_s) => Err(format!("the vehicle hit the ground at {time_s:.2} s")),
    }
}
