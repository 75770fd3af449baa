//! `cargo mixer check`.

use std::io::{Write, stdout};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use mixer_compiler::cost::Cost;
use mixer_compiler::diagnostic::Record;
use mixer_compiler::report::{Report, Summary};
use serde::Serialize;

use crate::Refusal;
use crate::stack::Stack;

/// Validates and compiles an airframe file and prints what came of it
#[derive(clap::Args, Debug)]
pub struct CheckArgs {
    /// The airframe file
    airframe: PathBuf,
    /// Print JSON; faults are then listed under "errors" on stdout as well as on stderr
    #[arg(long)]
    json: bool,
}

/// The JSON of a good file.
#[derive(Serialize)]
struct Success {
    #[serde(flatten)]
    summary: Summary,
    #[serde(flatten)]
    stack: Stack,
    /// Time of the whole compilation, ms.
    compile_ms: f64,
}

/// The JSON of a refused file.
#[derive(Serialize)]
struct Failure {
    errors: Vec<Record>,
}

/// Runs the command.
pub fn run(args: &CheckArgs) -> ExitCode {
    let start = Instant::now();
    let result = crate::compile(&args.airframe);
    let compile_ms = start.elapsed().as_secs_f64() * 1e3;
    let mut out = stdout().lock();
    match result {
        Ok(compiled) if args.json => crate::finish(json(
            &mut out,
            &Success {
                summary: Summary::new(&compiled),
                stack: Stack::new(&compiled),
                compile_ms,
            },
        )),
        Ok(compiled) => crate::finish(writeln!(
            out,
            "{}{}{}compiled in     {compile_ms:.0} ms",
            Report(&compiled),
            Cost::new(&compiled),
            Stack::new(&compiled)
        )),
        Err(refusal) => {
            let records = match &refusal {
                Refusal::Faulty(diagnostics) => diagnostics.records(),
                Refusal::Unreadable(message) => vec![unreadable(&args.airframe, message)],
            };
            if args.json {
                crate::finish(json(&mut out, &Failure { errors: records }));
            }
            refusal.report()
        }
    }
}

/// The record of a file that cannot be read: it has no place and no code.
fn unreadable(airframe: &Path, message: &str) -> Record {
    Record {
        code: String::new(),
        file: airframe.display().to_string(),
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
