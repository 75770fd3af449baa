//! The commands and their arguments.

use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};
use mixer_facts::command as check;

use crate::commands::{
    compare, expand, golden, identify, import, library, mix, new, params, plan, predict, report, review,
    schema, shell, sweep, wrench,
};
use crate::{Done, output};

/// Compiler of mixers for coaxial multirotors (X8, Y6, X12: n stacked pairs of rotors)
#[derive(Debug, Parser)]
#[command(
    name = "cargo mixer",
    bin_name = "cargo mixer",
    version,
    after_help = "Exit status: 0; 1 for a bad input; 2 for bad usage. Errors go to stderr."
)]
pub struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Check(check::CheckArgs),
    Compare(compare::CompareArgs),
    Mix(mix::MixArgs),
    Expand(expand::ExpandArgs),
    Golden(golden::GoldenArgs),
    Identify(Box<identify::IdentifyArgs>),
    New(new::NewArgs),
    Params(params::ParamsArgs),
    Plan(plan::PlanArgs),
    Predict(Box<predict::PredictArgs>),
    Import(import::ImportArgs),
    Library(library::LibraryArgs),
    Report(report::ReportArgs),
    Review(review::ReviewArgs),
    Schema(schema::SchemaArgs),
    Sweep(sweep::SweepArgs),
    Wrench(wrench::WrenchArgs),
    Completions(shell::CompletionsArgs),
}

/// Runs the command that the program was called with.
pub fn run() -> ExitCode {
    // Cargo passes the subcommand's own name to an installed `cargo-mixer`; the repository's alias
    // does not.
    let arguments = std::env::args_os().enumerate();
    let arguments = arguments
        .filter(|(index, word)| *index != 1 || word != "mixer")
        .map(|(_, word)| word);
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        // Help and the version go to stdout, bad usage to stderr.
        Err(said) if said.use_stderr() => said.exit(),
        Err(said) => return status(output(said.print())),
    };
    status(match arguments.command {
        Command::Check(args) => check::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Mix(args) => mix::run(&args),
        Command::Expand(args) => expand::run(&args),
        Command::Golden(args) => golden::run(&args),
        Command::Identify(args) => identify::run(&args),
        Command::New(args) => new::run(&args),
        Command::Params(args) => params::run(&args),
        Command::Plan(args) => plan::run(&args),
        Command::Predict(args) => predict::run(&args),
        Command::Import(args) => import::run(&args),
        Command::Library(args) => library::run(&args),
        Command::Report(args) => report::run(&args),
        Command::Review(args) => review::run(&args),
        Command::Schema(args) => schema::run(&args),
        Command::Sweep(args) => sweep::run(&args),
        Command::Wrench(args) => wrench::run(&args),
        Command::Completions(args) => shell::run(&args, Arguments::command()),
    })
}

fn status(done: Done) -> ExitCode {
    done.err().unwrap_or(ExitCode::SUCCESS)
}
