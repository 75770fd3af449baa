//! `cargo mixer identify`: from bench sweeps to the `[throttle]`, `[pair]` and `[voltage]` tables
//! of an airframe file.

use std::path::PathBuf;

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use mixer_compiler::airframe::{Basis, TYPICAL_EXPONENT};
use mixer_compiler::quantity;
use mixer_identify::bench::Preparation;
use mixer_identify::bench::read::refusal_notes;
use mixer_identify::fit::basis::ThrottleBox;
use mixer_identify::fit::wishes::FitOptions;
use mixer_identify::identified::Settings;
use mixer_identify::refusal::Refusal;
use mixer_identify::texts::{Outcome, Prediction, identify, rotor_lag};

use crate::bench_args::{AirArgs, ReadingArgs, exponents, of, throttle, throttle_box};
use crate::bench_files::{self, Reader};
use crate::commands::predict::{self, RotorArgs};
use crate::pack::PackArgs;
use crate::place::Place;
use crate::{Done, bad_usage, print_note};

/// Identify a pair's thrust and torque, and their dependence on voltage, from bench files.
///
/// Reads coaxial maps (`PWM Left`, `PWM Right`, ..), RCbenchmark 1520/1580/1780, Tyto Flight Stand,
/// and the plain `upper,lower,thrust_n,torque_nm[,voltage_v]` with throttles in [0, 1]. Several
/// files are joined: repeats of one pair, the same at other voltages, and single-rotor sweeps at
/// two voltages for the exponents.
#[derive(Debug, Clone, Args)]
pub struct IdentifyArgs {
    /// Bench files (CSV).
    #[arg(required = true, value_name = "BENCH.csv")]
    pub files: Vec<PathBuf>,
    /// Where the answer goes
    #[command(flatten)]
    pub place: Place,
    /// Print every number: cross-validation, coefficients with their intervals, fold, all warnings.
    #[arg(long, conflicts_with = "json")]
    pub verbose: bool,
    /// Terms of the model; auto chooses by cross-validation.
    #[arg(long, default_value = AUTO, value_parser = bases())]
    pub basis: BasisChoice,
    /// Leave out the rows that stand out (they are named with or without this).
    #[arg(long)]
    pub robust: bool,
    /// The throttles to command [default: those measured].
    #[arg(long, value_name = "MIN,MAX", value_parser = throttle_box)]
    pub throttle: Option<ThrottleBox>,
    /// How the bench files are read
    #[command(flatten)]
    pub reading: ReadingArgs,
    /// Reference voltage, V [default: mean of the rows].
    #[arg(long, value_name = "VOLT", value_parser = of(quantity::VOLTAGE))]
    pub reference_voltage: Option<f64>,
    /// A run of the upper rotor alone, the lower one at rest: `[pair.lower_out]`, for when the
    /// lower rotor is out.
    #[arg(long, value_name = "RUN.csv")]
    pub lower_out: Option<PathBuf>,
    /// A run of the lower rotor alone, likewise: `[pair.upper_out]`.
    #[arg(long, value_name = "RUN.csv")]
    pub upper_out: Option<PathBuf>,
    /// Exponent of thrust and of torque in (V / reference)^k, or one for both: brings the rows to
    /// the reference voltage and writes `[voltage]` where the files cannot tell one. 1.75 is the
    /// median of 104 motors with propellers.
    #[arg(long, value_name = "K[,K]", value_parser = exponents, conflicts_with = "rpm_at_full")]
    pub voltage_exponent: Option<[f64; 2]>,
    /// The air at the bench
    #[command(flatten)]
    pub air: AirArgs,
    /// The battery of the vehicle
    #[command(flatten)]
    pub pack: PackArgs,
    /// The files are logs of one rotor whose throttle steps (time, throttle, speed or thrust, 50 Hz or more): find its lag at
    /// this throttle, that of hover, for `[vehicle] rotor_lag_s`, and whether its controller brakes.
    #[arg(long, value_name = "THROTTLE", value_parser = throttle,
        conflicts_with_all = ["output", "frame", "prior", "lower_out", "upper_out", "verbose", "rpm_at_full"])]
    pub lag_at: Option<f64>,
    /// Few rows of the pair on top of what this run of one rotor predicts (`cargo mixer predict`):
    /// four rows serve, thrust alone serves a little. From 16 rows on leave it out.
    #[arg(long, value_name = "SINGLE.csv")]
    pub prior: Option<PathBuf>,
    /// What is known of the rotors beside the run
    #[command(flatten)]
    pub rotors: RotorArgs,
}

/// `--basis`; none is to be chosen by cross-validation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BasisChoice(pub Option<Basis>);

/// Most refused rows that are told one by one: without and with `--verbose`.
const MOST_ROWS: [usize; 2] = [5, 200];

