//! `cargo mixer predict`: a pair's tables from a run of one rotor alone.

use std::path::PathBuf;

use clap::Args;
use mixer_compiler::airframe::TYPICAL_EXPONENT;
use mixer_compiler::quantity;
use mixer_identify::bench::Preparation;
use mixer_identify::bench::air::BenchAir;
use mixer_identify::bench::header::ByHand;
use mixer_identify::bench::read::Reading;
use mixer_identify::fit::basis::ThrottleBox;
use mixer_identify::identified::Settings;
use mixer_identify::refusal::Refusal;
use mixer_identify::rotor::predict::{PredictOptions, Predicted};
use mixer_identify::rotor::single;
use mixer_identify::texts::{self, Outcome, Prediction, Text};

use crate::Done;
use crate::bench_args;
use crate::bench_args::{AirArgs, ReadingArgs, of, throttle_box};
use crate::bench_files::{self, Reader};
use crate::pack::PackArgs;
use crate::place::Place;

/// Predict a pair's thrust and torque from a run of one rotor, or the table of its data sheet
///
/// Without a coaxial bench: takes any run of one rotor that `cargo mixer identify` reads, or a plain
/// table `throttle,thrust[,torque]` of five rows or more, with units in the header or by --unit, as
/// `Throttle (%),Thrust (gf),Torque (N*m)`. The result is within some per cent of a measured map;
/// docs/no-bench.md says how many, and how a few bench points make it better.
#[derive(Debug, Clone, Args)]
pub struct PredictArgs {
    /// A run of one rotor alone, or its data sheet's table (CSV).
    #[arg(value_name = "SINGLE.csv")]
    pub single: PathBuf,
    /// What is known of the rotors beside the run
    #[command(flatten)]
    pub rotors: RotorArgs,
    /// How the run is read; `upper` is the role of its rotor, `throttle` the same
    #[command(flatten)]
    pub reading: ReadingArgs,
    /// Bring the rows of the run to this voltage, V [default: their mean].
    #[arg(long, value_name = "VOLT", value_parser = of(quantity::VOLTAGE))]
    pub reference_voltage: Option<f64>,
    /// Exponent of thrust and of torque in (V / reference)^k, or one for both [default: 1.75, the
    /// median of 104 motors with propellers].
    #[arg(long, value_name = "K[,K]", value_parser = bench_args::exponents, conflicts_with = "rpm_at_full")]
    pub voltage_exponent: Option<[f64; 2]>,
    /// The battery of the vehicle
    #[command(flatten)]
    pub pack: PackArgs,
    /// The air at the bench
    #[command(flatten)]
    pub air: AirArgs,
    /// The throttles to command; the lower is raised where the map asks for it [default: 0.2,1].
    #[arg(long, value_name = "MIN,MAX", value_parser = throttle_box)]
    pub throttle: Option<ThrottleBox>,
    /// Where the answer goes
    #[command(flatten)]
    pub place: Place,
}

/// What is known of the rotors beside the run.
#[derive(Debug, Clone, Default, Args)]
pub struct RotorArgs {
    /// A run of the lower rotor alone, where it differs from the upper one.
    #[arg(long, value_name = "RUN.csv")]
    pub lower_single: Option<PathBuf>,
    /// Distance of the rotors over their diameter, z/D [default: 0.25].
    #[arg(long, value_name = "RATIO", value_parser = of(quantity::SPACING_RATIO), conflicts_with = "spacing")]
    pub spacing_ratio: Option<f64>,
    /// Distance of the rotors, m.
    #[arg(long, value_name = "METRE", value_parser = of(quantity::SPACING), requires = "diameter")]
    pub spacing: Option<f64>,
    /// Diameter of the propeller, m.
    #[arg(long, value_name = "METRE", value_parser = of(quantity::DIAMETER))]
    pub diameter: Option<f64>,
    /// Torque per thrust, m, for a run without torque [default: 0.048 of the diameter].
    #[arg(long, value_name = "METRE", value_parser = of(quantity::TORQUE_PER_THRUST))]
    pub kappa: Option<f64>,
    /// Voltage of the run, V, where it has no column for it.
    #[arg(long, value_name = "VOLT", value_parser = of(quantity::VOLTAGE))]
    pub run_voltage: Option<f64>,
}

