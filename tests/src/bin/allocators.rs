//! Compares allocators on attainable wrenches and writes `tests/measurements/allocators.csv`:
//! `cargo allocators`.

use std::process::ExitCode;

use mixer_tests::allocators;

fn main() -> ExitCode {
    let path = allocators::file();
    let written = allocators::measure().and_then(|rows| {
        let text = allocators::text(&rows);
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
