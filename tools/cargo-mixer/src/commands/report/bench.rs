//! Bench files for the report page, read as `identify` reads them.

use mixer_files::report::bench::BenchPoints;
use mixer_files::report::study::Study;
use mixer_identify::bench::BenchKind;
use mixer_identify::fit::balance::balanced;
use mixer_identify::identified::Settings;
use mixer_identify::refusal::Refusal;
use mixer_identify::texts::{Text, read as ready};

/// Reads bench files of the airframe's pair.
///
/// # Errors
/// A file that cannot be read, or that holds a single rotor.
pub(super) fn read(study: &Study<'_>, files: &[Text], settings: &Settings) -> Result<BenchPoints, Refusal> {
    let mut bench = BenchPoints::default();
    for file in files {
        add(&mut bench, study, file, settings)?;
    }
    Ok(bench)
}

fn add(points: &mut BenchPoints, study: &Study<'_>, file: &Text, settings: &Settings) -> Result<(), Refusal> {
    let mut bench = ready(file, settings)?;
    if study.compiled.airframe.voltage.is_some() {
        bench = balanced(&bench);
    }
    if bench.kind != BenchKind::Pair {
        return Err(Refusal::of(
            bench.file,
            "one rotor alone says nothing about the pair",
            "a sweep of both throttles",
        ));
    }
    for point in &bench.points {
        let voltage_v = Some(point.voltage).filter(|volts| volts.is_finite());
        let (throttles, measured) = ([point.u, point.l], [point.thrust, point.torque]);
        points.add(study, point.line, throttles, measured, voltage_v);
    }
    let refused = bench.refused_rows.iter().map(ToString::to_string);
    points.refused.extend(refused);
    points.files.push(bench.file);
    Ok(())
}
