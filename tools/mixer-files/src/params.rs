//! An airframe's parameters as files that a flight stack loads.

mod ardupilot;
mod betaflight;
pub mod frames;
mod parameter;
mod px4;
pub(crate) mod read;
mod stack;

use std::fmt::Write as _;

use mixer_compiler::Compiled;
use mixer_compiler::diagnostic::wrapped;

pub use crate::params::parameter::bench_pulses;
use crate::params::parameter::{PULSES_US, Parameter, Parameters, Value};
use crate::params::px4::Currents;
pub use crate::params::stack::Stack;
use mixer_compiler::diagnostic::printable_lines;

/// Which parameters, and in which form.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// The flight stack.
    pub stack: Stack,
    /// The form of the file.
    pub format: Format,
    /// Whether they are for the stack's own mixer instead of this one.
    pub own: bool,
    /// Pulse widths of throttle 0 and 1 on the bench, microseconds; without them those that the
    /// airframe remembers.
    pub pulses_us: Option<[f64; 2]>,
}

impl Options {
    /// For this mixer, as a ground station loads them, without pulse widths.
    pub fn of(stack: Stack) -> Self {
        Options {
            stack,
            format: Format::GroundStation,
            own: false,
            pulses_us: None,
        }
    }
}

/// The form of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// For a ground station: QGroundControl's .params, ArduPilot's .parm, lines of Betaflight's CLI.
    GroundStation,
    /// A start script of PX4's simulator.
    Simulator,
}

impl Format {
    /// All, each with its word on the command line and what it is.
    #[rustfmt::skip]
    pub const ALL: [(Format, &'static str, &'static str); 2] = [
        (Format::GroundStation, "parameters", "A file for a ground station: QGroundControl's .params, ArduPilot's .parm, lines of Betaflight's CLI"),
        (Format::Simulator, "airframe", "A start script of PX4's simulator"),
    ];
}

/// A stack's parameters for an airframe.
#[derive(Clone, Debug)]
pub struct Params {
    /// The file.
    pub text: String,
    /// The script that PX4's simulator runs after it, `FILE.post`.
    pub post: Option<&'static str>,
    /// Parameters that need more than the airframe file says.
    pub notes: Vec<String>,
}

