//! `cargo mixer import` from outside: frames of PX4 and ArduPilot as airframe files.

mod bench_data;
mod stacks;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use toml::{Table, Value};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// A folder of this test's own, empty; removed when dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(test: &str) -> Self {
        let path = std::env::temp_dir().join(format!("cargo-mixer-{test}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Folder(path)
    }

    fn write(&self, name: &str, text: &str) -> PathBuf {
        let path = self.0.join(name);
        fs::write(&path, text).unwrap();
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn cargo_mixer(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_cargo-mixer"));
    command.args(arguments).current_dir(root()).output().unwrap()
}

/// A unit of an airframe file.
#[derive(Debug, PartialEq)]
struct Unit {
    position_m: Vec<f64>,
    upper_spin: String,
    channels: Vec<i64>,
}

/// Imports `files` into `folder`, has the airframe checked, and returns its units and the file.
#[track_caller]
fn import(folder: &Folder, files: &[&Path], options: &[&str]) -> (Vec<Unit>, String) {
    let airframe = folder.0.join("airframe.toml");
    let output = airframe.display().to_string();
    let files: Vec<String> = files.iter().map(|file| file.display().to_string()).collect();
    let mut arguments = vec![
        "import",
        "--pair",
        "airframes/isae-x8.toml",
        "--force",
        "-o",
        &output,
    ];
    arguments.extend(files.iter().map(String::as_str));
    arguments.extend(options);
    let imported = cargo_mixer(&arguments);
    assert!(imported.status.success(), "{imported:?}");
    let checked = cargo_mixer(&["check", &output]);
    assert!(checked.status.success(), "{checked:?}");
    let text = fs::read_to_string(airframe).unwrap();
    (units(&text), text)
}

fn units(text: &str) -> Vec<Unit> {
    let table: Table = text.parse().unwrap();
    let unit = |unit: &Value| Unit {
        position_m: numbers(&unit["position_m"]),
        upper_spin: unit["upper_spin"].as_str().unwrap().to_owned(),
        channels: unit["channels"]
            .as_array()
            .unwrap()
            .iter()
            .map(|c| c.as_integer().unwrap())
            .collect(),
    };
    table["unit"].as_array().unwrap().iter().map(unit).collect()
}

fn numbers(value: &Value) -> Vec<f64> {
    value
        .as_array()
        .unwrap()
        .iter()
        .map(|x| x.as_float().unwrap())
        .collect()
}

/// Channels and upper spin of every unit.
fn outline(units: &[Unit]) -> Vec<(Vec<i64>, &str)> {
    units
        .iter()
        .map(|unit| (unit.channels.clone(), unit.upper_spin.as_str()))
        .collect()
}

/// The first line of what a refusal says; nothing is written.
#[track_caller]
fn refused(folder: &Folder, file: &Path, options: &[&str]) -> String {
    let airframe = folder.0.join("refused.toml");
    let (file, output) = (file.display().to_string(), airframe.display().to_string());
    let mut arguments = vec!["import", &file, "-o", &output];
    arguments.extend(options);
    let run = cargo_mixer(&arguments);
    assert_eq!(run.status.code(), Some(1), "{run:?}");
    assert!(!airframe.exists());
    let said = String::from_utf8(run.stderr).unwrap();
    assert!(said.starts_with("error: ") && said.lines().count() == 1, "{said}");
    said
}

/// A bicopter with defaults left out: PX4's are a position of 0, an axis upwards, KM 0.05.
const BICOPTER: &str = "# by hand
1\t1\tCA_ROTOR_COUNT\t4\t6
1\t1\tCA_ROTOR0_PY\t0.300000011920928955\t9
1\t1\tCA_ROTOR0_PZ\t-0.1\t9
1\t1\tCA_ROTOR1_PY\t-0.300000011920928955\t9
1\t1\tCA_ROTOR1_PZ\t0.05\t9
1\t1\tCA_ROTOR2_PY\t0.300000011920928955\t9
1\t1\tCA_ROTOR2_KM\t-0.05\t9
1\t1\tCA_ROTOR3_PY\t-0.300000011920928955\t9
1\t1\tCA_ROTOR3_KM\t-0.05\t9
1\t1\tBAT1_N_CELLS\t4\t6
1\t1\tBAT1_V_EMPTY\t3.6\t9
1\t1\tBAT1_V_CHARGED\t4.05\t9
";

#[test]
fn px4_defaults_stand_in() {
    let folder = Folder::new("px4");
    let file = folder.write("bicopter.params", BICOPTER);
    let output = folder.0.join("airframe.toml").display().to_string();
    let run = cargo_mixer(&[
        "import",
        &file.display().to_string(),
        "--name",
        "my-bicopter",
        "-o",
        &output,
    ]);
    assert!(run.status.success(), "{run:?}");
    let notes = String::from_utf8(run.stderr).unwrap();
    for note in [
        "note: the idle is not",
        "note: [voltage] is in comments",
        "note: no parameter describes the pair",
    ] {
        assert!(notes.contains(note), "{notes}");
    }
    let text = fs::read_to_string(&output).unwrap();
    assert!(text.starts_with("name = \"my-bicopter\"\n"), "{text}");
    assert!(text.contains("# range_v = [14.4, 16.2]\n"), "{text}");
    let expected = [
        Unit {
            position_m: vec![0.0, 0.3, -0.05],
            upper_spin: "ccw".to_owned(),
            channels: vec![0, 2],
        },
        Unit {
            position_m: vec![0.0, -0.3, 0.025],
            upper_spin: "cw".to_owned(),
            channels: vec![3, 1],
        },
    ];
    assert_eq!(units(&text), expected);

    // What is there is not overwritten.
    let again = cargo_mixer(&["import", &file.display().to_string(), "-o", &output]);
    assert_eq!(again.status.code(), Some(1));
    assert_eq!(fs::read_to_string(&output).unwrap(), text);
}

#[test]
fn ardupilot_frames_need_an_arm() {
    let folder = Folder::new("ardupilot");
    let file = folder.write(
        "y6.param",
        "FRAME_CLASS,5\nFRAME_TYPE,10\nMOT_SPIN_MIN,0.08\nMOT_SPIN_MAX,0.95\nMOT_BAT_VOLT_MIN,13.2\nMOT_BAT_VOLT_MAX,16.8\n",
    );
    let said = refused(&folder, &file, &[]);
    assert!(said.contains("--arm METRES"), "{said}");
    let (units, text) = import(&folder, &[&file], &["--arm", "0.4"]);
    let expected = [(vec![0, 1], "cw"), (vec![2, 3], "cw"), (vec![4, 5], "cw")];
    assert_eq!(outline(&units), expected);
    assert_eq!(units[0].position_m, [0.2, 0.3464, 0.0]);
    assert_eq!(units[1].position_m, [-0.4, 0.0, 0.0]);
    // The X8's pair has an idle of 0.1 and its own [voltage].
    assert!(text.contains("\n[throttle]\nmin = 0.1\nmax = 0.95\n"), "{text}");
    assert!(
        text.contains("narrowed to the pair's: set MOT_SPIN_MIN to 0.1"),
        "{text}"
    );
    assert!(text.contains("13.2 to 16.8 V: compare"), "{text}");

    let (swapped, _) = import(&folder, &[&file], &["--arm", "0.4", "--upper", "1,3,5"]);
    let expected = [(vec![1, 0], "ccw"), (vec![3, 2], "ccw"), (vec![5, 4], "ccw")];
    assert_eq!(outline(&swapped), expected);
}

#[test]
fn files_without_coaxial_rotors_are_refused() {
    let folder = Folder::new("import-refusals");
    for (text, options, message) in [
        (
            "BAT1_N_CELLS 3\n",
            [].as_slice(),
            "no rotors: neither CA_ROTOR_COUNT",
        ),
        (
            "FRAME_CLASS,1\nFRAME_TYPE,1\n",
            &["--arm", "0.4"],
            "is no frame of coaxial pairs",
        ),
        (
            "FRAME_CLASS,4\nFRAME_TYPE,20\n",
            &["--arm", "0.4"],
            "both rotors of an arm turn the same way",
        ),
        (
            "FRAME_CLASS,4\n",
            &["--arm", "0.4"],
            "FRAME_TYPE is not a whole number",
        ),
        (
            "CA_ROTOR_COUNT 0\n",
            &[],
            "CA_ROTOR_COUNT is not a number from 1 to 12",
        ),
        (
            "CA_ROTOR_COUNT 2\nCA_ROTOR1_KM -0.05\n",
            &[],
            "rotors 0 and 1 are at one height: which is on top?",
        ),
        ("CA_ROTOR_COUNT 1\nCA_ROTOR0_KM 0\n", &[], "CA_ROTOR0_KM is 0"),
        ("not a parameter\n", &[], "is no parameter"),
    ] {
        let file = folder.write("a.params", text);
        let said = refused(&folder, &file, options);
        assert!(said.contains(message), "{said}");
    }
    let file = folder.write("b.params", BICOPTER);
    let said = refused(&folder, &file, &["--pair", "airframes/none.toml"]);
    assert!(said.contains("airframes/none.toml: "), "{said}");
}
