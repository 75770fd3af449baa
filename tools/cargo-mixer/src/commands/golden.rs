//! `cargo mixer golden`: what an airframe compiles to, held in files and compared.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use mixer_files::golden;

use crate::Done;

pub mod compare;

/// Writes golden outputs of airframes, or compares them with those that were written
///
/// Per airframe:
///   NAME.rs              the generated Rust
///   NAME.report.txt      its summary
///   NAME.vectors.csv     setpoints with the bits of throttles, achieved wrench and saturation
///   NAME.rotors-out.csv  the same with rotors out
///
/// Keep the folder under version control and run the command with --check in your tests.
#[derive(clap::Args, Debug)]
#[command(verbatim_doc_comment)]
pub struct GoldenArgs {
    /// The airframe files
    #[arg(required = true, value_name = "AIRFRAME.toml")]
    airframes: Vec<PathBuf>,
    /// The folder of the outputs
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Compare and write nothing; status 1 where an output differs, is missing or belongs to no
    /// airframe
    #[arg(long)]
    check: bool,
    /// Overwrite outputs that have changed
    #[arg(long)]
    force: bool,
}

/// Runs the command.
pub fn run(args: &GoldenArgs) -> Done {
    let outputs = all_outputs(&args.airframes)?;
    let done = if args.check {
        check(&args.output, &outputs)
    } else {
        write(&args.output, &outputs, args.force)
    };
    done.map_err(crate::print_error)
}

/// The outputs of all airframes by file name. Everything is compiled before anything is written.
fn all_outputs(airframes: &[PathBuf]) -> Result<BTreeMap<String, String>, ExitCode> {
    let mut outputs = BTreeMap::new();
    let mut of_name: BTreeMap<String, &PathBuf> = BTreeMap::new();
    for path in airframes {
        let compiled = crate::compile(path)?;
        let name = &compiled.airframe.name;
        if let Some(other) = of_name.insert(name.clone(), path) {
            return Err(crate::print_error(format_args!(
                "{} and {} are both named {name}: golden outputs are named after the airframe",
                other.display(),
                path.display()
            )));
        }
        outputs.extend(golden::outputs(&compiled));
    }
    Ok(outputs)
}

fn write(folder: &Path, outputs: &BTreeMap<String, String>, force: bool) -> Result<(), String> {
    let files = outputs.iter();
    let files = files.map(|(name, text)| (name.as_str(), text.as_bytes()));
    crate::file::save_all(folder, files, force)?;
    for orphan in compare::orphans(folder, outputs)? {
        crate::print_note(format_args!(
            "{} belongs to none of these airframes: remove it",
            folder.join(orphan).display()
        ));
    }
    Ok(())
}

fn check(folder: &Path, outputs: &BTreeMap<String, String>) -> Result<(), String> {
    let differences = compare::differences(folder, outputs)?;
    if differences.is_empty() {
        return Ok(());
    }
    for difference in &differences {
        crate::print_note(format_args!("{}", folder.join(difference).display()));
    }
    Err(format!(
        "{} of {} golden outputs differ; if that is meant, run the command with --force in place of --check and look at what changes",
        differences.len(),
        outputs.len()
    ))
}
