use super::*;
use crate::bench::header::ByHand;
use crate::bench::sheet::Heading;

fn columns(line: &str) -> Columns {
    let headings: Vec<Heading> = line.split(',').map(Heading::of).collect();
    Columns::find("b.csv:1", &headings, &ByHand::default()).expect("a header")
}

/// Rotor torques `a` u2 and `b` l2, total their sum.
fn samples(a: f64, b: f64) -> Vec<Sample> {
    let at = |u: f64, l: f64| Sample {
        line: 1,
        throttle: [u, l],
        thrust: Split {
            whole: -(u + l),
            rotors: [u, -0.5 * l],
        },
        torque: Split {
            whole: a * u * u + b * l * l,
            rotors: [a * u * u, b * l * l],
        },
        voltage: [f64::NAN; 2],
        power_w: f64::NAN,
        speed: [f64::NAN; 2],
        time_s: f64::NAN,
    };
    [(0.2, 0.8), (0.8, 0.2), (0.5, 0.5), (0.9, 0.9), (0.2, 0.3)]
        .map(|(u, l)| at(u, l))
        .to_vec()
}

const AUTO: SignPolicy = SignPolicy {
    thrust: SignChoice::Auto,
    torque: SignChoice::Auto,
};

#[test]
fn totals_are_turned_to_the_convention() {
    let c = columns("upper,lower,thrust_n,torque_nm");
    for (a, b, sign) in [(-1.0, 0.8, 1.0), (1.0, -0.8, -1.0)] {
        let s = samples(a, b);
        let mut notes = Vec::new();
        let (signs, sums) = pair("b.csv", &c, &s, &AUTO, false, &mut notes).expect("signs");
        assert_eq!((signs.thrust, signs.torque), (vec![-1.0], vec![sign]));
        assert!(sums[0].1 > 0.0 && sums[1].1 < 0.0 && sums[0].0 > 0.0);
        let turned = notes.iter().any(|note| note.contains("torque is turned"));
        assert_eq!(turned, sign < 0.0, "{notes:?}");
    }
}

#[test]
fn rotor_columns_each_get_their_sign() {
    let c = columns("ESC A (us),ESC B (us),Thrust A (N),Thrust B (N),Torque A (Nm),Torque B (Nm)");
    for (a, b) in [(1.0, 0.8), (-1.0, 0.8), (-1.0, -0.8)] {
        let mut notes = Vec::new();
        let (_, sums) = pair("b.csv", &c, &samples(a, b), &AUTO, false, &mut notes).expect("signs");
        assert!((sums[0].1 - (-0.04 + 0.8 * 0.64)).abs() < 1e-12, "{a} {b}");
        assert!((sums[0].0 - (0.2 + 0.4)).abs() < 1e-12);
        assert!(notes.is_empty(), "{notes:?}");
    }
}

#[test]
fn magnitudes_are_refused_and_given_signs_help() {
    let c = columns("upper,lower,thrust_n,torque_nm");
    let error = pair("b.csv", &c, &samples(1.0, 0.8), &AUTO, false, &mut Vec::new()).unwrap_err();
    assert!(error.reason.contains("sum of magnitudes"), "{error}");
    let c = columns("ESC A (us),ESC B (us),Thrust A (N),Thrust B (N),Torque A (Nm),Torque B (Nm)");
    let given = SignPolicy {
        torque: SignChoice::Given([1.0, -1.0]),
        ..AUTO
    };
    let mut notes = Vec::new();
    let (signs, sums) = pair("b.csv", &c, &samples(1.0, 0.8), &given, false, &mut notes).expect("signs");
    assert!(notes[0].contains("written mirrored, for one"), "{notes:?}");
    assert_eq!(signs.torque, [-1.0, 1.0]);
    assert!(sums[0].1 > 0.0);
}

#[test]
fn constant_and_missing_torque_are_refused() {
    let c = columns("upper,lower,thrust_n,torque_nm");
    let mut s = samples(-1.0, 0.8);
    s.iter_mut().for_each(|s| s.torque.whole = 0.25);
    let error = pair("b.csv", &c, &s, &AUTO, false, &mut Vec::new()).unwrap_err();
    assert!(error.reason.contains("constant at 0.25"), "{error}");
    let c = columns("upper,lower,thrust_n");
    let error = pair("b.csv", &c, &s, &AUTO, false, &mut Vec::new()).unwrap_err();
    assert!(error.reason.contains("no torque column"), "{error}");
}
