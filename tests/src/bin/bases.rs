//! Compares the three bases on real bench maps and writes `tests/measurements/bases.csv`:
//! `MIXER_BENCH_DATA=FOLDER cargo bases`.

use std::path::Path;
use std::process::ExitCode;

use mixer_tests::bases;

fn main() -> ExitCode {
    let Some(data) = std::env::var_os("MIXER_BENCH_DATA") else {
        eprintln!("error: MIXER_BENCH_DATA is not set; it names the folder of the bench files");
        return ExitCode::FAILURE;
    };
    let path = bases::file();
    let written = bases::measure(Path::new(&data)).and_then(|rows| {
        let text = bases::text(&rows);
        print!("{text}");
        std::fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))
    });
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
