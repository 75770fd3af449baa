//! `cargo mixer library`: an airframe's mixer as an object, a header and a self-test for C and C++.

use std::io::{IsTerminal as _, stderr};
use std::path::{Path, PathBuf};

use mixer_files::library::{Airframe, Options};

use crate::{Done, Refusal, file, print_error, print_note};

/// Writes a C library of one or more airframes: an archive, headers, CMake and a self-test
///
/// Per airframe with module name M (`isae-x8` gives isae_x8):
///   libM.a        one object with M_mix and M_mix_in as its global functions, and no undefined symbol
///   M.h           its interface, C99 and C++17, with coaxial_mixer.h, which all share
///   M.cmake       the imported target M
///   M_selftest.c  golden bits: M_selftest() counts the rows that differ
///
/// The mixer is compiled by this machine's rustc (RUSTC or PATH) for the target: `rustup target add
/// TRIPLE`, or the sources of `core` (`rustup component add rust-src`). Nothing is downloaded. For
/// a target without a floating-point unit the object calls the arithmetic of the C compiler's
/// run-time library (__aeabi_fadd and the like), with the same bits.
///
/// The float ABI is the target's: thumbv7em-none-eabihf goes with -mfloat-abi=hard,
/// thumbv7em-none-eabi with -mfloat-abi=soft or softfp.
#[derive(clap::Args, Debug)]
#[command(verbatim_doc_comment)]
pub struct LibraryArgs {
    /// The airframe files
    #[arg(required = true)]
    airframes: Vec<PathBuf>,
    /// The target, as rustc names it; without it the host
    #[arg(long, value_name = "TRIPLE")]
    target: Option<String>,
    /// Adds M_mix_with_health, for rotors that are out, as a second object of the archive
    #[arg(long)]
    health: bool,
    /// Adds M_mix_dynamic, for rotors that are under way, as a further object of the archive
    #[arg(long)]
    dynamic: bool,
    /// The folder to write into; made where there is none
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Overwrite files that have changed
    #[arg(long)]
    force: bool,
}

/// Runs the command.
pub fn run(args: &LibraryArgs) -> Done {
    let airframes = args.airframes.iter().map(|path| airframe(path));
    let airframes = airframes.collect::<Result<Vec<_>, _>>();
    let airframes = airframes.map_err(|refusal| refusal.report())?;
    file::check_folder(&args.output).map_err(print_error)?;
    let options = Options {
        target: args.target.as_deref(),
        health: args.health,
        dynamic: args.dynamic,
    };
    let note = |note: &str| {
        if stderr().is_terminal() {
            print_note(note);
        }
    };
    let files = mixer_files::library::library(&airframes, &options, note).map_err(print_error)?;
    let files = files.iter();
    let files = files.map(|file| (file.name.as_str(), file.bytes.as_slice()));
    file::save_all(&args.output, files, args.force).map_err(print_error)
}

fn airframe(path: &Path) -> Result<Airframe, Refusal> {
    let airframe = Airframe::new(&crate::read(path)?).map_err(Refusal::Faulty)?;
    crate::warn(&airframe.warnings());
    Ok(airframe)
}
