//! The mixers on a Cortex-M4F in QEMU: the same bits as on the host, and what they cost.
//!
//! Run with `--nocapture` (or through `tests/run`) to see the tables.
#![allow(missing_docs)]

use std::fs;
use std::process::Command;

use mixer_compiler::Compiled;
use mixer_setpoints::Digest;
use mixer_tests::counts::{self, Images, worst};
use mixer_tests::firmware::{Toolchain, Variant};
use mixer_tests::frames::{self, zoo};
use mixer_tests::image::Image;
use mixer_tests::{airframes, cost, digest, golden};

/// Below the caller's frame, [`REFERENCE`].
const STACK_LIMIT_BYTES: u64 = 704;
/// Below the caller's frame, any airframe: the interior point method, with rotors out.
const ANY_STACK_LIMIT_BYTES: u64 = 1792;
/// Code and tables of [`REFERENCE`].
const SIZE_LIMIT_BYTES: u64 = 9 * 1024 + 512;
/// The airframe that the first and the last limit are for.
const REFERENCE: &str = "isae-x8";

/// One line of what the `golden` image prints.
#[derive(Debug)]
struct Line {
    airframe: String,
    vectors: u64,
    mismatches: u64,
    mean: f64,
    worst: u64,
    stack: u64,
    /// Floating-point exceptions, with all rotors and with one out.
    exceptions: [u64; 2],
}

/// Lines after the one that begins with `airframe`.
fn table(text: &str) -> Vec<Line> {
    let lines = text
        .lines()
        .skip_while(|line| !line.starts_with("airframe"))
        .skip(1);
    lines
        .map(|line| {
            let cells: Vec<&str> = line.split_whitespace().collect();
            let [
                airframe,
                vectors,
                mismatches,
                mean,
                worst,
                stack,
                whole,
                rotors_out,
            ] = cells[..]
            else {
                panic!("not a line of the table: {line}")
            };
            Line {
                airframe: airframe.to_owned(),
                vectors: vectors.parse().expect("vectors"),
                mismatches: mismatches.parse().expect("mismatches"),
                mean: mean.parse().expect("mean"),
                worst: worst.parse().expect("worst"),
                stack: stack.parse().expect("stack"),
                exceptions: [whole, rotors_out].map(|bits| bits.parse().expect("exceptions")),
            }
        })
        .collect()
}

fn size_image(toolchain: &Toolchain, variant: &Variant) -> Image {
    let path = toolchain.build("size", variant).unwrap_or_else(|e| panic!("{e}"));
    Image::read(&path).unwrap_or_else(|e| panic!("{e}"))
}

fn toolchain() -> Toolchain {
    Toolchain::find().unwrap_or_else(|missing| panic!("{missing}"))
}

#[test]
fn golden_vectors_have_the_same_bits_as_on_the_host() {
    let toolchain = toolchain();
    let text = toolchain
        .run("golden", &Variant::default())
        .unwrap_or_else(|e| panic!("{e}"));
    println!("{text}");

    let lines = table(&text);
    let names: Vec<&str> = lines.iter().map(|line| line.airframe.as_str()).collect();
    assert_eq!(names, airframes().expect("airframes"), "every airframe, in order");
    for line in &lines {
        assert!(line.vectors > 0, "{line:?}");
        assert_eq!(line.mismatches, 0, "{line:?}");
        // FPSCR's IOC, DZC and OFC, with all rotors and with one out.
        assert_eq!(line.exceptions, [0, 0], "{line:?}");
        assert!(line.mean > 0.0 && line.mean <= line.worst as f64, "{line:?}");
        let limit = if line.airframe == REFERENCE {
            STACK_LIMIT_BYTES
        } else {
            ANY_STACK_LIMIT_BYTES
        };
        assert!(line.stack <= limit, "stack is over {limit} bytes: {line:?}");
    }
    let again = toolchain
        .run("golden", &Variant::default())
        .unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(text, again, "a second run counts the same instructions");
}

/// The harness that users copy, on the table that `cargo mixer golden` writes.
#[test]
fn the_copied_harness_agrees_in_one_line() {
    let text = toolchain()
        .run("vectors", &Variant::default())
        .unwrap_or_else(|e| panic!("{e}"));
    println!("{text}");
    let rows = |file: &str| {
        let table = std::fs::read_to_string(golden::folder().join(file)).expect("golden");
        table.lines().count() - 1
    };
    let rows = rows("isae-x8.vectors.csv") + rows("isae-x8.rotors-out.csv");
    assert_eq!(text.trim(), format!("isae-x8: {rows} vectors, 0 differ"));
}

