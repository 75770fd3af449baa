//! Electrical energy of the manoeuvre with the power bias and without:
//! `airframes/x8-11in-least-power.toml` on the paper's vehicle.
//!
//! The ISAE X8 has no map of electrical power, so its rotors give way to those of an airframe that
//! has one, identified from a bench; mass, inertia, controller and manoeuvre stay. The supply is
//! held at the reference voltage, at which the power map is. Energy is the map's, over the
//! throttles that the mixer commands.

use std::error::Error;
use std::fmt;
use std::io::Write;

use mixer_compiler::Source;
use mixer_compiler::airframe::Airframe;
use mixer_compiler::tables::MixerTables;

use crate::air::Room;
use crate::controller::PERIOD_S;
use crate::flight::{Flight, Sample, Scenario, fly};
use crate::mixer::Mixer;

/// The airframe file.
const FILE: &str = include_str!("../../airframes/x8-11in-least-power.toml");

/// An airframe with a power map, and its mixer with and without the bias.
#[derive(Clone, Debug)]
pub struct Rotors {
    airframe: Airframe,
    with: MixerTables,
    without: MixerTables,
}

/// Energy of both rotors of all units over one manoeuvre, J.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energy {
    /// The seed of mismatch and air.
    pub seed: u64,
    /// With the power bias.
    pub with_j: f64,
    /// With all torques from zero.
    pub without_j: f64,
}

impl Energy {
    /// The saving by the bias, percent.
    pub fn saving_percent(&self) -> f64 {
        100.0 * (1.0 - self.with_j / self.without_j)
    }
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
        let with = compiled.tables;
        let without = with.without_power_bias();
        Ok(Rotors {
            airframe: compiled.airframe,
            with,
            without,
        })
    }

    /// Flies `seed` with and without the bias.
    ///
    /// # Errors
    /// A flight that was lost, or an airframe without a power map.
    pub fn fly(&self, scenario: &Scenario, seed: u64) -> Result<Energy, Box<dyn Error>> {
        let energy = |tables: &MixerTables| -> Result<f64, Box<dyn Error>> {
            let mixer = Mixer::Compiled(Box::new(tables.clone()));
            let room = Room::new(scenario.air, seed);
            self.energy_j(&fly(&self.airframe, &mixer, scenario.tilt, room)?)
        };
        Ok(Energy {
            seed,
            with_j: energy(&self.with)?,
            without_j: energy(&self.without)?,
        })
    }

    fn energy_j(&self, flight: &Flight) -> Result<f64, Box<dyn Error>> {
        let samples = flight.samples.iter();
        let power = |sample: &Sample| self.airframe.power_w(sample.throttle.as_slice());
        let energy: Option<f64> = samples.map(|sample| Some(power(sample)? * PERIOD_S)).sum();
        energy.ok_or_else(|| "the airframe has no [pair.power]".into())
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
        let count = self.flights.len().max(1) as f64;
        let mean = |of: fn(&Energy) -> f64| self.flights.iter().map(of).sum::<f64>() / count;
        write!(
            f,
            "  {:<30} {:>9.0} J with the power bias, {:>9.0} J without: {:.2} % less",
            self.scenario.to_string(),
            mean(|energy| energy.with_j),
            mean(|energy| energy.without_j),
            mean(Energy::saving_percent)
        )
    }
}

/// Writes all flights as CSV.
///
/// # Errors
/// A failure to write to `to`.
pub fn write(savings: &[Saving], to: impl Write) -> csv::Result<()> {
    let mut writer = csv::Writer::from_writer(to);
    writer.write_record(["scenario", "seed", "mixer", "energy_j"])?;
    for Saving { scenario, flights } in savings {
        for energy in flights {
            for (mixer, joules) in [("bias", energy.with_j), ("none", energy.without_j)] {
                let [scenario, seed] = [scenario.to_string(), energy.seed.to_string()];
                writer.write_record([scenario, seed, mixer.to_owned(), format!("{joules:.1}")])?;
            }
        }
    }
    Ok(writer.flush()?)
}
