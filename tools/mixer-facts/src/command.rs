//! `cargo mixer check`: its arguments, and what it prints.

use std::path::{Path, PathBuf};
use std::time::Instant;

use mixer_compiler::diagnostic::{Diagnostics, printable};
use serde_json::{Value, json};

use crate::check::{Checked, refusal as refused};
use crate::checklist::Checklist;
use crate::input::{Refusal, errors, fault, read};
use crate::terminal::{Done, print, print_error, print_note, show};

/// Validates and compiles an airframe file and says what came of it
#[derive(clap::Args, Debug)]
pub struct CheckArgs {
    /// The airframe file
    airframe: PathBuf,
    /// Print JSON; faults are then listed under "errors" on stdout as well as on stderr
    #[arg(long)]
    json: bool,
    /// Print every number: M, M+, proof, costs, check list for the bench
    #[arg(long, conflicts_with = "json")]
    verbose: bool,
    /// Exit with status 1 where there is a warning
    #[arg(long)]
    deny_warnings: bool,
}

/// Runs the command.
pub fn run(args: &CheckArgs) -> Done {
    let start = Instant::now();
    let source = read(&args.airframe);
    let result = source.and_then(|source| mixer_compiler::compile(&source).map_err(Refusal::Faulty));
    let compile_ms = start.elapsed().as_secs_f64() * 1e3;
    let checked = match result {
        Ok(compiled) => Checked::new(compiled),
        Err(refusal) => {
            if args.json {
                let _ = print(&pretty(&match &refusal {
                    Refusal::Faulty(faults) => refused(faults),
                    Refusal::Unreadable(message) => unreadable(&args.airframe, message),
                }));
            }
            return Err(refusal.report());
        }
    };
    tell(&checked.warnings, args.verbose);
    print(&if args.json {
        pretty(&checked.json(json!({ "compile_ms": compile_ms })))
    } else if args.verbose {
        let (report, list) = (checked.report(), Checklist(&checked.compiled));
        format!("{report}{list}compiled in     {compile_ms:.0} ms\n")
    } else {
        let file = printable(&args.airframe.display().to_string());
        format!(
            "{}next                cargo mixer report {file} -o report.html (pictures), or check --verbose (every number)\n",
            checked.verdict()
        )
    })?;
    match checked.warnings.faults().len() {
        count if args.deny_warnings && count > 0 => Err(print_error(format_args!(
            "{}: {count} {}, and --deny-warnings is given",
            checked.warnings.source().name,
            if count == 1 { "warning" } else { "warnings" }
        ))),
        _ => Ok(()),
    }
}

/// Warnings in full, several as a line each where the verdict is to stay on one screen.
fn tell(warnings: &Diagnostics, in_full: bool) {
    match warnings.faults().len() {
        0 => {}
        1 => show(warnings),
        _ if in_full => show(warnings),
        _ => print_note(warnings.lines().join("\n")),
    }
}

/// The JSON of a file that cannot be read.
fn unreadable(airframe: &Path, message: &str) -> Value {
    let file = printable(&airframe.display().to_string());
    errors([fault(&file, None, message, "")])
}

fn pretty(value: &Value) -> String {
    format!("{value:#}\n")
}
