//! Prints what a mix costs on a Cortex-M4F, counted in QEMU.
//!
//! ```text
//! cargo counts                      all subjects
//! cargo counts isae-x8 regular-3    only these airframes
//! cargo counts c-interface,isae-x8  only this row, named as tests/counts.csv names it
//! cargo counts --search [..]        the same, after a search for more expensive requests
//! cargo counts --bless              all; writes tests/counts.csv, tests/worst.csv and docs/costs.md
//! cargo counts --page               counts nothing; writes docs/costs.md from tests/counts.csv
//! ```
//!
//! With --search --bless what was found is written, too. It may be stopped: started again, it searches only
//! where it had not.

use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;
use std::time::Instant;

use mixer_tests::counts::worst::{self, Found, Request};
use mixer_tests::counts::{self, Images, Row, Subject};
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
        return write(&counts::page(), &counts::document(&compiler, &rows));
    }
    let toolchain = Toolchain::find()?;
    let mut flag = |flag: &str| {
        let before = named.len();
        named.retain(|name| name != flag);
        named.len() < before
    };
    let (bless, search) = (flag("--bless"), flag("--search"));
    if bless && !named.is_empty() {
        return Err("--bless writes all counts: name no airframe".into());
    }
    let airframes = mixer_tests::airframes().map_err(|error| format!("airframes/: {error}"))?;
    let mut subjects = counts::all(&airframes);
    subjects.retain(|Subject { mixer, airframe }| {
        named.is_empty() || named.contains(airframe) || named.contains(&format!("{mixer},{airframe}"))
    });
    if subjects.is_empty() {
        return Err(format!(
            "no airframe and no row of these names: {}",
            named.join(" ")
        ));
    }

    println!("{}", toolchain.compiler);
    println!(
        "{:<13} {:<26} {:>10} {:>10} {:>7} {:>6} {:>6} {:>6}",
        "instructions", "", "attainable", "saturated", "worst", "bytes", "", ""
    );
    println!(
        "{:<13} {:<26} {:>10} {:>10} {:>7} {:>6} {:>6} {:>6}",
        "mixer", "airframe", "mean", "mean", "found", "code", "tables", "stack"
    );
    let (rows, found) = measure(&toolchain, &subjects, search)?;
    for row in &rows {
        if named.contains(&format!("{},{}", row.subject.mixer, row.subject.airframe)) {
            println!("{row}");
        }
    }
    if bless {
        write(&worst::file(), &worst::text(&found))?;
        write(&counts::file(), &counts::text(&toolchain.compiler, &rows))?;
        write(&counts::page(), &counts::document(&toolchain.compiler, &rows))?;
    }
    Ok(())
}

/// Measures all subjects, one on each core, and prints each when it and those before it are done.
/// Returns their rows and the requests that are in them beside the sets.
fn measure(toolchain: &Toolchain, subjects: &[Subject], search: bool) -> Result<(Vec<Row>, Found), String> {
    let empty = Image::read(&toolchain.build("size", &Variant::default())?)?;
    let held = worst::held()?;
    let one = |subject: &Subject| -> Result<(Row, Vec<Request>), String> {
        let images = Images::build(toolchain, subject)?;
        let mut given = worst::of(&held, subject);
        let mut most = 0;
        if search {
            let found = images.search(&given)?;
            most = found.first().map_or(0, |(cost, _)| *cost);
            given = found.into_iter().map(|(_, request)| request).collect();
        }
        let row = images.measure(&empty, &given)?;
        if row.get("worst_found") < most {
            return Err(format!("{subject:?}: {most} found, less when counted again"));
        }
        Ok((row, given))
    };
    let started = Instant::now();
    let next = AtomicUsize::new(0);
    let workers = thread::available_parallelism().map_or(1, usize::from);
    let (sender, receiver) = mpsc::channel();
    thread::scope(|scope| {
        for _ in 0..workers {
            let sender = sender.clone();
            let (next, one) = (&next, &one);
            scope.spawn(move || {
                while let Some((index, subject)) = {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    subjects.get(index).map(|subject| (index, subject))
                } {
                    // Nobody listens after a fault.
                    if sender.send((index, one(subject))).is_err() {
                        break;
                    }
                }
            });
        }
        drop(sender);
        let mut done: Vec<Option<(Row, Vec<Request>)>> = vec![None; subjects.len()];
        let (mut rows, mut found) = (Vec::new(), Found::new());
        for (count, (index, measured)) in (1..).zip(receiver) {
            done[index] = Some(measured?);
            eprintln!(
                "{count} of {} after {} s",
                subjects.len(),
                started.elapsed().as_secs()
            );
            while let Some((row, requests)) = done.get_mut(rows.len()).and_then(Option::take) {
                print_row(&row);
                found.extend(requests.into_iter().map(|request| (row.subject.clone(), request)));
                rows.push(row);
            }
        }
        Ok((rows, found))
    })
}

fn print_row(row: &Row) {
    println!(
        "{:<13} {:<26} {:>10.0} {:>10.0} {:>7} {:>6} {:>6} {:>6}",
        row.subject.mixer,
        row.subject.airframe,
        row.mean("attainable"),
        row.mean("saturated"),
        row.get("worst_found"),
        row.get("code_b"),
        row.get("tables_b"),
        row.get("stack_b")
    );
}

fn write(path: &std::path::Path, text: &str) -> Result<(), String> {
    std::fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))
}
