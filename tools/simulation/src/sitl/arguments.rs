//! The command line.

use std::path::PathBuf;

use clap::{ArgGroup, Parser};
use mixer_compiler::atmosphere;

use super::plan::Manoeuvre;

/// One vehicle for the simulators of PX4, ArduPilot and Betaflight
///
/// The plant is an airframe file: its pair's map at the battery's voltage, rotors as flywheels on motors, mass and
/// inertia. The flight stack, unpatched, connects to it by the interface that it has for outside
/// simulators, and its outputs are the throttles of single rotors: those of the stack's own
/// allocator and those of this project's mixer fly the same vehicle.
#[derive(Parser, Debug)]
#[command(name = "sitl")]
#[command(group = ArgGroup::new("stack").required(true).args(["px4", "ardupilot", "betaflight"]))]
pub struct Arguments {
    /// The airframe file
    pub airframe: PathBuf,
    /// Serve PX4: MAVLink over TCP, PX4 connects
    #[arg(long)]
    pub px4: bool,
    /// Serve ArduPilot: JSON over UDP, `--model JSON`
    #[arg(long)]
    pub ardupilot: bool,
    /// Serve Betaflight: its packets over UDP, by the wall clock
    #[arg(long)]
    pub betaflight: bool,
    /// Fly a manoeuvre: PX4 in Offboard and ArduPilot in Guided by MAVLink, Betaflight in acro mode by sticks
    #[arg(long, value_enum)]
    pub fly: Option<Manoeuvre>,
    /// Write the true flight as CSV
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Stop the rotor on an output at a time of the manoeuvre; without --fly of the simulation
    #[arg(long, value_name = "OUTPUT@SECONDS", value_parser = failure)]
    pub fail: Option<Failure>,
    /// Fly the pair of another airframe file, so that the mixer's model is in error
    #[arg(long, value_name = "FILE")]
    pub map: Option<PathBuf>,
    /// Multiply thrust and torque of every pair, so that the mixer's model is off by a known factor
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = positive)]
    pub thrust_scale: f64,
    /// Noise of the sensors as a share of the usual
    #[arg(long, value_name = "SHARE", default_value_t = 1.0, value_parser = not_negative)]
    pub noise: f64,
    /// Standard deviation of the rotors' throttles about the commanded ones
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, value_parser = not_negative)]
    pub spread: f64,
    /// Seed of noise and spread
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Voltage of the battery at the start, V; without it `reference_v` of the file
    #[arg(long, value_parser = positive)]
    pub volts: Option<f64>,
    /// Resistance of the battery, ohm
    #[arg(long, value_name = "OHM", default_value_t = 0.0, value_parser = not_negative)]
    pub resistance: f64,
    /// Capacity of the battery, A h; without it the voltage does not fall with the charge
    #[arg(long, value_name = "AH", value_parser = positive)]
    pub capacity: Option<f64>,
    /// Home at this altitude of the standard atmosphere, m: thrust follows voltage and density by a model of the
    /// motors, barometer and satellite receiver are there
    #[arg(long, value_name = "M", value_parser = altitude, allow_negative_numbers = true)]
    pub altitude: Option<f64>,
    /// Home at the altitude of this density, kg/m3
    // Read as that altitude, m.
    #[arg(long = "density", value_name = "KG_M3", value_parser = density_altitude, conflicts_with = "altitude")]
    pub density_altitude: Option<f64>,
    /// Mass, kg, instead of the file's
    #[arg(long, value_parser = positive)]
    pub mass_kg: Option<f64>,
    /// Moments of inertia, kg m2, instead of the file's
    #[arg(long, value_name = "X,Y,Z", value_parser = inertia)]
    pub inertia: Option<[f64; 3]>,
    /// Time constant of a rotor's speed in hover, s; without it by the inertia
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    pub rotor_lag: Option<f64>,
    /// Inertia of a rotor with its motor's bell, kg m2; without it the file's `rotor_inertia_kg_m2`, else estimated from the
    /// largest thrust
    #[arg(long, value_name = "KG_M2", value_parser = positive, conflicts_with = "rotor_lag")]
    pub rotor_inertia: Option<f64>,
    /// Pulse widths of throttle 0 and 1 in ArduPilot, MOT_PWM_MIN and MOT_PWM_MAX, or Betaflight
    #[arg(long, value_name = "LOW,HIGH", default_value = "1000,2000", value_parser = pulses)]
    pub pwm_range: [f64; 2],
    /// Port to serve: 4560 plus PX4's instance, 9002 for ArduPilot, 9001 for Betaflight; 0 takes a free one
    #[arg(long)]
    pub port: Option<u16>,
    /// Port of the MAVLink for pilot and battery: 14540 plus PX4's instance, 5760 of ArduPilot
    #[arg(long)]
    pub link: Option<u16>,
    /// Simulated over real time, at most; 0 is as fast as the stack goes; Betaflight's clock is the wall's
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = not_negative)]
    pub speed: f64,
    /// End after so much simulated time, s
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    pub seconds: Option<f64>,
}

/// Altitudes to fly at, m.
const ALTITUDES_M: [f64; 2] = [-1000.0, atmosphere::TOP_M];

/// A rotor that stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Failure {
    /// Its output, from 0.
    pub output: usize,
    /// When, s.
    pub time_s: f64,
}

fn number(text: &str) -> Result<f64, String> {
    let value: f64 = text.trim().parse().map_err(|_| "not a number")?;
    if value.is_finite() {
        Ok(value)
    } else {
        Err("not a finite number".to_owned())
    }
}

fn not_negative(text: &str) -> Result<f64, String> {
    let value = number(text)?;
    (value >= 0.0)
        .then_some(value)
        .ok_or_else(|| "must be 0 or more".to_owned())
}

fn positive(text: &str) -> Result<f64, String> {
    let value = number(text)?;
    (value > 0.0)
        .then_some(value)
        .ok_or_else(|| "must be above 0".to_owned())
}

fn altitude(text: &str) -> Result<f64, String> {
    number(text).and_then(flown)
}

/// The altitude of a density.
fn density_altitude(text: &str) -> Result<f64, String> {
    positive(text).map(atmosphere::altitude_of).and_then(flown)
}

fn flown(altitude_m: f64) -> Result<f64, String> {
    let [least, most] = ALTITUDES_M;
    (least..=most)
        .contains(&altitude_m)
        .then_some(altitude_m)
        .ok_or_else(|| format!("an altitude of {altitude_m:.0} m: must be from {least} to {most} m"))
}

fn failure(text: &str) -> Result<Failure, String> {
    let form = "expected OUTPUT@SECONDS, like 0@5";
    let (output, time) = text.split_once('@').ok_or(form)?;
    Ok(Failure {
        output: output.trim().parse().map_err(|_| form.to_owned())?,
        time_s: not_negative(time)?,
    })
}

fn inertia(text: &str) -> Result<[f64; 3], String> {
    let moments: Vec<f64> = text.split(',').map(positive).collect::<Result<_, _>>()?;
    moments
        .try_into()
        .map_err(|_| "expected three numbers, like 0.08,0.087,0.16".to_owned())
}

fn pulses(text: &str) -> Result<[f64; 2], String> {
    let widths: Vec<f64> = text.split(',').map(number).collect::<Result<_, _>>()?;
    match widths[..] {
        [low, high] if 500.0 <= low && low + 100.0 <= high && high <= 2500.0 => Ok([low, high]),
        _ => Err("expected two widths from 500 to 2500, like 1000,2000".to_owned()),
    }
}
