//! `cargo mixer check`.

mod verdict;

use std::io::{Write, stdout};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use mixer_compiler::diagnostic::{Diagnostics, Record, Severity, printable};
use mixer_facts::checklist::Checklist;
use mixer_facts::cost::Cost;
use mixer_facts::report::{Report, Summary};
use serde::Serialize;

use self::verdict::Verdict;
use crate::Refusal;
use crate::stack::Stacks;

/// Validates and compiles an airframe file and says what came of it
#[derive(clap::Args, Debug)]
pub struct CheckArgs {
    /// The airframe file
    airframe: PathBuf,
    /// Print JSON; faults are then listed under "errors" on stdout as well as on stderr
    #[arg(long)]
    json: bool,
    /// Print every number: M, M+, proof, costs, parameters of flight stacks, check list for the bench
    #[arg(long, conflicts_with = "json")]
    verbose: bool,
    /// Exit with status 1 where there is a warning
    #[arg(long)]
    deny_warnings: bool,
}

/// The JSON of a good file.
#[derive(Serialize)]
struct Success {
    #[serde(flatten)]
    summary: Summary,
    /// What is plausibly a mistake and yet compiles.
    warnings: Vec<Record>,
    #[serde(flatten)]
    stacks: Stacks,
    /// Time of the whole compilation, ms.
    compile_ms: f64,
}

/// The JSON of a refused file.
#[derive(Serialize)]
struct Failure {
    errors: Vec<Record>,
    warnings: Vec<Record>,
}

/// Runs the command.
pub fn run(args: &CheckArgs) -> ExitCode {
    let start = Instant::now();
    let source = crate::read(&args.airframe);
    let result = source.and_then(|source| mixer_compiler::compile(&source).map_err(Refusal::Faulty));
    let compile_ms = start.elapsed().as_secs_f64() * 1e3;
    let mut out = stdout().lock();
    match result {
        Ok(compiled) => {
            let warnings = mixer_compiler::lint(&compiled);
            tell(&warnings, args.verbose);
            let written = if args.json {
                let success = Success {
                    summary: Summary::new(&compiled),
                    stacks: Stacks::new(&compiled),
                    warnings: warnings.records(),
                    compile_ms,
                };
                json(&mut out, &success)
            } else if !args.verbose {
                let verdict = Verdict {
                    compiled: &compiled,
                    summary: &Summary::new(&compiled),
                    warnings: &warnings,
                    file: &args.airframe,
                };
                write!(out, "{verdict}")
            } else {
                let (report, cost) = (Report(&compiled), Cost::new(&compiled));
                let (list, stacks) = (Checklist(&compiled), Stacks::new(&compiled));
                writeln!(
                    out,
                    "{report}{cost}{stacks}{list}compiled in     {compile_ms:.0} ms"
                )
            };
            match crate::output(written.and_then(|()| out.flush())) {
                Err(status) => status,
                Ok(()) if args.deny_warnings && !warnings.is_empty() => denied(&warnings),
                Ok(()) => ExitCode::SUCCESS,
            }
        }
        Err(refusal) => {
            if args.json {
                let failure = match &refusal {
                    Refusal::Faulty(diagnostics) => Failure {
                        errors: diagnostics.records_of(Severity::Error),
                        warnings: diagnostics.records_of(Severity::Warning),
                    },
                    Refusal::Unreadable(message) => Failure {
                        errors: vec![unreadable(&args.airframe, message)],
                        warnings: Vec::new(),
                    },
                };
                crate::finish(json(&mut out, &failure));
            }
            refusal.report()
        }
    }
}

/// Warnings in full, several as a line each where the verdict is to stay on one screen.
fn tell(warnings: &Diagnostics, in_full: bool) {
    match warnings.faults().len() {
        0 => {}
        1 => crate::show(warnings),
        _ if in_full => crate::show(warnings),
        _ => crate::print_note(warnings.lines().join("\n")),
    }
}

/// Refuses a good file for its warnings.
fn denied(warnings: &Diagnostics) -> ExitCode {
    let count = warnings.faults().len();
    crate::print_error(format_args!(
        "{}: {count} {}, and --deny-warnings is given",
        warnings.source().name,
        if count == 1 { "warning" } else { "warnings" }
    ))
}

/// The record of a file that cannot be read: it has no place and no code.
fn unreadable(airframe: &Path, message: &str) -> Record {
    Record {
        code: String::new(),
        file: printable(&airframe.display().to_string()),
        line: None,
        column: None,
        key: String::new(),
        message: message.to_owned(),
        label: String::new(),
        help: String::new(),
    }
}

fn json(out: &mut impl Write, value: &impl Serialize) -> std::io::Result<()> {
    serde_json::to_writer_pretty(&mut *out, value)?;
    writeln!(out)
}
