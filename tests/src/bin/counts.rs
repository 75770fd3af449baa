//! Prints what a mix costs on a Cortex-M4F, counted in QEMU.
//!
//! ```text
//! cargo xtask counts                      all subjects
//! cargo xtask counts isae-x8 regular-3    only these airframes
//! cargo xtask counts c-interface,isae-x8  only this row, named as tests/counts.csv names it
//! cargo xtask counts --bless              all; writes tests/counts.csv and what --fit writes
//! cargo xtask counts --fit                counts nothing; writes docs/costs.md and the compiler's
//!                                         model of cost from tests/counts.csv
//! ```

use std::process::ExitCode;

use mixer_tests::counts::{self, Row, Subject};
use mixer_tests::firmware::{Toolchain, Variant};
use mixer_tests::image::Image;
use mixer_tests::overhead;

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
    if named == ["--fit"] {
        let (compiler, rows) = counts::held()?;
        return fit(&compiler, &rows);
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
        fit(&toolchain.compiler, &rows)?;
    }
    Ok(())
}

/// Writes the page of counts, fits the compiler's model to them, writes it and says how well it
/// does.
fn fit(compiler: &str, rows: &[Row]) -> Result<(), String> {
    let page = counts::page();
    std::fs::write(&page, counts::document(compiler, rows))
        .map_err(|error| format!("{}: {error}", page.display()))?;
    let samples = overhead::samples(rows)?;
    let counted = overhead::fit(&samples)?;
    overhead::write(compiler, &counted)?;
    println!("{:<17} {:<10} {:>9} {:>7}", "", "", "counted", "model");
    for sample in &samples {
        for &quantity in sample.quantities() {
            let value = sample.counted(quantity);
            let error = 100.0 * sample.error(&counted, quantity);
            println!(
                "{:<17} {:<10} {value:>9.0} {error:>+6.1}%",
                sample.airframe,
                format!("{quantity:?}").to_lowercase()
            );
        }
    }
    Ok(())
}
