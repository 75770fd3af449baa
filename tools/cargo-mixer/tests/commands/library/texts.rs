//! Text of an airframe file in comments of the generated Rust and C.

use std::fs;
use std::process::Command;

use super::{Folder, library, root, run};

/// What ends or begins comments, strings and lines in either language, and what they escape by.
const DESCRIPTION: &str = "*/ /* // /// */ ??/ \\ \"#\" 'é' <b> [x] {} @M@ 飛 ends in a backslash \\";

#[test]
#[cfg(unix)]
fn any_text_compiles() {
    let folder = Folder::new("texts");
    let text = fs::read_to_string(root().join("airframes/single-pair.toml")).unwrap();
    let lines = text.lines().filter(|line| !line.starts_with("description"));
    let text: Vec<&str> = lines.collect();
    let description = toml::Value::from(DESCRIPTION);
    // No `/` can be in a file's name.
    let file = folder.join("*?? `a\u{1b}\u{202e}\"\n#error\\.toml");
    fs::write(
        &file,
        format!("description = {description}\n{}\n", text.join("\n")),
    )
    .unwrap();
    // The generated Rust is compiled on the way.
    run(&mut library(
        &[&file.display().to_string(), "--health"],
        &folder.0,
    ));
    for [driver, standard] in [["gcc", "-std=c99"], ["gcc", "-std=c17"], ["g++", "-std=c++11"]] {
        let mut command = Command::new(driver);
        command.args([standard, "-Wall", "-Wextra", "-Werror", "-pedantic", "-trigraphs"]);
        if driver == "g++" {
            command.args(["-x", "c++"]);
        }
        run(command
            .arg("-fsyntax-only")
            .arg(folder.join("single_pair_selftest.c")));
    }
    for name in ["single_pair.h", "single_pair.cmake", "single_pair_selftest.c"] {
        let text = fs::read_to_string(folder.join(name)).unwrap();
        let acting = |c: char| c != '\n' && (c.is_control() || c == '\u{202e}');
        assert!(!text.contains(acting), "{name}: {text}");
    }
    let cmake = fs::read_to_string(folder.join("single_pair.cmake")).unwrap();
    assert!(!cmake.lines().any(|line| line.starts_with("#error")), "{cmake}");
    let header = fs::read_to_string(folder.join("single_pair.h")).unwrap();
    assert!(
        header.contains("ends in a backslash") && header.contains("飛"),
        "{header}"
    );
}
