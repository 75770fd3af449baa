//! `cargo mixer library`: an airframe's mixer as an object, a header and a self-test for C and C++.
//!
//! ```text
//! airframe files -> compiled, names checked                          names.rs
//!   -> the user's rustc and its `core` for the target                toolchain.rs
//!   -> Rust of the C interface                                       interface.rs
//!   -> one object: runtime, tables, interface, link-time optimised   build.rs
//!   -> again with what it would call of the C compiler's library     support.rs
//!   -> the object looked into, wrapped in an archive                 object.rs
//!   -> headers, CMake, self-test                                     header.rs, selftest.rs
//!   -> all files written, or none                                    output.rs
//! ```

mod airframe;
mod build;
mod header;
mod interface;
mod names;
mod object;
mod output;
mod selftest;
mod support;
mod toolchain;

use std::path::PathBuf;
use std::process::ExitCode;

use airframe::Airframe;
use build::Build;
use header::Header;
use object::Symbols;
use output::File;
use toolchain::Toolchain;

/// Writes a C library of one or more airframes: an archive, headers, CMake and a self-test
///
/// Per airframe with module name M (`isae-x8` gives isae_x8):
///   libM.a        one object with one global function, M_mix, and no undefined symbol
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
    /// The folder to write into; made where there is none
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Overwrite files that have changed
    #[arg(long)]
    force: bool,
}

impl LibraryArgs {
    /// Of one airframe, without rotors out.
    pub fn for_target(airframe: PathBuf, target: &str, output: PathBuf) -> Self {
        LibraryArgs {
            airframes: vec![airframe],
            target: Some(target.to_owned()),
            health: false,
            output,
            force: true,
        }
    }
}

/// Runs the command.
pub fn run(args: &LibraryArgs) -> ExitCode {
    let mut airframes = Vec::new();
    for path in &args.airframes {
        match crate::compile(path) {
            Ok(compiled) => match Airframe::new(path, compiled) {
                Ok(airframe) => airframes.push(airframe),
                Err(message) => return crate::print_error(message),
            },
            Err(refusal) => return refusal.report(),
        }
    }
    match library(args, &airframes) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => crate::print_error(message),
    }
}

fn library(args: &LibraryArgs, airframes: &[Airframe]) -> Result<(), String> {
    names::check(airframes)?;
    output::check(&args.output)?;
    let toolchain = Toolchain::find(args.target.as_deref())?;
    let build = Build::new(&toolchain)?;
    let mut files = vec![File::text("coaxial_mixer.h", header::shared())];
    for airframe in airframes {
        let module = &airframe.module;
        let mut members = vec![(format!("{module}.o"), member(&build, airframe, false)?)];
        if args.health {
            members.push((format!("{module}_health.o"), member(&build, airframe, true)?));
        }
        let functions = interface::functions(module, args.health);
        let header = Header {
            airframe,
            target: &toolchain.target,
            health: args.health,
        };
        files.push(File {
            name: format!("lib{module}.a"),
            bytes: object::archive(&members, &functions)?,
        });
        files.push(File::text(format!("{module}.h"), header.text()));
        files.push(File::text(format!("{module}.cmake"), header.cmake()));
        files.push(File::text(
            format!("{module}_selftest.c"),
            selftest::text(airframe, args.health),
        ));
    }
    output::write(&args.output, &files, args.force)
}

/// The object of one function, looked into.
fn member(build: &Build<'_>, airframe: &Airframe, health: bool) -> Result<Vec<u8>, String> {
    let name = if health {
        format!("{}_health", airframe.module)
    } else {
        airframe.module.clone()
    };
    let rust = interface::rust(airframe, health);
    let fault = |fault: String| format!("the object of {} for {}: {fault}", airframe.file, build.target());
    // The run-time functions that the object calls; they may call others in turn.
    let mut calls: Vec<String> = Vec::new();
    loop {
        let bytes = build.object(&name, &(rust.clone() + &support::rust(build.target(), &calls)))?;
        let symbols = Symbols::of(&bytes).map_err(fault)?;
        let known = calls.len();
        let new = |name: &&String| support::has(name) && !calls.contains(name);
        let found: Vec<String> = symbols.undefined.iter().filter(new).cloned().collect();
        calls.extend(found);
        if calls.len() == known {
            let is_linked = |name: &str| support::is_linked(build.target(), name);
            symbols
                .check(&interface::function(&airframe.module, health), is_linked)
                .map_err(fault)?;
            return Ok(bytes);
        }
    }
}