/// The parameters of an airframe, each below its reason. `file` is the name of the airframe's file.
///
/// # Errors
/// More rotors than the stack has parameters for; a simulator's script for ArduPilot; no pulse widths.
pub fn params(compiled: &Compiled, file: &str, options: &Options) -> Result<Params, String> {
    let Parameters { list, notes } = parameters(options, compiled)?;
    let mut head = header(compiled, file, options, &notes);
    let mut post = None;
    let text = match (options.stack, options.format) {
        (Stack::Px4, Format::GroundStation) => {
            head.push_str("#\n# Vehicle-Id Component-Id Name Value Type\n");
            head + &lines(&list, ground_station)
        }
        (Stack::Ardupilot, Format::GroundStation) => {
            head + &lines(&list, |parameter| {
                format!("{},{}", parameter.name, parameter.value)
            })
        }
        (Stack::Betaflight, Format::GroundStation) => {
            head + &lines(&list, |parameter| match parameter.value {
                Value::Line => parameter.name.clone(),
                value => format!("set {} = {value}", parameter.name),
            }) + "save\n"
        }
        (Stack::Ardupilot | Stack::Betaflight, Format::Simulator) => {
            return Err("--format airframe is for PX4".to_owned());
        }
        (Stack::Px4, Format::Simulator) => {
            post = (!options.own).then_some(START);
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
    Ok(Params { text, post, notes })
}

fn parameters(options: &Options, compiled: &Compiled) -> Result<Parameters, String> {
    let mut all = Parameters::default();
    let [least, most] = PULSES_US;
    if let Some([low, high]) = options
        .pulses_us
        .filter(|us| us.iter().any(|us| !(least..=most).contains(us)))
    {
        return Err(format!(
            "--pwm-range {low},{high}: pulse widths in microseconds from {least} to {most}, as 1000,2000"
        ));
    }
    let currents = match options.format {
        Format::GroundStation => Currents::Measured,
        Format::Simulator => Currents::Simulated,
    };
    match options.stack {
        Stack::Px4 => px4::geometry(compiled, &mut all)?,
        Stack::Ardupilot => ardupilot::geometry(compiled, options.own, &mut all),
        Stack::Betaflight => betaflight::geometry(compiled, &mut all)?,
    }
    match (options.stack, options.own) {
        (Stack::Px4, true) => px4::own(compiled, currents, &mut all),
        (Stack::Px4, false) => px4::settings(compiled, currents, &mut all),
        (Stack::Ardupilot, true) => ardupilot::own(compiled, &mut all),
        (Stack::Ardupilot, false) => ardupilot::settings(compiled, &mut all),
        (Stack::Betaflight, true) => betaflight::own(compiled, &mut all),
        (Stack::Betaflight, false) => betaflight::settings(compiled, &mut all),
    }
    let pulses_us = options.pulses_us.or_else(|| bench_pulses(&compiled.airframe));
    match (options.format, pulses_us, options.stack) {
        // The simulator's outputs have no pulse widths.
        (Format::Simulator, ..) => px4::simulated(compiled, &mut all),
        (_, Some(pulses), Stack::Px4) => px4::pulses(compiled, pulses, &mut all),
        (_, Some(pulses), Stack::Ardupilot) => ardupilot::pulses(pulses, &mut all),
        (_, Some(pulses), Stack::Betaflight) => betaflight::pulses(pulses, &mut all),
        (_, None, stack) => {
            let names = match stack {
                Stack::Px4 => "PWM_MAIN_MINn and PWM_MAIN_MAXn (PWM_AUX_MINn, PWM_AUX_MAXn)",
                Stack::Ardupilot => "MOT_PWM_MIN and MOT_PWM_MAX",
                Stack::Betaflight => "min_command and max_throttle, which DShot does not use,",
            };
            all.note(format!(
                "{names} are missing: --pwm-range gives them, the pulse widths of throttle 0 and 1 on the bench"
            ));
        }
    }
    // The simulator's outputs are written.
    if options.format == Format::GroundStation {
        all.note(format!(
            "what describes outputs and battery is not written and stays as it is: {}",
            read::stays(options.stack)
        ));
    }
    Ok(all)
}

/// Characters of a comment: ArduPilot reads a file of defaults in pieces of 98 bytes
/// (`AP_Param::read_param_defaults_file`), and takes the rest of a longer comment for a parameter.
const COMMENT: usize = 90;

/// Comments at the top of the file.
fn header(compiled: &Compiled, file: &str, options: &Options, notes: &[String]) -> String {
    let mut head = format!(
        "# {}: {} with {}.\n# Generated by cargo mixer {} from {}.\n",
        compiled.airframe.name,
        options.stack.name(),
        if options.own {
            "its own mixer"
        } else {
            "the coaxial mixer"
        },
        env!("CARGO_PKG_VERSION"),
        file,
    );
    let borrowed = compiled.airframe.pair.borrowed();
    let beware = borrowed.map(|told| format!("beware: {told}"));
    if !options.own {
        let (what, unit) = match options.stack {
            Stack::Px4 => ("A setpoint of 1", compiled.scale()),
            Stack::Ardupilot => ("A setpoint of 1", compiled.ardupilot_scale()),
            Stack::Betaflight => ("A PID sum of 1000, or full stick,", compiled.betaflight_scale()),
        };
        let (roll, pitch, yaw, thrust) = (unit.roll_nm, unit.pitch_nm, unit.yaw_nm, unit.thrust_n);
        let _ = writeln!(
            head,
            "# {what} is {roll:.4} N m roll, {pitch:.4} N m pitch, {yaw:.4} N m yaw, {thrust:.3} N.",
        );
    }
    for note in beware.iter().chain(notes) {
        for (k, line) in wrapped(&format!("{note}."), COMMENT).iter().enumerate() {
            // Writing to a String cannot fail.
            let _ = writeln!(head, "# {} {line}", if k == 0 { "*" } else { " " });
        }
    }
    printable_lines(&head)
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
        Value::Whole(_) | Value::Line => 6,
        Value::Real(_) => 9,
    };
    format!("1\t1\t{name}\t{value}\t{kind}")
}

/// PX4's own modules have been started when this runs.
const START: &str = "#!/bin/sh\n# Runs after all of PX4's modules: the coaxial mixer takes control_allocator's place.\n\
                     control_allocator stop\ncoaxial_mixer start\n";
