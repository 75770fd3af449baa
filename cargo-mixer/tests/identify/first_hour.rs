//! From a bench file to an airframe, as a new user goes: verdicts that fit a screen, one airframe by
//! every way, the pack's voltages.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use crate::command::{folder, text};
use crate::sweep::{Row, plain, rows};

fn mixer(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_cargo-mixer"))
        .current_dir(folder)
        .args(args)
        .output()
        .expect("the program runs")
}

fn succeeds(folder: &Path, args: &[&str]) -> (String, String) {
    let output = mixer(folder, args);
    let [out, err] = [&output.stdout, &output.stderr].map(|bytes| text(bytes));
    assert!(output.status.success(), "{args:?}\n{err}");
    (out, err)
}

fn read(folder: &Path, file: &str) -> String {
    fs::read_to_string(folder.join(file)).expect("a file")
}

/// A sweep with currents, of whose power a little torque saves some.
fn with_power(rows: &[Row]) -> String {
    let mut text = String::from(
        "upper,lower,thrust_n,torque_nm,upper_voltage_v,lower_voltage_v,upper_current_a,lower_current_a\n",
    );
    for r in rows {
        let (f, q): (f64, f64) = (r.thrust.iter().sum(), r.torque.iter().sum());
        let [upper, lower] = [10.0 * r.u * r.u * r.u, 8.0 * r.l * r.l * r.l];
        let _ = writeln!(text, "{},{},{f},{q},14.8,14.8,{upper},{lower}", r.u, r.l);
    }
    text
}

#[test]
fn the_verdict_fits_a_screen() {
    let folder = folder("verdict");
    let parts: Vec<Row> = rows(1)
        .into_iter()
        .filter(|r| r.u.min(r.l) > 0.35 && r.u.max(r.l) < 0.9)
        .collect();
    let mut bad = String::from_utf8(plain(&rows(2))).expect("text");
    for k in 0..300 {
        let _ = writeln!(bad, "{k},.5,x,y,14.8");
    }
    for (name, content) in [
        ("good.csv", String::from_utf8(plain(&rows(1))).expect("text")),
        ("part.csv", String::from_utf8(plain(&parts)).expect("text")),
        ("bad.csv", bad),
        ("power.csv", with_power(&rows(3))),
    ] {
        fs::write(folder.join(name), content).expect("written");
        let (out, err) = succeeds(&folder, &["identify", name, "-o", "pair.toml", "--force"]);
        let lines = out.lines().count() + err.lines().filter(|line| !line.starts_with("refused: ")).count();
        assert!(lines <= 30, "{lines} lines\n{out}{err}");
        for line in out.lines() {
            assert!(line.chars().count() <= 100, "{line}");
        }
        for part in [
            "thrust ",
            "throttle ",
            "model error ",
            "voltage ",
            "warnings ",
            "% of the largest thrust",
        ] {
            assert!(out.contains(part), "no {part:?} in\n{out}");
        }
        assert!(
            err.contains("wrote pair.toml\n") && err.contains("next  "),
            "{err}"
        );
        let (verbose, _) = succeeds(&folder, &["identify", name, "--verbose"]);
        assert!(
            verbose.contains("leave one throttle level out") && verbose.contains("u2l2"),
            "{verbose}"
        );
    }
    let (part, _) = succeeds(&folder, &["identify", "part.csv"]);
    assert!(
        part.contains("throttle.min is 0.4: what is below is never commanded"),
        "{part}"
    );
    let (_, bad) = succeeds(&folder, &["identify", "bad.csv"]);
    assert!(
        bad.contains("bad.csv:102: ") && bad.contains("refused: 295 rows more"),
        "{bad}"
    );
}

#[test]
fn both_ways_give_one_airframe() {
    let folder = folder("both-ways");
    fs::write(folder.join("map.csv"), with_power(&rows(3))).expect("written");
    for frame in ["x8", "y6"] {
        let at = ["--frame", frame, "--arm", "0.45", "--name", "one", "--force"];
        let of = |args: &[&str]| succeeds(&folder, &[args, &at].concat());
        of(&["identify", "map.csv", "-o", "direct.toml"]);
        succeeds(&folder, &["identify", "map.csv", "-o", "pair.toml", "--force"]);
        of(&["new", "--pair", "pair.toml", "-o", "two-steps.toml"]);
        let direct = read(&folder, "direct.toml");
        assert_eq!(direct, read(&folder, "two-steps.toml"), "{frame}");
        assert_eq!(
            direct.contains("\npower_bias_nm_per_n = "),
            frame == "x8",
            "{direct}"
        );
    }
}

