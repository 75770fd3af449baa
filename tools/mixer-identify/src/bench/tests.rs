//! Files as people hand them in: read with these numbers, read with a word, or refused with the mend.
//! What is silently wrong is the only failure.

use crate::identified::Settings;
use crate::texts::{Text, read};

/// What comes of a text.
#[derive(Debug, Clone, Copy)]
enum Comes {
    /// Points, and u, l, thrust (N), torque (N m; 0 where there is none) of the last one.
    Read(usize, [f64; 4]),
    /// Read, and this is noted.
    Noted(&'static str),
    /// Refused, with all of these in the message.
    Refused(&'static [&'static str]),
}
use Comes::{Noted, Read, Refused};

/// Gram-force, N.
const G: f64 = 9.80665e-3;

/// How `predict` reads a run of one rotor.
fn one_rotor() -> Settings {
    let mut settings = Settings::default();
    settings.preparation.prefers_rotor_cell = true;
    settings
}

#[track_caller]
fn hold(settings: &Settings, cases: &[(&str, Comes)]) {
    let mut complaints = Vec::new();
    for (text, comes) in cases {
        let content = Ok(text.as_bytes().to_vec());
        let found = read(
            &Text {
                name: "b.csv".into(),
                content,
            },
            settings,
        );
        let last = |points: &[super::Point]| {
            let p = points.last().expect("points");
            [p.u, p.l, p.thrust, if p.torque.is_nan() { 0.0 } else { p.torque }]
        };
        let near = |(a, b): (f64, &f64)| (a - b).abs() < 1e-9 * b.abs().max(1e-3);
        let holds = match (&found, comes) {
            (Ok(bench), Read(points, wanted)) => {
                bench.points.len() == *points && last(&bench.points).into_iter().zip(wanted).all(near)
            }
            (Ok(bench), Noted(phrase)) => bench.notes.iter().any(|note| note.contains(phrase)),
            (Err(refusal), Refused(phrases)) => {
                let told = refusal.to_string();
                phrases.iter().all(|phrase| told.contains(phrase)) && told.lines().count() <= 12
            }
            _ => false,
        };
        if !holds {
            let told = match &found {
                Err(refusal) => refusal.to_string(),
                Ok(bench) => format!(
                    "{:?} of {}: {:?}",
                    last(&bench.points),
                    bench.points.len(),
                    bench.passed_over()
                ),
            };
            complaints.push(format!("{text:?}\n  is to be {comes:?}\n  is {told}"));
        }
    }
    assert!(
        complaints.is_empty(),
        "{} of {}:\n{}",
        complaints.len(),
        cases.len(),
        complaints.join("\n")
    );
}

/// 40, 70 and 100 % of throttle.
const END: [f64; 4] = [1.0, 0.0, 2040.0 * G, 0.0];
const WITH_TORQUE: [f64; 4] = [1.0, 0.0, 2040.0 * G, 0.3];

#[test]
fn numbers_and_units_in_cells() {
    hold(
        &one_rotor(),
        &[
            (
                "Throttle (%),Thrust (g)\n40,\"820.5\"\n70,\"1,410.0\"\n100,\"2,040.0\"\n",
                Read(3, END),
            ),
            (
                "Throttle (%);Thrust (g)\n40,5;820\n70,5;1.410\n100,0;2.040\n",
                Read(3, END),
            ),
            (
                "Throttle (%);Thrust (g)\n40;820\n70;1 410\n100;2 040\n",
                Read(3, END),
            ),
            (
                "Throttle (%)\tThrust (g)\n40\t820\n70\t1\u{202f}410\n100\t2\u{a0}040\n",
                Read(3, END),
            ),
            (
                "Throttle (%),Thrust (g)\n40,820\n70,1'410\n100,2\u{2019}040\n",
                Read(3, END),
            ),
            (
                "Throttle (%);Thrust (g)\n40;820\n70;1,410\n100;2,040\n",
                Refused(&["b.csv:3", "\"1,410\"", "1234 or 1.234"]),
            ),
            (
                "Throttle (%);Thrust (kg)\n40;1.410\n70;2\n100;3.040\n",
                Refused(&["\"1.410\" may be in thousands"]),
            ),
            ("Throttle (%);Thrust (kg)\n40;1.410\n100;2.040\n", Read(2, END)),
            (
                "Throttle (%),Thrust (g)\n40,820\n70,1,410\n100,2,040\n",
                Refused(&["3 cells, the header has 2"]),
            ),
            ("Throttle,Thrust (g)\n40.00%,820\n100.00%,2040\n", Read(2, END)),
            ("Throttle;Thrust\n40 %;820 g\n100 %;2040 g\n", Read(2, END)),
            ("Throttle,Thrust (g)\n40%,820gf\n100%,2040gf\n", Read(2, END)),
            (
                "Throttle,Thrust (N)\n40%,820 g\n100%,2040 g\n",
                Refused(&["by its name and in \"g\" below"]),
            ),
            (
                "Throttle,Thrust\n40%,820 g\n70%,1410 g\n100%,2.04 kg\n",
                Refused(&["another unit than its column"]),
            ),
            (
                "Throttle,Thrust (g)\n40%,820\n70%,1410\n1.0,2040\n",
                Refused(&["another unit than its column"]),
            ),
            (
                "Throttle,Thrust (g)\n40%,~820\n100%,~2040\n",
                Refused(&["\"~820\" is not a finite number"]),
            ),
            (
                "Throttle (%),Thrust (g),Torque (Nm)\n40,820,#DIV/0!\n100,2040,0.3\n",
                Read(2, WITH_TORQUE),
            ),
            (
                "Throttle (%),Thrust (g)\n40,#NV\n70,n/a\n100,2040\n",
                Noted("2 of 3 rows are passed over: no load cell has a value in them"),
            ),
            (
                "Throttle (%),Thrust (g),Voltage (V)\n40,820,-\n100,2040,NaN\n",
                Read(2, END),
            ),
        ],
    );
}

