//! A log read, and held against the airframe: whether it is one of this vehicle.

use crate::params::bench_pulses;
use mixer_compiler::Source;
use mixer_compiler::airframe::Airframe;

use crate::import::{Stated, USUAL_US, stated};

use crate::review::flight::{Flight, Form};
use crate::review::log::Log;
use crate::stacks::{ardupilot, px4};

const FORMS: [Form; 2] = [px4::log::FORM, ardupilot::log::FORM];

/// How far a rotor may be from where the airframe file has it, over the mean arm: a third of the way to
/// the next arm of a dodecahexa.
const SAME_PLACE: f64 = 0.3;

/// Name of a log's parameters in messages.
const PARAMETERS: &str = "the log's parameters";

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
        let Some(form) = FORMS.iter().find(|form| bytes.starts_with(form.magic)) else {
            return Err(format!("{name}: {}", what_else(bytes)));
        };
        let second = bytes
            .windows(form.begin.len())
            .skip(1)
            .position(|window| window == form.begin)
            .map(|before| before + 1);
        let first = &bytes[..second.unwrap_or(bytes.len())];
        let mut log = (form.log)(first);
        let is_sound = |name: &str, value: f64| {
            value.is_finite()
                && name
                    .bytes()
                    .all(|byte| byte.is_ascii_alphanumeric() || byte == b'_')
        };
        let all = log.parameters.len();
        log.parameters.retain(|name, value| is_sound(name, *value));
        let unsound = all - log.parameters.len();
        let told = [
            log.damage,
            (unsound > 0)
                .then(|| format!("the log is damaged: {unsound} parameters that cannot be are left out")),
            second.map(|at| {
                format!("a second log begins at byte {at} of the file and is left out: cut the file there")
            }),
        ];
        log.damage = told.into_iter().flatten().reduce(|a, b| format!("{a}; {b}"));
        // What is missing may stand behind the damage.
        let damage = log.damage.clone();
        let flight = vehicle(&log).and_then(|vehicle| {
            same_vehicle(&vehicle, airframe)?;
            let bench_us = bench_us.or_else(|| bench_pulses(airframe)).unwrap_or(USUAL_US);
            (form.flight)(log, &vehicle, bench_us)
        });
        flight.map_err(|error| match damage {
            Some(damage) => format!("{name}: {damage}; {error}"),
            None => format!("{name}: {error}"),
        })
    }
}

/// Kind of a file that is no log.
fn what_else(bytes: &[u8]) -> &'static str {
    const TELEMETRY: &str =
        "a telemetry log (.tlog): give the log of the vehicle's own memory card (.bin, .ulg)";
    const OTHERS: [(&[u8], &str); 5] = [
        (b"\xfd7zXZ", "a compressed file: unpack it first (xz -dk)"),
        (b"\x1f\x8b", "a compressed file: unpack it first (gunzip -k)"),
        (b"PK", "a zip archive: unpack it first"),
        (
            b"FMT,",
            "ArduPilot's log as text: give the .bin file that it was made of",
        ),
        (
            b"ULogEnc",
            "an encrypted log: decrypt it first with the key of the vehicle (PX4: Tools/decrypt_ulog.py)",
        ),
    ];
    // A time of eight bytes, and the first byte of a MAVLink message.
    let is_telemetry = |bytes: &[u8]| {
        [0, 8]
            .iter()
            .any(|at| matches!(bytes.get(*at), Some(0xfd | 0xfe)))
    };
    if bytes.is_empty() {
        return "the file is empty";
    }
    let form = OTHERS.iter().find(|(magic, _)| bytes.starts_with(magic));
    form.map_or_else(
        || match is_telemetry(bytes) {
            true => TELEMETRY,
            false => "neither PX4's ULog (.ulg) nor ArduPilot's DataFlash log (.bin)",
        },
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
    let lines = log.parameters.iter();
    let text = lines
        .map(|(name, value)| format!("{name} {value:?}\n"))
        .collect::<String>();
    // A log has no lines.
    let placeless = |error: String| match error.split_once(": ") {
        Some((place, words)) if place.starts_with(PARAMETERS) => format!("{PARAMETERS}: {words}"),
        _ => error,
    };
    stated(&Source::new(PARAMETERS, text)).map_err(placeless)
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
        let unit = airframe.units.iter().find_map(|unit| {
            let own = unit.rotors().find(|own| own.channel == rotor.channel)?;
            Some((unit, own.spin))
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
        let mate = rotors.iter().find(|other| {
            other.channel != rotor.channel && unit.channels().any(|channel| channel == other.channel)
        });
        let below = mate.map_or(0.0, |mate| rotor.position_m[2] - mate.position_m[2]);
        let is_upper = rotor.channel == unit.upper_channel;
        if below != 0.0 && (below < 0.0) != is_upper {
            let [there, here] = if is_upper {
                ["lower", "upper"]
            } else {
                ["upper", "lower"]
            };
            return Err(format!(
                "a log of another vehicle, or `channels` with the layers exchanged: motor {motor} is the {there} rotor there, output {} of \
                 {of} the {here} one",
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
