//! `cargo mixer mix`: rows in, rows out.

use std::io::{BufRead, BufReader, Read, Write};
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

use crate::{HEADER, X8, cargo_mixer, folder, printed, root};

/// One row of `mix`: throttles, achieved wrench, saturation.
fn row(line: &str) -> (Vec<f32>, [f32; 4], u16) {
    let fields: Vec<&str> = line.split(',').collect();
    let (saturation, numbers) = fields.split_last().unwrap();
    let numbers: Vec<f32> = numbers.iter().map(|number| number.parse().unwrap()).collect();
    let (throttles, achieved) = numbers.split_at(numbers.len() - 4);
    (
        throttles.to_vec(),
        achieved.try_into().unwrap(),
        saturation.parse().unwrap(),
    )
}

#[test]
fn mix_prints_the_bits_of_the_tables() {
    let text = std::fs::read_to_string(root().join(X8)).unwrap();
    let compiled = mixer_compiler::compile(&mixer_compiler::Source::new(X8, text)).unwrap();
    let setpoints: Vec<([f32; 4], f32)> = (0..200u8)
        .map(|i| {
            let x = f32::from(i) / 200.0;
            ([x - 0.3, 1.7 * x * x - 0.4, 0.7 - x, 90.0 * x], 12.5 + 5.0 * x)
        })
        .collect();
    let rows = setpoints
        .iter()
        .map(|([roll, pitch, yaw, thrust], voltage)| format!("{voltage},{thrust},{roll},{pitch},{yaw}\n"));
    let input = format!(
        "voltage_v,thrust_n,roll_nm,pitch_nm,yaw_nm\n{}",
        rows.collect::<String>()
    );
    let output = printed(&["mix", X8], input.as_bytes());
    let mut lines = output.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert_eq!(header.len(), 8 + 4 + 1);
    assert_eq!((header[0], header[7]), ("throttle_0", "throttle_7"));
    assert_eq!(
        header[8..],
        [
            "achieved_roll_nm",
            "achieved_pitch_nm",
            "achieved_yaw_nm",
            "achieved_thrust_n",
            "saturation"
        ]
    );
    let rows: Vec<_> = lines.map(row).collect();
    assert_eq!(rows.len(), setpoints.len());
    let (mut saturated, mut clamped) = (0, 0);
    for ((wrench, voltage), (throttles, achieved, saturation)) in setpoints.iter().zip(&rows) {
        let wrench = mixer_rt::Wrench::from_array(*wrench);
        let expected = compiled.tables.mix(&wrench, *voltage).unwrap();
        let bits = |values: &[f32]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(throttles), bits(&expected.0));
        assert_eq!(bits(achieved), bits(&expected.1.to_array()));
        assert_eq!(*saturation, expected.2.bits());
        saturated += u32::from(expected.2.any_axis());
        clamped += u32::from(expected.2.voltage_clamped());
    }
    // The sequence shows both kinds of row.
    assert!(
        (1..200).contains(&saturated) && (1..200).contains(&clamped),
        "{saturated} {clamped}"
    );
}

#[test]
fn mix_answers_each_row_before_the_next() {
    let mut child = cargo_mixer(&["mix", X8]).spawn().unwrap();
    let mut stdin = child.stdin.take().unwrap();
    let (sender, answers) = mpsc::channel();
    let output = BufReader::new(child.stdout.take().unwrap());
    let reader = thread::spawn(move || output.lines().try_for_each(|line| sender.send(line.unwrap())));
    // An answer that is kept back fails the test; it does not hang it.
    let answer = || answers.recv_timeout(Duration::from_secs(30)).expect("no answer");
    writeln!(stdin, "{HEADER}").unwrap();
    assert!(answer().starts_with("throttle_0,"));
    for thrust_n in [20.0, 30.0, 40.0] {
        // In two pieces: half a line is no reason to keep an answer back.
        write!(stdin, "0,0,0,{thrust_n}\n0,").unwrap();
        let (_, [.., achieved], _) = row(&answer());
        assert!((achieved - thrust_n).abs() < 0.04, "{achieved}");
        writeln!(stdin, "0,0,{thrust_n}").unwrap();
        let (_, [.., again], _) = row(&answer());
        assert_eq!(again, achieved);
    }
    drop(stdin);
    reader.join().unwrap().unwrap();
    assert_eq!(answers.try_recv(), Err(mpsc::TryRecvError::Disconnected));
    assert!(child.wait().unwrap().success());
}

#[test]
fn a_reader_that_has_seen_enough_is_no_fault() {
    // More rows than any pipe holds.
    let input = format!("{HEADER}\n{}", "0,0,0,31\n".repeat(10_000));
    let mut child = cargo_mixer(&["mix", X8]).spawn().unwrap();
    let mut first = [0; 8];
    let mut reader = child.stdout.take().unwrap();
    let mut stdin = child.stdin.take().unwrap();
    let writer = thread::spawn(move || {
        let _ = stdin.write_all(input.as_bytes());
    });
    reader.read_exact(&mut first).unwrap();
    drop(reader);
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap();
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    assert_eq!(&first, b"throttle");
}

/// With all rotors `[pair.lower_out]` and `[pair.upper_out]` change no bit; with one out they do. A
/// bias of 0 is none.
#[test]
fn rotors_alone_and_a_bias_of_zero_leave_the_bits() {
    let text = std::fs::read_to_string(root().join("airframes/x8-11in-least-power.toml")).unwrap();
    let (before, rest) = text.split_once("[pair.lower_out]").unwrap();
    let (_, after) = rest.split_once("[pair.power]").unwrap();
    let bias = |value: &str| text.replacen("power_bias_nm_per_n = 0.00654", value, 1);
    let variants = [
        ("declared", text.clone()),
        ("polynomials", format!("{before}[pair.power]{after}")),
        ("zero", bias("power_bias_nm_per_n = 0.0")),
        ("none", bias("")),
    ];
    let folder = folder("bits");
    let mut input = format!("{HEADER},voltage_v\n");
    for k in 0..500u16 {
        let x = f32::from(k) / 500.0;
        let [roll, pitch, yaw] = [17.0, 29.0, 41.0].map(|turns: f32| 1.5 * (turns * x).sin());
        input += &format!("{roll},{pitch},{},{},{}\n", 0.2 * yaw, 80.0 * x, 9.5 + 2.0 * x);
    }
    let [declared, polynomials, zero, none] = variants.map(|(name, text)| {
        let path = folder.join(format!("{name}.toml"));
        std::fs::write(&path, text).unwrap();
        let path = path.display().to_string();
        [&["mix", path.as_str()][..], &["mix", &path, "--failed", "0"]]
            .map(|arguments| printed(arguments, input.as_bytes()))
    });
    assert_eq!(declared[0], polynomials[0]);
    assert_ne!(declared[1], polynomials[1]);
    assert_eq!(zero, none);
    assert_ne!(declared[0], none[0]);
    assert_eq!(declared[1], none[1], "there is no bias while a rotor is out");
}
