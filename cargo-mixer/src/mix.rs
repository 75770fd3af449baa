//! `cargo mixer mix`: setpoints in, throttles out, on the very tables that the macro emits.

use std::fmt::Write as _;
use std::io::{self, Read, Write, stdin, stdout};
use std::path::PathBuf;
use std::process::ExitCode;

use csv::{Reader, ReaderBuilder, StringRecord, Trim};
use mixer_compiler::Compiled;
use mixer_rt::Wrench;

use crate::BAD_INPUT;

/// Mixes setpoints: CSV on stdin to CSV on stdout, row by row
///
/// In: roll_nm,pitch_nm,yaw_nm,thrust_n[,voltage_v] (any order, with this header; without voltage_v the reference
/// voltage is taken). Out: throttle_0.., achieved_roll_nm, achieved_pitch_nm, achieved_yaw_nm, achieved_thrust_n,
/// saturation (bits: 1 roll, 4 pitch, 16 yaw, 64 thrust fell short; twice that: overshot; 256 voltage clamped).
/// A bad row is reported with its line on stderr and left out; the exit status is then 1.
#[derive(clap::Args, Debug)]
#[command(verbatim_doc_comment)]
pub struct MixArgs {
    /// The airframe file
    airframe: PathBuf,
}

/// Runs the command.
pub fn run(args: &MixArgs) -> ExitCode {
    let compiled = match crate::compile(&args.airframe) {
        Ok(compiled) => compiled,
        Err(refusal) => return refusal.report(),
    };
    match mix(&compiled, stdin().lock(), stdout().lock(), io::stderr().lock()) {
        Ok(0) => ExitCode::SUCCESS,
        Ok(bad) => {
            eprintln!("error: {bad} bad row(s) left out");
            ExitCode::from(BAD_INPUT)
        }
        Err(Stopped::Header(message)) => {
            eprintln!("error: stdin:1: {message}");
            ExitCode::from(BAD_INPUT)
        }
        Err(Stopped::Io(error)) => crate::finish(Err(error)),
    }
}

/// Why mixing ended before the input did.
#[derive(Debug)]
pub enum Stopped {
    /// The header is not one of setpoints.
    Header(String),
    /// Input or output failed.
    Io(io::Error),
}

impl From<io::Error> for Stopped {
    fn from(error: io::Error) -> Self {
        Stopped::Io(error)
    }
}

/// The columns of a setpoint, in the order of [`Columns`].
const REQUIRED: [&str; 4] = ["roll_nm", "pitch_nm", "yaw_nm", "thrust_n"];
const VOLTAGE: &str = "voltage_v";

/// Where the columns stand.
struct Columns {
    wrench: [usize; 4],
    voltage: Option<usize>,
}

impl Columns {
    fn new(header: &StringRecord) -> Result<Self, String> {
        let place = |name: &str| header.iter().position(|column| column == name);
        let known = |name: &str| REQUIRED.contains(&name) || name == VOLTAGE;
        let missing: Vec<&str> = REQUIRED
            .into_iter()
            .filter(|name| place(name).is_none())
            .collect();
        if !missing.is_empty() {
            return Err(format!(
                "no column {}; the header is {}[,{VOLTAGE}]",
                missing.join(", "),
                REQUIRED.join(",")
            ));
        }
        if let Some(unknown) = header.iter().find(|name| !known(name)) {
            return Err(format!(
                "unknown column `{unknown}`; the header is {}[,{VOLTAGE}]",
                REQUIRED.join(",")
            ));
        }
        if let Some(repeated) = header
            .iter()
            .enumerate()
            .find(|(i, name)| place(name) != Some(*i))
        {
            return Err(format!("column `{}` stands twice", repeated.1));
        }
        Ok(Columns {
            wrench: REQUIRED.map(|name| place(name).unwrap_or_default()),
            voltage: place(VOLTAGE),
        })
    }

    /// The setpoint of a row and its voltage, if it has one.
    fn read(&self, row: &StringRecord) -> Result<(Wrench, Option<f32>), String> {
        let number = |index: usize, name: &str| {
            let text = row.get(index).unwrap_or_default();
            text.parse::<f32>()
                .map_err(|_| format!("{name} `{text}` is not a number"))
        };
        let mut wrench = [0.0; 4];
        for ((value, index), name) in wrench.iter_mut().zip(self.wrench).zip(REQUIRED) {
            *value = number(index, name)?;
        }
        let voltage = self.voltage.map(|index| number(index, VOLTAGE)).transpose()?;
        Ok((Wrench::from_array(wrench), voltage))
    }
}

/// Mixes every row of `input` into `output`; bad rows go to `errors`. Returns their number.
///
/// # Errors
/// A header that is none, or input or output that fails.
pub fn mix(
    compiled: &Compiled,
    input: impl Read,
    mut output: impl Write,
    mut errors: impl Write,
) -> Result<usize, Stopped> {
    let mut reader: Reader<_> = ReaderBuilder::new().trim(Trim::All).from_reader(input);
    let header = reader.headers().map_err(|error| match error.into_kind() {
        csv::ErrorKind::Io(error) => Stopped::Io(error),
        other => Stopped::Header(format!("{other:?}")),
    })?;
    let columns = Columns::new(header).map_err(Stopped::Header)?;
    let reference_v = compiled
        .airframe
        .voltage
        .as_ref()
        .map_or(0.0, |voltage| voltage.reference_v as f32);

    let mut line = String::new();
    for channel in 0..compiled.airframe.rotors() {
        let _ = write!(line, "throttle_{channel},");
    }
    writeln!(
        output,
        "{line}achieved_roll_nm,achieved_pitch_nm,achieved_yaw_nm,achieved_thrust_n,saturation"
    )?;
    let mut bad = 0;
    let mut row = StringRecord::new();
    loop {
        let read = reader.read_record(&mut row);
        let place = row.position().map_or(0, csv::Position::line);
        let mixed = match read {
            Ok(false) => break,
            Ok(true) => columns.read(&row).and_then(|(setpoint, voltage)| {
                let voltage_v = voltage.unwrap_or(reference_v);
                compiled
                    .tables
                    .mix(&setpoint, voltage_v)
                    .map_err(|error| error.to_string())
            }),
            Err(error) => match error.into_kind() {
                csv::ErrorKind::Io(error) => return Err(Stopped::Io(error)),
                csv::ErrorKind::UnequalLengths {
                    expected_len, len, ..
                } => Err(format!("{len} columns where the header has {expected_len}")),
                csv::ErrorKind::Utf8 { .. } => Err("not UTF-8".to_owned()),
                other => Err(format!("{other:?}")),
            },
        };
        match mixed {
            Ok((throttles, achieved, saturation)) => {
                line.clear();
                for value in throttles.into_iter().chain(achieved.to_array()) {
                    // `{:?}` is the shortest text that reads back to the same bits.
                    let _ = write!(line, "{value:?},");
                }
                writeln!(output, "{line}{}", saturation.bits())?;
                output.flush()?;
            }
            Err(message) => {
                bad += 1;
                writeln!(errors, "error: stdin:{place}: {message}")?;
            }
        }
    }
    output.flush()?;
    Ok(bad)
}
