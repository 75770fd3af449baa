//! Bad input: one clear error, nothing written.

use std::fs;
use std::path::Path;

use crate::{Folder, library, root};

/// A file with the X8's contents under another name.
fn renamed(folder: &Folder, file: &str, name: &str) -> String {
    let text = fs::read_to_string(root().join("airframes/isae-x8.toml")).unwrap();
    let path = folder.join(file);
    fs::write(&path, text.replacen("\"isae-x8\"", &format!("\"{name}\""), 1)).unwrap();
    path.display().to_string()
}

/// What the command says, the first line of it; the folder is neither made nor written to.
#[track_caller]
fn refused(arguments: &[&str], environment: &[(&str, &str)], output: &Path) -> String {
    let before = output.is_dir().then(|| fs::read_dir(output).unwrap().count());
    let run = library(arguments, output)
        .envs(environment.iter().copied())
        .output()
        .unwrap();
    let said = String::from_utf8(run.stderr).unwrap();
    assert_eq!(run.status.code(), Some(1), "{said}");
    assert_eq!(said.matches("error").count(), 1, "{said}");
    let after = output.is_dir().then(|| fs::read_dir(output).unwrap().count());
    assert_eq!(before, after, "{said}");
    said
}

const X8: &str = "airframes/isae-x8.toml";

#[test]
fn bad_input_is_refused_with_one_error() {
    let folder = Folder::new("refusals");
    let output = folder.join("out");
    let said = refused(&[X8, "--target", "thumbv7em-none-eabihard"], &[], &output);
    assert!(
        said.contains("no target `thumbv7em-none-eabihard`") && said.contains("thumbv7em-none-eabihf"),
        "{said}"
    );
    let said = refused(&[X8, "--target", "x86_64-pc-windows-msvc"], &[], &output);
    assert!(said.contains("is for windows"), "{said}");

    let said = refused(&[X8], &[("RUSTC", "/nonexistent/rustc")], &output);
    assert!(said.contains("no rustc") && said.contains("rustup.rs"), "{said}");

    let string = renamed(&folder, "string.toml", "string");
    let said = refused(&[&string], &[], &output);
    assert!(
        said.contains("`string`, which is a header of the C library"),
        "{said}"
    );
    let twin = renamed(&folder, "twin.toml", "isae_x8");
    let said = refused(&[X8, &twin], &[], &output);
    assert!(
        said.contains("isae-x8.toml and twin.toml are both `isae_x8`"),
        "{said}"
    );

    let file = folder.join("file");
    fs::write(&file, "").unwrap();
    assert!(refused(&[X8], &[], &file).contains("is a file; name a folder"));
    let nowhere = folder.join("none/none");
    assert!(refused(&[X8], &[], &nowhere).contains("there is no folder"));
}

#[test]
fn a_place_that_is_taken_leaves_the_rest_as_it_was() {
    let folder = Folder::new("taken");
    let output = folder.join("out");
    fs::create_dir_all(output.join("isae_x8.h")).unwrap();
    assert!(refused(&[X8], &[], &output).contains("isae_x8.h: is a folder"));
}
