//! Runs of one rotor alone: synthetic truth, and runs that cannot serve.

use std::fmt::Write as _;

use mixer_compiler::Source;
use mixer_compiler::airframe::Basis;
use mixer_identify::bench::Bench;
use mixer_identify::fragment;
use mixer_identify::identified::with_runs;

use super::sweep::{Normal, bench, plain, rows, settings};

const THRUST: [f64; 3] = [0.3, 14.0, -2.0];
const TORQUE: [f64; 3] = [0.004, 0.16, -0.02];

fn value([a1, a2, a3]: [f64; 3], x: f64) -> f64 {
    ((a3 * x + a2) * x + a1) * x
}

fn map() -> Bench {
    bench("map.csv", &plain(&rows(1)), &settings(None)).expect("a bench")
}

/// A run of the upper (0) or of the lower (1) rotor at `volts`, thrust and torque following the
/// 1.75th power of 14.8 V.
fn run(rotor: usize, volts: f64, noise: f64) -> Bench {
    let mut normal = Normal::new(11);
    let mut text = String::from("upper,lower,thrust_n,torque_nm,voltage_v\n");
    for k in 0..=18 {
        let x = 0.1 + 0.05 * f64::from(k);
        let k = libm::pow(volts / 14.8, 1.75);
        let f = k * value(THRUST, x) + noise * normal.next();
        let q = [-1.0, 1.0][rotor] * k * value(TORQUE, x) + 0.01 * noise * normal.next();
        let [u, l] = if rotor == 0 { [x, 0.0] } else { [0.0, x] };
        writeln!(text, "{u},{l},{f},{q},{volts}").expect("a string");
    }
    bench("run.csv", text.as_bytes(), &settings(None)).expect("a bench")
}

#[test]
fn one_rotor_alone_is_recovered_and_compiles() {
    let wishes = settings(Some(Basis::Biquadratic)).wishes;
    let runs = [Some(run(0, 14.8, 0.02)), Some(run(1, 14.8, 0.02))];
    let found = with_runs(vec![map()], runs, &wishes).expect("a pair");
    let pair = found.pair.as_ref().expect("a pair");
    for (alone, sign) in [(&pair.lower_out, -1.0), (&pair.upper_out, 1.0)] {
        let alone = alone.as_ref().expect("a rotor alone");
        for x in [0.1, 0.3, 0.6, 1.0] {
            assert!((value(alone.thrust_n, x) - value(THRUST, x)).abs() < 0.05);
            assert!((sign * value(alone.torque_nm, x) - value(TORQUE, x)).abs() < 5e-4);
        }
        assert!(alone.thrust.leave_one_out_rms < 0.04, "{alone:?}");
    }
    let unit = "[[unit]]\nposition_m = [0.0, 0.0, 0.0]\nupper_spin = \"cw\"\nchannels = [0, 1]\n";
    let allocation = "[allocation]\naxes = [\"yaw\", \"thrust\"]\n";
    let text = format!("name = \"x\"\n{}\n{unit}{allocation}", fragment::text(&found));
    let compiled = mixer_compiler::compile(&Source::new("x.toml", text.clone()));
    let compiled = compiled.unwrap_or_else(|faults| panic!("{faults}\n{text}"));
    let alone = compiled.airframe.pairs[0].lower_out.as_ref().expect("lower_out");
    assert_eq!(Some(alone.thrust_n), pair.lower_out.as_ref().map(|a| a.thrust_n));
    let json = serde_json::to_value(&found).expect("JSON");
    assert_eq!(json["pair"]["upper_out"]["points"], 19);
}

#[test]
fn a_run_at_another_voltage_is_brought_to_the_maps() {
    let mut wishes = settings(Some(Basis::Biquadratic)).wishes;
    let runs = || [Some(run(0, 12.6, 0.0)), None];
    let told = with_runs(vec![map()], runs(), &wishes).expect("a pair").warnings;
    assert!(
        told.iter().any(|w| w.contains("--lower-out was run at 12.60 V")),
        "{told:?}"
    );
    (wishes.voltage_exponent, wishes.reference_v) = (Some([1.75; 2]), Some(14.8));
    let found = with_runs(vec![map()], runs(), &wishes).expect("a pair");
    let alone = found.pair.expect("a pair").lower_out.expect("a rotor alone");
    for (found, truth) in alone.thrust_n.into_iter().zip(THRUST) {
        assert!((found - truth).abs() < 1e-6, "{found} {truth}");
    }
}
