//! Golden outputs of a user's airframes: written, compared, and what is said of a difference.

use std::fs;

use super::*;

/// A folder of this test's own that is not there yet.
fn folder(test: &str) -> String {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("golden-{test}"));
    let _ = fs::remove_dir_all(&path);
    path.to_str().unwrap().to_owned()
}

const PAIR: &str = "airframes/single-pair.toml";
const FILES: [&str; 5] = [
    "single-pair.report.txt",
    "single-pair.rotors-out.csv",
    "single-pair.rs",
    "single-pair.vectors.csv",
    "single-pair.vectors.rs",
];

#[test]
fn golden_outputs_are_written_and_hold() {
    let folder = folder("holds");
    let output = run(&["golden", PAIR, "-o", &folder]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(stderr(&output).lines().count(), 5, "{}", stderr(&output));
    let mut files: Vec<_> = fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    files.sort();
    assert_eq!(files, FILES);
    let generated = fs::read_to_string(Path::new(&folder).join("single-pair.rs")).unwrap();
    assert_eq!(generated, stdout(&run(&["expand", PAIR])));
    assert_status(&run(&["golden", PAIR, "-o", &folder, "--check"]), 0);
    let output = run(&["golden", PAIR, "-o", &folder]);
    assert!(
        stderr(&output).ends_with("nothing has changed\n"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn golden_check_names_what_differs() {
    let folder = folder("differs");
    run(&["golden", PAIR, "-o", &folder]);
    let path = |file: &str| Path::new(&folder).join(file);
    // One unit in the last place of a throttle.
    let vectors = fs::read_to_string(path(FILES[3])).unwrap();
    let line = vectors.lines().nth(3).unwrap();
    let cell = line.split(',').nth(5).unwrap();
    let bits = u32::from_str_radix(cell.strip_prefix("0x").unwrap(), 16).unwrap();
    let edited = line.replacen(cell, &format!("0x{:08x}", bits - 1), 1);
    fs::write(path(FILES[3]), vectors.replacen(line, &edited, 1)).unwrap();
    fs::remove_file(path(FILES[0])).unwrap();
    fs::write(path("other-x8.rs"), "").unwrap();
    let output = run(&["golden", PAIR, "-o", &folder, "--check"]);
    assert_status(&output, 1);
    let told = stderr(&output);
    for part in [
        "single-pair.vectors.csv:4: throttle_0 was 0.",
        "single-pair.report.txt: No such file",
        "other-x8.rs: belongs to none of these airframes",
        "error: 3 of 5 golden outputs differ",
    ] {
        assert!(told.contains(part), "no {part:?} in {told}");
    }
}

#[test]
fn golden_refuses_before_it_writes() {
    let folder = folder("refused");
    let output = run(&["golden", PAIR, FAULTY, "-o", &folder]);
    assert_status(&output, 1);
    assert!(!Path::new(&folder).exists());
    let output = run(&["golden", PAIR, PAIR, "-o", &folder]);
    assert_status(&output, 1);
    assert!(
        stderr(&output).contains("are both named single-pair"),
        "{}",
        stderr(&output)
    );
    assert_status(&run(&["golden", PAIR, "-o", &folder, "--check"]), 1);
}

/// Vectors are of every kind, and ask something of every rotor that is out.
#[test]
fn golden_vectors_cover_what_they_should() {
    let folder = folder("covers");
    run(&["golden", X8, "-o", &folder]);
    let table = |file: &str| fs::read_to_string(Path::new(&folder).join(file)).unwrap();
    let saturation = |line: &str| line.rsplit(',').next().unwrap().parse::<u16>().unwrap();
    let vectors = table("isae-x8.vectors.csv");
    let (mut delivered, mut saturated, mut clamped) = (0, 0, 0);
    for line in vectors.lines().skip(1) {
        assert_eq!(line.split(',').count(), 5 + 8 + 4 + 1, "{line}");
        match saturation(line) {
            0 => delivered += 1,
            bits => {
                saturated += 1;
                clamped += usize::from(bits >= 256);
            }
        }
    }
    assert!(
        delivered >= 150 && saturated >= 150 && clamped >= 5,
        "{delivered} {saturated} {clamped}"
    );
    let failed = table("isae-x8.rotors-out.csv");
    for channel in 0..8 {
        let rows = failed
            .lines()
            .filter(|line| line.starts_with(&format!("{channel},")));
        // The throttle of a rotor that is out is zero.
        let zero = rows
            .clone()
            .all(|line| line.split(',').nth(6 + channel) == Some("0x00000000"));
        assert!(zero && rows.count() == 12, "{channel}");
    }
}

/// However the path is spelled: no folder of a machine goes under version control.
#[test]
fn outputs_do_not_depend_on_how_the_path_is_spelled() {
    let absolute = root().canonicalize().unwrap().join(PAIR);
    let spellings = [PAIR, &format!("./{PAIR}"), absolute.to_str().unwrap()];
    let outputs = spellings.map(|airframe| {
        let folder = folder("spelled");
        let page = format!("{folder}.html");
        assert_eq!(run(&["golden", airframe, "-o", &folder]).status.code(), Some(0));
        let report = cargo_mixer(&["report", airframe, "-o", &page, "--force"])
            .env("SOURCE_DATE_EPOCH", "0")
            .output()
            .unwrap();
        assert_eq!(report.status.code(), Some(0), "{}", stderr(&report));
        let mut outputs: Vec<String> = FILES
            .iter()
            .map(|file| fs::read_to_string(Path::new(&folder).join(file)).unwrap())
            .collect();
        outputs.push(stdout(&run(&["expand", airframe])).to_owned());
        outputs.push(fs::read_to_string(&page).unwrap());
        for output in &outputs {
            assert!(
                !output.contains(&format!("/{}", "single-pair.toml")),
                "a folder is named"
            );
        }
        outputs
    });
    assert!(outputs[0] == outputs[1] && outputs[0] == outputs[2]);
}
