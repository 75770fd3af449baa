//! What a power bias gives and costs: electrical energy of the manoeuvre, and what a rotor that stops
//! does, with shares of the bias of `airframes/x8-11in-least-power.toml` on the paper's vehicle.
//!
//! The ISAE X8 has no map of electrical power, so its rotors give way to those of an airframe that
//! has one, identified from a bench with runs of either rotor alone; mass, inertia, controller and
//! manoeuvre stay. The supply is held at the reference voltage, at which the power map is. Energy is
//! the map's, over the throttles that the mixer commands.
//!
//! A rotor stops in hover. For a while nobody knows; then the mixer leaves it out. Measured are the
//! largest tilt and the largest error of the height until `AFTER_S`.

use std::error::Error;
use std::fmt;
use std::io::Write;

use mixer_compiler::Source;
use mixer_compiler::airframe::Airframe;
use mixer_compiler::tables::MixerTables;
use mixer_rt::Health;
use nalgebra::Vector3;

use crate::air::{Air, Room};
use crate::controller::{PERIOD_S, Tilt};
use crate::flight::{ClosedLoop, Flight, Sample, Scenario, fly, periods};
use crate::manoeuvre::{SETTLING_S, reference};
use crate::mixer::{Mixer, mix};
use crate::vehicle::ROTORS;

/// The airframe file.
const FILE: &str = include_str!("../../../airframes/x8-11in-least-power.toml");

/// Shares of the bias of the file.
pub const SHARES: [f64; 3] = [1.0, 0.5, 0.0];

/// How long nobody knows that a rotor has stopped, ms.
pub const UNKNOWN_MS: [u32; 3] = [100, 200, 300];

/// Time after the stop over which its effects are measured, s.
const AFTER_S: f64 = 5.0;

/// An airframe with a power map, and its mixers with shares of the bias.
#[derive(Clone, Debug)]
pub struct Rotors {
    airframe: Airframe,
    mixers: [MixerTables; 3],
}

/// Energy of both rotors of all units over one manoeuvre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energy {
    /// The seed of mismatch and air.
    pub seed: u64,
    /// J, in the order of [`SHARES`].
    pub joules: [f64; 3],
}

/// What a rotor that stops does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// The share of the bias.
    pub share: f64,
    /// Whether it is an upper rotor.
    pub is_upper: bool,
    /// How long nobody knows, ms.
    pub unknown_ms: u32,
    /// The seed of mismatch.
    pub seed: u64,
    /// Largest tilt, degrees.
    pub tilt_deg: f64,
    /// Largest error of the height, m.
    pub height_m: f64,
}

impl Rotors {
    /// The airframe at its reference voltage.
    ///
    /// # Errors
    /// A file that is refused.
    pub fn new() -> Result<Rotors, Box<dyn Error>> {
        let mut compiled = mixer_compiler::compile(&Source::new("x8-11in-least-power.toml", FILE))
            .map_err(|faults| faults.to_string())?;
        compiled.airframe.voltage = None;
        compiled.tables.corrections.voltage = None;
        let tables = compiled.tables;
        let bias = tables.power_bias_nm_per_n;
        Ok(Rotors {
            airframe: compiled.airframe,
            mixers: SHARES.map(|share| tables.with_power_bias(share as f32 * bias)),
        })
    }

    /// Flies `seed` with every share.
    ///
    /// # Errors
    /// A flight that was lost, or an airframe without a power map.
    pub fn fly(&self, scenario: &Scenario, seed: u64) -> Result<Energy, Box<dyn Error>> {
        let mut joules = [0.0; 3];
        for (joules, tables) in joules.iter_mut().zip(&self.mixers) {
            let mixer = Mixer::Compiled(Box::new(tables.clone()));
            let room = Room::new(scenario.air, seed);
            *joules = self.energy_j(&fly(&self.airframe, &mixer, scenario.tilt, room)?)?;
        }
        Ok(Energy { seed, joules })
    }

    fn energy_j(&self, flight: &Flight) -> Result<f64, Box<dyn Error>> {
        let samples = flight.samples.iter();
        let power = |sample: &Sample| self.airframe.power_w(sample.throttle.as_slice());
        let energy: Option<f64> = samples.map(|sample| Some(power(sample)? * PERIOD_S)).sum();
        energy.ok_or_else(|| "the airframe has no [pair.power]".into())
    }

