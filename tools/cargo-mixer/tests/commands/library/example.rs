//! `examples/c`, built in a folder of its own by make and by CMake.

use std::fs;
use std::process::Command;

use super::{Folder, root, run};

/// A copy of the example.
fn copy(test: &str) -> Folder {
    let folder = Folder::new(test);
    for name in ["CMakeLists.txt", "Makefile", "control.c", "control.h", "main.c"] {
        fs::copy(root().join("examples/c").join(name), folder.join(name)).unwrap();
    }
    folder
}

#[test]
fn make_builds_and_flies_the_example() {
    let folder = copy("example-make");
    let airframe = root().join("airframes/isae-x8.toml").canonicalize().unwrap();
    let mut make = Command::new("make");
    make.args(["run", "selftest", "CFLAGS=-O2 -Wall -Wextra -Werror -pedantic"]);
    make.arg(format!("CARGO_MIXER={}", env!("CARGO_BIN_EXE_cargo-mixer")));
    make.arg(format!("AIRFRAME={}", airframe.display()));
    let output = run(make.current_dir(&folder.0));
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("held 43, disarmed 60 cycles"), "{text}");
    assert!(text.contains("isae_x8: 178 rows, 0 different"), "{text}");
}

#[test]
fn cmake_links_the_imported_target() {
    let folder = copy("example-cmake");
    run(&mut super::library(
        &["airframes/isae-x8.toml"],
        &folder.join("lib"),
    ));
    let cmake =
        |arguments: &[&str], program: &str| run(Command::new(program).args(arguments).current_dir(&folder.0));
    cmake(
        &["-B", "build", "-DCMAKE_C_FLAGS=-Wall -Wextra -Werror -pedantic"],
        "cmake",
    );
    cmake(&["--build", "build"], "cmake");
    cmake(&["--test-dir", "build"], "ctest");
}