#[test]
fn what_comes_next_is_said() {
    let folder = folder("next");
    fs::write(folder.join("map.csv"), plain(&rows(1))).expect("written");
    let rotor = "throttle,thrust_n,torque_nm\n0.2,1,0.02\n0.4,3,0.05\n0.6,6,0.1\n0.8,10,0.17\n1,15,0.25\n";
    fs::write(folder.join("rotor.csv"), rotor).expect("written");
    for command in [["identify", "map.csv"], ["predict", "rotor.csv"]] {
        for (arguments, next) in [
            (
                vec![],
                "-o PAIR.toml writes the tables; nothing is written without it",
            ),
            (
                vec!["-o", "pair.toml", "--force"],
                "cargo mixer new --frame x8 --arm METRE --pair pair.toml -o AIRFRAME.toml",
            ),
            (
                vec!["-o", "y6.toml", "--force", "--frame", "y6", "--arm", "0.3"],
                "cargo mixer check y6.toml",
            ),
        ] {
            let (_, err) = succeeds(&folder, &[&command[..], &arguments].concat());
            let last = err.lines().last().expect("a line");
            assert_eq!(last, format!("next            {next}"), "{command:?}");
        }
        let (_, err) = succeeds(&folder, &[&command[..], &["--json"]].concat());
        assert!(!err.contains("next  "), "{command:?}: {err}");
    }
}

/// The pair of another airframe, without what was chosen for its vehicle.
#[test]
fn a_whole_airframe_s_pair_is_taken() {
    let folder = folder("whole-airframe");
    let other = Path::new(env!("CARGO_MANIFEST_DIR")).join("../airframes/x8-11in-least-power.toml");
    let other = other.to_str().expect("a path");
    let at = ["--frame", "y6", "--arm", "0.3", "-o", "mine.toml"];
    succeeds(&folder, &[&["new", "--pair", other][..], &at].concat());
    let tables = |text: String| -> toml::Table { text.parse().expect("TOML") };
    let (mine, other) = (
        tables(read(&folder, "mine.toml")),
        tables(fs::read_to_string(other).expect("a file")),
    );
    for key in ["throttle", "pair", "voltage"] {
        assert_eq!(mine[key], other[key], "{key}");
    }
    assert!(!mine.contains_key("vehicle"), "{mine}");
    assert!(
        !mine["allocation"]
            .as_table()
            .expect("a table")
            .contains_key("power_bias_nm_per_n")
    );

    // What is wrong is told of the file that was given.
    fs::write(
        folder.join("bad.toml"),
        "[pair]\nbasis = \"cubic\"\nthrust_n = [1.0\n",
    )
    .expect("written");
    fs::write(folder.join("none.toml"), "[throttle]\nmin = 0.1\nmax = 1.0\n").expect("written");
    fs::write(
        folder.join("short.toml"),
        "[throttle]\nmin = 0.1\nmax = 1.0\n[pair]\nbasis = \"cubic\"\n",
    )
    .expect("written");
    for (file, told) in [
        ("bad.toml", "bad.toml: TOML parse error at line 3"),
        ("none.toml", "none.toml: no [pair] in it"),
        ("short.toml", "with the pair of short.toml, not written"),
    ] {
        let output = mixer(
            &folder,
            &[
                "new", "--frame", "x8", "--arm", "0.4", "--pair", file, "-o", "no.toml",
            ],
        );
        let err = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{err}");
        assert!(err.contains(told), "{err}");
        assert!(!folder.join("no.toml").exists());
    }
}

#[test]
fn the_pack_s_voltages_are_its_cells() {
    let folder = folder("pack");
    fs::write(folder.join("map.csv"), plain(&rows(1))).expect("written");
    let of = |args: &[&str]| {
        succeeds(
            &folder,
            &[&["identify", "map.csv", "-o", "pair.toml", "--force"][..], args].concat(),
        );
        read(&folder, "pair.toml")
    };
    // Without exponents it is there to be filled in.
    let open = of(&[]);
    assert!(
        open.contains("\n# [voltage]\n# reference_v = 14.8 ") && open.contains("\n# range_v = [?, ?]"),
        "{open}"
    );
    assert!(of(&["--cells", "4"]).contains("\n# range_v = [12.8, 16.8]"));
    let range = |args: &[&str]| {
        let table: toml::Table = of(args).parse().expect("TOML");
        table["voltage"]["range_v"].to_string()
    };
    let exponent = ["--voltage-exponent", "1.75"];
    assert_eq!(range(&exponent), "[14.8, 14.8]");
    assert_eq!(
        range(&[&exponent[..], &["--cells", "4"]].concat()),
        "[12.8, 16.8]"
    );
    assert_eq!(
        range(&[&exponent[..], &["--cells", "4", "--chemistry", "li-ion"]].concat()),
        "[11.2, 16.8]"
    );
    let output = mixer(
        &folder,
        &[
            "identify",
            "map.csv",
            "--voltage-exponent",
            "1.75",
            "--cells",
            "6",
        ],
    );
    let err = text(&output.stderr);
    assert!(
        err.contains("the pack has 19.2 to 25.2 V, the bench had 14.8 V"),
        "{err}"
    );
    for (wrong, told) in [
        (vec!["--voltage-exponent", "99"], "99 is above 4"),
        (vec!["--reference-voltage", "1e9"], "measured at 14.80 to 14.80 V"),
        (vec!["--date", "2024-02-31"], "is not a date"),
    ] {
        let output = mixer(&folder, &[&["identify", "map.csv"][..], &wrong].concat());
        let err = text(&output.stderr);
        assert!(!output.status.success() && err.contains(told), "{wrong:?}: {err}");
    }
}

