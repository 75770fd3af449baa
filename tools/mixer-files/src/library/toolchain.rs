//! The Rust compiler of this machine and its `core` for the target.
//!
//! `core` is installed for the target (`rustup target add`), or its sources are (`rustup component
//! add rust-src`, Debian's rust-web-src) and it is compiled from them.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Oldest compiler that the runtime's source is written for.
const OLDEST: &str = env!("CARGO_PKG_RUST_VERSION");

/// Where `core` for the target comes from.
#[derive(Debug)]
pub(crate) enum Core {
    /// The compiler has it.
    Installed,
    /// Its sources: the folder with `src/lib.rs`.
    Sources(PathBuf),
}

/// A compiler for the target.
#[derive(Debug)]
pub(crate) struct Toolchain {
    /// `rustc`.
    pub(crate) rustc: PathBuf,
    /// The target, as rustc names it.
    pub(crate) target: String,
    /// Its `core`.
    pub(crate) core: Core,
}

impl Toolchain {
    /// The first compiler that has `core` for the target, else the first that has its sources.
    /// `RUSTC` names the only one to ask, otherwise they are those on the path.
    pub(crate) fn find(target: Option<&str>) -> Result<Self, String> {
        let all: Vec<PathBuf> = match env::var_os("RUSTC") {
            Some(rustc) => vec![rustc.into()],
            None => on_path(),
        };
        let compilers: Vec<Compiler> = all.iter().filter_map(|rustc| Compiler::ask(rustc)).collect();
        let Some(first) = compilers.first() else {
            // A path that was set by hand is the likelier mistake than a machine without the
            // compiler.
            let set = all.first().filter(|_| env::var_os("RUSTC").is_some());
            let place = set.map(|rustc| format!(" at {}, which RUSTC names", rustc.display()));
            return Err(format!(
                "no rustc{}: the mixer is compiled by this machine's Rust compiler. Install Rust \
                 (https://rustup.rs), or set RUSTC to its path",
                place.unwrap_or_default()
            ));
        };
        let recent: Vec<&Compiler> = compilers.iter().filter(|compiler| compiler.is_recent()).collect();
        if recent.is_empty() {
            return Err(format!(
                "{} is {}: the mixer needs {OLDEST} or later (rustup update)",
                first.rustc.display(),
                first.release
            ));
        }
        let target = target.unwrap_or(&first.host);
        let Some(os) = recent.iter().find_map(|compiler| compiler.os(target)) else {
            return Err(format!(
                "rustc knows no target `{target}`; `rustc --print target-list` lists them, among them \
                 thumbv7em-none-eabihf (Cortex-M4F, M7), thumbv7em-none-eabi, thumbv7m-none-eabi, \
                 thumbv6m-none-eabi, aarch64-unknown-linux-gnu, x86_64-unknown-linux-gnu"
            ));
        };
        if !["none", "linux", "nuttx"].contains(&os.as_str()) {
            return Err(format!(
                "{target} is for {os}: libraries are made for bare metal (..-none-eabihf) and Linux; name a --target"
            ));
        }
        let found = |compiler: &Compiler, core| Toolchain {
            rustc: compiler.rustc.clone(),
            target: target.to_owned(),
            core,
        };
        if let Some(compiler) = recent.iter().find(|compiler| compiler.has(target)) {
            return Ok(found(compiler, Core::Installed));
        }
        let mut with_sources = recent.iter().filter(|compiler| compiler.os(target).is_some());
        with_sources
            .find_map(|compiler| Some(found(compiler, Core::Sources(compiler.core_sources()?))))
            .ok_or_else(|| {
                format!(
                    "{} has no `core` for {target}: `rustup target add {target}`, or its sources: `rustup component add \
                     rust-src`; on Debian 12 `apt-get install rustc-web rust-web-src`",
                    first.rustc.display()
                )
            })
    }
}

/// A compiler, asked.
#[derive(Debug)]
struct Compiler {
    rustc: PathBuf,
    /// Version, as 1.89.0.
    release: String,
    /// Triple that it runs on.
    host: String,
}

impl Compiler {
    fn ask(rustc: &Path) -> Option<Self> {
        let version = answer(rustc, &["-vV"])?;
        let line = |key: &str| {
            let mut lines = version.lines();
            lines.find_map(|line| Some(line.strip_prefix(key)?.trim().to_owned()))
        };
        Some(Compiler {
            rustc: rustc.to_owned(),
            release: line("release:")?,
            host: line("host:")?,
        })
    }

    fn is_recent(&self) -> bool {
        match (numbers(&self.release), numbers(OLDEST)) {
            (Some(release), Some(oldest)) => release >= oldest,
            // No number to go by: the compiler says what it cannot read.
            _ => true,
        }
    }

    /// The target's operating system; `None` of a target that it does not know, or a file's.
    fn os(&self, target: &str) -> Option<String> {
        let is_file = target.ends_with(".json");
        let settings = (!is_file).then(|| answer(&self.rustc, &["--print", "cfg", "--target", target]))??;
        let mut lines = settings.lines();
        let os = lines.find_map(|line| line.strip_prefix("target_os=\"")?.strip_suffix('"'));
        os.map(str::to_owned)
    }

    /// Whether `core` is installed for the target.
    fn has(&self, target: &str) -> bool {
        let libraries = answer(&self.rustc, &["--print", "target-libdir", "--target", target]);
        let Some(files) = libraries.and_then(|folder| fs::read_dir(folder.trim_end()).ok()) else {
            return false;
        };
        let mut names = files.filter_map(|file| file.ok()?.file_name().into_string().ok());
        names.any(|name| name.starts_with("libcore-") && name.ends_with(".rlib"))
    }

    fn core_sources(&self) -> Option<PathBuf> {
        let sysroot = answer(&self.rustc, &["--print", "sysroot"])?;
        let core = Path::new(sysroot.trim_end()).join("lib/rustlib/src/rust/library/core");
        core.join("src/lib.rs").is_file().then_some(core)
    }
}

/// Major and minor version.
fn numbers(version: &str) -> Option<[u32; 2]> {
    let mut parts = version.split('.');
    Some([parts.next()?.parse().ok()?, parts.next()?.parse().ok()?])
}

/// Every `rustc` on the path, each once.
fn on_path() -> Vec<PathBuf> {
    let folders = env::var_os("PATH").unwrap_or_default();
    let name = format!("rustc{}", env::consts::EXE_SUFFIX);
    let mut found: Vec<PathBuf> = Vec::new();
    for rustc in env::split_paths(&folders).map(|folder| folder.join(&name)) {
        if rustc.is_file() && !found.contains(&rustc) {
            found.push(rustc);
        }
    }
    found
}

/// What a compiler prints; `None` where it fails.
fn answer(rustc: &Path, arguments: &[&str]) -> Option<String> {
    let output = Command::new(rustc)
        .args(arguments)
        .stdin(Stdio::null())
        .output()
        .ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then_some(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_compared_by_number() {
        let compiler = |release: &str| Compiler {
            rustc: PathBuf::new(),
            release: release.to_owned(),
            host: String::new(),
        };
        assert!(!compiler("1.9.0").is_recent());
        assert!(compiler(OLDEST).is_recent());
        assert!(compiler("1.100.0-nightly").is_recent());
    }
}
