//! The program as its user runs it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use simulation::vehicle::WEIGHT_N;

fn flight(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_flight"))
        .args(arguments)
        .output()
        .unwrap()
}

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    if folder.exists() {
        fs::remove_dir_all(&folder).unwrap();
    }
    folder
}

const SCENARIOS: [&str; 3] = [
    "still-air-decoupled-tilt",
    "unsteady-air-decoupled-tilt",
    "unsteady-air-coupled-tilt",
];

#[test]
fn prints_the_tables_and_writes_figures_and_data() {
    let (plots, logs) = (folder("plots"), folder("logs"));
    let run = flight(&[
        "--seeds",
        "1",
        "--plots",
        plots.to_str().unwrap(),
        "--csv",
        logs.to_str().unwrap(),
    ]);
    assert!(run.status.success(), "{run:?}");
    let text = String::from_utf8(run.stdout).unwrap();
    assert_eq!(text.matches("Table II").count(), 3, "{text}");
    assert_eq!(text.matches("MSE x, mm2").count(), 3, "{text}");
    // The paper's own ratios, from its Table II.
    for ratio in [
        "0.55", "0.39", "0.45", "0.72", "0.69", "0.73", "0.90", "0.50", "0.78",
    ] {
        assert!(text.contains(&format!("{ratio}\n")), "{ratio} in\n{text}");
    }
    assert!(text.contains("docs/flights.md says what"), "{text}");

    for scenario in SCENARIOS {
        for figure in ["fig8-position", "fig9-yaw", "fig10-thrust"] {
            let svg = fs::read_to_string(plots.join(format!("{figure}-{scenario}.svg"))).unwrap();
            assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
            assert!(svg.contains("conventional mixer") && svg.contains("coaxial mixer"));
            // Two columns with two lines each at least, none of them broken.
            let lines: Vec<&str> = svg.split("<path class=\"line ").skip(1).collect();
            let is_whole = |line: &&str| line.split("/>").next().unwrap().matches('M').count() == 1;
            assert!(lines.len() >= 4 && lines.iter().all(is_whole));
        }
        let [coaxial, conventional] = ["coaxial", "conventional"].map(|mixer| {
            let mut log = csv::Reader::from_path(logs.join(format!("{scenario}-{mixer}.csv"))).unwrap();
            let column = log.headers().unwrap().iter().position(|name| name == "thrust_n");
            let thrusts: Vec<f64> = log
                .records()
                .map(|record| record.unwrap()[column.unwrap()].parse().unwrap())
                .collect();
            assert_eq!(thrusts.len(), 5000);
            thrusts.iter().sum::<f64>() / thrusts.len() as f64 / WEIGHT_N
        });
        assert!(
            (coaxial - 1.0).abs() < 0.02 && (1.15..1.23).contains(&conventional),
            "{coaxial} {conventional}"
        );
    }
    let mut tracking = csv::Reader::from_path(logs.join("tracking.csv")).unwrap();
    assert_eq!(tracking.records().map(Result::unwrap).count(), 6);
}

#[test]
fn refuses_what_it_cannot_do() {
    let none = flight(&["--seeds", "0"]);
    assert_eq!(none.status.code(), Some(2), "{none:?}");
    // A file where the folder should be.
    let taken = Path::new(env!("CARGO_TARGET_TMPDIR")).join("taken");
    fs::write(&taken, "").unwrap();
    let blocked = flight(&["--seeds", "1", "--csv", taken.to_str().unwrap()]);
    assert_eq!(blocked.status.code(), Some(1), "{blocked:?}");
    assert!(
        String::from_utf8_lossy(&blocked.stderr).starts_with("error: "),
        "{blocked:?}"
    );
}
