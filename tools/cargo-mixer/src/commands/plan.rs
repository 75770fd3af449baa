//! `cargo mixer plan`: the throttle pairs that a bench has to run before `cargo mixer identify`.

use std::path::PathBuf;

use clap::ValueEnum;
use mixer_identify::bench::STOP_THROTTLE;
use mixer_identify::plan::{CORRECTING, flight_stand, plan, rcbenchmark, template, with_rests};

use crate::Done;

/// Writes the throttle pairs to run on the bench, in an order that averages temperature and sag
///
/// `cargo mixer identify` reads what each format leaves. 5 x 5 levels suffice for the cubic basis,
/// 4 x 4 nearly; 3 x 3 do not determine it.
#[derive(clap::Args, Debug)]
pub struct PlanArgs {
    /// Throttles per rotor, evenly spaced; every pair of them is run
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u8).range(4..=20))]
    levels: u8,
    /// The lowest throttle: the least at which both rotors turn steadily
    #[arg(long, value_name = "THROTTLE", value_parser = throttle, required_unless_present = "prior")]
    min: Option<f64>,
    /// The four points that correct a prediction, for `cargo mixer identify --prior`, in place of a
    /// grid
    #[arg(long, conflicts_with_all = ["levels", "min", "max"])]
    prior: bool,
    /// The highest throttle
    #[arg(long, value_name = "THROTTLE", default_value_t = 1.0, value_parser = throttle)]
    max: f64,
    /// The format to write
    #[arg(long, value_enum, default_value_t = Format::Template)]
    format: Format,
    /// The speed controllers hold a speed: the speed at full throttle, revolutions per minute; the
    /// template then has speeds to command
    #[arg(long, value_name = "RPM", value_parser = crate::bench_args::positive)]
    rpm_at_full: Option<f64>,
    /// Pulse widths of throttle 0 and 1 in a script, microseconds
    #[arg(long, value_name = "LOW,HIGH", default_value = "1000,2000", value_parser = crate::bench_args::pwm_range)]
    pwm_range: [f64; 2],
    /// The file to write, whole or not at all [default: standard output]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Overwrite the output if it is there
    #[arg(long)]
    force: bool,
}

/// The format of a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// A CSV to fill in.
    Template,
    /// A script for the RCbenchmark application (series 1780, escA above, escB below).
    Rcbenchmark,
    /// A Python script for the Flight Stand software's programming interface.
    FlightStand,
}

fn throttle(text: &str) -> Result<f64, String> {
    let value = text.trim().parse::<f64>().ok();
    value
        .filter(|x| (0.0..=1.0).contains(x))
        .ok_or_else(|| format!("{text:?} is not a throttle in [0, 1]"))
}

/// Runs the command.
pub fn run(args: &PlanArgs) -> Done {
    let pairs = match args.min {
        Some(min) if min <= STOP_THROTTLE => {
            let message = format_args!(
                "--min {min}: a rotor at rest is no row of a map; the least throttle at which both turn steadily, 0.05 to 0.15"
            );
            return Err(crate::bad_usage(message));
        }
        Some(min) if min < args.max => plan(usize::from(args.levels), min, args.max),
        Some(min) => {
            let message = format_args!("--min {min} is not below --max {}", args.max);
            return Err(crate::bad_usage(message));
        }
        // clap asks for one of the two.
        None => CORRECTING.to_vec(),
    };
    let pairs = with_rests(&pairs);
    if args.rpm_at_full.is_some() && args.format != Format::Template {
        let message = "--rpm-at-full writes speeds into the template; the scripts command pulse widths";
        return Err(crate::bad_usage(message));
    }
    let text = match args.format {
        Format::Template => template(&pairs, args.rpm_at_full),
        Format::Rcbenchmark => rcbenchmark(&pairs, args.pwm_range),
        Format::FlightStand => flight_stand(&pairs, args.pwm_range),
    };
    crate::deliver(args.output.as_deref(), args.force, &text)
}