#[test]
fn mixers_are_small_and_cannot_panic() {
    let toolchain = toolchain();
    // What one mixer adds to an image that does nothing.
    let empty = size_image(&toolchain, &Variant::default());
    println!(
        "bytes added to an image\n{:<29} {:>8} {:>8} {:>8}",
        "airframe", "code", "tables", "sum"
    );
    let airframes = airframes().expect("airframes");
    for (airframe, rotors_out) in airframes
        .iter()
        .flat_map(|airframe| [(airframe, 0), (airframe, 1)])
    {
        let image = size_image(&toolchain, &Variant::of_airframe(airframe, rotors_out));
        let (code, tables) = (image.code - empty.code, image.tables - empty.tables);
        let subject = format!("{airframe}{}", if rotors_out == 0 { "" } else { ", rotors out" });
        println!("{subject:<29} {code:>8} {tables:>8} {:>8}", code + tables);

        assert!(code > 100, "{subject}: the mixer is not in the image");
        assert_eq!(image.ram, empty.ram, "{subject}: a mixer has no state");
        assert_eq!(image.panic_symbols(), [""; 0], "{subject}");
        // Clearing and copying arrays may be calls, arithmetic may not.
        let mut helpers = image.helper_symbols();
        helpers.retain(|symbol| !symbol.contains("mem"));
        assert_eq!(helpers, [""; 0], "{subject}: soft float");
        if airframe == REFERENCE && rotors_out == 0 {
            assert!(
                code + tables <= SIZE_LIMIT_BYTES,
                "{airframe}: over {SIZE_LIMIT_BYTES} bytes"
            );
        }
    }
}

/// The size image proves by linking that no panic is reachable: here is the panic that must not
/// link.
#[test]
fn a_reachable_panic_does_not_link() {
    let linked = toolchain().build("size", &Variant::with("panic_path"));
    let message = linked.expect_err("an index out of range went unnoticed");
    assert!(message.contains("the_mixer_can_panic"), "{message}");
}

#[test]
fn panic_symbols_are_found_where_there_are_some() {
    let this_test = std::env::current_exe().expect("path of this test");
    let image = Image::read(&this_test).unwrap_or_else(|e| panic!("{e}"));
    assert!(!image.panic_symbols().is_empty());
}

