//! What cannot serve is refused with its reason and with what would be needed.

use mixer_identify::bench::Kind;
use mixer_identify::identified::from_benches;

use crate::sweep::{Row, bench, plain, rows, settings};

fn reason(bytes: &[u8]) -> String {
    let settings = settings(None);
    let result = bench("bench.csv", bytes, &settings).and_then(|b| from_benches(vec![b], &settings.wishes));
    let refusal = result.expect_err("a refusal");
    assert!(refusal.needed.len() > 10, "{refusal}");
    refusal.to_string()
}

fn sweep(keep: impl Fn(&Row) -> bool) -> Vec<u8> {
    plain(&rows(1).into_iter().filter(keep).collect::<Vec<_>>())
}

#[test]
fn too_few_throttle_pairs() {
    let levels = |t: f64| (t * 10.0).round() as i64 % 4 == 1; // 0.1, 0.5, 0.9
    let text = reason(&sweep(|r| levels(r.u) && levels(r.l)));
    assert!(
        text.contains("9 distinct throttle pairs") && text.contains("a grid of"),
        "{text}"
    );
}

#[test]
fn equal_throttles_only() {
    let mut text = plain(&rows(1))
        .split(|b| *b == b'\n')
        .next()
        .expect("a header")
        .to_vec();
    text.push(b'\n');
    for k in 1..=40 {
        let t = 0.025 * f64::from(k);
        text.extend(format!("{t},{t},{},{},15\n", 20.0 * t * t, 0.01 * t * t).bytes());
    }
    let text = reason(&text);
    assert!(text.contains("one line of the throttle square"), "{text}");
}

#[test]
fn one_throttle_only() {
    let still = |r: &Row| (r.l - 0.1).abs() < 1e-9;
    let mut single = rows(1);
    single.retain(still);
    single.iter_mut().for_each(|r| r.l = 0.0);
    let text = reason(&plain(&single));
    assert!(
        text.contains("one throttle only") && text.contains("one voltage only"),
        "{text}"
    );
    let settings = settings(None);
    assert_eq!(
        bench("b.csv", &plain(&single), &settings).expect("a bench").kind,
        Kind::SingleRotor
    );
    let text = reason(b"upper,thrust_n\n.1,.2\n.5,3\n.9,8\n");
    assert!(
        text.contains("one throttle only") && text.contains("no voltage was measured"),
        "{text}"
    );
}

#[test]
fn torque_that_says_nothing() {
    let with_torque = |q: &dyn Fn(usize) -> String| {
        let line = |(k, r): (usize, &Row)| format!("{},{},{},{}\n", r.u, r.l, r.thrust[0], q(k));
        let lines: String = rows(1).iter().enumerate().map(line).collect();
        reason(format!("upper,lower,thrust_n,torque_nm\n{lines}").as_bytes())
    };
    assert!(with_torque(&|_| "0.5".into()).contains("constant at 0.5"));
    assert!(with_torque(&|_| String::new()).contains("torque is empty in every row"));
    let magnitudes = with_torque(&|k| format!("{}", (k / 10 * (k / 10) + k % 10 * (k % 10)) as f64 * 0.01));
    assert!(magnitudes.contains("sum of magnitudes"), "{magnitudes}");
}

#[test]
fn missing_columns_and_empty_commands() {
    let text = reason(b"upper,lower,thrust_n\n.1,.2,.3\n.2,.1,.3\n");
    assert!(
        text.contains("bench.csv:1") && text.contains("no torque column"),
        "{text}"
    );
    assert!(reason(b"upper,lower,torque_nm\n.1,.2,.3\n").contains("no thrust column"));
    assert!(reason(b"a,b,c\n1,2,3\n").contains("no throttle column"));
    let text = reason("ESC signal (µs),Thrust (gf)\n,1\n,2\n".as_bytes());
    assert!(text.contains("empty in all 2 rows"), "{text}");
    assert!(reason(b"upper,lower,thrust_n,torque_nm\n").contains("no rows below the header"));
}

#[test]
fn only_bad_rows() {
    let text = reason(b"upper,lower,thrust_n,torque_nm\n50,50,8,.1\n60,50,9,.2\n");
    assert!(
        text.starts_with("bench.csv:2: none of 2 rows can be read") && text.contains("--unit upper=%"),
        "{text}"
    );
    let text = reason(b"upper,lower,thrust_n,torque_nm\n.5,.5,,1\n.6,.5,,2\n");
    assert!(
        text.contains("none of 2 rows can be used") && text.contains("line 2: the thrust is empty"),
        "{text}"
    );
}

#[test]
fn a_blank_row_of_a_map_is_named() {
    let mut text = String::from_utf8(plain(&rows(1))).expect("text");
    text.push_str(".33,.44,,0.1,14.8\n.34,.44,5.0,,14.8\n1500,.44,5.0,0.1,14.8\n");
    let bench = bench("b.csv", text.as_bytes(), &settings(None)).expect("a bench");
    assert_eq!((bench.rows, bench.points_used), (103, 100));
    let lines: Vec<u64> = bench.refused_rows.iter().map(|r| r.line).collect();
    assert_eq!(lines, [102, 103, 104]);
    assert!(bench.refused_rows[1].reason.contains("torque is empty"));
    assert!(bench.refused_rows[2].reason.contains("--pwm-range"));
}

/// Commands a row late, or columns of another file.
#[test]
fn rows_in_disorder() {
    let mut shuffled = rows(1);
    let count = shuffled.len();
    for (k, row) in rows(1).iter().enumerate() {
        (shuffled[(7 * k + 3) % count].u, shuffled[(7 * k + 3) % count].l) = (row.u, row.l);
    }
    let text = reason(&plain(&shuffled));
    assert!(text.contains("columns or rows are in disorder"), "{text}");
}
