//! Draws the pictures of `docs/`: `cargo pictures`.

use std::error::Error;
use std::fs;
use std::path::Path;

use mixer_compiler::Source;
use mixer_files::report::pictures;

fn main() -> Result<(), Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let path = root.join("airframes/isae-x8.toml");
    let source = Source::new(path.display().to_string(), fs::read_to_string(&path)?);
    let compiled = mixer_compiler::compile(&source).map_err(|faults| faults.to_string())?;
    for (name, text) in pictures::pictures(&compiled) {
        fs::write(root.join("docs").join(name), text)?;
    }
    let flown = fs::read_to_string(root.join("tests/measurements/flights/yaw-step.csv"))?;
    let mut rows = flown
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| line.split(',').collect::<Vec<_>>());
    let header = rows.next().ok_or("no flights")?;
    let mut mixers: Vec<(String, Vec<[f64; 2]>)> = header[1..]
        .iter()
        .map(|name| (name.trim().to_owned(), Vec::new()))
        .collect();
    for row in rows {
        let time_s = row[0].parse()?;
        for ((_, points), cell) in mixers.iter_mut().zip(&row[1..]) {
            points.push([time_s, cell.parse()?]);
        }
    }
    fs::write(root.join("docs/yaw-step.svg"), pictures::yaw_step(&mixers))?;
    Ok(())
}
