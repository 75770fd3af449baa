//! C libraries of coaxial mixers: airframe files in, an archive, headers, CMake and a self-test out.
//!
//! The mixer is compiled by this machine's `rustc`, in a temporary folder; nothing else is read or
//! written, and nothing is downloaded.
//!
//! ```text
//! airframe files -> compiled, names checked                          airframe.rs, names.rs
//!   -> the user's rustc and its `core` for the target                toolchain.rs
//!   -> Rust of the C interface                                       interface.rs
//!   -> one object: runtime, tables, interface, link-time optimised   build.rs
//!   -> again with what it would call of the C compiler's library     support.rs
//!   -> the object looked into, wrapped in an archive                 object.rs
//!   -> headers, CMake, self-test                                     header.rs, selftest.rs, templates/
//! ```
//!
//! ```no_run
//! use mixer_files::library::{Airframe, Options, library};
//! use mixer_compiler::Source;
//!
//! # let text = std::fs::read_to_string("../../airframes/isae-x8.toml").unwrap();
//! let airframe = Airframe::new(&Source::new("isae-x8.toml", text)).unwrap();
//! let options = Options { target: Some("thumbv7em-none-eabihf"), health: false, dynamic: false };
//! for file in library(&[airframe], &options, |note| eprintln!("{note}")).unwrap() {
//!     std::fs::write(file.name, file.bytes).unwrap();
//! }
//! ```

mod airframe;
mod build;
mod error;
mod header;
mod interface;
mod names;
mod object;
mod selftest;
mod support;
mod toolchain;

pub use airframe::Airframe;
pub use error::Error;

use build::Build;
use header::Header;
use interface::Object;
use mixer_compiler::dynamics::UNPROVEN;
use object::{Member, Symbols};
use toolchain::Toolchain;

/// What a library is made for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options<'a> {
    /// The target as rustc names it, as `thumbv7em-none-eabihf`; without it the host.
    pub target: Option<&'a str>,
    /// Whether `M_mix_with_health`, for rotors that are out, is a second object of the archive.
    pub health: bool,
    /// Whether `M_mix_dynamic`, for rotors that are under way, is a further one.
    pub dynamic: bool,
}

/// A file of a library.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// Its name, without a folder.
    pub name: String,
    /// What it holds.
    pub bytes: Vec<u8>,
}

/// The files of a library: of an airframe with module name M `libM.a`, `M.h`, `M.cmake` and
/// `M_selftest.c`, and `coaxial_mixer.h` of all. `RUSTC` names the compiler to ask, otherwise those
/// on the path are asked. `note` is told what takes long.
///
/// # Errors
/// A name that no C library can have, a target that there is no compiler for, a compiler that fails.
pub fn library(
    airframes: &[Airframe],
    options: &Options<'_>,
    note: impl Fn(&str),
) -> Result<Vec<File>, Error> {
    names::check(airframes).map_err(Error::Name)?;
    let toolchain = Toolchain::find(options.target).map_err(Error::Toolchain)?;
    files(airframes, &toolchain, options, note).map_err(Error::Build)
}

fn files(
    airframes: &[Airframe],
    toolchain: &Toolchain,
    options: &Options<'_>,
    note: impl Fn(&str),
) -> Result<Vec<File>, String> {
    let &Options { health, dynamic, .. } = options;
    let build = Build::new(toolchain, note)?;
    let text = |name: String, text: String| File {
        name,
        bytes: text.into_bytes(),
    };
    let mut files = vec![text("coaxial_mixer.h".to_owned(), header::shared())];
    for airframe in airframes {
        let module = &airframe.module;
        if dynamic && airframe.compiled.dynamics.is_none() {
            return Err(format!("{}: {UNPROVEN}", airframe.file));
        }
        let all = [(false, false), (true, false), (false, true), (true, true)];
        let objects = all.map(|(health, dynamic)| Object { health, dynamic });
        let asked = |of: &Object| of.health <= health && of.dynamic <= dynamic;
        let members = objects.into_iter().filter(asked);
        let members: Vec<Member> = members
            .map(|object| member(&build, airframe, object))
            .collect::<Result<_, _>>()?;
        let header = Header {
            airframe,
            target: &toolchain.target,
            health,
            dynamic,
        };
        files.push(File {
            name: format!("lib{module}.a"),
            bytes: object::archive(&members)?,
        });
        files.push(text(format!("{module}.h"), header.text()));
        files.push(text(format!("{module}.cmake"), header.cmake()));
        files.push(text(
            format!("{module}_selftest.c"),
            selftest::text(airframe, health, dynamic),
        ));
    }
    Ok(files)
}

/// The object of the mixer, looked into.
fn member(build: &Build<'_>, airframe: &Airframe, object: Object) -> Result<Member, String> {
    let dynamic = if object.dynamic { "_dynamic" } else { "" };
    let health = if object.health { "_health" } else { "" };
    let name = format!("{}{dynamic}{health}", airframe.module);
    let rust = interface::rust(airframe, object);
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
            let functions = interface::functions(&airframe.module, object);
            symbols.check(&functions, is_linked).map_err(fault)?;
            return Ok(Member {
                name: format!("{name}.o"),
                bytes,
                functions,
            });
        }
    }
}
