//! Builds the images of `tests/firmware` and of the examples and runs them in QEMU.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use crate::root;

/// Of every image.
pub const TARGET: &str = "thumbv7em-none-eabihf";
/// Far more than any image needs; an image that hangs must not hang the tests.
const TIME_LIMIT: Duration = Duration::from_secs(300);
/// Where the `counts` image looks for its order (`order.rs`).
const ORDER: u32 = 0x2100_0000;
/// Of images that mix up to a million times.
const LONG_TIME_LIMIT: Duration = Duration::from_secs(3600);

/// What of an image is chosen when it is built.
#[derive(Clone, Debug, Default)]
pub struct Variant {
    /// Configuration of the image's own crate.
    pub cfgs: Vec<String>,
    /// Features of the firmware package.
    pub features: Vec<&'static str>,
    /// A library for C that is linked, by its folder and its module.
    pub library: Option<(PathBuf, String)>,
}

impl Variant {
    /// An airframe's mixer (`tests/firmware/src/subject`), asked with `rotors_out`: 0, 1 or 2.
    pub fn of_airframe(airframe: &str, rotors_out: u32) -> Self {
        let mut cfgs = vec!["airframe".into(), format!("airframe={airframe:?}")];
        if rotors_out > 0 {
            cfgs.push(format!("rotors_out=\"{rotors_out}\""));
        }
        Variant {
            cfgs,
            ..Variant::default()
        }
    }

    /// With one configuration flag.
    pub fn with(cfg: &str) -> Self {
        Variant {
            cfgs: vec![cfg.to_owned()],
            ..Variant::default()
        }
    }
}

/// What builds firmware on this machine.
pub struct Toolchain {
    /// The package of the images.
    folder: PathBuf,
    cargo: OsString,
    environment: Vec<(&'static str, OsString)>,
    arguments: Vec<&'static str>,
    /// Apart from what a user builds, and one per toolchain.
    target_dir: PathBuf,
    /// The compiler, by its own name and version.
    pub compiler: String,
}

impl Toolchain {
    /// The running toolchain if it has the target, else Debian's compiler, which builds `core` from
    /// its sources.
    ///
    /// # Errors
    ///
    /// If there is neither, or no QEMU: what to install.
    pub fn find() -> Result<Toolchain, String> {
        Toolchain::for_package("tests/firmware")
    }

    /// The same for the images of another package.
    ///
    /// # Errors
    ///
    /// As [`Toolchain::find`].
    pub fn for_package(package: &str) -> Result<Toolchain, String> {
        let folder = root().join(package);
        if Command::new("qemu-system-arm").arg("--version").output().is_err() {
            return Err("qemu-system-arm is missing: apt-get install qemu-system-arm".into());
        }
        // One for all packages: what they have in common is compiled once.
        let target = root().join("tests/firmware/target");
        let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
        let target_libdir = print(Path::new(&rustc), &["target-libdir", "--target", TARGET]);
        if target_libdir.is_some_and(|libraries| libraries.is_dir()) {
            return Ok(Toolchain {
                folder,
                cargo: std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()),
                environment: Vec::new(),
                arguments: Vec::new(),
                target_dir: target.join("tests"),
                compiler: version(Path::new(&rustc)),
            });
        }
        let debian = Path::new("/usr/bin/rustc");
        let sources = print(debian, &["sysroot"]).map(|root| root.join("lib/rustlib/src/rust/library/core"));
        let linker = Command::new("arm-none-eabi-ld").arg("--version").output();
        if sources.is_some_and(|core| core.is_dir()) && Path::new("/usr/bin/cargo").exists() && linker.is_ok()
        {
            return Ok(Toolchain {
                folder,
                cargo: "/usr/bin/cargo".into(),
                environment: vec![
                    ("RUSTC", debian.into()),
                    // `-Zbuild-std` is not stable, and Debian has no other way to a bare-metal
                    // `core`.
                    ("RUSTC_BOOTSTRAP", "1".into()),
                    (
                        "CARGO_TARGET_THUMBV7EM_NONE_EABIHF_LINKER",
                        "arm-none-eabi-ld".into(),
                    ),
                ],
                arguments: vec!["-Zbuild-std=core"],
                target_dir: target.join("tests-build-std"),
                compiler: version(debian),
            });
        }
        Err(format!(
            "no compiler for {TARGET}: `rustup target add {TARGET}`, or on Debian 12 \
             `apt-get install rustc-web cargo-web rust-web-src binutils-arm-none-eabi`"
        ))
    }

