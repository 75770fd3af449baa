//! Maps at several voltages: exponents and the map at the reference voltage.

use mixer_compiler::airframe::Basis;
use mixer_identify::bench::Bench;
use mixer_identify::fragment;
use mixer_identify::identified::from_benches;

use super::sweep::{bench, plain, rows, settings};
use mixer_identify::paper::{THRUST, TORQUE};

/// The sweep at `volts`, sagging by `sag` V times the mean square of throttle, thrust following 1.7
/// and torque 1.9.
fn map(name: &str, volts: f64, sag: f64, seed: u64) -> Bench {
    let mut rows = rows(seed);
    for r in &mut rows {
        r.voltage = volts - sag * 0.5 * (r.u * r.u + r.l * r.l);
        r.thrust = r.thrust.map(|f| f * libm::pow(r.voltage / 14.8, 1.7));
        r.torque = r.torque.map(|q| q * libm::pow(r.voltage / 14.8, 1.9));
    }
    bench(name, &plain(&rows), &settings(None)).expect("a bench")
}

#[test]
fn two_voltages_give_exponents_and_one_map() {
    let mut settings = settings(Some(Basis::Biquadratic));
    settings.wishes.reference_v = Some(14.8);
    let found = from_benches(
        vec![map("a.csv", 16.4, 0.6, 1), map("b.csv", 12.9, 0.6, 2)],
        &settings.wishes,
    );
    let found = found.expect("a pair");
    let voltage = found.voltage.as_ref().expect("voltages");
    let (f, q) = (
        voltage.thrust.estimate().expect("thrust"),
        voltage.torque.estimate().expect("torque"),
    );
    assert!((f.exponent - 1.7).abs() < 2.0 * f.ci95 && f.ci95 < 0.05, "{f:?}");
    assert!((q.exponent - 1.9).abs() < 2.0 * q.ci95 && q.ci95 < 0.2, "{q:?}");
    let pair = found.pair.as_ref().expect("a pair");
    assert_eq!((pair.normalised_to_v, pair.thrust.points), (Some(14.8), 200));
    for (c, ci, truth) in [
        (&pair.thrust_n, &pair.thrust.ci95, THRUST),
        (&pair.torque_nm, &pair.torque.ci95, TORQUE),
    ]
    .into_iter()
    .flat_map(|(c, ci, t)| (0..8).map(move |k| (c[k], ci[k], t[k])))
    {
        assert!((c - truth).abs() < 2.0 * ci, "{c} {truth} {ci}");
    }
    let text = fragment::text(&found);
    let table: toml::Table = text.parse().expect("TOML");
    let v = &table["voltage"];
    assert_eq!(v["reference_v"].as_float(), Some(14.8));
    assert!((v["thrust_exponent"].as_float().expect("a number") - f.exponent).abs() < 5e-4 + 1e-12);
    let range = v["range_v"].as_array().expect("an array");
    assert!(
        range[0].as_float() < Some(12.31) && range[1].as_float() > Some(16.39),
        "{range:?}"
    );
}

#[test]
fn sag_in_one_map_gives_no_exponent_and_is_told() {
    let found = from_benches(vec![map("a.csv", 16.4, 3.0, 1)], &settings(None).wishes).expect("a pair");
    let voltage = found.voltage.as_ref().expect("voltages");
    assert!(voltage.thrust.estimate().is_none() && voltage.torque.estimate().is_none());
    assert!(
        found
            .warnings
            .iter()
            .any(|w| w.contains("confounded with throttle")),
        "{:?}",
        found.warnings
    );
    let text = fragment::text(&found);
    assert!(
        !text.parse::<toml::Table>().expect("TOML").contains_key("voltage"),
        "{text}"
    );
}

#[test]
fn thrust_alone_leaves_the_table_to_be_completed() {
    let file = |name: &str, volts: f64| {
        let row = |k: i32| {
            let u = 0.1 * f64::from(k);
            format!("{u},{},{volts}\n", 9.0 * u * u * libm::pow(volts / 14.8, 1.7))
        };
        let text: String = (1..=10).map(row).collect();
        bench(
            name,
            format!("upper,thrust_n,voltage_v\n{text}").as_bytes(),
            &settings(None),
        )
        .expect("a bench")
    };
    let single = vec![file("s1.csv", 12.0), file("s2.csv", 16.0)];
    let mut wishes = settings(None).wishes;
    wishes.run.diameter_m = Some(0.28);
    let alone = from_benches(single.clone(), &wishes).expect("a rotor");
    let text = fragment::text(&alone);
    let table: toml::Table = text.parse().expect("TOML");
    let thrust = &table["rotor"][0]["thrust_n"];
    let full: f64 = (0..3).map(|k| thrust[k].as_float().unwrap()).sum();
    let reference = alone.reference_v.expect("a reference");
    assert!(
        (full / (9.0 * libm::pow(reference / 14.8, 1.7)) - 1.0).abs() < 1e-3,
        "{text}"
    );
    assert!(
        !table.contains_key("voltage") && text.contains("# thrust_exponent = 1.7"),
        "{text}"
    );

    // Beside a pair an incomplete table would make the airframe invalid.
    let files = [vec![map("a.csv", 14.8, 0.0, 1)], single].concat();
    let found = from_benches(files, &settings(None).wishes).expect("a pair");
    assert!(
        found.warnings.iter().any(|w| w.contains("no torque exponent")),
        "{:?}",
        found.warnings
    );
    let text = fragment::text(&found);
    let table: toml::Table = text.parse().expect("TOML");
    assert!(
        table.contains_key("pair") && !table.contains_key("voltage"),
        "{text}"
    );
    assert!(text.contains("# thrust_exponent = 1.7"), "{text}");
}

