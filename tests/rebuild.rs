//! Editing an airframe file rebuilds what was made of it, by the macro and by a build script: a new
//! number arrives in the program, a fault stops the build and names its place in the file, mending
//! it builds again.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, SystemTime};
use std::{env, fs};

/// Where the pair model is edited: the thrust coefficient of u2l2.
const COEFFICIENT: &str = "5.2075";
const EDITED: &str = "5.3075";
const FAULT: &str = "\"5.2075\"";

const MAIN: &str = r#"
mod by_macro {
    mixer_macros::airframe!("by-macro.toml");
}
mod by_build_script {
    include!(concat!(env!("OUT_DIR"), "/by-build-script.rs"));
}

fn main() {
    println!("{} {}", by_macro::isae_x8::TABLES.kinds.pair.thrust.0[0], by_build_script::isae_x8::TABLES.kinds.pair.thrust.0[0]);
}
"#;

const BUILD_SCRIPT: &str = r#"
fn main() {
    mixer_compiler::build_script::compile("by-build-script.toml");
}
"#;

/// A package outside of the workspace that has a mixer by each way.
struct Package {
    folder: PathBuf,
    target: PathBuf,
    airframe: String,
}

impl Package {
    fn new() -> Self {
        let workspace = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("..")
            .canonicalize()
            .unwrap();
        let scratch = Path::new(env!("CARGO_TARGET_TMPDIR"));
        let package = Package {
            folder: scratch.join("rebuild"),
            // Stays from run to run: the dependencies are compiled once.
            target: scratch.join("rebuild-target"),
            airframe: fs::read_to_string(workspace.join("airframes/isae-x8.toml")).unwrap(),
        };
        // What an earlier run left, if there was one.
        let _ = fs::remove_dir_all(&package.folder);
        fs::create_dir_all(package.folder.join("src")).unwrap();
        let dependency = |name: &str| format!("{{ path = {:?} }}", workspace.join(name));
        let manifest = format!(
            "[package]\nname = \"rebuild\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[workspace]\n\n\
             [dependencies]\nmixer-macros = {}\nmixer-rt = {}\n\n[build-dependencies]\nmixer-compiler = {}\n",
            dependency("mixer-macros"),
            dependency("mixer-rt"),
            dependency("mixer-compiler"),
        );
        fs::write(package.folder.join("Cargo.toml"), manifest).unwrap();
        fs::copy(workspace.join("Cargo.lock"), package.folder.join("Cargo.lock")).unwrap();
        fs::write(package.folder.join("src/main.rs"), MAIN).unwrap();
        fs::write(package.folder.join("build.rs"), BUILD_SCRIPT).unwrap();
        package
    }

    /// Writes one of the airframe files with another coefficient. Cargo compares times of
    /// modification, which some file systems keep in seconds; setting `time` keeps edits apart
    /// without waiting.
    fn edit(&self, file: &str, coefficient: &str, time: SystemTime) {
        assert_eq!(self.airframe.matches(COEFFICIENT).count(), 1);
        let path = self.folder.join(file);
        fs::write(&path, self.airframe.replace(COEFFICIENT, coefficient)).unwrap();
        fs::File::options()
            .write(true)
            .open(&path)
            .unwrap()
            .set_modified(time)
            .unwrap();
    }

    fn build(&self) -> Output {
        let cargo = env::var_os("CARGO").unwrap_or("cargo".into());
        let mut command = Command::new(cargo);
        command
            .args(["build", "--offline", "--color=never"])
            .current_dir(&self.folder);
        command.env("CARGO_TARGET_DIR", &self.target);
        command.output().unwrap()
    }

    /// Builds and runs: the coefficient by each way, and whether anything was compiled.
    #[track_caller]
    fn coefficients(&self) -> ([String; 2], bool) {
        let build = self.build();
        let messages = String::from_utf8(build.stderr).unwrap();
        assert!(build.status.success(), "{messages}");
        let program = self
            .target
            .join("debug")
            .join(format!("rebuild{}", env::consts::EXE_SUFFIX));
        let run = Command::new(program).output().unwrap();
        let text = String::from_utf8(run.stdout).unwrap();
        let (by_macro, by_build_script) = text.trim().split_once(' ').unwrap();
        (
            [by_macro.to_owned(), by_build_script.to_owned()],
            messages.contains("Compiling rebuild "),
        )
    }

    /// Builds in vain: what cargo says.
    #[track_caller]
    fn refusal(&self) -> String {
        let build = self.build();
        let messages = String::from_utf8(build.stderr).unwrap();
        assert!(!build.status.success(), "{messages}");
        messages
    }
}

#[test]
fn editing_an_airframe_rebuilds() {
    let package = Package::new();
    let past = SystemTime::now() - Duration::from_secs(3600);
    package.edit("by-macro.toml", COEFFICIENT, past);
    package.edit("by-build-script.toml", COEFFICIENT, past);
    let original = || [COEFFICIENT.to_owned(), COEFFICIENT.to_owned()];
    assert_eq!(package.coefficients(), (original(), true));
    // Nothing was edited, nothing is compiled.
    assert_eq!(package.coefficients(), (original(), false));

    let soon = || SystemTime::now() + Duration::from_secs(2);
    let line = package
        .airframe
        .lines()
        .position(|line| line.contains(COEFFICIENT))
        .unwrap();
    let column = package
        .airframe
        .lines()
        .nth(line)
        .unwrap()
        .find(COEFFICIENT)
        .unwrap();
    for (way, file) in ["by-macro.toml", "by-build-script.toml"].into_iter().enumerate() {
        let mut expected = original();
        expected[way] = EDITED.to_owned();
        package.edit(file, EDITED, soon());
        assert_eq!(package.coefficients(), (expected, true), "{file}");

        package.edit(file, FAULT, soon());
        let place = format!("{file}:{}:{}\n", line + 1, column + 1);
        // A second build says it again.
        for messages in [package.refusal(), package.refusal()] {
            assert!(messages.contains(&place), "no {place} in\n{messages}");
            assert!(
                messages.contains("`pair.thrust_n[0]` is a string, not a number"),
                "{messages}"
            );
        }
        package.edit(file, COEFFICIENT, soon());
        assert_eq!(package.coefficients(), (original(), true), "{file}");
    }
}
