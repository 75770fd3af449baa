//! `cargo xtask TASK`: the developer's commands behind one door. Each starts a program that stands
//! elsewhere.

use std::path::Path;
use std::process::{Command, ExitCode};

/// A task: its name, the words that start it, and what it does.
struct Task {
    name: &'static str,
    program: &'static [&'static str],
    does: &'static str,
}

/// Runs a program of `mixer-tests`, compiled as for the tests.
macro_rules! tests {
    ($binary:literal) => {
        &[
            "cargo",
            "run",
            "--quiet",
            "--locked",
            "--profile=test",
            "-p",
            "mixer-tests",
            "--bin",
            $binary,
            "--",
        ]
    };
}

const TASKS: &[Task] = &[
    Task {
        name: "test",
        program: &["tests/run"],
        does: "every test; `test --stage NAME` runs one stage, `test --install` installs what is missing first",
    },
    Task {
        name: "bless",
        program: &[
            "sh",
            "-c",
            "exec cargo run --quiet --locked --profile=test -p cargo-mixer -- golden airframes/*.toml -o tests/golden --force \"$@\"",
            "sh",
        ],
        does: "writes the golden outputs of airframes/ to tests/golden/",
    },
    Task {
        name: "counts",
        program: tests!("counts"),
        does: "counts instructions in QEMU; `counts --search` looks for requests that cost more, `counts --bless` writes tests/counts.csv, tests/worst.csv and docs/costs.md, `counts --page` docs/costs.md alone",
    },
    Task {
        name: "web",
        program: &[
            "cargo",
            "run",
            "--quiet",
            "--locked",
            "-p",
            "mixer-web-bundle",
            "--",
        ],
        does: "makes the page of web/ as static files; `web -o FOLDER`",
    },
    Task {
        name: "soak",
        program: tests!("soak"),
        does: "draws frames and requests for `--minutes M` with `--seed S` and holds every answer to the physics; prints failures with what reproduces them",
    },
    Task {
        name: "allocators",
        program: tests!("allocators"),
        does: "compares allocators and writes tests/measurements/allocators.csv",
    },
    Task {
        name: "bases",
        program: tests!("bases"),
        does: "compares bases on MIXER_BENCH_DATA and writes tests/measurements/bases.csv",
    },
    Task {
        name: "interaction",
        program: tests!("interaction"),
        does: "fits the constants of the interaction on MIXER_BENCH_DATA, leaves systems out and writes interaction.csv and interaction-constants.csv of tests/measurements/",
    },
    Task {
        name: "bench-data",
        program: &[
            "sh",
            "-c",
            ": \"${MIXER_BENCH_DATA:?names the folder of bench data}\" && \
             MIXER_MEASUREMENTS=write exec cargo test --quiet --locked -p cargo-mixer --test commands -- \
             five_levels two_spacings mistakes_are_told logged_flights in_hover report_of_the_documents",
        ],
        does: "measures on MIXER_BENCH_DATA and writes levels.csv, spacings.csv, logged-saving.csv, logged-hover.csv and \
               docs/bench.md",
    },
    Task {
        name: "flights",
        program: &[
            "cargo",
            "run",
            "--quiet",
            "--locked",
            "--release",
            "-p",
            "simulation",
            "--",
            "--errors",
            "tests/measurements/flight.csv",
            "--energy",
            "tests/measurements/energy.csv",
            "--rotor-out",
            "tests/measurements/rotor-out.csv",
        ],
        does: "flies the comparison and writes flight.csv, energy.csv and rotor-out.csv of tests/measurements/",
    },
    Task {
        name: "tables",
        program: tests!("tables"),
        does: "writes the tables of README.md and docs/ from what the tasks above have measured",
    },
    Task {
        name: "gallery",
        program: &[
            "cargo",
            "run",
            "--quiet",
            "--locked",
            "--profile=test",
            "-p",
            "mixer-report",
            "--example",
            "gallery",
            "--",
        ],
        does: "draws the pictures of docs/",
    },
];

fn main() -> ExitCode {
    let mut arguments = std::env::args_os().skip(1);
    let name = arguments.next().unwrap_or_default();
    let Some(task) = TASKS.iter().find(|task| name == task.name) else {
        eprintln!("usage: cargo xtask TASK [ARGUMENT..]\n");
        for Task { name, does, .. } in TASKS {
            eprintln!("  {name:<11} {does}");
        }
        return ExitCode::from(2);
    };
    let [program, words @ ..] = task.program else {
        return ExitCode::FAILURE;
    };
    // `cargo xtask counts -- --page` and `cargo xtask counts --page` are the same.
    let arguments = arguments.filter(|argument| argument != "--");
    // This package lies in the project's folder `tools`.
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let program = if program.contains('/') {
        root.join(program)
    } else {
        program.into()
    };
    match Command::new(&program)
        .args(words)
        .args(arguments)
        .current_dir(&root)
        .status()
    {
        Ok(status) if status.success() => ExitCode::SUCCESS,
        Ok(_) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {}: {error}", program.display());
            ExitCode::FAILURE
        }
    }
}