/// The run that docs/bench.md explains. `cargo xtask bench-data` writes it.
#[test]
fn the_report_of_the_documents_is_that_of_the_bench() {
    const FILE: &str =
        "data2021_08_17_23_41_12_16p2in_prop_400kv_22V_MN4014_T_motor_map10x10_full_range_zD_025.csv";
    let Some(data) = std::env::var_os("MIXER_BENCH_DATA") else {
        eprintln!("NOT RUN: the_report_of_the_documents_is_that_of_the_bench needs MIXER_BENCH_DATA");
        return;
    };
    let arguments = ["--voltage-exponent", "1.75", "--cells", "6"];
    let (told, _) = succeeds(
        &Path::new(&data).join("newdexterity"),
        &[&["identify", FILE][..], &arguments].concat(),
    );
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/bench.md");
    let text = fs::read_to_string(&page).expect("the page");
    let (before, rest) = text.split_once("<!-- identify -->").expect("a place");
    let (_, after) = rest.split_once("<!-- end -->").expect("an end");
    let command = format!("$ cargo mixer identify {FILE} {}", arguments.join(" "));
    let now = format!("{before}<!-- identify -->\n\n```console\n{command}\n{told}```\n\n<!-- end -->{after}");
    if std::env::var_os("MIXER_MEASUREMENTS").is_some_and(|word| word == "write") {
        fs::write(&page, &now).expect("written");
    }
    assert!(
        fs::read_to_string(&page).expect("the page") == now,
        "run `cargo xtask bench-data`"
    );
}

/// What is said of a broken file does not grow with it.
#[test]
fn messages_are_bounded() {
    let folder = folder("bounded");
    let header = "upper,lower,thrust_n,torque_nm\n";
    let good = String::from_utf8(plain(&rows(1))).expect("text");
    let many = |row: &str| row.repeat(2_000_000 / row.len());
    for (name, content, told) in [
        (
            "rows.csv",
            format!("{header}{}", many("x,y,z,1\n")),
            "rows.csv:2: none of 250000 rows",
        ),
        (
            "some.csv",
            format!("{good}{}", many("x,y,z,1\n")),
            "refused: 249995 rows more",
        ),
        (
            "cell.csv",
            format!("{header}.1,.2,{},3\n", "z".repeat(2_000_000)),
            "cell.csv:2: none of 1 rows",
        ),
        (
            "header.csv",
            format!("{}\n1\n", many("c,")),
            "header.csv:1: a header line of 1000001 columns",
        ),
        (
            "points.csv",
            format!(
                "{header}{}",
                (0..20_000)
                    .map(|k| format!("0.{:05},0.5,3,1\n", 1 + 7919 * k % 20_000))
                    .collect::<String>()
            ),
            "points, at most 10000 are fitted",
        ),
    ] {
        fs::write(folder.join(name), content).expect("written");
        let output = mixer(&folder, &["identify", name]);
        let err = text(&output.stderr);
        assert!(err.contains(told), "{name}: {err:.500}");
        assert!(
            err.len() < 3000 && err.lines().all(|line| line.chars().count() <= 1003),
            "{name}: {}",
            err.len()
        );
        let cell = err
            .split("zzz")
            .next()
            .map_or(0, |before| err.len() - before.len());
        assert!(cell < 300, "{name}: a cell of {cell}");
    }
    for (command, name, content) in [
        (
            vec!["check"],
            "a.toml",
            format!("name = \"{}\"\n", "a".repeat(500_000)),
        ),
        (
            vec!["import", "-o", "b.toml"],
            "a.params",
            "garbage ".repeat(100_000),
        ),
        (
            vec!["new", "--frame", "single", "-o", "b.toml", "--pair"],
            "p.toml",
            many("k = ["),
        ),
    ] {
        fs::write(folder.join(name), content).expect("written");
        let output = mixer(&folder, &[&command[..], &[name]].concat());
        assert_eq!(output.status.code(), Some(1), "{command:?}");
        assert!(
            output.stderr.len() < 20_000,
            "{command:?}: {}",
            output.stderr.len()
        );
        assert!(text(&output.stderr).contains(name), "{command:?}");
    }
    #[cfg(target_os = "linux")]
    for command in [vec!["check"], vec!["identify"], vec!["import", "-o", "b.toml"]] {
        let output = mixer(&folder, &[&command[..], &["/dev/zero"]].concat());
        assert!(text(&output.stderr).contains("/dev/zero: "), "{command:?}");
        assert_eq!(output.status.code(), Some(1), "{command:?}");
    }
}
