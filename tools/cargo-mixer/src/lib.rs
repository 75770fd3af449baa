//! `cargo mixer`: the command line of the coaxial mixer compiler.
//!
//! Exit status 0, 1 for a bad input, 2 for bad usage; errors go to stderr.

use std::fmt::Display;
use std::io;
use std::io::{IsTerminal as _, Write};
use std::path::Path;
use std::process::ExitCode;

use mixer_compiler::diagnostic::Diagnostics;
use mixer_compiler::{Compiled, Source};
use mixer_files::plain::printable_lines;
use serde_json::{Value, json};

mod airframe_file;
pub mod arguments;
pub mod bench_args;
pub mod bench_files;
pub mod commands;
pub mod file;
pub mod frame_args;
pub mod pack;
pub mod place;
pub mod rows;
mod today;

/// The exit status for a bad input.
const BAD_INPUT: u8 = 1;

/// The exit status for bad usage that clap cannot see.
const BAD_USAGE: u8 = 2;

/// Why an airframe file gave no mixer.
#[derive(Debug)]
enum Refusal {
    /// It cannot be read: a message that names it.
    Unreadable(String),
    /// It has faults.
    Faulty(Diagnostics),
}

impl Refusal {
    /// Reports to stderr.
    fn report(&self) -> ExitCode {
        match self {
            Refusal::Unreadable(message) => print_error(message),
            Refusal::Faulty(diagnostics) => {
                show(diagnostics);
                ExitCode::from(BAD_INPUT)
            }
        }
    }
}

/// A fault without a code or a column, as `--json` lists those of airframe files.
fn fault(file: &str, line: Option<u64>, message: &str, help: &str) -> Value {
    json!({ "code": "", "file": file, "key": "", "message": message, "label": "", "help": help, "line": line, "column": null })
}

/// What `--json` prints of faults.
fn errors(faults: impl IntoIterator<Item = Value>) -> Value {
    json!({ "errors": faults.into_iter().collect::<Vec<_>>(), "warnings": [] })
}

/// The result of a command: the exit status where it failed and has said why.
pub type Done = Result<(), ExitCode>;

/// Says on stderr what is wrong with the arguments; the exit status for it.
fn bad_usage(message: impl Display) -> ExitCode {
    print_error(message);
    ExitCode::from(BAD_USAGE)
}

/// Says on stderr what is wrong; the exit status for a bad input.
fn print_error(message: impl Display) -> ExitCode {
    print_note(format_args!("error: {message}"));
    ExitCode::from(BAD_INPUT)
}

/// Longest line on stderr, characters: what a broken file has in it may have megabytes.
const LONGEST_LINE: usize = 1000;

/// Says a line on stderr. (`eprintln!` panics where stderr is a pipe that nobody reads any more, as
/// in `2>&1 | head`.)
fn print_note(message: impl Display) {
    let text = printable_lines(&message.to_string());
    let lines = text
        .split('\n')
        .map(|line| mixer_identify::refusal::cut_to(line.to_owned(), LONGEST_LINE));
    let _ = writeln!(io::stderr().lock(), "{}", lines.collect::<Vec<_>>().join("\n"));
}

/// Says on stderr what the user of an output has to know of it.
fn print_notes(notes: &[String]) {
    for note in notes {
        print_note(format_args!("note: {note}"));
    }
}

/// Shows faults or warnings on stderr; each begins with `error[..]` or `warning[..]` itself. In
/// colours on a terminal, unless `NO_COLOR` is set (no-color.org).
fn show(diagnostics: &Diagnostics) {
    let wanted = std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty());
    if wanted && io::stderr().is_terminal() {
        let _ = writeln!(io::stderr().lock(), "{}", diagnostics.coloured());
    } else {
        print_note(diagnostics);
    }
}

/// Shows what the compiler warns of on stderr.
fn warn(warnings: &Diagnostics) {
    if !warnings.is_empty() {
        show(warnings);
    }
}

/// Reads and compiles an airframe file; its warnings go to stderr.
fn compile(path: &Path) -> Result<Compiled, ExitCode> {
    let compile = |source: Source| mixer_compiler::compile(&source).map_err(Refusal::Faulty);
    let compiled = read(path).and_then(compile).map_err(|refusal| refusal.report())?;
    warn(&mixer_compiler::lint(&compiled));
    Ok(compiled)
}

/// Reads an airframe file.
fn read(path: &Path) -> Result<Source, Refusal> {
    let name = path.display().to_string();
    let bytes = file::read_small(path).map_err(Refusal::Unreadable)?;
    Source::from_bytes(name, bytes).map_err(Refusal::Faulty)
}

/// Prints the only output of a command.
fn print(text: &str) -> Done {
    output(io::stdout().lock().write_all(text.as_bytes()))
}

/// Writes an output to its file, or prints it where there is none.
fn deliver(output: Option<&Path>, force: bool, text: &str) -> Done {
    let Some(path) = output else {
        return print(text);
    };
    let written = file::not_there(path, force).and_then(|()| file::save(path, text));
    written.map_err(print_error)
}

/// Result of an output. A reader that has seen enough (`| head`) is no fault.
fn output(written: io::Result<()>) -> Done {
    match written.and_then(|()| io::stdout().flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(print_error(format_args!("stdout: {error}")))
        }
        _ => Ok(()),
    }
}