#[test]
fn a_map_without_voltage_asks_for_its_reference() {
    let single = |name: &str, volts: f64| {
        let row = |k: i32| {
            let u = 0.1 * f64::from(k);
            let scale = u * u * libm::pow(volts / 14.8, 1.7);
            format!("{u},{},{},{volts}\n", 9.0 * scale, 0.1 * scale)
        };
        let text: String = (1..=10).map(row).collect();
        let text = format!("upper,thrust_n,torque_nm,voltage_v\n{text}");
        bench(name, text.as_bytes(), &settings(None)).expect("a bench")
    };
    let map = String::from_utf8(plain(&rows(1))).expect("text");
    let without: String = map
        .lines()
        .map(|l| format!("{}\n", l.rsplit_once(',').expect("a column").0))
        .collect();
    let map = bench("map.csv", without.as_bytes(), &settings(None)).expect("a bench");
    let files = vec![map, single("s1.csv", 12.0), single("s2.csv", 16.0)];
    let mut wishes = settings(None).wishes;
    let found = from_benches(files.clone(), &wishes).expect("a pair");
    assert!(
        found.warnings.iter().any(|w| w.contains("--reference-voltage")),
        "{:?}",
        found.warnings
    );
    let table: toml::Table = fragment::text(&found).parse().expect("TOML");
    assert!(!table.contains_key("voltage"));
    wishes.reference_v = Some(14.8);
    let found = from_benches(files, &wishes).expect("a pair");
    let table: toml::Table = fragment::text(&found).parse().expect("TOML");
    assert_eq!(table["voltage"]["reference_v"].as_float(), Some(14.8));
    assert_eq!(table["voltage"]["torque_exponent"].as_float(), Some(1.7));
}

#[test]
fn a_declared_exponent_brings_the_rows_to_the_reference() {
    let mut settings = settings(Some(Basis::Biquadratic));
    settings.wishes.reference_v = Some(14.8);
    settings.wishes.voltage_exponent = Some([1.7, 1.9]);
    let found = from_benches(vec![map("a.csv", 16.4, 3.0, 1)], &settings.wishes).expect("a pair");
    let pair = found.pair.as_ref().expect("a pair");
    assert_eq!(pair.normalised_to_v, Some(14.8));
    let truth = THRUST.into_iter().zip(&pair.thrust_n).zip(&pair.thrust.ci95);
    for ((truth, c), ci) in truth {
        assert!((c - truth).abs() < 2.0 * ci, "{c} {truth} {ci}");
    }
    let text = fragment::text(&found);
    let table: toml::Table = text.parse().expect("TOML");
    let v = &table["voltage"];
    assert_eq!(
        ["thrust_exponent", "torque_exponent"].map(|key| v[key].as_float()),
        [Some(1.7), Some(1.9)]
    );
    assert!(text.contains("exponent 1.7 as declared"), "{text}");
    assert!(text.contains("must be measured where the bench's was"), "{text}");
    let told = |part: &str| found.warnings.iter().any(|w| w.contains(part));
    assert!(
        told("sagged by 18.1 % within a map") && told("range_v is"),
        "{:?}",
        found.warnings
    );
}

#[test]
fn a_declared_exponent_that_the_files_contradict_is_told() {
    let mut wishes = settings(None).wishes;
    wishes.voltage_exponent = Some([1.6, 2.9]);
    let found = from_benches(
        vec![map("a.csv", 16.4, 0.6, 1), map("b.csv", 12.9, 0.6, 2)],
        &wishes,
    );
    let warnings = found.expect("a pair").warnings;
    let told = |part: &str| warnings.iter().any(|w| w.contains(part));
    assert!(
        told("declares 1.6 for thrust, the files themselves give 1.72") && told("declares 2.9 for torque"),
        "{warnings:?}"
    );
}
