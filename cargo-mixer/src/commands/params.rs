//! `cargo mixer params`: an airframe's parameters as files that a flight stack loads.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::ValueEnum;
use mixer_compiler::Compiled;
use mixer_identify::report::wrapped;

use crate::bench_args::{PulseRange, pwm_range};
use crate::stack::px4::{self, Currents};
use crate::stack::{Parameter, Parameters, Stack, Value, ardupilot};

/// Writes an airframe's parameters for a flight stack, each with its reason
///
/// Without --own they are for this mixer: `examples/px4` or `examples/ardupilot` puts out the
/// throttles. With it they are for the stack's own mixer on the same vehicle, to compare with.
///
/// PX4:       CA_* in motor order, hover and least thrust, failure detection, what must be off.
///            `--format airframe` writes a start script for PX4's simulator and, beside it as
///            FILE.post, what starts this mixer in place of control_allocator.
/// ArduPilot: FRAME_CLASS and FRAME_TYPE where one fits, MOT_*.
///
/// Parameters that need more than the airframe file says are named on stderr and in the file.
#[derive(clap::Args, Debug)]
#[command(verbatim_doc_comment)]
pub struct ParamsArgs {
    /// The airframe file
    airframe: PathBuf,
    /// The flight stack
    #[arg(long, value_enum)]
    stack: Stack,
    /// The file's form
    #[arg(long, value_enum, default_value = "parameters")]
    format: Format,
    /// For the stack's own mixer instead of this one
    #[arg(long)]
    own: bool,
    /// CT and KM of PX4's rotors from the pair's slopes in hover, upper and lower apart, instead of alike
    #[arg(long)]
    slopes: bool,
    /// Pulse widths of throttle 0 and 1 on the bench, microseconds, as `1000,2000`
    #[arg(long, value_name = "LOW,HIGH", value_parser = pwm_range)]
    pwm_range: Option<PulseRange>,
    /// The file to write; without it stdout
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Overwrite the file if it is there
    #[arg(long)]
    force: bool,
}

/// The form of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    /// A file for a ground station: QGroundControl's .params, ArduPilot's .parm
    Parameters,
    /// A start script of PX4's simulator
    Airframe,
}

/// Runs the command.
pub fn run(args: &ParamsArgs) -> ExitCode {
    let compiled = match crate::compile(&args.airframe) {
        Ok(compiled) => compiled,
        Err(refusal) => return refusal.report(),
    };
    match params(args, &compiled) {
        Ok(status) => status,
        Err(message) => crate::print_error(message),
    }
}

fn params(args: &ParamsArgs, compiled: &Compiled) -> Result<ExitCode, String> {
    let for_px4 = args.stack == Stack::Px4;
    if !for_px4 && (args.slopes || args.format == Format::Airframe) {
        return Err("--slopes and --format airframe are for PX4".to_owned());
    }
    let Parameters { list, notes } = parameters(args, compiled)?;
    let mut head = header(args, compiled, &notes);
    let mut files = Vec::new();
    let text = match (args.stack, args.format) {
        (Stack::Px4, Format::Parameters) => {
            head.push_str("#\n# Vehicle-Id Component-Id Name Value Type\n");
            head + &lines(&list, ground_station)
        }
        (Stack::Ardupilot, _) => {
            head + &lines(&list, |parameter| {
                format!("{},{}", parameter.name, parameter.value)
            })
        }
        (Stack::Px4, Format::Airframe) => {
            if !args.own {
                files.push((".post", START.to_owned()));
            }
            let defaults = lines(&list, |parameter| {
                format!("param set-default {} {}", parameter.name, parameter.value)
            });
            let name = &compiled.airframe.name;
            format!(
                "#!/bin/sh\n#\n# @name {name}\n#\n# @type Coaxial multirotor\n#\n{head}\n. ${{R}}etc/init.d/rc.mc_defaults\n\n\
                 {defaults}"
            )
        }
    };
    let Some(path) = &args.output else {
        if !files.is_empty() {
            return Err("--format airframe writes two files: -o FILE names the first".to_owned());
        }
        say(&notes);
        return Ok(crate::print(&text));
    };
    files.insert(0, ("", text));
    let path = |suffix: &str| {
        let mut path = path.clone().into_os_string();
        path.push(suffix);
        PathBuf::from(path)
    };
    for (suffix, _) in &files {
        let inputs = [args.airframe.as_path()];
        if let Err(status) = crate::file::writable(&path(suffix), args.force, inputs) {
            return Ok(status);
        }
    }
    for (suffix, text) in &files {
        crate::file::save(&path(suffix), text)?;
    }
    say(&notes);
    Ok(ExitCode::SUCCESS)
}

