//! Benches as other laboratories have them: read as what they are, or refused with the mend.

use mixer_identify::bench::{BenchKind, Preparation};
use mixer_identify::identified::Settings;
use mixer_identify::refusal::Refusal;
use mixer_identify::rotor::Turning;
use mixer_identify::rotor::predict::Predicted;
use mixer_identify::rotor::single::RunFacts;
use mixer_identify::texts::{Prediction, Text, predict, read};

fn text(content: &str) -> Text {
    Text {
        name: "run.csv".into(),
        content: Ok(content.as_bytes().to_vec()),
    }
}

fn one_rotor() -> Settings {
    Settings {
        preparation: Preparation {
            prefers_rotor_cell: true,
            ..Preparation::default()
        },
        ..Settings::default()
    }
}

/// What `predict` makes of a run of a propeller of this diameter, m.
fn predicted(content: &str, diameter_m: Option<f64>, run: Settings) -> Result<Predicted, Refusal> {
    let how = Prediction {
        run,
        known: RunFacts {
            diameter_m,
            ..RunFacts::default()
        },
        ..Prediction::default()
    };
    let found = predict(&text(content), None, &[], &how);
    found
        .map(|outcome| outcome.found)
        .map_err(|mut refusals| refusals.remove(0))
}

/// What is said of it; the refusal where there is one.
#[track_caller]
fn said(content: &str, diameter_m: Option<f64>) -> String {
    match predicted(content, diameter_m, one_rotor()) {
        Ok(found) => found.warnings.join("\n"),
        Err(refusal) => format!("refused: {refusal}"),
    }
}

/// A table with a row per throttle, %, from 30 to 100.
fn table(header: &str, row: impl Fn(f64) -> String) -> String {
    let rows = (3..=10).map(|k| row(0.1 * f64::from(k)) + "\n");
    format!("{header}\n{}", rows.collect::<String>())
}

#[test]
fn thrust_grows_with_another_power_in_every_laboratory() {
    // A supply that gives up at 0.7 of full throttle: less thrust, and less voltage.
    let limited = table("ESC (us),Thrust (gf),Voltage (V)", |t| {
        let volts = if t < 0.72 {
            11.1
        } else {
            11.1 * libm::pow(0.7 / t, 1.2)
        };
        format!(
            "{},{},{volts}",
            1000.0 + 1000.0 * t,
            500.0 * libm::pow(t, 1.7) * libm::pow(volts / 11.1, 1.75)
        )
    });
    let smart = |power: f64| {
        table("PWM,Thrust (kg),Voltage (V)", |t| {
            format!("{},{},48.2", 1000.0 + 1000.0 * t, 4.2 * libm::pow(t, power))
        })
    };
    for (run, words) in [
        (&limited, None),
        (&smart(1.3), None),
        (&smart(1.45), None),
        (&smart(2.1), None),
        (&smart(1.05), Some("something linearised")),
        (&smart(2.4), Some("another range of pulses")),
    ] {
        let told = said(run, Some(0.4));
        assert_eq!(told.contains("grows"), words.is_some(), "{run}\n{told}");
        assert!(words.is_none_or(|words| told.contains(words)), "{told}");
    }
    // Of a speed that is held nobody speaks of pulses.
    let mut held = one_rotor();
    held.reading.by_hand.full_rpm = Some(6000.0);
    let speeds = table("RPM,Thrust (N),Torque (Nm)", |t| {
        format!(
            "{},{},{}",
            6000.0 * t,
            30.0 * libm::pow(t, 2.5),
            0.5 * libm::pow(t, 2.5)
        )
    });
    let found = predicted(&speeds, None, held).expect("a pair");
    assert!(
        !found.warnings.iter().any(|told| told.contains("pulses")),
        "{:?}",
        found.warnings
    );
}

#[test]
fn units_are_told_without_a_diameter_and_with_one() {
    // A propeller of 15 inch: 35 N and 0.78 N m at 7080 rpm.
    let run = |thrust: f64, torque: f64, unit: &str| {
        table(
            &format!("Throttle (%),Thrust ({unit}),Torque (Nm),RPM,Voltage (V),Current (A)"),
            |t| {
                let square = libm::pow(t, 1.7);
                let rpm = 7080.0 * square.sqrt();
                let (volts, current) = (23.9 - 0.5 * t, 30.2 * square * square.sqrt());
                let [f, q] = [thrust, torque].map(|of| of * square);
                format!("{},{f},{q},{rpm},{volts},{current}", 100.0 * t)
            },
        )
    };
    let told = |run: &str, diameter_m| said(run, diameter_m).contains("of right files");
    for (thrust, torque, unit, without, with) in [
        (35.2, 0.778, "N", false, false),
        (17.6, 0.778, "N", true, true),
        (70.4, 0.778, "N", true, true),
        (3.59, 0.778, "lb", true, true),
        (35.2, 0.389, "N", true, true),
        (35.2, 1.556, "N", true, true),
        (35.2, 0.5738, "N", true, true),
        (35.2, 1.0548, "N", true, true),
    ] {
        let run = run(thrust, torque, unit);
        assert_eq!(
            [told(&run, None), told(&run, Some(0.381))],
            [without, with],
            "{thrust} {unit}, {torque} N m: {}",
            said(&run, Some(0.381))
        );
    }
}

