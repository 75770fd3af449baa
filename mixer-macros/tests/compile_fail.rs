//! What the macro says of input that it cannot use, `ui/<case>.rs`, and of airframes with warnings, `warned/<case>.rs`: what the
//! compiler says is in the `.stderr` beside it. `MIXER_BLESS=1` writes those anew.
//!
//! The compiler is called by itself, with the macro that cargo has built for this test: nothing is compiled a
//! second time.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// The library of this name that cargo has built last, beside this test.
fn built(prefix: &str, name: &str, suffix: &str) -> PathBuf {
    let folder = env::current_exe().unwrap().parent().unwrap().to_owned();
    let start = format!("{prefix}{name}-");
    let files = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path());
    let libraries = files.filter(|path| {
        let file = path.file_name().unwrap_or_default().to_string_lossy();
        file.starts_with(&start) && file.ends_with(suffix)
    });
    libraries
        .max_by_key(|path| path.metadata().unwrap().modified().unwrap())
        .unwrap_or_else(|| panic!("no {name} in {}", folder.display()))
}

/// The status of the compiler, and what it says of a case, without blanks at the ends of lines.
fn compiled(case: &Path, options: &[&str]) -> (bool, String) {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let macros = built(env::consts::DLL_PREFIX, "mixer_macros", env::consts::DLL_SUFFIX);
    let runtime = built("lib", "mixer_rt", ".rlib");
    let output = Command::new(env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()))
        .current_dir(package)
        .env("CARGO_MANIFEST_DIR", package)
        .args([
            "--edition",
            "2024",
            "--emit",
            "metadata",
            "--color",
            "never",
            "-o",
        ])
        .arg(Path::new(env!("CARGO_TARGET_TMPDIR")).join("case"))
        .arg("-L")
        .arg(macros.parent().unwrap())
        .arg(format!("--extern=mixer_macros={}", macros.display()))
        .arg(format!("--extern=mixer_rt={}", runtime.display()))
        .args(options)
        .arg(case.strip_prefix(package).unwrap())
        .output()
        .unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    let lines = said.lines().map(|line| line.trim_end().to_owned() + "\n");
    (output.status.success(), lines.collect())
}

/// The cases of a folder.
fn cases(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(folder);
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    files
        .filter(|path| path.extension().is_some_and(|end| end == "rs"))
        .collect()
}

/// Compares what is said of a case with the file beside it.
#[track_caller]
fn hold(case: &Path, said: &str) {
    let expected = case.with_extension("stderr");
    if env::var_os("MIXER_BLESS").is_some() {
        fs::write(&expected, said).unwrap();
    }
    let held = fs::read_to_string(&expected).unwrap_or_default();
    assert_eq!(said, held, "{}", case.display());
}

#[test]
fn refusals_of_the_macro() {
    let cases = cases("ui");
    assert!(cases.len() >= 5, "{cases:?}");
    for case in cases {
        let (is_compiled, said) = compiled(&case, &[]);
        assert!(!is_compiled, "{} compiles:\n{said}", case.display());
        // The last lines count the errors.
        let errors = said.split("\nerror: aborting due to").next().unwrap_or_default();
        hold(&case, &(errors.trim_end().to_owned() + "\n"));
    }
}

/// Also where a build denies or forbids warnings; where deprecations are allowed, nothing is said.
#[test]
fn warnings_of_the_macro_break_no_build() {
    let cases = cases("warned");
    assert!(!cases.is_empty());
    for case in cases {
        for options in [&[][..], &["-Dwarnings"], &["-Fwarnings"]] {
            let (is_compiled, said) = compiled(&case, options);
            assert!(is_compiled, "{options:?} {said}");
            assert!(said.contains("warning[MIX"), "{options:?} {said}");
        }
        hold(&case, &compiled(&case, &[]).1);
        assert_eq!(compiled(&case, &["-Adeprecated"]), (true, String::new()));
    }
}
