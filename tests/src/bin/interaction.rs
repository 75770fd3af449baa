//! Predicts real pairs from runs of one rotor and writes `interaction*.csv` of `tests/measurements`:
//! `MIXER_BENCH_DATA=FOLDER cargo interaction`.

use std::path::Path;
use std::process::ExitCode;

use mixer_tests::interaction;

fn main() -> ExitCode {
    let Some(data) = std::env::var_os("MIXER_BENCH_DATA") else {
        eprintln!("error: MIXER_BENCH_DATA is not set; it names the folder of the bench files");
        return ExitCode::FAILURE;
    };
    let written = interaction::measure(Path::new(&data)).and_then(|measured| {
        for (path, text) in interaction::files().iter().zip(measured.texts()) {
            print!("{text}");
            std::fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))?;
        }
        Ok(())
    });
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