#[test]
fn lines_around_the_table() {
    hold(
        &one_rotor(),
        &[
            (
                "Throttle;Thrust;Torque\n%;g;Nm\n40;820;0,1\n100;2040;0,3\n",
                Read(2, WITH_TORQUE),
            ),
            ("Throttle,Thrust\n[%],[g]\n40,820\n100,2040\n", Read(2, END)),
            (
                "Throttle (%),Thrust (N)\n%,g\n40,820\n100,2040\n",
                Refused(&["by its name and in \"g\" below"]),
            ),
            (
                "# second run, motor upside down\nThrottle (%),Thrust (g)\n40,820\n100,2040\n",
                Read(2, END),
            ),
            ("# Throttle (%) Thrust (g)\n40 820\n100 2040\n", Read(2, END)),
            (
                "Motor,U5\nProp,16x5.4\nVoltage,22.2\n\nThrottle (%),Thrust (g)\n40,820\n100,2040\n",
                Read(2, END),
            ),
            (
                "Thrust test 22 July,,\n,,\nThrottle (%),Thrust (g),Torque (Nm)\n40,820,.1\n100,2040,.3\n",
                Read(2, WITH_TORQUE),
            ),
            ("sep=;\nThrottle (%);Thrust (g)\n40;820\n100;2040\n", Read(2, END)),
            (
                "\"sep=,\"\r\nThrottle (%),Thrust (g)\r\n40,820\r\n100,2040\r\n",
                Read(2, END),
            ),
            (
                "Throttle (%),Thrust (g)\n40,820\n100,2040\nAverage,1430\n",
                Noted("b.csv:4 is passed over: a summary"),
            ),
            (
                "No,Throttle (%),Thrust (g)\n1,40,820\n2,100,2040\nMax,100,2040\n",
                Noted("a summary"),
            ),
            (
                "Throttle (%),Thrust (g)\n40,820\nThrottle (%),Thrust (g)\n100,2040\n",
                Noted("b.csv:3 is passed over"),
            ),
            (
                "Throttle (%),Thrust (g)\n40,820\nThrust (g),Throttle (%)\n2040,100\n",
                Refused(&["b.csv:3", "one table in a file"]),
            ),
            (
                "Throttle (%),Thrust (g)\n40,820\n100,2040\nNotes: motor 60 C at 100 %,\n",
                Noted("there is no number in it"),
            ),
            ("0.4,820\n1.0,2040\n", Refused(&["numbers where the names"])),
            ("", Refused(&["is empty"])),
        ],
    );
}

#[test]
fn separators() {
    hold(
        &one_rotor(),
        &[
            ("Throttle (%) | Thrust (g)\n40 | 820\n100 | 2040\n", Read(2, END)),
            (
                "| Throttle (%) | Thrust (g) |\n|---|---|\n| 40 | 820 |\n| 100 | 2040 |\n",
                Read(2, END),
            ),
            (
                "Throttle (%)   Thrust (g)\n  40            820\n 100           2040\n",
                Read(2, END),
            ),
            ("throttle thrust_gf\n0.4 820\n1.0 2040\n", Read(2, END)),
            (
                "throttle thrust_gf\n1 0.4 820\n2 1.0 2040\n",
                Refused(&["3 cells, the header has 2"]),
            ),
            (",throttle,thrust_gf\n0,0.4,820\n1,1.0,2040\n", Read(2, END)),
            (
                "throttle,thrust_gf\n0,4,820,5\n1,0,2040,5\n",
                Refused(&["4 cells, the header has 2"]),
            ),
            (
                "throttle,thrust_gf\n\"0,4\",\"820,5\"\n\"1,0\",\"2040,0\"\n",
                Read(2, END),
            ),
            ("throttle\tthrust_gf\n0,4\t820\n1,0\t2040\n", Read(2, END)),
        ],
    );
}