    /// Stops every rotor, one at a time, in hover in still air, with every share and delay.
    ///
    /// # Errors
    /// A flight that was lost.
    pub fn stops(&self, seed: u64) -> Result<Vec<Stop>, String> {
        let hover = reference(-SETTLING_S);
        let mut stops = Vec::new();
        for (share, tables) in SHARES.into_iter().zip(&self.mixers) {
            let mut settled = ClosedLoop::new(&self.airframe, Tilt::Decoupled, Room::new(Air::Still, seed));
            for period in 0..periods(SETTLING_S) {
                settled.period(period, &hover, |wrench, volts| {
                    mix(tables, wrench, volts, Health::GOOD)
                })?;
            }
            for unknown_ms in UNKNOWN_MS {
                let known = periods(f64::from(unknown_ms) * 1e-3);
                for rotor in 0..ROTORS {
                    let mut flight = settled.clone();
                    let (mut tilt, mut height_m) = (0.0f64, 0.0f64);
                    for period in 0..periods(AFTER_S) {
                        let health = if period < known {
                            Health::GOOD
                        } else {
                            Health::GOOD.with_failed(rotor as u8)
                        };
                        flight.period(period, &hover, |wrench, volts| {
                            let (mut throttle, saturated) = mix(tables, wrench, volts, health)?;
                            throttle[rotor] = 0.0;
                            Ok((throttle, saturated))
                        })?;
                        tilt = tilt.max((flight.state.rotation() * Vector3::z()).angle(&Vector3::z()));
                        height_m = height_m.max((flight.state.position.z - hover.position.z).abs());
                    }
                    stops.push(Stop {
                        share,
                        is_upper: self.airframe.units.iter().any(|unit| unit.upper_channel == rotor),
                        unknown_ms,
                        seed,
                        tilt_deg: tilt.to_degrees(),
                        height_m,
                    });
                }
            }
        }
        Ok(stops)
    }
}

/// The energies of one scenario; prints as a line.
#[derive(Clone, Debug)]
pub struct Saving {
    /// Air and tilt of the flights.
    pub scenario: Scenario,
    /// One per seed.
    pub flights: Vec<Energy>,
}

impl fmt::Display for Saving {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let of = |k: usize| mean(self.flights.iter().map(|energy| energy.joules[k]));
        let [full, half, none] = [0, 1, 2].map(of);
        write!(
            f,
            "  {:<30} {none:>9.0} J without a power bias; {:.2} % less with half of it, {:.2} % with all",
            self.scenario.to_string(),
            100.0 * (1.0 - half / none),
            100.0 * (1.0 - full / none)
        )
    }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

/// The stops, a line per rotor, delay and share.
pub struct Stops(pub Vec<Stop>);

impl fmt::Display for Stops {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for is_upper in [true, false] {
            for unknown_ms in UNKNOWN_MS {
                for share in SHARES {
                    let these = || {
                        let stops = self.0.iter().filter(move |stop| {
                            (stop.is_upper, stop.unknown_ms, stop.share) == (is_upper, unknown_ms, share)
                        });
                        stops.copied()
                    };
                    let rotor = if is_upper { "an upper" } else { "a lower" };
                    let [tilt_deg, height_m] = [
                        mean(these().map(|stop| stop.tilt_deg)),
                        mean(these().map(|stop| stop.height_m)),
                    ];
                    writeln!(
                        f,
                        "  {rotor} rotor stops, unknown for {unknown_ms} ms, {share} of the bias: tilt {tilt_deg:.2} deg, height {height_m:.3} m"
                    )?;
                }
            }
        }
        Ok(())
    }
}

/// Writes the energy of all flights as CSV.
///
/// # Errors
/// A failure to write to `to`.
pub fn write(savings: &[Saving], to: impl Write) -> csv::Result<()> {
    let mut writer = csv::Writer::from_writer(to);
    writer.write_record(["scenario", "seed", "bias", "energy_j"])?;
    for Saving { scenario, flights } in savings {
        for energy in flights {
            for (share, joules) in SHARES.into_iter().zip(energy.joules) {
                let [scenario, seed] = [scenario.to_string(), energy.seed.to_string()];
                writer.write_record([scenario, seed, share.to_string(), format!("{joules:.1}")])?;
            }
        }
    }
    Ok(writer.flush()?)
}

/// Writes all stops as CSV.
///
/// # Errors
/// A failure to write to `to`.
pub fn write_stops(Stops(stops): &Stops, to: impl Write) -> csv::Result<()> {
    let mut writer = csv::Writer::from_writer(to);
    writer.write_record(["rotor", "unknown_ms", "bias", "seed", "tilt_deg", "height_m"])?;
    for stop in stops {
        writer.write_record([
            if stop.is_upper { "upper" } else { "lower" }.to_owned(),
            stop.unknown_ms.to_string(),
            stop.share.to_string(),
            stop.seed.to_string(),
            format!("{:.3}", stop.tilt_deg),
            format!("{:.4}", stop.height_m),
        ])?;
    }
    Ok(writer.flush()?)
}
