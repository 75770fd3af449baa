//! Prints what a mix costs on a Cortex-M4F, counted in QEMU.
//!
//! ```text
//! cargo xtask counts                      all subjects
//! cargo xtask counts isae-x8 regular-3    only these airframes
//! cargo xtask counts c-interface,isae-x8  only this row, named as tests/counts.csv names it
//! cargo xtask counts --bless              all; writes tests/counts.csv and docs/costs.md
//! cargo xtask counts --page               counts nothing; writes docs/costs.md from tests/counts.csv
//! ```

use std::process::ExitCode;

use mixer_tests::counts::{self, Row, Subject};
use mixer_tests::firmware::{Toolchain, Variant};
use mixer_tests::image::Image;

fn main() -> ExitCode {
    match print() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn print() -> Result<(), String> {
    let mut named: Vec<String> = std::env::args().skip(1).collect();
    if named == ["--page"] {
        let (compiler, rows) = counts::held()?;
        return write_page(&compiler, &rows);
    }
    let toolchain = Toolchain::find()?;
    let bless = named.iter().any(|name| name == "--bless");
    named.retain(|name| name != "--bless");
    if bless && !named.is_empty() {
        return Err("--bless writes all counts: name no airframe".into());
    }
    let airframes = mixer_tests::airframes().map_err(|error| format!("airframes/: {error}"))?;
    let mut subjects = counts::all(&airframes);
    subjects.retain(|Subject { mixer, airframe }| {
        named.is_empty() || named.contains(airframe) || named.contains(&format!("{mixer},{airframe}"))
    });
    let empty = Image::read(&toolchain.build("size", &Variant::default())?)?;

    println!("{}", toolchain.compiler);
    println!(
        "{:<13} {:<17} {:>10} {:>7} {:>10} {:>7} {:>8} {:>6} {:>6} {:>6}",
        "instructions", "", "attainable", "", "saturated", "", "searched", "bytes", "", ""
    );
    println!(
        "{:<13} {:<17} {:>10} {:>7} {:>10} {:>7} {:>8} {:>6} {:>6} {:>6}",
        "mixer", "airframe", "mean", "worst", "mean", "worst", "worst", "code", "tables", "stack"
    );
    let mut rows = Vec::new();
    for subject in &subjects {
        let row = Row::measure(&toolchain, subject, &empty)?;
        println!(
            "{:<13} {:<17} {:>10.0} {:>7} {:>10.0} {:>7} {:>8} {:>6} {:>6} {:>6}",
            subject.mixer,
            subject.airframe,
            row.mean("attainable"),
            row.get("attainable_worst"),
            row.mean("saturated"),
            row.get("saturated_worst"),
            row.get("searched_worst"),
            row.get("code_b"),
            row.get("tables_b"),
            row.get("stack_b")
        );
        rows.push(row);
    }
    for row in &rows {
        if named.contains(&format!("{},{}", row.subject.mixer, row.subject.airframe)) {
            println!("{row}");
        }
    }
    if bless {
        let path = counts::file();
        std::fs::write(&path, counts::text(&toolchain.compiler, &rows))
            .map_err(|error| format!("{}: {error}", path.display()))?;
        write_page(&toolchain.compiler, &rows)?;
    }
    Ok(())
}

/// Writes the page of counts.
fn write_page(compiler: &str, rows: &[Row]) -> Result<(), String> {
    let page = counts::page();
    std::fs::write(&page, counts::document(compiler, rows))
        .map_err(|error| format!("{}: {error}", page.display()))
}