const AUTO: &str = "auto";

/// The bases by their words, each with its terms, and `auto`.
fn bases() -> impl TypedValueParser<Value = BasisChoice> {
    let bases = Basis::ALL.map(|basis| {
        let terms = basis.term_names();
        PossibleValue::new(basis.name()).help(format!("{} terms: {}", terms.len(), terms.join(", ")))
    });
    let auto = PossibleValue::new(AUTO).help("By cross-validation");
    PossibleValuesParser::new(bases.into_iter().chain([auto])).map(|word| {
        let mut bases = Basis::ALL.into_iter();
        BasisChoice(bases.find(|basis| basis.name() == word))
    })
}

impl IdentifyArgs {
    /// The settings that the arguments ask for.
    pub fn settings(&self) -> Settings {
        let mut settings = self.reading.settings();
        settings.reading.by_hand.speed_serves = self.lag_at.is_some();
        Settings {
            preparation: Preparation {
                is_correction: self.prior.is_some(),
                air: self.air.air(),
                ..settings.preparation
            },
            wishes: FitOptions {
                basis: self.basis.0,
                robust: self.robust,
                throttle: self.throttle,
                reference_v: self.reference_voltage,
                voltage_exponent: self.voltage_exponent,
                closed_loop: self.reading.rpm_at_full.is_some(),
                pack_v: self.pack.range_v(),
                run: self.rotors.known(None, [0.0; 2]),
                name: self
                    .place
                    .output
                    .as_ref()
                    .and_then(|path| Some(path.file_stem()?.to_str()?.to_owned())),
            },
            ..settings
        }
    }
}

/// Why there is no answer.
#[derive(Debug, Clone)]
pub enum NoAnswer {
    /// The arguments do not fit together.
    Usage(&'static str),
    /// The files cannot serve.
    Refused(Vec<Refusal>),
}

impl IdentifyArgs {
    /// The pair, and notes about refused rows.
    ///
    /// # Errors
    /// Arguments that do not fit together, files that cannot serve.
    pub fn answer(&self, reader: Reader<'_>) -> Result<(Outcome<()>, Vec<String>), NoAnswer> {
        let maps = self.files.iter().map(|path| reader(path)).collect::<Vec<_>>();
        let runs = [&self.prior, &self.lower_out, &self.upper_out];
        let [prior, upper, lower] = runs.map(|run| run.as_deref().map(reader));
        let settings = self.settings();
        if let Some(throttle) = self.lag_at {
            let exponent = self.voltage_exponent.map_or(TYPICAL_EXPONENT, |k| k[0]);
            let answer = rotor_lag(&maps, exponent, throttle, &settings).map_err(NoAnswer::Refused)?;
            return Ok((answer.texts(), Vec::new()));
        }
        if let Some(single) = &prior {
            let held = self.reading.rpm_at_full.is_some();
            let exponents = predict::exponents(self.voltage_exponent, held);
            let mut run = self.rotors.reading(self.air.air(), self.reading.rpm_at_full);
            run.preparation.tare = self.reading.tare;
            let how = Prediction {
                run,
                map: settings,
                known: self.rotors.known(self.reference_voltage, exponents),
                wishes: self.rotors.wishes(self.throttle, held, &self.pack),
            };
            let answer = self.rotors.predict(single, &maps, &how, reader);
            return Ok((answer.map_err(NoAnswer::Refused)?.texts(), Vec::new()));
        }
        let answer =
            identify(&maps, [upper.as_ref(), lower.as_ref()], &settings).map_err(NoAnswer::Refused)?;
        if self.rotors.is_given() && (answer.found.rotor.is_none() || self.rotors.is_of_pair()) {
            let message = "what is known of one rotor alone belongs to its run, or to --prior SINGLE.csv, which is not given";
            return Err(NoAnswer::Usage(message));
        }
        let refused_rows = answer.found.files.iter().flat_map(|file| &file.refused_rows);
        let most = MOST_ROWS[usize::from(self.verbose)];
        let notes = refusal_notes(refused_rows, most);
        Ok((answer.texts(), notes))
    }
}

/// Runs the command: status 0, 1 for input that cannot serve, 2 for bad usage.
pub fn run(args: &IdentifyArgs) -> Done {
    let place = &args.place;
    let runs = [&args.prior, &args.lower_out, &args.upper_out];
    place.check(args.files.iter().chain(runs.into_iter().flatten()))?;
    let (answer, notes) = args.answer(&bench_files::text).map_err(|none| match none {
        NoAnswer::Usage(message) => bad_usage(message),
        NoAnswer::Refused(refusals) => place.refused(&refusals),
    })?;
    notes.iter().for_each(print_note);
    place.write(&answer, args.verbose)
}