#[test]
fn names_and_units_of_columns() {
    let newtons = [1.0, 0.0, 20.0, 0.0];
    hold(
        &one_rotor(),
        &[
            (
                "Throttle [%],Thrust [N],Torque [Nm]\n40,8,.1\n100,20,.3\n",
                Read(2, [1.0, 0.0, 20.0, 0.3]),
            ),
            (
                "throttle/%;thrust/N;torque/Nm\n40;8;0,1\n100;20;0,3\n",
                Read(2, [1.0, 0.0, 20.0, 0.3]),
            ),
            ("Throttle %,\"Thrust, N\"\n40,8\n100,20\n", Read(2, newtons)),
            ("Throttle (%),Total thrust (g)\n40,820\n100,2040\n", Read(2, END)),
            (
                "Gas (%);Schub (g);Drehmoment (Nm)\n40;820;0,1\n100;2040;0,3\n",
                Read(2, WITH_TORQUE),
            ),
            ("Gaz (%);Poussée (g)\n40;820\n100;2040\n", Read(2, END)),
            (
                "Throttle (%),F (g)\n40,820\n100,2040\n",
                Refused(&["no thrust column", "--column thrust=HEADER"]),
            ),
            (
                "Signal (%),T (kgf)\n40,.8\n100,2\n",
                Refused(&["no throttle column; no thrust column", "--column throttle=HEADER"]),
            ),
            (
                "Throttle,Thrust,Torque\n.4,820,.1\n1,2040,.3\n",
                Refused(&[
                    "\"Thrust\" has no unit",
                    "\"Torque\" has no unit",
                    "--unit thrust=",
                    "--unit torque=",
                ]),
            ),
            (
                "Thrust (g),RPM\n820,4000\n2040,7000\n",
                Refused(&["no throttle column", "--rpm-at-full", "\"RPM\""]),
            ),
            (
                "Throttle (%),Thrust (g),Thrust raw (g)\n40,820,8\n100,2040,20\n",
                Refused(&["both look like the thrust"]),
            ),
            (
                "Throttle,Thrust (g)\n40,820\n100,2040\n",
                Refused(&["2 of 2 rows", "--unit upper=%"]),
            ),
            (
                "Throttle,Thrust (g)\n1400,820\n2000,2040\n",
                Refused(&["--pwm-range 1000,2000"]),
            ),
            (
                "Throttle,Thrust (g)\n848,820\n2047,2040\n",
                Refused(&["is above 1"]),
            ),
            (
                "PWM,Thrust (g)\n300,820\n1047,1500\n2047,2040\n",
                Refused(&["far below the pulse widths"]),
            ),
            ("PWM (ms),Thrust (g)\n1.4,820\n2.0,2040\n", Read(2, END)),
            (
                "PWM (ns),Thrust (g)\n1400000,820\n",
                Refused(&["unit \"ns\"", "us, %"]),
            ),
            (
                "PWM (us),Thrust (g)\n0.4,820\n1.0,2040\n",
                Refused(&["far below the pulse widths"]),
            ),
            (
                "Throttle (%),Thrust (g)\n0.4,820\n1.0,2040\n",
                Refused(&["reaches 0.01 of full throttle"]),
            ),
            (
                "J CT CP eta\n0 0.13 0.05 0\n0.1 0.12 0.05 0.2\n",
                Refused(&["no thrust column"]),
            ),
        ],
    );
}

