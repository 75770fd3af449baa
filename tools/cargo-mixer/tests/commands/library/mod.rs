//! `cargo mixer library` from outside: its objects in C and C++ programs, on the host and on a
//! Cortex-M4F in QEMU.

mod example;
// Traps are of this processor's C library.
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
mod exceptions;
mod program;
mod stacks;
mod texts;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use crate::root;
use program::{Golden, HOST_COMPILERS};

/// Mean and worst instructions of the X8's golden vectors through the C interface: the goals for
/// the whole mix.
const MEAN_LIMIT: u32 = 2_000;
const WORST_LIMIT: u32 = 5_000;

/// A folder of this test's own, empty; removed when dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(test: &str) -> Self {
        let path = std::env::temp_dir().join(format!("cargo-mixer-{test}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Folder(path)
    }

    fn join(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).unwrap();
        let mut names: Vec<String> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// `cargo mixer library` in the project's folder.
fn library(arguments: &[&str], output: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_cargo-mixer"));
    command.arg("library").args(arguments).arg("-o").arg(output);
    command.current_dir(root()).stdin(Stdio::null());
    command
}

#[track_caller]
fn run(command: &mut Command) -> Output {
    let program = command.get_program().to_string_lossy().into_owned();
    let output = command
        .output()
        .unwrap_or_else(|error| panic!("{program}: {error}; tests/run --install gets it"));
    let said = String::from_utf8_lossy(&output.stderr);
    let printed = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{command:?}\n{printed}{said}");
    output
}

/// Global symbols of an archive: `T name`, `U name`.
fn symbols(archive: &Path) -> Vec<String> {
    let output = run(Command::new("nm").args(["-g", "--no-sort"]).arg(archive));
    let text = String::from_utf8(output.stdout).unwrap();
    let words = |line: &str| -> Option<String> {
        let mut words = line.rsplit(' ');
        let (name, kind) = (words.next()?, words.next()?);
        (kind.len() == 1).then(|| format!("{kind} {name}"))
    };
    text.lines().filter_map(words).collect()
}

/// All functions of a library with `--health`.
const WITH_HEALTH: [&str; 4] = [
    "T isae_x8_mix",
    "T isae_x8_mix_in",
    "T isae_x8_mix_in_with_health",
    "T isae_x8_mix_with_health",
];

/// At the bench's density, and under conditions.
fn functions(module: &str) -> [String; 2] {
    ["", "_in"].map(|name| format!("T {module}_mix{name}"))
}

#[test]
fn host_programs_have_the_golden_bits() {
    let folder = Folder::new("host");
    let golden = Golden::new();
    golden.library(&[], &folder.0);
    for module in &golden.modules {
        let archive = folder.join(&format!("lib{module}.a"));
        assert_eq!(symbols(&archive), functions(module));
    }
    // Two airframes in one program, and three more.
    for compiler in HOST_COMPILERS {
        let program = folder.join("golden");
        golden.build(compiler, &["host.c"], &folder.0, &program);
        let output = run(&mut Command::new(&program));
        golden.assert_same(&String::from_utf8(output.stdout).unwrap());
    }
}

#[test]
fn rotors_that_are_out_have_an_object_of_their_own() {
    let folder = Folder::new("health");
    // Without [air], which ignores the density, and with it.
    let airframes = [
        "airframes/isae-x8.toml",
        "airframes/x8-11in-least-power.toml",
        "airframes/x8-22-16in.toml",
        "airframes/y4.toml",
        "--health",
    ];
    run(&mut library(&airframes, &folder.0));
    assert_eq!(symbols(&folder.join("libisae_x8.a")), WITH_HEALTH);
    let languages = [["gcc", "-std=c99"], ["g++", "-std=c++17"]];
    let modules = ["isae_x8", "x8_11in_least_power", "x8_22_16in", "y4"].into_iter();
    for (module, [driver, standard]) in
        modules.flat_map(|module| languages.map(|language| (module, language)))
    {
        let program = folder.join("selftest");
        let mut command = Command::new(driver);
        command.args([
            standard,
            "-Wall",
            "-Wextra",
            "-Wfloat-equal",
            "-Werror",
            "-pedantic",
        ]);
        command.arg(format!("-D{}_SELFTEST_MAIN", module.to_uppercase()));
        if driver == "g++" {
            command.args(["-x", "c++"]);
        }
        command.arg(folder.join(&format!("{module}_selftest.c")));
        command
            .args(["-x", "none"])
            .arg(folder.join(&format!("lib{module}.a")));
        run(command.arg("-o").arg(&program));
        let output = run(&mut Command::new(&program));
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(text.ends_with(" rows, 0 different\n"), "{text}");
    }
}

#[test]
fn the_same_airframe_gives_the_same_bytes() {
    let [first, second, temporary] = ["first", "second", "temporary"].map(Folder::new);
    let arguments = ["airframes/px4-y6.toml", "--health"];
    run(&mut library(&arguments, &first.0));
    // From another folder, by another path.
    let path = root().join(arguments[0]).canonicalize().unwrap();
    let mut elsewhere = library(&[&path.display().to_string(), "--health"], &second.0);
    run(elsewhere.env("TMPDIR", &temporary.0).current_dir(&second.0));
    assert_eq!(temporary.names(), [""; 0], "nothing is left behind");
    let expected = [
        "coaxial_mixer.h",
        "libpx4_y6.a",
        "px4_y6.cmake",
        "px4_y6.h",
        "px4_y6_selftest.c",
    ];
    assert_eq!(first.names(), expected);
    for name in first.names() {
        let [first, second] = [&first, &second].map(|folder| fs::read(folder.join(&name)).unwrap());
        assert!(first == second, "{name}");
    }
}

/// The vectors that every airframe holds, through the C interface on the target.
#[test]
fn a_cortex_m4f_has_the_golden_bits() {
    let folder = Folder::new("m4f");
    let golden = Golden::new();
    golden.library(&["--target", "thumbv7em-none-eabihf"], &folder.0);
    for module in &golden.modules {
        let archive = folder.join(&format!("lib{module}.a"));
        assert_eq!(symbols(&archive), functions(module));
    }
    for flags in program::TARGET_FLAGS {
        let image = folder.join("golden.elf");
        let script = format!("-T{}", program::source("board.ld").display());
        let compiler: Vec<&str> = flags.iter().copied().chain([script.as_str()]).collect();
        golden.build(&compiler, &["board.c"], &folder.0, &image);
        let text = program::qemu(&image);
        println!("{text}");
        let lines = golden.assert_same(&text);
        let [_, rows, _, sum, worst] = lines[golden.index("isae_x8")];
        println!("isae_x8: mean {}, worst {worst} instructions", sum / rows);
        assert!(
            worst > 0 && worst <= WORST_LIMIT && sum / rows <= MEAN_LIMIT,
            "{text}"
        );
    }

    // The other float ABI is a clear error.
    let mut soft = Command::new("arm-none-eabi-gcc");
    soft.args(["-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=soft", "-fsyntax-only"]);
    let output = soft.arg(folder.join("isae_x8_selftest.c")).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("is for -mfloat-abi=hard"), "{said}");
}