#[test]
fn one_rotor_on_a_stand_for_two_is_one() {
    let stand = |moves: [f64; 2]| {
        let header =
            "Motor PWM,Top Voltage (V),Bottom Voltage (V),Top Current (A),Bottom Current (A),Thrust (kg)";
        table(header, |t| {
            let [top, bottom] =
                moves.map(|moves| 0.2 + 0.01 * ((100.0 * t) % 3.0) + 14.0 * moves * t * t * t);
            let thrust = 4.0 * (moves[0] + 0.7 * moves[1]) * libm::pow(t, 1.7);
            format!("{},48.2,48.3,{top},{bottom},{thrust}", 1000.0 + 1000.0 * t)
        })
    };
    for (moves, kind, turning) in [
        ([1.0, 0.0], BenchKind::SingleRotor, Some(Turning::Upper)),
        ([0.0, 1.0], BenchKind::SingleRotor, Some(Turning::Lower)),
        ([1.0, 0.8], BenchKind::Pair, None),
    ] {
        let bench = read(&text(&stand(moves)), &one_rotor()).expect("a bench");
        assert_eq!(
            (bench.kind, bench.turning, bench.points.len()),
            (kind, turning, 8)
        );
    }
    let told = said(&stand([1.0, 0.0]), Some(0.45));
    assert!(told.contains("the lower rotor stands still throughout"), "{told}");
    let both = said(&stand([1.0, 0.8]), Some(0.45));
    assert!(both.contains("--prior SINGLE.csv"), "{both}");
}

#[test]
fn what_was_not_plugged_in_is_not_measured() {
    let run = |volts: &str, torque: f64| {
        table("Throttle (%),Thrust (gf),Torque (Nm),Voltage (V)", |t| {
            let square = libm::pow(t, 1.7);
            format!("{},{},{},{volts}", 100.0 * t, 2000.0 * square, torque * square)
        })
    };
    for volts in ["0.02", "0", "0.00004", "-0.3"] {
        let found = predicted(&run(volts, 0.3), None, one_rotor()).expect("a pair");
        assert_eq!(found.reference_v, None, "{volts}");
        let told = found.warnings.join("\n");
        assert!(told.contains("V in most rows: taken as not measured"), "{told}");
    }
    assert!(said(&run("22200", 0.3), None).contains("--unit voltage=mV"));
    // A torque of 0 is none, and the diameter leads on.
    let told = said(&run("22.2", 0.0), None);
    assert!(
        told.starts_with("refused") && told.contains("--diameter METRE"),
        "{told}"
    );
    let told = said(&run("22.2", 0.0), Some(0.3));
    assert!(
        told.contains("the torque is 0 in every row: taken as not measured"),
        "{told}"
    );
}

#[test]
fn a_run_may_end_at_the_limit_by_any_number_of_rows() {
    for rows in 1..=9 {
        let mut run = "PWM,thrust_n,torque_nm\n".to_owned();
        for (pulse, k) in (1100..=1700)
            .step_by(100)
            .flat_map(|pulse| (0..rows).map(move |k| (pulse, k)))
        {
            let t = 1e-3 * f64::from(pulse - 1000);
            let thrust = 40.0 * libm::pow(t, 1.8) + 0.01 * f64::from(k);
            run += &format!("{pulse},{thrust},{}\n", 0.022 * thrust);
        }
        let told = said(&run, None);
        assert!(!told.contains("refused"), "{rows}: {told}");
    }
}

#[test]
fn words_and_units_of_thrust() {
    let grams = |t: f64| 4210.0 * libm::pow(t, 1.65);
    for header in ["Force (g)", "Axial load (gf)", "Load (g)", "Mean force [g]"] {
        let run = table(&format!("Throttle (%),{header}"), |t| {
            format!("{},{:.0}", 100.0 * t, grams(t))
        });
        let found = predicted(&run, Some(0.4), one_rotor());
        assert!(found.is_ok(), "{header}: {:?}", found.err());
    }
    // Side forces, and a load beside a thrust, are none.
    let run = table("Throttle (%),Force Fx (g),Thrust (g),Load (%)", |t| {
        format!("{},{},{:.0},{}", 100.0 * t, 3.0 * t, grams(t), 50.0 * t)
    });
    assert!(predicted(&run, Some(0.4), one_rotor()).is_ok());
    let both = |newtons: f64| {
        table("Throttle Range,Thrust Output (g),Thrust Output (N)", |t| {
            let grams = grams(t);
            format!("{:.1}%,{grams:.0},{:.2}", 100.0 * t, newtons * grams)
        })
    };
    assert!(predicted(&both(9.80665e-3), Some(0.4), one_rotor()).is_ok());
    let told = said(&both(2.0 * 9.80665e-3), Some(0.4));
    assert!(
        told.contains("both look like the thrust") && !told.contains("torque"),
        "{told}"
    );
}

