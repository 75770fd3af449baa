//! Compiles the runtime with a C interface into one object: three runs of rustc in a folder of
//! their own.

use std::fs;
use std::io;
use std::path::Path;
use std::process::{Command, Stdio};

use tempfile::TempDir;

use crate::library::toolchain::{Core, Toolchain};

/// As the firmware's profile has it, but without vectors. The bits of a mix depend on none of these.
///
/// Flight stacks on a host trap floating-point exceptions (ArduPilot's simulator does). A vector
/// that holds fewer numbers than it has lanes divides 0 by 0 in the others. These two options leave
/// out the only passes of LLVM that make vectors of scalar arithmetic; `core` and the runtime have
/// none of their own, and instructions for scalars (`divss`, `fdiv s`) look at one lane.
const CODE: &[&str] = &[
    "--cap-lints=allow",
    "-Copt-level=3",
    "-Cpanic=abort",
    "-Ccodegen-units=1",
    "-Cforce-unwind-tables=no",
    "-Cno-vectorize-loops",
    "-Cno-vectorize-slp",
];

/// Older `no_std` crates name it; nothing of it is used.
const BUILTINS: &str = "#![feature(compiler_builtins)]\n#![compiler_builtins]\n#![no_std]\n";

/// A folder with the runtime compiled for the target; it is removed when dropped.
pub(crate) struct Build<'a> {
    toolchain: &'a Toolchain,
    folder: TempDir,
}

impl<'a> Build<'a> {
    /// Compiles the runtime, and `core` where it has to be, which takes long and is told.
    pub(crate) fn new(toolchain: &'a Toolchain, note: impl Fn(&str)) -> Result<Self, String> {
        let folder = tempfile::tempdir().map_err(|error| fault(&std::env::temp_dir(), &error))?;
        let build = Build { toolchain, folder };
        if let Core::Sources(core) = &toolchain.core {
            let target = build.target();
            note(&format!(
                "compiling core for {target} from its sources, half a minute or so"
            ));
            build.core(core)?;
        }
        build.extract()?;
        let runtime = build.path().join("mixer-rt/lib.rs");
        build.compile("mixer_rt", &runtime, "rlib", &["link"])?;
        Ok(build)
    }

    fn path(&self) -> &Path {
        self.folder.path()
    }

    pub(crate) fn target(&self) -> &str {
        &self.toolchain.target
    }

    /// The object of a crate that exports C functions.
    pub(crate) fn object(&self, name: &str, rust: &str) -> Result<Vec<u8>, String> {
        let source = self.path().join(format!("{name}.rs"));
        fs::write(&source, rust).map_err(|error| fault(&source, &error))?;
        // Link-time optimisation leaves one object, in which only the interface is global. It is
        // run only where something is linked, here an archive with the compiler's own helpers, of
        // which nothing is used.
        self.compile(name, &source, "staticlib", &["obj", "link"])?;
        let object = self.path().join(format!("{name}.o"));
        fs::read(&object).map_err(|error| fault(&object, &error))
    }

    /// `core` from its sources.
    fn core(&self, core: &Path) -> Result<(), String> {
        let manifest = core.join("Cargo.toml");
        let manifest = fs::read_to_string(&manifest).map_err(|error| fault(&manifest, &error))?;
        let edition = manifest
            .lines()
            .find_map(|line| line.strip_prefix("edition = \"")?.strip_suffix('"'))
            .unwrap_or("2024");
        let mut command = self.rustc("core", &core.join("src/lib.rs"), "rlib", &["link"]);
        command.args(["--edition", edition]);
        run(command)?;
        let builtins = self.path().join("compiler_builtins.rs");
        fs::write(&builtins, BUILTINS).map_err(|error| fault(&builtins, &error))?;
        self.compile("compiler_builtins", &builtins, "rlib", &["link"])
    }

    /// Writes the runtime's sources.
    fn extract(&self) -> Result<(), String> {
        let folder = self.path().join("mixer-rt");
        let mut written = Ok(());
        mixer_rt::sources(&mut |name, text| {
            let path = folder.join(name);
            if written.is_ok() {
                let made = path.parent().map_or(Ok(()), fs::create_dir_all);
                let made = made.and_then(|()| fs::write(&path, text));
                written = made.map_err(|error| fault(&path, &error));
            }
        });
        written
    }

    fn compile(&self, name: &str, source: &Path, kind: &str, emit: &[&str]) -> Result<(), String> {
        let mut command = self.rustc(name, source, kind, emit);
        command.args(["--edition", "2024"]);
        if let Core::Sources(_) = self.toolchain.core {
            command.arg("--extern").arg(self.library("core"));
        }
        if kind == "staticlib" {
            command.arg("-Clto=fat");
            command.arg("--extern").arg(self.library("mixer_rt"));
        }
        run(command)
    }

    /// `rustc` with what every run has.
    fn rustc(&self, name: &str, source: &Path, kind: &str, emit: &[&str]) -> Command {
        let mut command = Command::new(&self.toolchain.rustc);
        command.args(["--crate-name", name, "--crate-type", kind]);
        command.arg(format!("--emit={}", emit.join(",")));
        command.arg("--target").arg(self.target());
        let path = self.path();
        command.arg("-L").arg(path).arg("--out-dir").arg(path);
        // Wherever it was compiled, the same bytes.
        let mut remapped = self.path().as_os_str().to_owned();
        remapped.push("=.");
        command.arg("--remap-path-prefix").arg(remapped);
        command.args(CODE).arg(source);
        if let Core::Sources(_) = self.toolchain.core {
            // `core` is written in the language of the next releases.
            command.env("RUSTC_BOOTSTRAP", "1");
        }
        command
    }

    /// `name=path` of a library that this build made.
    fn library(&self, name: &str) -> std::ffi::OsString {
        let mut library = std::ffi::OsString::from(format!("{name}="));
        library.push(self.path().join(format!("lib{name}.rlib")));
        library
    }
}

fn fault(path: &Path, error: &io::Error) -> String {
    format!("{}: {error}", path.display())
}

/// Runs to the end; the compiler's own words where it fails.
fn run(mut command: Command) -> Result<(), String> {
    let program = command.get_program().to_owned();
    let output = command
        .stdin(Stdio::null())
        .output()
        .map_err(|error| fault(Path::new(&program), &error))?;
    if output.status.success() {
        return Ok(());
    }
    let said = String::from_utf8_lossy(&output.stderr);
    Err(format!("{} failed:\n{}", program.display(), said.trim_end()))
}