    /// Builds one image in release mode, its own crate as `variant` says, and returns the path of
    /// its ELF file, which is that variant's own.
    ///
    /// # Errors
    ///
    /// What the compiler said.
    pub fn build(&self, image: &str, variant: &Variant) -> Result<PathBuf, String> {
        let images = self.target_dir.join("images");
        let fault = |e: std::io::Error| format!("{}: {e}", images.display());
        fs::create_dir_all(&images).map_err(fault)?;
        // Cargo puts an image in the same place whatever its `cfgs`, and tests run side by side.
        let lock = File::create(images.join(".lock")).map_err(fault)?;
        lock.lock().map_err(fault)?;
        let mut command = self.command("rustc", image);
        for feature in &variant.features {
            command.args(["--features", feature]);
        }
        command.arg("--");
        for cfg in &variant.cfgs {
            command.args(["--cfg", cfg]);
        }
        if let Some((folder, module)) = &variant.library {
            command.arg(format!("-Lnative={}", folder.display()));
            command.arg(format!("-lstatic={module}"));
            command.arg(format!("-Clink-arg=--undefined={module}_mix"));
            command.arg(format!("-Clink-arg=--defsym=c_interface_mix={module}_mix"));
        }
        let output = command.output().map_err(|e| format!("cannot start cargo: {e}"))?;
        if !output.status.success() {
            return Err(String::from_utf8_lossy(&output.stderr).into_owned());
        }
        let built = self.target_dir.join(TARGET).join("release").join(image);
        let name: String = std::iter::once(image)
            .chain(variant.cfgs.iter().map(String::as_str))
            .collect::<Vec<_>>()
            .join(",")
            .replace('"', "");
        let kept = images.join(name);
        fs::copy(&built, &kept).map_err(fault)?;
        Ok(kept)
    }

    /// A folder beside the images for what is linked into them.
    ///
    /// # Errors
    ///
    /// If it cannot be made.
    pub fn scratch(&self, name: &str) -> Result<PathBuf, String> {
        let folder = self.target_dir.join("images").join(name);
        fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        Ok(folder)
    }

    /// Builds one image, runs it in QEMU and returns what it printed.
    ///
    /// # Errors
    ///
    /// What the compiler said, or what the image printed before it failed or was stopped for taking
    /// too long.
    pub fn run(&self, image: &str, variant: &Variant) -> Result<String, String> {
        self.start(&self.build(image, variant)?, &self.runner()?, &[], TIME_LIMIT)
    }

    /// Runs an image that is built, with `order` in the memory where the `counts` image looks for
    /// it, and returns what it printed.
    ///
    /// # Errors
    ///
    /// As [`Toolchain::run`].
    pub fn order(&self, elf: &Path, order: &[u8]) -> Result<String, String> {
        let mut file = elf.to_owned();
        file.as_mut_os_string().push(".order");
        fs::write(&file, order).map_err(|e| format!("{}: {e}", file.display()))?;
        // QEMU reads two commas as one that belongs to the name.
        let file = file.display().to_string().replace(',', ",,");
        let loader = format!("loader,file={file},addr={ORDER:#x},force-raw=on");
        self.start(elf, &self.runner()?, &["-device", &loader], LONG_TIME_LIMIT)
    }

    /// As [`Toolchain::run`], but QEMU does not count instructions, which makes it faster.
    ///
    /// # Errors
    ///
    /// As [`Toolchain::run`].
    pub fn run_uncounted(&self, image: &str, variant: &Variant) -> Result<String, String> {
        let mut runner = self.runner()?;
        if let Some(at) = runner.iter().position(|word| word == "-icount") {
            // The option and its value.
            runner.drain(at..(at + 2).min(runner.len()));
        }
        self.start(&self.build(image, variant)?, &runner, &[], LONG_TIME_LIMIT)
    }

