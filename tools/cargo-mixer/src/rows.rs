//! Commands that answer a table row by row: CSV in, CSV out.

use std::cell::RefCell;
use std::fs::File;
use std::io::{self, BufWriter, IsTerminal as _, Read, Write, stdin, stdout};
use std::path::{Path, PathBuf};
use std::str::FromStr;

use mixer_compiler::Compiled;
use mixer_compiler::airframe::Airframe;
use mixer_compiler::tables::AnyState;
use mixer_rt::Health;

mod read;

pub use self::read::{BadLine, Line, Row, Rows, Stopped};
use crate::{Done, file, print_error};

/// Arguments of a command that answers rows.
#[derive(clap::Args, Debug)]
pub struct RowArgs {
    /// The airframe file
    airframe: PathBuf,
    /// The rows; without a file, or as `-`, those of stdin
    rows: Option<PathBuf>,
    /// The file to write, whole or not at all [default: stdout, row by row]
    #[arg(short, long, value_name = "OUT.csv")]
    output: Option<PathBuf>,
    /// Overwrite the file if it is there
    #[arg(long)]
    force: bool,
    /// The rotor at this output is out; several with commas between
    #[arg(long, value_name = "CHANNEL", value_delimiter = ',')]
    failed: Vec<usize>,
}

/// Work of such a command: columns in, columns out, an answer per row.
#[derive(Debug)]
pub struct Task<T> {
    /// The columns that it needs.
    pub required: fn(&Airframe) -> Vec<String>,
    /// The columns that it gives.
    pub given: fn(&Airframe) -> Vec<String>,
    /// Its row, a value per column with commas between, or what is wrong.
    pub answer: fn(&Compiled, Health, &Row<T>, &mut Memory) -> Result<String, String>,
}

/// What rows before leave to the next one: their last time, s, and the rotors that are under way.
pub type Memory = Option<(f32, AnyState)>;

/// The outputs of an airframe as columns.
pub(crate) fn throttles(airframe: &Airframe) -> Vec<String> {
    (0..airframe.rotors())
        .map(|channel| format!("throttle_{channel}"))
        .collect()
}

/// Values as fields: `{:?}` is the shortest text that reads back to the same bits.
pub(crate) fn fields(values: impl IntoIterator<Item = impl std::fmt::Debug>) -> String {
    let values = values.into_iter().map(|value| format!("{value:?}"));
    itertools::join(values, ",")
}

/// The health of an airframe of which these channels are out.
///
/// # Errors
/// A channel that it does not have.
pub fn health(airframe: &Airframe, failed: impl IntoIterator<Item = usize>) -> Result<Health, String> {
    let last = airframe.rotors() - 1;
    let without = |health: Health, channel| match u8::try_from(channel) {
        Ok(small) if channel <= last => Ok(health.with_failed(small)),
        _ => Err(format!(
            "failed {channel}: the channels of {} are 0 to {last}",
            airframe.name
        )),
    };
    failed.into_iter().try_fold(Health::GOOD, without)
}

/// Runs the command.
pub(crate) fn run<T: FromStr>(args: &RowArgs, task: &Task<T>) -> Done {
    if let Some(output) = &args.output {
        let inputs = args.rows.iter().chain([&args.airframe]);
        file::writable(output, args.force, inputs)?;
    }
    let compiled = crate::compile(&args.airframe)?;
    let health = health(&compiled.airframe, args.failed.iter().copied())
        .map_err(|message| crate::bad_usage(format_args!("--{message}")))?;
    let columns = (task.required)(&compiled.airframe);
    let (input, name) = input(args.rows.as_deref(), &columns).map_err(print_error)?;
    let bad_line = |BadLine { line, message }| print_error(format_args!("{name}:{line}: {message}"));
    let mut rows = Vec::new();
    let answered = match &args.output {
        None => {
            let output = BufWriter::new(stdout().lock());
            answer(task, &compiled, health, input, output, bad_line)
        }
        Some(_) => answer(task, &compiled, health, input, &mut rows, bad_line),
    };
    let bad = answered.map_err(|stopped| match stopped {
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

/// Where the rows come from, with its name in messages.
fn input(path: Option<&Path>, columns: &[String]) -> Result<(Box<dyn Read>, String), String> {
    match path.filter(|path| *path != Path::new("-")) {
        None => {
            if stdin().is_terminal() {
                crate::print_note(format_args!(
                    "waiting for a header and rows of {}; end with Ctrl-D",
                    read::header(columns)
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
/// answer before the next row gets it, and a file goes through in large pieces.
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

/// Answers every row of `input` into `output` with the rotors that `health` leaves; bad rows go to
/// `bad_line`. Returns their number. A reader of `output` that has seen enough ends the work
/// without an error.
///
/// # Errors
/// A header that is none, or input or output that fails.
pub fn answer<T: FromStr, U>(
    task: &Task<T>,
    compiled: &Compiled,
    health: Health,
    input: impl Read,
    output: impl Write,
    mut bad_line: impl FnMut(BadLine) -> U,
) -> Result<usize, Stopped> {
    let output = RefCell::new(output);
    let mut bad = 0;
    let answered = answer_rows(task, compiled, health, input, &output, |line| {
        bad += 1;
        bad_line(line);
    });
    match answered.and_then(|()| output.borrow_mut().flush().map_err(Stopped::Output)) {
        Err(Stopped::Output(error)) if error.kind() == io::ErrorKind::BrokenPipe => Ok(bad),
        Err(stopped) => Err(stopped),
        Ok(()) => Ok(bad),
    }
}

fn answer_rows<T: FromStr>(
    task: &Task<T>,
    compiled: &Compiled,
    health: Health,
    input: impl Read,
    output: &RefCell<impl Write>,
    mut bad_line: impl FnMut(BadLine),
) -> Result<(), Stopped> {
    let input = Answering { input, output };
    let mut rows = Rows::new(input, (task.required)(&compiled.airframe))?;
    crate::print_notes("note", &rows.ignored(&compiled.airframe));
    let write = |text: &str| {
        let written = writeln!(output.borrow_mut(), "{text}");
        written.map_err(Stopped::Output)
    };
    write(&(task.given)(&compiled.airframe).join(","))?;
    let mut memory = None;
    while let Some((line, row)) = rows.read()? {
        let answer = |row| {
            (task.answer)(compiled, health, &row, &mut memory).map_err(|message| BadLine { line, message })
        };
        match row.and_then(answer) {
            Ok(text) => write(&text)?,
            Err(line) => bad_line(line),
        }
    }
    Ok(())
}
