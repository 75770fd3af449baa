//! Writes the tables of the documents from the airframes and the measurements held: `cargo
//! tables`.

use std::fs;
use std::process::ExitCode;

use mixer_tests::{documents, root};

fn main() -> ExitCode {
    match write() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn write() -> Result<(), String> {
    for table in documents::tables()? {
        let path = root().join(table.page);
        let fault = |error: std::io::Error| format!("{}: {error}", path.display());
        let page = fs::read_to_string(&path).map_err(fault)?;
        let filled = documents::filled(&page, &table)?;
        if filled != page {
            println!("written {}: {}", table.page, table.name);
            fs::write(&path, filled).map_err(fault)?;
        }
    }
    Ok(())
}