fn say(notes: &[String]) {
    for note in notes {
        crate::print_note(format_args!("note: {note}"));
    }
}

fn parameters(args: &ParamsArgs, compiled: &Compiled) -> Result<Parameters, String> {
    let mut all = Parameters::default();
    let mut add = |more: Parameters| {
        all.list.extend(more.list);
        all.notes.extend(more.notes);
    };
    let only = |list| Parameters {
        list,
        notes: Vec::new(),
    };
    match (args.stack, args.own) {
        (Stack::Px4, own) => {
            let currents = match args.format {
                Format::Parameters => Currents::Measured,
                Format::Airframe => Currents::Simulated,
            };
            add(only(px4::geometry(compiled, args.slopes)?));
            add(if own {
                px4::own(compiled, currents)
            } else {
                px4::settings(compiled, currents)
            });
        }
        (Stack::Ardupilot, own) => {
            add(ardupilot::geometry(compiled));
            add(if own {
                ardupilot::own(compiled)
            } else {
                ardupilot::settings(compiled)
            });
        }
    }
    match (args.format, args.pwm_range, args.stack) {
        // The simulator's outputs have no pulse widths.
        (Format::Airframe, ..) => {
            add(only(px4::simulated_outputs(compiled)));
            add(only(px4::simulated_surroundings()));
        }
        (_, Some(PulseRange(pulses)), Stack::Px4) => add(only(px4::pulses(compiled, pulses))),
        (_, Some(PulseRange(pulses)), Stack::Ardupilot) => add(only(ardupilot::pulses(pulses))),
        (_, None, stack) => add(Parameters {
            list: Vec::new(),
            notes: vec![format!(
                "{} are missing: --pwm-range gives them, the pulse widths of throttle 0 and 1 on the bench",
                match stack {
                    Stack::Px4 => "PWM_MAIN_MINn and PWM_MAIN_MAXn (or PWM_AUX_)",
                    Stack::Ardupilot => "MOT_PWM_MIN and MOT_PWM_MAX",
                }
            )],
        }),
    }
    Ok(all)
}

/// Characters of a comment: ArduPilot reads a file of defaults in pieces of 98 bytes
/// (`AP_Param::read_param_defaults_file`), and takes the rest of a longer comment for a parameter.
const COMMENT: usize = 90;

/// Comments at the top of the file.
fn header(args: &ParamsArgs, compiled: &Compiled, notes: &[String]) -> String {
    let mut head = format!(
        "# {}: {} with {}.\n# Generated by cargo mixer {} from {}.\n",
        compiled.airframe.name,
        args.stack.name(),
        if args.own {
            "its own mixer"
        } else {
            "the coaxial mixer"
        },
        env!("CARGO_PKG_VERSION"),
        args.airframe
            .file_name()
            .map_or_else(String::new, |name| Path::new(name).display().to_string()),
    );
    for note in notes {
        for (k, line) in wrapped(&format!("{note}."), COMMENT).iter().enumerate() {
            // Writing to a String cannot fail.
            let _ = writeln!(head, "# {} {line}", if k == 0 { "*" } else { " " });
        }
    }
    crate::printable_lines(&head)
}

/// A line per parameter, and a comment where the reason changes.
fn lines(list: &[Parameter], line: impl Fn(&Parameter) -> String) -> String {
    let mut text = String::new();
    let mut why = "";
    for parameter in list {
        if parameter.why != why {
            why = &parameter.why;
            for line in wrapped(why, COMMENT) {
                text += &format!("# {line}\n");
            }
        }
        text += &line(parameter);
        text.push('\n');
    }
    text
}

/// Of QGroundControl: vehicle, component, name, value, MAV_PARAM_TYPE.
fn ground_station(parameter: &Parameter) -> String {
    let Parameter { name, value, .. } = parameter;
    let kind = match value {
        Value::Whole(_) => 6,
        Value::Real(_) => 9,
    };
    format!("1\t1\t{name}\t{value}\t{kind}")
}

/// PX4's own modules have been started when this runs.
const START: &str = "#!/bin/sh\n# Runs after all of PX4's modules: the coaxial mixer takes control_allocator's place.\n\
                     control_allocator stop\ncoaxial_mixer start\n";
