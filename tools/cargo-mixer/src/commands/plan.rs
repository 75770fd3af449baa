//! `cargo mixer plan`: the throttle pairs that a bench has to run before `cargo mixer identify`.

use std::path::PathBuf;

use mixer_compiler::quantity;
use mixer_identify::bench::STOP_THROTTLE;
use mixer_identify::plan::{CORRECTING, plan, template, with_rests};

use crate::Done;

/// Writes the throttle pairs to run on the bench, in an order that averages temperature and sag
///
/// `cargo mixer identify` reads the file when it is filled in. 5 x 5 levels suffice for the cubic basis,
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
    /// The speed controllers hold a speed: the speed at full throttle, revolutions per minute; the
    /// file then has speeds to command
    #[arg(long, value_name = "RPM", value_parser = crate::bench_args::of(quantity::SPEED))]
    rpm_at_full: Option<f64>,
    /// The file to write, whole or not at all [default: standard output]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Overwrite the output if it is there
    #[arg(long)]
    force: bool,
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
    let text = template(&pairs, args.rpm_at_full);
    crate::deliver(args.output.as_deref(), args.force, &text)
}
