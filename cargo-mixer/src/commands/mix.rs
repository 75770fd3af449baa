//! `cargo mixer mix`: setpoints in, throttles out, on the very tables that the macro emits.

use std::cell::RefCell;
use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, BufWriter, IsTerminal as _, Read, Write, stdin, stdout};
use std::path::{Path, PathBuf};

use mixer_compiler::Compiled;
use mixer_rt::{Conditions, Health};

use crate::setpoints::{BadLine, HEADER, Setpoints, Stopped};
use crate::{Done, file, print_error};

/// Mixes setpoints: CSV to CSV, from stdin to stdout row by row
///
/// In:  a header and rows of roll_nm,pitch_nm,yaw_nm,thrust_n and, if there are such, voltage_v
///      and density_kg_m3, in any order. Without them the bench's voltage and density are taken.
/// Out: throttle_0.., achieved_roll_nm, achieved_pitch_nm, achieved_yaw_nm, achieved_thrust_n,
///      saturation. Numbers read back to the same bits (f32).
///      saturation is a sum: 1 roll, 4 pitch, 16 yaw, 64 thrust is achieved below the setpoint;
///      2, 8, 32, 128 above it; 256 the voltage was outside the airframe's range and clamped
///      into it; 512 the density was, or was NaN, infinite, 0 or less and taken as the bench's.
///      The throttle of a rotor that is out is 0.
///
/// A bad row is reported with its line on stderr and left out; the exit status is then 1.
#[derive(clap::Args, Debug)]
#[command(verbatim_doc_comment)]
pub struct MixArgs {
    /// The airframe file
    airframe: PathBuf,
    /// The setpoints; without a file, or as `-`, those of stdin
    setpoints: Option<PathBuf>,
    /// The file to write, whole or not at all [default: stdout, row by row]
    #[arg(short, long, value_name = "THROTTLES.csv")]
    output: Option<PathBuf>,
    /// Overwrite the file if it is there
    #[arg(long)]
    force: bool,
    /// The rotor at this output is out; several with commas between
    #[arg(long, value_name = "CHANNEL", value_delimiter = ',')]
    failed: Vec<u8>,
}

/// Runs the command.
pub fn run(args: &MixArgs) -> Done {
    if let Some(output) = &args.output {
        let inputs = args.setpoints.iter().chain([&args.airframe]);
        file::writable(output, args.force, inputs)?;
    }
    let compiled = crate::compile(&args.airframe)?;
    let rotors = compiled.airframe.rotors();
    let mut failed = args.failed.iter();
    if let Some(channel) = failed.find(|channel| usize::from(**channel) >= rotors) {
        return Err(crate::bad_usage(format_args!(
            "--failed {channel}: the channels of {} are 0 to {}",
            compiled.airframe.name,
            rotors - 1
        )));
    }
    let failed = args.failed.iter().copied();
    let health = failed.fold(Health::GOOD, Health::with_failed);
    let (input, name) = input(args.setpoints.as_deref()).map_err(print_error)?;
    let bad_line = |BadLine { line, message }| print_error(format_args!("{name}:{line}: {message}"));
    let mut rows = Vec::new();
    let mixed = match &args.output {
        None => {
            let output = BufWriter::new(stdout().lock());
            mix(&compiled, health, input, output, bad_line)
        }
        Some(_) => mix(&compiled, health, input, &mut rows, bad_line),
    };
    let bad = mixed.map_err(|stopped| match stopped {
        Stopped::Header(bad) => bad_line(bad),
        Stopped::Input(error) => print_error(format_args!("{name}: {error}")),
        Stopped::Output(error) => print_error(format_args!("stdout: {error}")),
    })?;
    if let Some(path) = &args.output {
        file::save(path, &String::from_utf8_lossy(&rows)).map_err(print_error)?;
    }
    match bad {
        0 => Ok(()),
        1 => Err(print_error("1 bad row is left out")),
        bad => Err(print_error(format_args!("{bad} bad rows are left out"))),
    }
}

