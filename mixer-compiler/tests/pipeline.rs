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
    assert_eq!(isae_x8(&[]).unwrap().least_idle, 0.08875);
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
        let cost = compiled.evaluator.cost(compiled.airframe.pair.basis).unwrap();
        assert!(cost > last, "{thrust} N: {:?}", compiled.evaluator);
        last = cost;
        let certificate = &compiled.certificate;
        for (k, tolerance) in [thrust, torque].into_iter().enumerate() {
            assert!(compiled.residual.efforts[k] <= certificate.reference[k]);
            assert!(certificate.stated[k] <= tolerance.parse().unwrap());
        }
    }
}

/// What a refusal offers as a mend must work, and asks for no more than is missing: a tolerance
/// that is met is left as it is.
#[test]
fn offered_tolerances_would_do() {
    for (thrust, torque, method, raised) in [
        (0.01, 1e-9, "auto", [false, true]),
        (1e-6, 1e-3, "auto", [true, false]),
        (1e-7, 1e-9, "auto", [true, true]),
    ] {
        let text = |thrust: f64, torque: f64, method: &str| {
            isae_x8(&[
                (
                    "thrust_tolerance_n = 0.01",
                    &format!("thrust_tolerance_n = {thrust:?}"),
                ),
                (
                    "torque_tolerance_nm = 1e-4",
                    &format!("torque_tolerance_nm = {torque:?}\nmethod = {method:?}"),
                ),
            ])
        };
        let faults = text(thrust, torque, method).map(|_| ()).unwrap_err();
        let help = &faults.faults()[0].help;
        let offered = |key: &str| -> Option<f64> {
            let (_, rest) = help.split_once(&format!("{key} = "))?;
            rest.split(' ').next()?.parse().ok()
        };
        let keys = ["thrust_tolerance_n", "torque_tolerance_nm"];
        assert_eq!(keys.map(|key| offered(key).is_some()), raised, "{faults}");
        let [thrust, torque] = [0, 1].map(|k| offered(keys[k]).unwrap_or([thrust, torque][k]));
        let mended = text(thrust, torque, method);
        assert!(mended.is_ok(), "{help}: {}", mended.unwrap_err());
        assert_eq!(help.contains("method"), method != "auto", "{help}");
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
