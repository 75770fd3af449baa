//! One vehicle for the software in the loop of PX4, ArduPilot and Betaflight.
//!
//! [`vehicle`] makes the plant of an airframe file, [`world`] has it on the ground or in the air,
//! [`sensors`] measures it. [`px4`], [`ardupilot`] and [`betaflight`] speak the interfaces
//! that the stacks have for outside simulators; [`pilot`] flies a [`plan`] by MAVLink, [`sticks`] by sticks; [`record`]
//! holds the truth, [`score`] makes the table of it.

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
pub mod sticks;
pub mod vehicle;
pub mod world;

use std::fs::File;
use std::net::SocketAddr;

use self::arguments::Arguments;
use self::flight::{End, Flight};
use self::link::Link;
use self::pilot::{Pilot, Stack, Station};
use self::score::Score;
use self::sensors::Sensors;
use self::sticks::Sticks;
use self::vehicle::Vehicle;

/// PX4's port of its MAVLink for an offboard computer, instance 0.
const PX4_LINK: u16 = 14540;

/// ArduPilot's first serial port, instance 0.
const ARDUPILOT_LINK: u16 = 5760;

/// Says where a stack is waited for.
fn say(stack: &str, address: std::io::Result<SocketAddr>) {
    if let Ok(address) = address {
        eprintln!("waiting for {stack} port {}", address.port());
    }
}

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
    let output;
    let (flight, end) = if arguments.px4 {
        let link = Link::udp(arguments.link.unwrap_or(PX4_LINK))?;
        let listener = px4::listen(arguments.port.unwrap_or(px4::PORT))?;
        output = file(arguments)?;
        say("PX4 on TCP", listener.local_addr());
        // Without a manoeuvre, too: PX4 has its battery by this link.
        let pilot = Station::new(Stack::Px4, link, arguments);
        let mut flight = Flight::new(vehicle, Some(Box::new(pilot)), arguments);
        let end = px4::serve(&listener, &mut flight, &mut sensors);
        (flight, end)
    } else if arguments.betaflight {
        if arguments.speed != 1.0 {
            return Err("--speed: Betaflight's time is that of the wall clock".to_owned());
        }
        let port = arguments.port.unwrap_or(betaflight::PORT);
        let socket = betaflight::listen(port)?;
        output = file(arguments)?;
        say("Betaflight on UDP", socket.local_addr());
        let sticks = Sticks::new(vehicle.hover_throttle, arguments);
        let pilot = arguments.fly.map(|_| Box::new(sticks) as Box<dyn Pilot>);
        let mut flight = Flight::new(vehicle, pilot, arguments);
        let end = betaflight::serve(&socket, port, &mut flight, &mut sensors, arguments.pwm_range);
        (flight, end)
    } else {
        let socket = ardupilot::listen(arguments.port.unwrap_or(ardupilot::PORT))?;
        output = file(arguments)?;
        say("ArduPilot on UDP", socket.local_addr());
        let link = Link::tcp(arguments.link.unwrap_or(ARDUPILOT_LINK));
        let pilot = Station::new(Stack::Ardupilot, link, arguments);
        let pilot = arguments.fly.map(|_| Box::new(pilot) as Box<dyn Pilot>);
        let mut flight = Flight::new(vehicle, pilot, arguments);
        let end = ardupilot::serve(&socket, &mut flight, &mut sensors, arguments.pwm_range);
        (flight, end)
    };
    if let (Some(path), Some(file)) = (&arguments.output, output) {
        let written = flight.record.write(file);
        written.map_err(|error| format!("{}: {error}", path.display()))?;
        eprintln!("wrote {}", path.display());
    }
    print!("{}", Score::new(&flight));
    for (what, count) in &flight.record.counts {
        println!("{what}: {count}");
    }
    match end? {
        End::Done => Ok(()),
        End::Crashed(time_s) => Err(format!("the vehicle hit the ground at {time_s:.2} s")),
    }
}
