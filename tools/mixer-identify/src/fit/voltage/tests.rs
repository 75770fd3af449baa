use super::*;
use crate::bench::sign::Signs;

fn bench(kind: BenchKind, points: Vec<Point>) -> Bench {
    Bench {
        file: "b.csv".into(),
        format: "plain".into(),
        kind,
        sides_by_hand: false,
        rows: points.len(),
        start_stop_rows: 0,
        streaming: false,
        settling_rows: 0,
        points_used: points.len(),
        refused_rows: Vec::new(),
        signs: Signs {
            thrust: vec![1.0],
            torque: vec![1.0],
            thrust_policy: "auto",
            torque_policy: "auto",
        },
        air: None,
        tare: Vec::new(),
        offsets: Vec::new(),
        notes: Vec::new(),
        no_power: None,
        turning: None,
        idle_options: Vec::new(),
        record_drifts: false,
        holds_speed: false,
        rests: Vec::new(),
        points,
    }
}

/// A sweep at `volts` less a sag of `sag` V at full throttle, thrust 10 u2 (V/12)^k with relative
/// noise.
fn sweep(volts: f64, sag: f64, k: f64, throttles: impl Iterator<Item = f64>, noise: f64) -> Vec<Point> {
    let point = |(i, u): (usize, f64)| {
        let voltage = volts - sag * u * u;
        let scale = libm::pow(voltage / 12.0, k) * (1.0 + noise * (((i * 37 + 11) % 17) as f64 / 8.5 - 1.0));
        Point {
            line: 1,
            u,
            l: 0.0,
            thrust: 10.0 * u * u * scale,
            torque: f64::NAN,
            voltage,
            imbalance: 0.0,
            power_w: f64::NAN,
            shaft_w: f64::NAN,
            rpm: [f64::NAN; 2],
            cells: [f64::NAN; 4],
        }
    };
    throttles.enumerate().map(point).collect()
}

fn tenths(shift: f64) -> impl Iterator<Item = f64> {
    (1..=10).map(move |i| 0.1 * i as f64 - shift)
}

fn thrust_exponent(benches: &[Bench]) -> Exponent {
    examine(benches, BenchKind::SingleRotor).expect("voltages").thrust
}

#[test]
fn equal_throttles_give_the_true_exponent_despite_sag() {
    for k in [1.5, 1.75, 2.0] {
        let files = [12.6, 8.4].map(|v| bench(BenchKind::SingleRotor, sweep(v, 1.0, k, tenths(0.0), 0.01)));
        let e = thrust_exponent(&files).estimate().cloned().expect("an exponent");
        assert_eq!((e.method, e.levels), ("equal throttles", 10));
        assert!((e.exponent - k).abs() < e.ci95 && e.ci95 < 0.05, "{k}: {e:?}");
    }
}

#[test]
fn levels_that_differ_are_joined_by_a_polynomial() {
    let files = [(12.6, 0.0), (8.4, 0.05)]
        .map(|(v, shift)| bench(BenchKind::SingleRotor, sweep(v, 1.0, 1.75, tenths(shift), 0.005)));
    let e = thrust_exponent(&files).estimate().cloned().expect("an exponent");
    assert_eq!(e.method, "joint map");
    assert!((e.exponent - 1.75).abs() < e.ci95 && e.ci95 < 0.1, "{e:?}");
}

#[test]
fn one_voltage_and_a_sagging_battery_give_no_number() {
    let reason = |sag: f64, noise: f64| {
        let file = bench(BenchKind::SingleRotor, sweep(25.0, sag, 1.75, tenths(0.0), noise));
        match thrust_exponent(&[file]) {
            Exponent::Refused { reason, .. } => reason,
            other => panic!("{other:?}"),
        }
    };
    assert!(reason(0.5, 0.0).contains("one voltage only"));
    assert!(reason(5.0, 0.01).contains("confounded with throttle"));
}

#[test]
fn different_rotors_are_noticed() {
    let strong = sweep(12.6, 0.5, 1.75, tenths(0.0), 0.0);
    let mut weak = sweep(8.4, 0.5, 1.75, tenths(0.0), 0.0);
    weak.iter_mut()
        .enumerate()
        .for_each(|(i, p)| p.thrust *= 0.5 + 0.1 * i as f64);
    let files = [strong, weak].map(|points| bench(BenchKind::SingleRotor, points));
    assert!(thrust_exponent(&files).estimate().is_none());
    let strong = sweep(12.6, 0.5, 3.0, tenths(0.0), 0.0);
    let weak = sweep(8.4, 0.5, 3.0, tenths(0.0), 0.0);
    let files = [strong, weak].map(|points| bench(BenchKind::SingleRotor, points));
    assert!(
        matches!(thrust_exponent(&files), Exponent::Refused { reason, .. } if reason.contains("no propeller"))
    );
}

#[test]
fn torque_that_changes_its_sign_has_an_exponent_too() {
    let map = |volts: f64| -> Vec<Point> {
        let level = |k: usize| 0.2 + 0.2 * k as f64;
        let at = |k: usize| {
            let (u, l) = (level(k / 5), level(k % 5));
            let scale = libm::pow(volts / 12.0, 1.8);
            let torque = 0.3 * (l * l - 1.1 * u * u) * scale;
            Point {
                line: 1,
                u,
                l,
                thrust: 20.0 * (u * u + l * l) * scale,
                torque,
                voltage: volts,
                imbalance: 0.0,
                power_w: f64::NAN,
                shaft_w: f64::NAN,
                rpm: [f64::NAN; 2],
                cells: [f64::NAN; 4],
            }
        };
        (0..25).map(at).collect()
    };
    let v = examine(
        &[
            bench(BenchKind::Pair, map(12.0)),
            bench(BenchKind::Pair, map(16.0)),
        ],
        BenchKind::Pair,
    )
    .expect("voltages");
    for e in [v.thrust, v.torque] {
        assert!((e.estimate().expect("an exponent").exponent - 1.8).abs() < 1e-6);
    }
}

#[test]
fn what_is_not_measured_says_so() {
    let files = [bench(
        BenchKind::SingleRotor,
        sweep(12.0, 0.0, 1.7, tenths(0.0), 0.0),
    )];
    assert!(matches!(
        examine(&files, BenchKind::SingleRotor).expect("v").torque,
        Exponent::NotMeasured
    ));
    assert!(examine(&files, BenchKind::Pair).is_none());
}
