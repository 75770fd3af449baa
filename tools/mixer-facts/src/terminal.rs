//! What a command says: its output on stdout, everything else on stderr, and the exit status.

use std::fmt::Display;
use std::io;
use std::io::{IsTerminal as _, Write};
use std::process::ExitCode;

use mixer_compiler::diagnostic::{Diagnostics, cut_to, printable_lines};

/// The exit status for a bad input.
pub const BAD_INPUT: u8 = 1;

/// The exit status for bad usage that clap cannot see.
pub const BAD_USAGE: u8 = 2;

/// The result of a command: the exit status where it failed and has said why.
pub type Done = Result<(), ExitCode>;

/// Says on stderr what is wrong with the arguments; the exit status for it.
pub fn bad_usage(message: impl Display) -> ExitCode {
    print_error(message);
    ExitCode::from(BAD_USAGE)
}

/// Says on stderr what is wrong; the exit status for a bad input.
pub fn print_error(message: impl Display) -> ExitCode {
    print_note(format_args!("error: {message}"));
    ExitCode::from(BAD_INPUT)
}

/// Longest line on stderr, characters: what a broken file has in it may have megabytes.
pub const LONGEST_LINE: usize = 1000;

/// Says a line on stderr. (`eprintln!` panics where stderr is a pipe that nobody reads any more, as
/// in `2>&1 | head`.)
pub fn print_note(message: impl Display) {
    let text = printable_lines(&message.to_string());
    let lines = text.split('\n').map(|line| cut_to(line.to_owned(), LONGEST_LINE));
    let _ = writeln!(io::stderr().lock(), "{}", itertools::join(lines, "\n"));
}

/// Says on stderr what the user of an output has to know of it, as a `note` or a `warning`.
pub fn print_notes(word: &str, notes: &[String]) {
    for note in notes {
        print_note(format_args!("{word}: {note}"));
    }
}

/// Shows faults or warnings on stderr; each begins with `error[..]` or `warning[..]` itself. In
/// colours on a terminal, unless `NO_COLOR` is set (no-color.org).
pub fn show(diagnostics: &Diagnostics) {
    let wanted = std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty());
    if wanted && io::stderr().is_terminal() {
        let _ = writeln!(io::stderr().lock(), "{}", diagnostics.coloured());
    } else {
        print_note(diagnostics);
    }
}

/// Shows what the compiler warns of on stderr.
pub fn warn(warnings: &Diagnostics) {
    if !warnings.is_empty() {
        show(warnings);
    }
}

/// Prints the only output of a command.
pub fn print(text: &str) -> Done {
    output(io::stdout().lock().write_all(text.as_bytes()))
}

/// Result of an output. A reader that has seen enough (`| head`) is no fault.
pub fn output(written: io::Result<()>) -> Done {
    match written.and_then(|()| io::stdout().flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(print_error(format_args!("stdout: {error}")))
        }
        _ => Ok(()),
    }
}
