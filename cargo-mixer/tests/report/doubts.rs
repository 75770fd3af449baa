//! A bench of another pair, or at another voltage, is told on stderr and on the page.

use super::*;

/// A bench of the paper's pair whose thrust is `strong` times the model's, at one voltage.
fn page_with_bench(name: &str, strong: f64, volts: f64) -> (String, String) {
    let compiled = x8();
    let study = Study::new(&compiled, None);
    let voltage = compiled.airframe.voltage.as_ref().unwrap();
    let mut bench = String::from("upper,lower,thrust_n,torque_nm,voltage_v\n");
    for k in 0..100 {
        let throttles = [k / 10, k % 10].map(|step| 0.1 * f64::from(step + 1));
        let [f, q] = study.pair.efforts(throttles);
        let [u, l] = throttles;
        let (f, q) = (
            strong * voltage.thrust_factor(volts) * f,
            voltage.torque_factor(volts) * q,
        );
        bench.push_str(&format!("{u},{l},{f},{q},{volts}\n"));
    }
    let [file, output] = [format!("{name}.csv"), format!("{name}.html")].map(|file| scratch(&file));
    fs::write(&file, bench).unwrap();
    let [file, output] = [file, output].map(|path| path.display().to_string());
    let run = cargo_mixer(&[
        "report",
        "airframes/isae-x8.toml",
        "-o",
        &output,
        "--bench",
        &file,
    ]);
    assert_eq!(run.status.code(), Some(0));
    let told = String::from_utf8(run.stderr).unwrap();
    let warnings = told.strip_suffix(&format!("wrote {output}\n")).unwrap();
    (warnings.to_owned(), fs::read_to_string(&output).unwrap())
}

#[test]
fn a_bench_of_the_pair_is_not_doubted() {
    let (told, page) = page_with_bench("own", 1.03, 14.0);
    assert!(told.is_empty() && !page.contains("Warning:"), "{told}");
}

#[test]
fn a_bench_of_another_pair_is_told() {
    let (told, page) = page_with_bench("other", 1.3, 14.0);
    assert!(
        told.starts_with("warning: the model misses the bench\u{2019}s thrust by "),
        "{told}"
    );
    assert_eq!(told.lines().count(), 1, "{told}");
    assert!(page.contains("<b>Warning:</b> the model misses the bench\u{2019}s thrust by "));
}

#[test]
fn a_voltage_outside_the_range_is_told() {
    let (told, page) = page_with_bench("voltage", 1.0, 11.1);
    let warning = "100 of 100 bench points were measured outside the airframe\u{2019}s 12.8 to 16.8 V";
    assert_eq!(told, format!("warning: {warning}\n"));
    assert!(page.contains(warning));
}