/// `docs/firmware.md`, "A crate of your own": the commands from an empty folder, but for `rustup`,
/// whose part `tests/run` has done, and the files as they stand there.
#[test]
fn the_guide_builds_from_an_empty_folder() {
    let toolchain = Toolchain::find().unwrap_or_else(|missing| panic!("{missing}"));
    let guide = fs::read_to_string(mixer_tests::root().join("docs/firmware.md")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    std::os::unix::fs::symlink(mixer_tests::root(), folder.path().join("coaxial-mixer")).unwrap();
    let package = folder.path().join("my-firmware");
    let mut files = 0;
    for block in guide.split("\n```").skip(1).step_by(2).take(3) {
        let (language, text) = block.split_once('\n').unwrap();
        if language == "sh" {
            let commands = text.lines().filter(|line| !line.starts_with("rustup"));
            let script: Vec<&str> = commands.collect();
            let status = Command::new("sh")
                .args(["-ec", &script.join("\n")])
                .current_dir(folder.path())
                .status();
            assert!(status.unwrap().success(), "{text}");
            continue;
        }
        let (name, text) = text.split_once('\n').unwrap();
        let path = package.join(name.trim_start_matches(['#', ' ']));
        // `cargo new` ends with an empty table of the same name.
        let begun = match name {
            "# Cargo.toml" => fs::read_to_string(&path).unwrap().replace("[dependencies]\n", ""),
            _ => String::new(),
        };
        fs::write(&path, begun + text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        files += 1;
    }
    assert_eq!(files, 2);
    fs::copy(mixer_tests::root().join("Cargo.lock"), package.join("Cargo.lock")).unwrap();
    toolchain
        .build_package(&package)
        .unwrap_or_else(|e| panic!("{e}"));
}

/// The flight of `flight::setpoint`: 1200 cycles less three lost ones are mixed; the three are
/// held, and so are the first forty of a hundred at the end, after which the rotors stop.
#[test]
fn control_loop_holds_and_then_disarms() {
    let text = Toolchain::for_package("examples/firmware")
        .and_then(|toolchain| toolchain.run("firmware", &Variant::default()))
        .unwrap_or_else(|e| panic!("{e}"));
    println!("{text}");
    assert!(text.contains("mixed 1197, held 43, disarmed 60\n"), "{text}");
    assert!(
        text.contains("after landing [900, 900, 900, 900, 900, 900, 900, 900] us\n"),
        "{text}"
    );
}

/// The flight of `examples/executors`: 1600 cycles, of which three lost ones are held, and of a
/// hundred at the end the first forty. The bench is the mixer's own model, so both executors give
/// the same numbers if each paces every cycle and passes voltage and saturation on; an integral
/// that does not stop overshoots to 4.7 rad/s.
#[test]
fn executors_pace_the_loop_and_stop_the_integral() {
    let toolchain =
        Toolchain::for_package("examples/executors").unwrap_or_else(|missing| panic!("{missing}"));
    for executor in ["embassy", "rtic"] {
        let variant = Variant {
            features: vec![executor],
            ..Variant::default()
        };
        let text = toolchain
            .run(executor, &variant)
            .unwrap_or_else(|e| panic!("{e}"));
        println!("{executor}: {text}");
        let numbers: Vec<u32> = text
            .split(|c: char| !c.is_ascii_digit())
            .filter_map(|word| word.parse().ok())
            .collect();
        let [
            rate,
            _,
            most,
            saturated,
            held,
            disarmed,
            cycles,
            millivolts,
            pulses @ ..,
        ] = &numbers[..]
        else {
            panic!("{executor}: {text}")
        };
        assert_eq!([*held, *disarmed, *cycles], [43, 60, 1600], "{executor}: {text}");
        assert!(
            rate.abs_diff(4000) < 200 && *most < 4400 && *saturated > 100,
            "{executor}: {text}"
        );
        // A pack of 16.8 V loses 2 mV with every measurement, of which there is one in ten cycles.
        assert!((16_470..16_600).contains(millivolts), "{executor}: {text}");
        assert_eq!(pulses, [900; 8], "{executor}: disarmed, {text}");
    }
}

/// The airframes whose bits are compared on many setpoints: a closed form of three and of four
/// units, and without a closed form. Others that are alike differ by their pair, as frames of the zoo do.
const AIRFRAMES: [&str; 3] = ["isae-x8", "px4-x12", "px4-y6"];

/// Twenty thousand setpoints per airframe: attainable, saturated, not finite; two thousand with one rotor out,
/// and with two. A million and twenty thousand where `MIXER_MILLION` names the airframe, or for `all`.
#[track_caller]
fn assert_same_bits(airframe: &str, compiled: &Compiled) {
    let millions = std::env::var("MIXER_MILLION").unwrap_or_default();
    let million = millions.split(',').any(|name| name == airframe || name == "all");
    let mut variant = Variant::of_airframe(airframe, 0);
    if million {
        variant.cfgs.push("million".into());
    }
    let printed = toolchain()
        .run_uncounted("digest", &variant)
        .unwrap_or_else(|e| panic!("{e}"));
    let target: Vec<&str> = printed.lines().collect();
    let mut host = Vec::new();
    for rotors_out in 0..=Digest::MOST_ROTORS_OUT {
        let count = Digest::setpoints(million, rotors_out);
        let digests = digest::of(compiled, count, rotors_out);
        host.extend(digests.iter().map(|d| format!("{rotors_out} {d:016x}")));
        println!(
            "{airframe:<24} {rotors_out} out {count:>8} setpoints, digest {:016x}",
            digests.last().expect("ten digests")
        );
    }
    let differs = host.iter().zip(&target).find(|(host, target)| host != target);
    assert!(
        target == host,
        "{airframe}: other bits, first {differs:?}: {host:?} {target:?}"
    );
}

#[test]
fn setpoints_to_airframes_have_the_same_bits_as_on_the_host() {
    for name in AIRFRAMES {
        let compiled = golden::compile(name).unwrap_or_else(|e| panic!("{e}"));
        assert_same_bits(name, &compiled);
    }
}

#[test]
fn setpoints_to_frames_of_the_zoo_have_the_same_bits_as_on_the_host() {
    let (seed, indices) = zoo::ON_TARGET;
    let zoo = frames::zoo(seed).unwrap_or_else(|e| panic!("{e}"));
    for index in indices {
        let compiled = frames::compile_text(&zoo.specimen(index).text).unwrap_or_else(|e| panic!("{e}"));
        assert_same_bits(&format!("zoo-{index}"), &compiled);
    }
}

/// How far a count may be from the held one where another compiler builds the firmware.
const OTHER_COMPILER: f64 = 0.05;

/// The counts of `tests/counts.csv`, to the instruction and to the byte, where the same compiler
/// builds the firmware. The requests of `tests/worst.csv` are counted, not searched for.
#[test]
fn counts_are_those_held() {
    let toolchain = toolchain();
    let (compiler, held) = counts::held().unwrap_or_else(|e| panic!("{e}"));
    let same = compiler == toolchain.compiler;
    if !same {
        println!(
            "ANOTHER COMPILER: the counts are those of {compiler}, this is {}: compared within {} %, not for equality",
            toolchain.compiler,
            100.0 * OTHER_COMPILER
        );
    }
    let airframes = airframes().expect("airframes");
    let names: Vec<_> = held.iter().map(|row| row.subject.clone()).collect();
    assert_eq!(
        names,
        counts::all(&airframes),
        "a row per subject, in order: {MEND}"
    );
    let compared = if std::env::var_os("MIXER_COUNTS").is_some_and(|value| value == "all") {
        counts::all(&airframes)
    } else {
        counts::compared(&airframes)
    };
    println!(
        "{} of {} rows compared; MIXER_COUNTS=all compares all",
        compared.len(),
        held.len()
    );
    let found = worst::held().unwrap_or_else(|e| panic!("{e}"));
    let empty = size_image(&toolchain, &Variant::default());
    let mut faults = Vec::new();
    for held in held.iter().filter(|row| compared.contains(&row.subject)) {
        let worst = worst::of(&found, &held.subject);
        assert!(!worst.is_empty(), "{:?}: no worst requests: {MEND}", held.subject);
        let now = Images::build(&toolchain, &held.subject)
            .and_then(|images| images.measure(&empty, &worst))
            .unwrap_or_else(|e| panic!("{e}"));
        println!("{now}");
        for ((column, held_value), value) in counts::COLUMNS.iter().zip(held.values).zip(now.values) {
            let allowed = if same { 0.0 } else { OTHER_COMPILER };
            if value.abs_diff(held_value) as f64 > allowed * held_value as f64 {
                let change = 100.0 * (value as f64 / held_value as f64 - 1.0);
                faults.push(format!(
                    "{:?} {column}: {held_value} held, {value} counted, {change:+.2} %",
                    held.subject
                ));
            }
        }
    }
    assert!(faults.is_empty(), "{}\n{MEND}", faults.join("\n"));
}

/// The compiler's estimates of what a mix costs are as good as it says.
#[test]
fn estimates_are_near_what_was_counted() {
    let (_, held) = counts::held().unwrap_or_else(|e| panic!("{e}"));
    let samples = cost::samples(&held).unwrap_or_else(|e| panic!("{e}"));
    for sample in samples
        .iter()
        .filter(|sample| sample.row.subject.rotors_out() == 0)
    {
        let name = &sample.row.subject.airframe;
        for (quantity, counted, estimate, stated) in sample.estimates() {
            let error = f64::from(estimate) / counted - 1.0;
            println!(
                "{name}, {quantity}: {counted:.0}, {estimate} estimated, {:+.1} %",
                100.0 * error
            );
            assert!(
                error.abs() <= stated && stated <= ESTIMATE_ERROR,
                "{name}, {quantity}: {estimate} estimated, {counted} counted, off by {stated} stated"
            );
        }
    }
}

#[test]
fn the_page_of_costs_is_that_of_the_counts() {
    let (compiler, held) = counts::held().unwrap_or_else(|e| panic!("{e}"));
    let page = std::fs::read_to_string(counts::page()).expect("docs/costs.md");
    assert_eq!(page, counts::document(&compiler, &held), "{MEND}");
}

/// No request that was found takes more than the bound that the compiler states, which is at most
/// [`BOUND_OVER_WORST`] times the worst of them.
#[test]
fn bounds_hold_what_was_counted() {
    let (_, held) = counts::held().unwrap_or_else(|e| panic!("{e}"));
    let samples = cost::samples(&held).unwrap_or_else(|e| panic!("{e}"));
    let mut faults = Vec::new();
    for sample in samples {
        let worst = sample.row.get("worst_found");
        let name = &sample.row.subject;
        let bound = u64::from(sample.bound().unwrap_or_else(|| panic!("{name:?}: no bound")));
        let ratio = bound as f64 / worst as f64;
        println!(
            "{}, {}: {worst} found, {bound} stated, {ratio:.2} times",
            name.mixer, name.airframe
        );
        let most = BOUND_OVER_WORST[usize::from(name.rotors_out() > 0)];
        if !(1.0..=most).contains(&ratio) {
            faults.push(format!(
                "{name:?}: {worst} found, at most {bound} stated, {ratio:.2} times"
            ));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// A bound that is further above the most that a search finds says little. All rotors; rotors out, where
/// the bound takes every programme to its last pivot and no request that was found does.
const BOUND_OVER_WORST: [f64; 2] = [1.8, 2.5];

/// The largest error that an estimate may have, as a share of what was counted.
const ESTIMATE_ERROR: f64 = 0.13;

const MEND: &str = "if the change is meant, `cargo counts --bless` and look at the difference";