    fn start(
        &self,
        elf: &Path,
        runner: &[String],
        options: &[&str],
        limit: Duration,
    ) -> Result<String, String> {
        let image = elf.display();
        let (qemu, arguments) = runner.split_first().ok_or("the runner is empty")?;
        // On Linux QEMU ends with the program that started it, however that is stopped.
        let mut command = match Command::new(ENDS_WITH_PARENT[0]).arg("--version").output() {
            Ok(_) if cfg!(target_os = "linux") => {
                let mut command = Command::new(ENDS_WITH_PARENT[0]);
                command.args(&ENDS_WITH_PARENT[1..]).arg(qemu);
                command
            }
            _ => Command::new(qemu),
        };
        let mut child = command
            .args(arguments)
            .arg(elf)
            .args(options)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(|e| format!("cannot start {qemu}: {e}"))?;
        let mut stdout = child.stdout.take().ok_or("no standard output")?;
        let printed = thread::spawn(move || {
            let mut text = String::new();
            stdout.read_to_string(&mut text).map(|_| text)
        });
        let started = Instant::now();
        let status = loop {
            if let Some(status) = child.try_wait().map_err(|e| e.to_string())? {
                break Some(status);
            }
            if started.elapsed() > limit {
                child.kill().map_err(|e| e.to_string())?;
                child.wait().map_err(|e| e.to_string())?;
                break None;
            }
            thread::sleep(Duration::from_millis(20));
        };
        let text = printed
            .join()
            .map_err(|_| "reading standard output failed")?
            .map_err(|e| e.to_string())?;
        match status {
            Some(status) if status.success() => Ok(text),
            Some(status) => Err(format!("{image}: {status}\n{text}")),
            None => Err(format!(
                "{image}: not finished after {} s\n{text}",
                limit.as_secs()
            )),
        }
    }

    /// Builds the package in `folder`, which is none of the project's, in release mode, with what
    /// cargo has fetched for the project.
    ///
    /// # Errors
    ///
    /// What the compiler said.
    pub fn build_package(&self, folder: &Path) -> Result<(), String> {
        let output = self
            .cargo()
            .current_dir(folder)
            .args(["build", "--quiet", "--offline", "--release"])
            .args(&self.arguments)
            .output()
            .map_err(|e| format!("cannot start cargo: {e}"))?;
        if !output.status.success() {
            return Err(String::from_utf8_lossy(&output.stderr).into_owned());
        }
        Ok(())
    }

    fn command(&self, subcommand: &str, image: &str) -> Command {
        let mut command = self.cargo();
        command
            .current_dir(&self.folder)
            .args([subcommand, "--quiet", "--locked", "--release", "--bin", image])
            .args(&self.arguments);
        command
    }

    /// Cargo with its environment and its folder for what it builds.
    fn cargo(&self) -> Command {
        let mut command = Command::new(&self.cargo);
        // What the toolchain of the tests, or its caller, has set for itself would mislead the
        // other one.
        for variable in [
            "CARGO_BUILD_TARGET",
            "CARGO_ENCODED_RUSTFLAGS",
            "CARGO_TARGET_DIR",
            "LD_LIBRARY_PATH",
            "RUSTC_WORKSPACE_WRAPPER",
            "RUSTC_WRAPPER",
            "RUSTFLAGS",
        ] {
            command.env_remove(variable);
        }
        command
            .stdin(Stdio::null())
            .env("CARGO_TARGET_DIR", &self.target_dir)
            // Incremental builds divide code in another way: other counts.
            .env("CARGO_INCREMENTAL", "0")
            .envs(self.environment.iter().map(|(name, value)| (name, value)));
        command
    }

    /// QEMU and its arguments, as `cargo run` in the package's folder starts it.
    fn runner(&self) -> Result<Vec<String>, String> {
        let path = self.folder.join(".cargo/config.toml");
        let fault = |what: String| format!("{}: {what}", path.display());
        let text = fs::read_to_string(&path).map_err(|e| fault(e.to_string()))?;
        let config: toml::Table = text.parse().map_err(|e: toml::de::Error| fault(e.to_string()))?;
        let runner = config
            .get("target")
            .and_then(|target| target.get(TARGET)?.get("runner")?.as_array());
        let words = runner.ok_or_else(|| fault(format!("no runner for {TARGET}")))?;
        Ok(words
            .iter()
            .filter_map(|word| word.as_str().map(str::to_owned))
            .collect())
    }
}

/// util-linux's way to be told of the parent's end.
const ENDS_WITH_PARENT: [&str; 3] = ["setpriv", "--pdeathsig", "TERM"];

/// First line of `rustc --version`: release, commit and date.
fn version(rustc: &Path) -> String {
    let output = Command::new(rustc).arg("--version").output();
    let text = output
        .map(|output| String::from_utf8_lossy(&output.stdout).into_owned())
        .unwrap_or_default();
    text.lines().next().unwrap_or("unknown").to_owned()
}

/// Answer of `rustc --print`, a path.
fn print(rustc: &Path, what: &[&str]) -> Option<PathBuf> {
    let output = Command::new(rustc).arg("--print").args(what).output().ok()?;
    let path = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| PathBuf::from(path.trim_end()))
}
