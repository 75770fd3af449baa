//! Where the tables of a pair go that `identify` and `predict` make: a file, alone or in a whole
//! airframe, standard output, or nowhere yet.

use std::io::{Write as _, stdout};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use mixer_compiler::Source;
use mixer_compiler::diagnostic::printable_lines;
use mixer_files::new::new;
use mixer_identify::refusal::Refusal;
use mixer_identify::texts::Outcome;

use crate::frame_args::FrameArgs;
use crate::{Done, bad_usage, output, print_error, print_note};

/// Where the answer of a bench command goes.
#[derive(Debug, Clone, Args)]
pub struct Place {
    /// Write the tables here, whole or not at all; `-` for standard output (the report then goes to
    /// standard error).
    #[arg(short, long, value_name = "PAIR.toml")]
    pub output: Option<PathBuf>,
    /// Overwrite the output if it is there
    #[arg(long)]
    force: bool,
    /// Write a whole airframe of this frame, not the tables alone
    #[command(flatten)]
    pub frame: Option<FrameArgs>,
    /// Print everything as JSON in place of the report.
    #[arg(long)]
    json: bool,
}

/// The tables of an answer, or the airframe of this frame with them.
///
/// # Errors
/// A frame that is not fully described.
pub fn tables_or_airframe<T>(
    answer: &Outcome<T>,
    frame: Option<&FrameArgs>,
    output: Option<&Path>,
) -> Result<String, String> {
    let text = match frame {
        None => answer.tables.clone(),
        Some(frame) => {
            let tables = Source::new("the tables", answer.tables.as_str());
            new(&frame.frame(output), Some(&tables)).map_err(|error| error.to_string())?
        }
    };
    // Names, headers and cells of the bench files are in it, as in the report.
    Ok(printable_lines(&text))
}

impl Place {
    fn to_stdout(&self) -> bool {
        self.output.as_deref() == Some(Path::new("-"))
    }

    fn file(&self) -> Option<&Path> {
        self.output.as_deref().filter(|_| !self.to_stdout())
    }

    /// Refuses a place that cannot be written, before there is anything to write.
    pub(crate) fn check(&self, inputs: impl IntoIterator<Item = impl AsRef<Path>>) -> Done {
        if self.json && self.to_stdout() {
            return Err(bad_usage("--json and -o - would both write to standard output"));
        }
        match self.file() {
            Some(path) => crate::file::writable(path, self.force, inputs),
            None => Ok(()),
        }
    }

    /// Says what is wrong with the files, on standard output, too, where the report is JSON: as
    /// `check --json` has the faults of an airframe file.
    pub(crate) fn refused(&self, refusals: &[Refusal]) -> ExitCode {
        if self.json {
            let error = |refusal: &Refusal| {
                let (file, line) = refusal.file_and_line();
                crate::fault(file, line, &refusal.reason, &refusal.needed)
            };
            let _ = crate::print(&format!("{:#}\n", crate::errors(refusals.iter().map(error))));
        }
        refusals.iter().for_each(|refusal| {
            print_error(refusal);
        });
        ExitCode::FAILURE
    }

    /// Writes report and tables, and says what comes next.
    pub(crate) fn write<T>(&self, answer: &Outcome<T>, verbose: bool) -> Done {
        let report = match (self.json, verbose) {
            (true, _) => &answer.json,
            (_, true) => &answer.details,
            _ => &answer.report,
        };
        let text = tables_or_airframe(answer, self.frame.as_ref(), self.file()).map_err(bad_usage)?;
        let report = printable_lines(report);
        let out = if self.to_stdout() {
            print_note(report.trim_end());
            text.trim_end()
        } else {
            report.trim_end()
        };
        output(writeln!(stdout().lock(), "{out}"))?;
        match self.file() {
            Some(path) if self.frame.is_some() => {
                crate::airframe_file::write(path, &text, None)?;
                self.next(format_args!("cargo mixer check {}", path.display()));
            }
            Some(path) => {
                crate::file::save(path, &text).map_err(print_error)?;
                if text.contains("\n[[rotor]]") {
                    self.next("paste it into an airframe: a [[unit]] has it by its name");
                    return Ok(());
                }
                self.next(format_args!(
                    "cargo mixer new --frame x8 --arm METRE --pair {} -o AIRFRAME.toml",
                    path.display()
                ));
            }
            None if self.to_stdout() || answer.tables.is_empty() => {}
            None => self.next("-o PAIR.toml writes the tables; nothing is written without it"),
        }
        Ok(())
    }

    /// Says what comes next, to a person.
    fn next(&self, what: impl std::fmt::Display) {
        if !self.json {
            print_note(format_args!("next            {what}"));
        }
    }
}
