//! The golden program: every airframe's golden vectors through its C interface.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::{library, root, run};

/// Compilers of the host with their options.
pub(crate) const HOST_COMPILERS: [&[&str]; 4] = [
    &["gcc", "-std=c99"],
    &["gcc", "-std=c11", "-O2", "-flto"],
    &["g++", "-std=c++17", "-x", "c++"],
    &["g++", "-std=c++20", "-O2", "-flto", "-x", "c++"],
];

/// The same of the target.
pub(crate) const TARGET_FLAGS: [&[&str]; 2] = [TARGET, TARGET_LTO];
const TARGET: &[&str] = &[
    "arm-none-eabi-gcc",
    "-std=c99",
    "-O2",
    "-mcpu=cortex-m4",
    "-mthumb",
    "-mfpu=fpv4-sp-d16",
    "-mfloat-abi=hard",
    "-nostartfiles",
];
const TARGET_LTO: &[&str] = &[
    "arm-none-eabi-gcc",
    "-std=c99",
    "-O2",
    "-mcpu=cortex-m4",
    "-mthumb",
    "-mfpu=fpv4-sp-d16",
    "-mfloat-abi=hard",
    "-nostartfiles",
    "-flto",
];

/// A file of this test's folder.
pub(crate) fn source(name: &str) -> PathBuf {
    root().join("tools/cargo-mixer/tests/commands/library").join(name)
}

/// The project's airframes.
pub(crate) struct Golden {
    files: Vec<String>,
    pub(crate) modules: Vec<String>,
}

impl Golden {
    pub(crate) fn new() -> Self {
        let entries = fs::read_dir(root().join("airframes")).unwrap();
        let mut files: Vec<String> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .filter(|name| name.ends_with(".toml"))
            .collect();
        files.sort();
        let modules = files
            .iter()
            .map(|name| name.trim_end_matches(".toml").replace('-', "_"))
            .collect();
        Golden { files, modules }
    }

    pub(crate) fn index(&self, module: &str) -> usize {
        self.modules.iter().position(|other| other == module).unwrap()
    }

    /// Libraries of all airframes, and their golden vectors as `rows.h`.
    pub(crate) fn library(&self, options: &[&str], folder: &Path) {
        let paths: Vec<String> = self
            .files
            .iter()
            .map(|name| format!("airframes/{name}"))
            .collect();
        let arguments: Vec<&str> = paths
            .iter()
            .map(String::as_str)
            .chain(options.iter().copied())
            .collect();
        run(&mut library(&arguments, folder));
        fs::write(folder.join("rows.h"), self.rows()).unwrap();
    }

    fn rows(&self) -> String {
        let mut text = String::new();
        for module in &self.modules {
            let _ = writeln!(text, "#include \"{module}.h\"");
        }
        for (file, module) in self.files.iter().zip(&self.modules) {
            let name = file.trim_end_matches(".toml");
            let vectors = root().join(format!("tests/golden/{name}.vectors.csv"));
            let vectors = fs::read_to_string(vectors).unwrap();
            let mut rows = vectors.lines();
            let columns = rows.next().unwrap().split(',').count();
            let _ = writeln!(text, "static const uint32_t {module}_rows[][{columns}] = {{");
            for row in rows {
                let _ = writeln!(text, "    {{{row}}},");
            }
            text += "};\n";
        }
        let all = self
            .modules
            .iter()
            .map(|module| format!(" X({module}, {})", module.to_uppercase()));
        let _ = writeln!(text, "#define AIRFRAMES(X){}", all.collect::<String>());
        text
    }

    /// Builds the program with the libraries in `folder`.
    pub(crate) fn build(&self, compiler: &[&str], board: &[&str], folder: &Path, program: &Path) {
        let (driver, options) = compiler.split_first().unwrap();
        let mut command = Command::new(driver);
        command
            .args(["-Wall", "-Wextra", "-Werror", "-pedantic"])
            .args(options);
        command.arg("-I").arg(folder);
        command.args(["golden.c"].iter().chain(board).map(|name| source(name)));
        for module in &self.modules {
            command.arg(folder.join(format!("{module}_selftest.c")));
        }
        command.args(["-x", "none"]);
        for module in &self.modules {
            command.arg(folder.join(format!("lib{module}.a")));
        }
        run(command.arg("-o").arg(program));
    }

    /// A line per airframe, no row different. Returns its numbers, the first being the airframe's
    /// index.
    #[track_caller]
    pub(crate) fn assert_same(&self, text: &str) -> Vec<[u32; 5]> {
        assert_eq!(text.lines().count(), self.modules.len(), "{text}");
        let lines = text.lines().zip(&self.modules).zip(0..);
        lines
            .map(|((line, module), index)| {
                let words: Vec<&str> = line.split(' ').collect();
                let [name, numbers @ ..] = &words[..] else {
                    panic!("{text}")
                };
                assert_eq!(name, module);
                let numbers: Vec<u32> = numbers.iter().map(|number| number.parse().unwrap()).collect();
                let [rows, different, sum, worst] = numbers[..] else {
                    panic!("{text}")
                };
                assert!(rows > 400 && different == 0, "{text}");
                [index, rows, different, sum, worst]
            })
            .collect()
    }
}

/// Runs an image on the board with a Cortex-M4F and returns what it prints.
pub(crate) fn qemu(image: &Path) -> String {
    qemu_on("mps2-an386", image)
}

/// The same on another machine of QEMU.
pub(crate) fn qemu_on(machine: &str, image: &Path) -> String {
    let mut command = Command::new("qemu-system-arm");
    command.args(["-machine", machine, "-display", "none"]);
    command.args(["-monitor", "none", "-serial", "none"]);
    command.args(["-icount", "shift=10,align=off,sleep=off"]);
    command.args(["-semihosting-config", "enable=on,target=native", "-kernel"]);
    command
        .arg(image)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    let mut child = command
        .spawn()
        .unwrap_or_else(|error| panic!("qemu-system-arm: {error}"));
    let started = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if started.elapsed() > Duration::from_secs(120) {
            child.kill().unwrap();
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    let output = child.wait_with_output().unwrap();
    // Semihosting writes to stderr.
    let text =
        String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{text}");
    text
}
