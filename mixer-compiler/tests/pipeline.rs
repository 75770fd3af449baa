//! The stages after the file, on the paper's airframe and on variations of it.

use std::fs;
use std::path::Path;

use mixer_compiler::diagnostic::{Code, Diagnostics};
use mixer_compiler::{Compiled, Source};
use mixer_rt::Wrench;

/// `airframes/isae-x8.toml` with each `(from, to)` replaced.
fn isae_x8(replacements: &[(&str, &str)]) -> Result<Compiled, Diagnostics> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("airframes/isae-x8.toml");
    let mut text = fs::read_to_string(path).unwrap();
    for (from, to) in replacements {
        assert!(text.contains(from), "{from} is not in the file");
        text = text.replace(from, to);
    }
    mixer_compiler::compile(&Source::new("isae-x8.toml", text))
}

fn refused(replacements: &[(&str, &str)]) -> Diagnostics {
    isae_x8(replacements)
        .map(|compiled| compiled.airframe.name)
        .unwrap_err()
}

/// Rows of M as eq. (4) has them.
#[test]
fn effectiveness_is_equation_4() {
    let compiled = isae_x8(&[]).unwrap();
    let l = 0.3182;
    let expected = [
        [-l, l, l, -l, 0.0, 0.0, 0.0, 0.0],
        [l, l, -l, -l, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, 1.0, -1.0, 1.0, -1.0],
        [1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0],
    ];
    for (row, expected) in compiled.effectiveness.matrix.row_iter().zip(expected) {
        assert_eq!(row.iter().copied().collect::<Vec<_>>(), expected);
    }
    assert_eq!(compiled.effectiveness.rank, 4);
}

/// The figure of the paper's model: it folds below an idle of 0.08875.
#[test]
fn least_idle_is_where_the_model_folds() {
    assert_eq!(isae_x8(&[]).unwrap().of_pairs[0].least_idle, 0.08875);
    assert!(isae_x8(&[("min = 0.10", "min = 0.08875")]).is_ok());
    let faults = refused(&[("min = 0.10", "min = 0.0887")]);
    assert_eq!(faults.faults()[0].code, Code::Fold);
    assert!(faults.faults()[0].help.contains("0.08875"), "{faults}");
}

/// A request for thrust alone is delivered at both ends of the stated range and not beyond them, in
/// closed form and on the general path.
#[test]
fn bare_thrust_is_what_is_delivered() {
    let bent = [
        ("min = 0.10", "min = 0.25"),
        (
            "[5.2075, -2.1892, 12.3604, -10.2432, 4.4427, 2.7640, 12.2092, 0.2363]",
            "[0.0, 0.0, 14.0, 0.0, -4.8, 0.0, 10.0, 0.0]",
        ),
        (
            "[-0.0673, -0.0606, -0.1312, 0.0953, 0.0364, -0.0907, 0.1441, 0.0720]",
            "[0.0, 0.0, -0.15, 0.0, 0.0, 0.0, 0.14, 0.0]",
        ),
    ];
    let position = "position_m = [0.3182, 0.3182, 0.0]";
    let tilted = format!("{position}\naxis = [0.0998, 0.0, -0.9950]");
    let cases: [&[(&str, &str)]; 3] = [&[], &bent, &[(position, &tilted)]];
    for replacements in cases {
        let compiled = isae_x8(replacements).unwrap_or_else(|faults| panic!("{faults}"));
        let tolerance = compiled.tables.tolerance.wrench[3];
        let [floor, ceiling] = compiled.thrust_range_n;
        for (end, outwards) in [(floor, -1.0), (ceiling, 1.0)] {
            let is_delivered = |thrust_n: f32| {
                let setpoint = Wrench {
                    thrust_n,
                    ..Wrench::default()
                };
                let (_, _, saturation) = compiled.tables.mix(&setpoint, 14.8).unwrap();
                !saturation.any_axis()
            };
            assert!(is_delivered(end), "{end}");
            let beyond = end + outwards * 2.0 * tolerance;
            assert!(!is_delivered(beyond), "{beyond} beyond {end}");
        }
    }
}