/// A processor without a floating-point unit: the X8's self-test, with all rotors and with rotors
/// out, in QEMU.
#[track_caller]
fn assert_bits_without_floating_point(target: &str, processor: &str, machine: &str, options: &[&str]) {
    let folder = Folder::new(target);
    run(&mut library(
        &["airframes/isae-x8.toml", "--health", "--target", target],
        &folder.0,
    ));
    let archive = folder.join("libisae_x8.a");
    let (linked, own): (Vec<String>, Vec<String>) = symbols(&archive)
        .into_iter()
        .partition(|symbol| symbol.starts_with("U __"));
    assert_eq!(own, WITH_HEALTH);
    assert!(
        linked.iter().any(|symbol| symbol == "U __aeabi_fadd"),
        "{linked:?}"
    );
    let image = folder.join("selftest.elf");
    let mut compiler = Command::new("arm-none-eabi-gcc");
    compiler.args(["-std=c99", "-O2", "-Wall", "-Wextra", "-Werror", "-pedantic"]);
    compiler.args(["-mthumb", "-mfloat-abi=soft", "-nostartfiles", processor]);
    compiler.args(options).arg("-I").arg(&folder.0);
    compiler.arg(format!("-T{}", program::source("board.ld").display()));
    compiler.arg(program::source("selftest.c"));
    compiler.arg(folder.join("isae_x8_selftest.c")).arg(archive);
    run(compiler.arg("-o").arg(&image));
    assert_eq!(program::qemu_on(machine, &image), "all rows equal\n");

    // The arithmetic of the compiler's run-time library against this machine's.
    let here = folder.join("arithmetic");
    let source = program::source("arithmetic.c");
    run(Command::new("cc")
        .args(["-std=c99", "-O2"])
        .arg(&source)
        .arg("-o")
        .arg(&here));
    let output = Command::new(&here).output().unwrap();
    let image = folder.join("arithmetic.elf");
    let mut compiler = Command::new("arm-none-eabi-gcc");
    compiler.args([
        "-std=c99",
        "-O2",
        "-DBOARD",
        "-mthumb",
        "-mfloat-abi=soft",
        "-nostartfiles",
        processor,
    ]);
    compiler.args(options).arg(&source).arg("-o").arg(&image);
    compiler.arg(format!("-T{}", program::source("board.ld").display()));
    run(&mut compiler);
    let digest = String::from_utf8(output.stdout).unwrap();
    assert!(digest.starts_with("200000 pairs: "), "{digest}");
    assert_eq!(program::qemu_on(machine, &image), digest);
}