#[test]
fn speeds_stand_for_throttles() {
    let mut settings = one_rotor();
    settings.reading.by_hand.full_rpm = Some(5000.0);
    hold(
        &settings,
        &[
            (
                "Motor speed (rpm),Thrust (N)\n2500,2\n5000,8\n",
                Read(2, [1.0, 0.0, 8.0, 0.0]),
            ),
            (
                "RPM,Thrust (N)\n2500,2\n5000,8\n6000,11\n",
                Noted("1 of 3 rows is left out, the first in line 4: \"RPM\" = 6000 is above --rpm-at-full"),
            ),
            (
                "RPM,Thrust (N)\n5500,2\n6000,11\n",
                Refused(&["above --rpm-at-full"]),
            ),
            ("throttle,thrust_n\n0.5,2\n1,8\n", Read(2, [1.0, 0.0, 8.0, 0.0])),
            (
                "throttle,RPM,thrust_n\n0.4,2500,2\n0.9,5000,8\n",
                Read(2, [1.0, 0.0, 8.0, 0.0]),
            ),
            (
                "upper_rpm,lower_rpm,thrust_n,torque_nm\n2500,4500,5,-.1\n4500,2500,6,-.3\n2500,2500,3,-.2\n",
                Read(3, [0.5, 0.5, 3.0, -0.2]),
            ),
        ],
    );
}

#[test]
fn maps_of_pairs() {
    let rows = "0.2,0.2,1,0\n0.2,0.8,5,.2\n0.8,0.2,6,-.2\n0.8,0.8,9,.1\n";
    let with = |header: &str| format!("{header}\n{rows}");
    let (plain, last) = (with("upper,lower,thrust_n,torque_nm"), [0.8, 0.8, 9.0, 0.1]);
    let texts = [
        (plain.clone(), Read(4, last)),
        (plain.replace(',', ";"), Read(4, last)),
        (plain.replace(',', " "), Read(4, last)),
        (format!("run 3, 22.7.,,\n{plain}"), Read(4, last)),
        (format!("sep=,\n{plain}"), Read(4, last)),
        (
            format!("date: 1.2.2026\n{}", plain.replace(',', " , ")),
            Read(4, last),
        ),
        (
            with("top throttle,bottom throttle,thrust_n,torque_nm"),
            Read(4, last),
        ),
        (
            with("Throttle A,Throttle B,Thrust (N),Torque (Nm)"),
            Noted("does not say which rotor is above"),
        ),
        (
            with("front throttle,rear throttle,thrust_n,torque_nm"),
            Noted("that of \"front throttle\" is taken"),
        ),
        (
            with("north throttle,south throttle,thrust_n,torque_nm"),
            Refused(&["both look like the upper", "--column upper=HEADER and --column lower=HEADER"]),
        ),
        (
            with("M1 throttle,M2 throttle,thrust_n,torque_nm"),
            Noted("does not say which rotor is above"),
        ),
        (with("throttle1,throttle2,thrust_n,torque_nm"), Read(4, last)),
        (
            "upper, lower, thrust_n, torque_nm\n\"0,2\", \"0,8\", \"5\", \"0,2\"\n\"0,8\", \"0,2\", \"6\", \"-0,2\"\n\
             \"0,8\", \"0,8\", \"9\", \"0,1\"\n"
                .to_owned(),
            Read(3, last),
        ),
        (
            with("motor1,motor2,F,Q"),
            Refused(&[
                "no throttle column; no thrust column",
                "--column lower=HEADER",
            ]),
        ),
        (
            with("upper,lower,Thrust,Torque"),
            Refused(&["\"Thrust\" has no unit", "\"Torque\" has no unit"]),
        ),
        (
            with("upper_pwm,lower_pwm,thrust_n,torque_nm"),
            Refused(&["far below the pulse widths"]),
        ),
        (
            with("upper (%),lower (%),thrust_n,torque_nm"),
            Refused(&["of full throttle at most"]),
        ),
    ];
    let cases: Vec<(&str, Comes)> = texts
        .iter()
        .map(|(text, comes)| (text.as_str(), *comes))
        .collect();
    hold(&Settings::default(), &cases);
}

/// Power is voltage times current, else what a column of it says.
#[test]
fn power_has_columns_of_its_own() {
    for (header, row, watts) in [
        ("throttle,thrust_n,Electrical Power (W)", "1,8,120", 120.0),
        ("throttle,thrust_n,Power (kW)", "1,8,0.12", 120.0),
        (
            "throttle,thrust_n,voltage_v,current_a,Power (W)",
            "1,8,20,5,120",
            100.0,
        ),
        (
            "upper,lower,thrust_n,torque_nm,upper_power_w,lower_power_w",
            "1,0,8,.1,70,50",
            120.0,
        ),
        ("throttle,thrust_n,Mechanical Power (W)", "1,8,120", f64::NAN),
    ] {
        let content = Ok(format!("{header}\n{row}\n").into_bytes());
        let name = "b.csv".to_owned();
        let bench = read(&Text { name, content }, &one_rotor()).expect("a bench");
        let found = bench.points[0].power_w;
        assert!(
            found == watts || found.is_nan() && watts.is_nan(),
            "{header}: {found}"
        );
    }
}