/// Looser tolerances get cheaper evaluators, tighter ones more steps; every choice is within its
/// tolerance.
#[test]
fn the_tolerance_decides_on_the_evaluator() {
    let mut last = 0;
    for (thrust, torque) in [("0.01", "1e-4"), ("1e-3", "1e-5"), ("5e-5", "8e-7")] {
        let compiled = isae_x8(&[
            (
                "thrust_tolerance_n = 0.01",
                &format!("thrust_tolerance_n = {thrust}"),
            ),
            (
                "torque_tolerance_nm = 1e-4",
                &format!("torque_tolerance_nm = {torque}"),
            ),
        ]);
        let compiled = compiled.unwrap_or_else(|faults| panic!("{faults}"));
        let cost = compiled.of_pairs[0]
            .evaluator
            .cost(compiled.airframe.pairs[0].basis)
            .unwrap();
        assert!(cost > last, "{thrust} N: {:?}", compiled.of_pairs[0].evaluator);
        last = cost;
        let certificate = &compiled.of_pairs[0].certificate;
        for (k, tolerance) in [thrust, torque].into_iter().enumerate() {
            assert!(compiled.of_pairs[0].residual.efforts[k] <= certificate.reference[k]);
            assert!(certificate.stated[k] <= tolerance.parse().unwrap());
        }
    }
}

/// A refusal states what is proven: tolerances of twice that are met.
#[test]
fn a_refused_tolerance_is_told_what_is_proven() {
    for (thrust, torque) in [(0.01, 1e-9), (1e-6, 1e-3), (1e-7, 1e-9)] {
        let compiled = |thrust: f64, torque: f64| {
            isae_x8(&[
                (
                    "thrust_tolerance_n = 0.01",
                    &format!("thrust_tolerance_n = {thrust:?}"),
                ),
                (
                    "torque_tolerance_nm = 1e-4",
                    &format!("torque_tolerance_nm = {torque:?}"),
                ),
            ])
        };
        let faults = compiled(thrust, torque).map(|_| ()).unwrap_err();
        let label = &faults.faults()[0].label;
        let (_, proven) = label.split_once("is proven within ").expect("what is proven");
        let words: Vec<&str> = proven.split(' ').collect();
        let [thrust_n, torque_nm] = [words[0], words[3]].map(|word| word.parse::<f64>().expect("a number"));
        assert!(thrust_n > thrust || torque_nm > torque, "{label}");
        let mended = compiled(thrust.max(2.0 * thrust_n), torque.max(2.0 * torque_nm));
        assert!(mended.is_ok(), "{label}: {}", mended.unwrap_err());
    }
}

/// The tabulated exponent law follows the file's to a few units in the last place of f32 and its
/// tolerance.
#[test]
fn voltage_laws_are_followed_over_the_whole_range() {
    let compiled = isae_x8(&[]).unwrap();
    let voltage = compiled.airframe.voltage.as_ref().unwrap();
    let table = compiled.tables.view().voltage.unwrap();
    for k in 0..=1000 {
        let volts = 12.8 + 4.0 * f64::from(k) / 1000.0;
        let error = f64::from(table.factors(volts as f32)[0]) / voltage.thrust_factor(volts) - 1.0;
        assert!(error.abs() < 1.3e-6, "{volts} V: {error}");
    }
}

/// Points are met exactly and joined by straight lines.
#[test]
fn voltage_points_are_joined() {
    let points = "thrust_points = [[12.8, 0.75], [14.8, 1.0], [16.8, 1.5]]";
    let compiled = isae_x8(&[("thrust_exponent = 1.75", points)]).unwrap();
    let table = compiled.tables.view().voltage.unwrap();
    for (volts, factor) in [
        (12.8, 0.75),
        (13.8, 0.875),
        (14.8, 1.0),
        (15.8, 1.25),
        (16.8, 1.5),
    ] {
        assert!((table.factors(volts)[0] - factor).abs() < 1e-6, "{volts} V");
    }
}

/// By the macro, a build script or the command line: what is emitted names the file and no folder.
#[test]
fn what_is_emitted_does_not_depend_on_how_the_path_is_spelled() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("airframes/single-pair.toml");
    let text = fs::read_to_string(&path).unwrap();
    let spellings = [
        "single-pair.toml",
        "./airframes/single-pair.toml",
        &path.display().to_string(),
    ];
    let [first, others @ ..] = spellings.map(|name| {
        let compiled = mixer_compiler::compile(&Source::new(name, text.as_str())).unwrap();
        compiled.rust()
    });
    assert!(first.contains(" from `single-pair.toml`."), "{first}");
    assert_eq!(others, [first.clone(), first]);
}
