//! Whatever the text, reading it ends in an airframe or in faults that can be shown, never in a
//! panic.

use std::fs;
use std::path::Path;
use std::time::Instant;

use mixer_compiler::Source;
use mixer_compiler::airframe::Airframe;
use proptest::prelude::*;

/// Reads the text and, if it is bad, goes through everything that a user may be shown of it.
fn read(text: &str) -> Result<(), TestCaseError> {
    let source = Source::new("any.toml", text);
    match Airframe::read(&source) {
        Ok(airframe) => {
            // What the model promises.
            prop_assert!(airframe.throttle.min < airframe.throttle.max);
            prop_assert_eq!(
                airframe.pairs[0].thrust_n.len(),
                airframe.pairs[0].basis.exponents().len()
            );
            let mut outputs: Vec<_> = airframe
                .units
                .iter()
                .flat_map(mixer_compiler::airframe::Unit::channels)
                .collect();
            outputs.sort_unstable();
            prop_assert!(!outputs.is_empty() && outputs.iter().copied().eq(0..outputs.len()));
            prop_assert!(
                airframe
                    .place("unit[0].channels")
                    .is_some_and(|span| text.get(span).is_some())
            );
            if let Some(voltage) = &airframe.voltage {
                for step in 0..=32 {
                    let [low, high] = voltage.range;
                    let volts = low + (high - low) * (f64::from(step) / 32.0);
                    // Rounding of a sum of nine terms, no more.
                    prop_assert!(
                        voltage.thrust_factor(volts) > 0.999e-3 && voltage.torque_factor(volts) > 0.999e-3
                    );
                }
            }
        }
        Err(faults) => {
            prop_assert!(!faults.faults().is_empty());
            prop_assert!(faults.to_string().contains("any.toml"));
            prop_assert!(!faults.compile_error().is_empty());
            for record in faults.records() {
                prop_assert!(
                    record
                        .line
                        .is_none_or(|line| line <= text.matches('\n').count() + 1)
                );
                prop_assert!(!record.message.is_empty() && !record.message.contains('\n'));
            }
        }
    }
    Ok(())
}

/// The files of `airframes/` and the bad files beside this test.
fn texts() -> Vec<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths: Vec<_> = ["airframes", "tests/diagnostics"]
        .into_iter()
        .flat_map(|folder| fs::read_dir(root.join(folder)).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    paths.sort();
    assert!(paths.len() > 1);
    paths
        .iter()
        .map(|path| fs::read_to_string(path).unwrap())
        .collect()
}

/// Fragments that a careless edit may leave.
const FRAGMENTS: &[&str] = &[
    "",
    "\n",
    "\r",
    "\"",
    "'''",
    "[",
    "]",
    "[[",
    "=",
    ".",
    ",",
    "#",
    "-",
    "0",
    "nan",
    "-inf",
    "1e999",
    "é",
    "\u{feff}",
    "\0",
    "unit",
    "[unit]",
    "[[unit]]",
    "[layout]",
    "units = 3",
    "true",
    "{}",
    "[[[[",
    "99999999999999999999",
    "0x1",
    "1979-05-27",
];

/// A text with some of its pieces replaced.
fn edited() -> impl Strategy<Value = String> {
    let edit = (
        any::<prop::sample::Index>(),
        0..12_usize,
        prop::sample::select(FRAGMENTS),
    );
    (prop::sample::select(texts()), prop::collection::vec(edit, 1..6)).prop_map(|(mut text, edits)| {
        for (place, removed, fragment) in edits {
            let boundary = |text: &str, offset: usize| {
                (0..=offset.min(text.len()))
                    .rev()
                    .find(|&at| text.is_char_boundary(at))
                    .unwrap_or(0)
            };
            let start = boundary(&text, place.index(text.len() + 1));
            let end = boundary(&text, start + removed).max(start);
            text.replace_range(start..end, fragment);
        }
        text
    })
}

/// A voltage table around arbitrary laws.
fn with_voltage() -> impl Strategy<Value = String> {
    let number = || {
        prop_oneof![
            -3.0..3.0_f64,
            any::<f64>().prop_filter("finite", |x| x.is_finite())
        ]
    };
    let laws = prop_oneof![
        prop::collection::vec((number(), number()), 0..5).prop_map(|points| {
            format!(
                "thrust_points = {:?}",
                points.iter().map(|&(v, k)| [v, k]).collect::<Vec<_>>()
            )
        }),
        number().prop_map(|e| format!("thrust_exponent = {e:?}")),
    ];
    (laws, 0.1..1.0_f64, 1.0..3.0_f64).prop_map(|(law, low, high)| {
        let airframe = include_str!("../airframes/isae-x8.toml");
        let (before, after) = airframe.split_once("[voltage]").unwrap();
        let (_, after) = after.split_once("[[unit]]").unwrap();
        format!(
            "{before}[voltage]\nreference_v = 1\nrange_v = [{low:?}, {high:?}]\ntorque_exponent = 1\n{law}\n[[unit]]{after}"
        )
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 512, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn arbitrary_text_is_refused_without_panic(text in any::<String>()) {
        read(&text)?;
    }

    #[test]
    fn arbitrary_toml_characters_are_refused_without_panic(text in "[\\[\\]{}=.,\"'#\\\\\r\n\t a-z0-9_éλ🚁-]{0,200}") {
        read(&text)?;
    }

    #[test]
    fn edited_files_are_read_or_refused_without_panic(text in edited()) {
        read(&text)?;
    }

    #[test]
    fn accepted_voltage_laws_are_positive(text in with_voltage()) {
        read(&text)?;
    }
}

/// Nesting and lengths that no user writes.
#[test]
fn extremes_are_refused_without_panic() {
    let long = format!("name = \"{}\"", "é".repeat(100_000));
    let texts = [
        "[".repeat(10_000),
        format!("x = {}", "[".repeat(10_000)),
        format!("x = {}", "{a=".repeat(10_000)),
        "a.".repeat(10_000),
        long,
        "[[unit]]\n".repeat(3_000),
        "\n".repeat(100_000),
        "name".to_string(),
        "unit = 5".to_string(),
        "unit = [[[]]]".to_string(),
        "layout = [[1]]".to_string(),
    ];
    for text in texts {
        read(&text).unwrap();
    }
}

/// What is no airframe at all is refused in a time that grows with its length: the square took 7 to
/// 60 s of each.
#[test]
fn long_files_are_refused_soon() {
    let join = |count: usize, line: &dyn Fn(usize) -> String| (0..count).map(line).collect::<String>();
    let strings = vec!["\"1.0\""; 40_000].join(", ");
    let texts = [
        join(20_000, &|k| format!("0.{k:05},0.5,{k}.25,0.01\n")),
        join(30_000, &|k| format!("key{k} = {k}\n")),
        join(40_000, &|_| "a = 1\n".to_owned()),
        join(40_000, &|k| format!("key{k} = 1\na = 1\n")),
        format!("[pair]\nbasis = \"cubic\"\nthrust_n = [{strings}]\n"),
    ];
    for text in texts {
        let start = Instant::now();
        let faults = Airframe::read(&Source::new("any.toml", text.as_str())).unwrap_err();
        assert!(!faults.to_string().is_empty() && !faults.records().is_empty());
        let seconds = start.elapsed().as_secs_f64();
        let beginning: String = text.chars().take(30).collect();
        println!(
            "{:.2} MB in {seconds:.2} s: {beginning:?}",
            1e-6 * text.len() as f64
        );
        // 0.2 to 0.9 s when measured without optimisation; other tests run beside this one.
        assert!(seconds < 5.0, "{seconds} s: {beginning:?}");
    }
}