#[test]
fn a_cortex_m4_of_the_soft_abi_has_the_bits() {
    assert_bits_without_floating_point("thumbv7em-none-eabi", "-mcpu=cortex-m4", "mps2-an386", &[]);
}

#[test]
fn a_cortex_m3_has_the_bits() {
    assert_bits_without_floating_point("thumbv7m-none-eabi", "-mcpu=cortex-m3", "mps2-an385", &[]);
}

#[test]
fn a_cortex_m0_has_the_bits() {
    // Its flash is where the other boards have all their memory, its stack elsewhere.
    let stack = "-Wl,--defsym=stack_top=0x20004000";
    assert_bits_without_floating_point("thumbv6m-none-eabi", "-mcpu=cortex-m0", "microbit", &[stack]);
}

/// A companion computer: both self-tests in QEMU's user mode.
#[test]
#[ignore = "needs aarch64-linux-gnu-gcc, its C library and qemu-aarch64"]
fn an_aarch64_computer_has_the_bits() {
    let tools = ["aarch64-linux-gnu-gcc", "qemu-aarch64"];
    let folder = Folder::new("aarch64");
    let target = "aarch64-unknown-linux-gnu";
    run(&mut library(
        &["airframes/isae-x8.toml", "--health", "--target", target],
        &folder.0,
    ));
    let archive = folder.join("libisae_x8.a");
    assert_eq!(symbols(&archive), WITH_HEALTH);
    let program = folder.join("selftest");
    let mut compiler = Command::new(tools[0]);
    compiler.args([
        "-std=c99",
        "-O2",
        "-Wall",
        "-Wextra",
        "-Werror",
        "-pedantic",
        "-static",
    ]);
    compiler.arg("-DISAE_X8_SELFTEST_MAIN");
    compiler.arg(folder.join("isae_x8_selftest.c")).arg(archive);
    run(compiler.arg("-o").arg(&program));
    let output = run(Command::new(tools[1]).arg(&program));
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.ends_with(" rows, 0 different\n"), "{text}");
}