#[test]
fn a_throttle_and_its_pulses_are_one_or_the_mend_names_it() {
    let run = |low: f64| {
        table("ESC signal (us),Throttle (%),Thrust (gf),Torque (Nm)", |t| {
            let square = libm::pow(t, 1.75);
            format!(
                "{},{},{},{}",
                low + (2000.0 - low) * t,
                100.0 * t,
                2200.0 * square,
                0.33 * square
            )
        })
    };
    assert!(!said(&run(1000.0), None).contains("refused"));
    let told = said(&run(1150.0), None);
    assert!(
        told.contains("--column throttle=\"Throttle (%)\" of one rotor"),
        "{told}"
    );
    let mut by_hand = one_rotor();
    by_hand.reading.by_hand.columns = vec![("upper".into(), "Throttle (%)".into())];
    assert!(predicted(&run(1150.0), None, by_hand).is_ok());
}

#[test]
fn logs_are_faster_than_load_cells() {
    // Twelve rows a stop, the load cell in every sixth; the stop at 55 % is too short for it.
    let mut log = "Throttle (%),Thrust (N),Torque (Nm),Voltage (V)\n".to_owned();
    for (stop, percent) in [30, 40, 50, 55, 60, 70, 80, 90, 100].into_iter().enumerate() {
        let rows = if percent == 55 { 5 } else { 12 };
        for row in 0..rows {
            let square = libm::pow(0.01 * f64::from(percent), 1.7);
            let cells = match row % 6 == 5 {
                true => format!("{},{}", 20.0 * square, 0.3 * square),
                false => ",".to_owned(),
            };
            log += &format!(
                "{percent},{cells},{}\n",
                22.2 - 0.001 * f64::from(row) - 0.01 * stop as f64
            );
        }
    }
    let bench = read(&text(&log), &one_rotor()).expect("a bench");
    assert_eq!(
        (bench.streaming, bench.points.len(), bench.refused_rows.len()),
        (true, 8, 0)
    );
    let told = bench.notes.join("\n");
    assert!(
        told.contains("1 of 9 stops are passed over: no load cell has a value in them"),
        "{told}"
    );
    // A row each, of which most have no value.
    let mut rows = "Throttle (%),Thrust (N),Torque (Nm)\n".to_owned();
    for percent in 30..=100 {
        let square = libm::pow(0.01 * f64::from(percent), 1.7);
        rows += &match percent % 6 {
            0 => format!("{percent},{},{}\n", 20.0 * square, 0.3 * square),
            _ => format!("{percent},,\n"),
        };
    }
    let bench = read(&text(&rows), &one_rotor()).expect("a bench");
    assert_eq!((bench.points.len(), bench.refused_rows.len()), (12, 0));
}

#[test]
fn remarks_below_a_table_are_passed_over() {
    let table = table("Throttle (%),Thrust (gf),Torque (Nm)", |t| {
        let square = libm::pow(t, 1.7);
        format!("{},{},{}", 100.0 * t, 2000.0 * square, 0.3 * square)
    });
    for remark in [
        "balanced by hand",
        "Note: new bearings, 21 C",
        "measured 3 May 2021,,",
    ] {
        let told = said(&format!("{table}{remark}\n"), None);
        assert!(told.contains("run.csv:10 is passed over"), "{remark}: {told}");
    }
}

#[test]
fn what_lies_beyond_a_run_counts_by_how_far() {
    let cut = |end: f64| {
        let rows = (10..=100).step_by(5).map(|percent| 0.01 * f64::from(percent));
        let rows = rows.filter(|t| *t < end + 1e-9).map(|t| {
            let square = libm::pow(t, 1.7);
            format!("{},{},{}\n", 100.0 * t, 2000.0 * square, 0.3 * square)
        });
        let run = format!(
            "Throttle (%),Thrust (gf),Torque (Nm)\n{}",
            rows.collect::<String>()
        );
        let how = Prediction {
            run: one_rotor(),
            wishes: mixer_identify::rotor::predict::PredictOptions {
                throttle: Some(mixer_identify::fit::basis::ThrottleBox { min: 0.2, max: 0.95 }),
                ..Default::default()
            },
            ..Prediction::default()
        };
        let found = predict(&text(&run), None, &[], &how).expect("a pair").found;
        found.pair.uncertainty.thrust_percent
    };
    let [whole, tenth, quarter] = [1.0, 0.85, 0.7].map(cut);
    assert!(
        whole < 2.5 && tenth > 7.5 && quarter > 12.0,
        "{whole} {tenth} {quarter}"
    );
}