impl RotorArgs {
    /// z/D, where it is given.
    pub(crate) fn ratio(&self) -> Option<f64> {
        let spacing = self.spacing.zip(self.diameter);
        self.spacing_ratio.or(spacing.map(|(z, diameter)| z / diameter))
    }

    /// What is known of the runs, whose thrust and torque follow the voltage by `exponents`.
    pub(crate) fn known(&self, reference_v: Option<f64>, exponents: [f64; 2]) -> single::RunFacts {
        single::RunFacts {
            kappa_m: self.kappa,
            diameter_m: self.diameter,
            run_v: self.run_voltage,
            reference_v,
            exponents,
        }
    }

    /// How a run of one rotor is read, without options for its columns.
    pub(crate) fn reading(&self, air: Option<BenchAir>, full_rpm: Option<f64>) -> Settings {
        Settings {
            reading: Reading {
                by_hand: ByHand {
                    full_rpm,
                    ..ByHand::default()
                },
                pwm_range: None,
            },
            preparation: Preparation {
                prefers_rotor_cell: true,
                air,
                ..Preparation::default()
            },
            ..Settings::default()
        }
    }

    /// What is wished of the pair.
    pub(crate) fn wishes(
        &self,
        throttle: Option<ThrottleBox>,
        closed_loop: bool,
        pack: &PackArgs,
    ) -> PredictOptions {
        PredictOptions {
            spacing_ratio: self.ratio(),
            closed_loop,
            throttle,
            pack_v: pack.range_v(),
        }
    }

    /// Predicts the pair of the run of a rotor and of what is given.
    pub(crate) fn predict(
        &self,
        single: &Text,
        maps: &[Text],
        how: &Prediction,
        reader: Reader<'_>,
    ) -> Result<Outcome<Predicted>, Vec<Refusal>> {
        let lower = self.lower_single.as_deref().map(reader);
        texts::predict(single, lower.as_ref(), maps, how)
    }

    /// Whether anything is given.
    pub(crate) fn is_given(&self) -> bool {
        let numbers = [self.diameter, self.kappa, self.run_voltage];
        self.is_of_pair() || numbers.iter().any(Option::is_some)
    }

    /// Whether anything is that takes two rotors.
    pub(crate) fn is_of_pair(&self) -> bool {
        self.lower_single.is_some() || self.ratio().is_some()
    }
}

impl PredictArgs {
    /// The settings that the arguments ask for.
    pub fn settings(&self) -> Settings {
        let mut settings = self.reading.settings();
        settings.preparation.prefers_rotor_cell = true;
        settings.preparation.air = self.air.air();
        settings
    }

    /// Predicts the pair.
    ///
    /// # Errors
    /// Files that cannot serve.
    pub fn answer(&self, reader: Reader<'_>) -> Result<Outcome<Predicted>, Vec<Refusal>> {
        let held = self.reading.rpm_at_full.is_some();
        let exponents = exponents(self.voltage_exponent, held);
        let how = Prediction {
            run: self.settings(),
            map: Settings::default(),
            known: self.rotors.known(self.reference_voltage, exponents),
            wishes: self.rotors.wishes(self.throttle, held, &self.pack),
        };
        self.rotors.predict(&reader(&self.single), &[], &how, reader)
    }
}

/// Exponents of the voltage: those given, else usual ones. A speed that is held does not follow it.
pub(crate) fn exponents(given: Option<[f64; 2]>, held: bool) -> [f64; 2] {
    given.unwrap_or([if held { 0.0 } else { TYPICAL_EXPONENT }; 2])
}

/// Runs the command: status 0, 1 for input that cannot serve, 2 for bad usage.
pub fn run(args: &PredictArgs) -> Done {
    let place = &args.place;
    place.check(args.rotors.lower_single.iter().chain([&args.single]))?;
    let answer = args.answer(&bench_files::text);
    let answer = answer.map_err(|refusals| place.refused(&refusals))?;
    place.write(&answer, false)
}
