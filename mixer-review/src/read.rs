//! A log read, and held against the airframe: whether it is one of this vehicle.

use mixer_compiler::Source;
use mixer_compiler::airframe::Airframe;
use mixer_files::bench_pulses;
use mixer_files::import::{Stated, USUAL_US, stated};

use crate::flight::{Flight, Stack};
use crate::log::Log;
use crate::{ardupilot, dataflash, px4, ulog};

/// How far a rotor may be from where the airframe file has it, over the mean arm: a third of the way to
/// the next arm of a dodecahexa.
const SAME_PLACE: f64 = 0.3;

impl Flight {
    /// Reads a log of a vehicle.
    ///
    /// # Errors
    /// A file that is no log of either stack, a log of another vehicle, or one without what every
    /// review needs: outputs and accelerometer.
    pub fn read(
        name: &str,
        bytes: &[u8],
        airframe: &Airframe,
        bench_us: Option<[f64; 2]>,
    ) -> Result<Flight, String> {
        let (stack, log) = if bytes.starts_with(ulog::MAGIC) {
            (Stack::Px4, ulog::read(bytes, px4::WANTED))
        } else if bytes.starts_with(dataflash::MAGIC) {
            (Stack::ArduPilot, dataflash::read(bytes, ardupilot::WANTED))
        } else {
            return Err(format!("{name}: {}", what_else(bytes)));
        };
        // What is missing may stand behind the damage.
        let damage = log.damage.clone();
        let flight = vehicle(&log).and_then(|vehicle| {
            same_vehicle(&vehicle, airframe)?;
            let bench_us = bench_us.or_else(|| bench_pulses(airframe)).unwrap_or(USUAL_US);
            match stack {
                Stack::Px4 => px4::flight(log, &vehicle, bench_us),
                Stack::ArduPilot => ardupilot::flight(log, &vehicle, bench_us),
            }
        });
        flight.map_err(|error| match damage {
            Some(damage) => format!("{name}: {damage}; {error}"),
            None => format!("{name}: {error}"),
        })
    }
}

/// Kind of a file that is no log.
fn what_else(bytes: &[u8]) -> &'static str {
    const FORMS: [(&[u8], &str); 6] = [
        (b"\xfd7zXZ", "a compressed file: unpack it first (xz -dk)"),
        (b"\x1f\x8b", "a compressed file: unpack it first (gunzip -k)"),
        (b"PK", "a zip archive: unpack it first"),
        (
            b"FMT,",
            "ArduPilot's log as text: give the .bin file that it was made of",
        ),
        (
            b"\xfe",
            "a telemetry log: give the log of the vehicle's own memory card (.bin, .ulg)",
        ),
        (
            b"\xfd",
            "a telemetry log: give the log of the vehicle's own memory card (.bin, .ulg)",
        ),
    ];
    let form = FORMS.iter().find(|(magic, _)| bytes.starts_with(magic));
    form.map_or(
        "neither PX4's ULog (.ulg) nor ArduPilot's DataFlash log (.bin)",
        |(_, what)| what,
    )
}

/// The vehicle by the log's parameters.
fn vehicle(log: &Log) -> Result<Stated, String> {
    if log.parameters.is_empty() {
        let why =
            "the log has no parameters, so nothing says of which vehicle it is: its beginning is missing";
        return Err(why.to_owned());
    }
    let lines = log.parameters.iter().filter(|(_, value)| value.is_finite());
    let text = lines
        .map(|(name, value)| format!("{name} {value:?}\n"))
        .collect::<String>();
    stated(&Source::new("parameters", text))
}

/// Refuses a log of another frame.
fn same_vehicle(vehicle: &Stated, airframe: &Airframe) -> Result<(), String> {
    let of = &airframe.name;
    let motors = vehicle.rotors.as_ref().map_or(vehicle.pins.len(), Vec::len);
    if motors != airframe.rotors() {
        return Err(format!(
            "a log of another vehicle: it has {motors} motors, {of} {} rotors",
            airframe.rotors()
        ));
    }
    let rotors = vehicle.rotors.as_deref().unwrap_or_default();
    // Stacks take the geometry in any unit.
    let arm = |places: &mut dyn Iterator<Item = [f64; 3]>| {
        let arms: Vec<f64> = places.map(|[x, y, _]| libm::hypot(x, y)).collect();
        let mean = arms.iter().sum::<f64>() / arms.len() as f64;
        if mean > 0.0 { mean } else { 1.0 }
    };
    let arm_there = arm(&mut rotors.iter().map(|rotor| rotor.position_m));
    let arm_here = arm(&mut airframe.units.iter().map(|unit| unit.position_m));
    for rotor in rotors {
        let motor = rotor.channel + 1;
        let unit = airframe.units.iter().find_map(|unit| match rotor.channel {
            channel if channel == unit.upper_channel => Some((unit, unit.upper_spin)),
            channel if channel == unit.lower_channel => Some((unit, unit.upper_spin.reversed())),
            _ => None,
        });
        let Some((unit, spin)) = unit else {
            return Err(format!(
                "a log of another vehicle: {of} has no output for motor {motor}"
            ));
        };
        let ([x, y, _], [of_x, of_y, _]) = (rotor.position_m, unit.position_m);
        let off = libm::hypot(x / arm_there - of_x / arm_here, y / arm_there - of_y / arm_here);
        if off > SAME_PLACE {
            let [x, y] = [x, y].map(|at| at / arm_there * arm_here);
            return Err(format!(
                "a log of another vehicle, or other `channels`: motor {motor} is {x:.2} m forward and {y:.2} m right there, \
                 output {} of {of} {of_x:.2} and {of_y:.2} m",
                rotor.channel
            ));
        }
        if rotor.spin != spin {
            return Err(format!(
                "a log of another vehicle, or other spins: motor {motor} turns {} there, output {} of {of} {}",
                rotor.spin.name(),
                rotor.channel,
                spin.name()
            ));
        }
    }
    Ok(())
}
