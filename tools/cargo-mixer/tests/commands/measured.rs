//! Measurements on bench data, held in `tests/measurements/`: the tables of the documents are made
//! from them.

use std::fs;
use std::path::Path;

/// Holds the file to this text. `tests/run --stage bench-data` has it written instead.
pub(crate) fn hold(name: &str, text: &str) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/measurements");
    let path = folder.join(name);
    let fault = |error: std::io::Error| format!("{}: {error}", path.display());
    if std::env::var_os("MIXER_MEASUREMENTS").is_some_and(|word| word == "write") {
        fs::write(&path, text).map_err(fault).expect("written");
    }
    let held = fs::read_to_string(&path).map_err(fault).expect("a measurement");
    assert_eq!(
        held, text,
        "run `tests/run --stage bench-data` and `cargo tables`"
    );
}