/// Where the setpoints come from, with its name in messages.
fn input(path: Option<&Path>) -> Result<(Box<dyn Read>, String), String> {
    match path.filter(|path| *path != Path::new("-")) {
        None => {
            if stdin().is_terminal() {
                crate::print_note(format_args!(
                    "waiting for setpoints, a header and rows of {HEADER}; end with Ctrl-D"
                ));
            }
            Ok((Box::new(stdin()), "stdin".to_owned()))
        }
        Some(path) => {
            let name = path.display().to_string();
            let file = File::open(path).map_err(|error| format!("{name}: {error}"))?;
            Ok((Box::new(file), name))
        }
    }
}

/// An input that is read only once all that is written has been put out: whoever waits for an
/// answer before the next setpoint gets it, and a file goes through in large pieces.
struct Answering<'a, R, W> {
    input: R,
    output: &'a RefCell<W>,
}

impl<R: Read, W: Write> Read for Answering<'_, R, W> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        // Where it fails the next row does, too.
        let _ = self.output.borrow_mut().flush();
        self.input.read(buffer)
    }
}

/// Mixes every row of `input` into `output` with the rotors that `health` leaves; bad rows go to
/// `bad_line`. Returns their number. A reader of `output` that has seen enough ends the mixing
/// without an error.
///
/// # Errors
/// A header that is none, or input or output that fails.
pub fn mix<T>(
    compiled: &Compiled,
    health: Health,
    input: impl Read,
    output: impl Write,
    mut bad_line: impl FnMut(BadLine) -> T,
) -> Result<usize, Stopped> {
    let output = RefCell::new(output);
    let mut bad = 0;
    let mixed = mix_rows(compiled, health, input, &output, |line| {
        bad += 1;
        bad_line(line);
    });
    match mixed.and_then(|()| output.borrow_mut().flush().map_err(Stopped::Output)) {
        Err(Stopped::Output(error)) if error.kind() == io::ErrorKind::BrokenPipe => Ok(bad),
        Err(stopped) => Err(stopped),
        Ok(()) => Ok(bad),
    }
}

fn mix_rows(
    compiled: &Compiled,
    health: Health,
    input: impl Read,
    output: &RefCell<impl Write>,
    mut bad_line: impl FnMut(BadLine),
) -> Result<(), Stopped> {
    let input = Answering { input, output };
    let mut setpoints = Setpoints::new(input)?;
    let reference = compiled
        .tables
        .view()
        .at_reference_density(compiled.airframe.reference_v() as f32);
    let write = |text: &str| {
        let written = output.borrow_mut().write_all(text.as_bytes());
        written.map_err(Stopped::Output)
    };
    for channel in 0..compiled.airframe.rotors() {
        write(&format!("throttle_{channel},"))?;
    }
    write("achieved_roll_nm,achieved_pitch_nm,achieved_yaw_nm,achieved_thrust_n,saturation\n")?;
    let mut text = String::new();
    while let Some((line, row)) = setpoints.read()? {
        let mixed = row.and_then(|row| {
            let conditions = Conditions {
                voltage_v: row.voltage_v.unwrap_or(reference.voltage_v),
                density_kg_m3: row.density_kg_m3.unwrap_or(reference.density_kg_m3),
            };
            let mixed = compiled.tables.mix_in(&row.wrench, conditions, health);
            mixed.map_err(|error| BadLine {
                line,
                message: error.to_string(),
            })
        });
        match mixed {
            Ok((throttles, achieved, saturation)) => {
                text.clear();
                for value in throttles.into_iter().chain(achieved.to_array()) {
                    // `{:?}` is the shortest text that reads back to the same bits.
                    let _ = write!(text, "{value:?},");
                }
                let _ = writeln!(text, "{}", saturation.bits());
                write(&text)?;
            }
            Err(line) => bad_line(line),
        }
    }
    Ok(())
}
