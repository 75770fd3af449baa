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
    assert!(
        said.contains("no rustc at /nonexistent/rustc") && said.contains("rustup.rs"),
        "{said}"
    );
    let said = refused(&[X8], &[("PATH", "/nonexistent")], &output);
    assert!(
        said.contains("no rustc: ") && said.contains("rustup.rs"),
        "{said}"
    );

    for (name, fault) in [("8x", "does not start with a letter"), ("größe", "`ö`")] {
        let file = renamed(&folder, "name.toml", name);
        let said = refused(&[&file], &[], &output);
        assert!(said.contains(fault), "{said}");
    }
    for name in [
        "string", "features", "sched", "malloc", "poll", "time", "signal", "arm-neon", "pthread",
    ] {
        let file = renamed(&folder, "header.toml", name);
        let said = refused(&[&file], &[], &output);
        let module = name.replace('-', "_");
        let what = format!("`{module}`, which is a header of the C compiler or its library");
        assert!(said.contains(&what), "{said}");
    }
    for (name, what) in [
        ("nosys", "a library of the C compiler"),
        ("rebuild-cache", "a target of CMake"),
        ("coaxial-mixer", "what all airframes share, coaxial_mixer.h"),
    ] {
        let file = renamed(&folder, "taken.toml", name);
        let said = refused(&[&file], &[], &output);
        assert!(said.contains(what), "{said}");
    }
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

/// Nobody may write into /proc, root included.
#[test]
#[cfg(target_os = "linux")]
fn a_folder_that_cannot_be_written_is_named() {
    for (folder, fault) in [
        ("/proc/self/task", "/proc/self/task: nothing can be written there"),
        ("/proc/coaxial-mixer", "/proc/coaxial-mixer: cannot be made"),
    ] {
        let run = library(&[X8], Path::new(folder)).output().unwrap();
        let said = String::from_utf8(run.stderr).unwrap();
        assert_eq!(run.status.code(), Some(1), "{said}");
        assert!(said.contains(fault) && said.lines().count() == 1, "{said}");
    }
}

/// A compiler that answers as another would.
#[cfg(unix)]
fn compiler(folder: &Folder, answers: &str) -> String {
    use std::os::unix::fs::PermissionsExt as _;

    let path = folder.join("rustc");
    let script = format!("#!/bin/sh\ncase \"$*\" in\n{answers}\nesac\nexec rustc \"$@\"\n");
    fs::write(&path, script).unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    path.display().to_string()
}

#[test]
#[cfg(unix)]
fn what_the_compiler_lacks_is_named_with_how_to_get_it() {
    let folder = Folder::new("compilers");
    let output = folder.join("out");
    let target = "thumbv7m-none-eabi";
    let bare = compiler(&folder, "*target-libdir* | *sysroot*) echo /nonexistent; exit ;;");
    let said = refused(&[X8, "--target", target], &[("RUSTC", &bare)], &output);
    for part in [
        "has no `core` for thumbv7m-none-eabi",
        "rustup target add thumbv7m-none-eabi",
        "rustup component add rust-src",
        "apt-get install rustc-web rust-web-src",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    let old = compiler(
        &folder,
        "-vV) echo 'release: 1.63.0'; echo 'host: x86_64-unknown-linux-gnu'; exit ;;",
    );
    let said = refused(&[X8], &[("RUSTC", &old)], &output);
    assert!(
        said.contains("is 1.63.0: the mixer needs ") && said.contains("rustup update"),
        "{said}"
    );
}

#[test]
fn a_place_that_is_taken_leaves_the_rest_as_it_was() {
    let folder = Folder::new("taken");
    let output = folder.join("out");
    fs::create_dir_all(output.join("isae_x8.h")).unwrap();
    assert!(refused(&[X8], &[], &output).contains("isae_x8.h: is a folder"));
}
