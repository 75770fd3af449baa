//! Mistakes of people who bring benches, data sheets and vehicles, and what is said of each:
//! `tests/mistakes/mistakes.txt`.
//!
//! ```text
//! ## units                                        a kind of mistake
//! @ i() { cargo mixer identify "$1" ..; }         what its commands share
//! $ i map.csv                                     the command for inputs that are right
//! * grams under a header of newtons               a mistake
//! $ sed .. && i bad.csv                           the command with it
//! = told                                          its outcome, and
//! > warning[MIX303]: ..                           the first line that is said of it
//! ```
//!
//! The outcome is `refused` (a status other than 0), `told` (something is said that is not said of the
//! right inputs), `read` (the same result as of the right inputs, nothing said) or `silent: reason`:
//! another result, and nothing said. `MIXER_BLESS=1` writes outcomes anew; a silent mistake needs its
//! reason by hand. `tests/measurements/mistakes.csv` has their counts.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use mixer_compiler::Source;
use mixer_compiler::airframe::Airframe;
use mixer_compiler::model::PairMap;

use crate::{folder, in_shell, measured, root};

/// A map of 7 x 7 throttles, runs of one rotor and four rows of the pair, of one real pair: its map and
/// its rotors alone as `airframes/x8-11in-least-power.toml` has them, with the noise of a bench.
fn inputs(place: &Path) {
    let text = fs::read_to_string(root().join("airframes/x8-11in-least-power.toml")).unwrap();
    let airframe = Airframe::read(&Source::new("x8.toml", text.as_str())).unwrap();
    let map = PairMap::new(&airframe.pairs[0], &airframe.throttle);
    let mut state = 1_u64;
    let mut noise = |size: f64| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        size * ((state >> 33) as f64 / f64::from(1_u32 << 31) - 0.5) * 3.0
    };
    let mut row = |u: f64, l: f64| {
        let volts = 11.1 - 0.5 * (u * u + l * l);
        let k = libm::pow(volts / 10.71, 1.75);
        let [f, q] = map.efforts([u, l]);
        format!(
            "{u},{l},{:.4},{:.5},{volts:.3}\n",
            k * f + noise(0.05),
            k * q + noise(0.0015)
        )
    };
    let levels = [0.1, 0.25, 0.4, 0.55, 0.7, 0.85, 1.0];
    let header = "upper,lower,thrust_n,torque_nm,voltage_v\n";
    let rows = levels.iter().flat_map(|u| levels.iter().map(move |l| [*u, *l]));
    let map_rows: String = rows.map(|[u, l]| row(u, l)).collect();
    fs::write(place.join("map.csv"), format!("{header}{map_rows}")).unwrap();
    let four: String = [[0.6, 0.6], [0.95, 0.4], [0.4, 0.95], [0.95, 0.95]]
        .map(|[u, l]| row(u, l))
        .concat();
    fs::write(place.join("four.csv"), format!("{header}{four}")).unwrap();
    let alone = airframe.pairs[0].lower_out.as_ref().expect("a run");
    let mut run = "throttle (%),thrust (g),torque (Nm),voltage (V),rpm,current (A)\n".to_owned();
    for percent in [30, 40, 50, 60, 70, 80, 90, 100] {
        let x = f64::from(percent) / 100.0;
        let volts = 11.1 - 0.5 * x * x;
        let k = libm::pow(volts / 10.71, 1.75);
        let at = |[a, b, c]: [f64; 3]| k * (a * x + b * x * x + c * x * x * x);
        let [f, q] = [alone.thrust_n, alone.torque_nm].map(at);
        let rpm = 2130.0 * f.sqrt();
        let current = 0.1047 * rpm * q.abs() / (0.75 * volts);
        let grams = f / 9.80665e-3;
        let _ = writeln!(
            run,
            "{percent},{grams:.1},{:.4},{volts:.2},{rpm:.0},{current:.2}",
            q.abs()
        );
    }
    fs::write(place.join("rotor.csv"), run).unwrap();
    fs::copy(
        root().join("airframes/x8-11in-least-power.toml"),
        place.join("x8.toml"),
    )
    .unwrap();
}

/// What a command says on both channels, its status, and the numbers that it wrote.
struct Answer {
    lines: Vec<String>,
    good: bool,
    written: Option<Vec<f64>>,
}

fn answer(command: &str, place: &Path) -> Answer {
    let _ = fs::remove_file(place.join("out.toml"));
    let output = in_shell(command, place);
    let text = [output.stderr, output.stdout]
        .map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
        .concat();
    assert!(!text.contains("panicked at"), "{command}\n{text}");
    Answer {
        lines: text.lines().map(str::to_owned).collect(),
        good: output.status.success(),
        written: fs::read_to_string(place.join("out.toml"))
            .ok()
            .map(|text| numbers(&text)),
    }
}

/// All numbers of a file that has a value, its comments left out; of a pair its efforts instead of its
/// coefficients, which noise moves.
fn numbers(text: &str) -> Vec<f64> {
    let Ok(airframe) = Airframe::read(&Source::new("out.toml", text)) else {
        return Vec::new();
    };
    let map = PairMap::new(&airframe.pairs[0], &airframe.throttle);
    let throttles = [[0.4, 0.4], [0.9, 0.9], [0.9, 0.4], [0.4, 0.9]];
    let efforts = throttles.into_iter().flat_map(|t| map.efforts(t));
    let units = airframe.units.iter().flat_map(|unit| {
        let [a, b] = [Some(unit.upper_channel), unit.lower_channel].map(|c| c.map_or(-1.0, |c| c as f64));
        unit.position_m.into_iter().chain([
            a,
            b,
            f64::from(u8::from(unit.upper_spin == airframe.pairs[0].upper_spin)),
        ])
    });
    let references =
        [&airframe.voltage, &airframe.air].map(|law| law.as_ref().map_or(0.0, |law| law.reference));
    let others = [
        airframe.throttle.min,
        airframe.throttle.max,
        airframe.allocation.power_bias_nm_per_n,
    ];
    efforts.chain(units).chain(references).chain(others).collect()
}

/// Within 1 % of the greatest number of its kind.
fn same(a: &Option<Vec<f64>>, b: &Option<Vec<f64>>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => {
            a.len() == b.len()
                && a.iter().zip(b).enumerate().all(|(k, (a, b))| {
                    let scale = if k < 8 { [20.0, 0.25][k % 2] } else { 1.0 };
                    (a - b).abs() <= 0.01 * scale
                })
        }
        (None, None) => true,
        _ => false,
    }
}

/// A line without its numbers: another number is nothing new, another output is.
fn without_numbers(line: &str) -> String {
    if line.contains("outputs") {
        return line.to_owned();
    }
    let letters: String = line
        .chars()
        .map(|c| if c.is_ascii_digit() { '0' } else { c })
        .collect();
    letters
        .split_whitespace()
        .map(|word| if word.contains('0') { "0" } else { word })
        .collect::<Vec<_>>()
        .join(" ")
}

/// Lines of the longest message: its first and those that go on with it.
fn longest_message(lines: &[String]) -> usize {
    let goes_on = |line: &&String| line.starts_with(' ') || line.starts_with(|c: char| c.is_ascii_digit());
    let of = |at: usize| 1 + lines[at + 1..].iter().take_while(goes_on).count();
    let begins =
        (0..lines.len()).filter(|&at| lines[at].starts_with("error") || lines[at].starts_with("warning["));
    begins.map(of).max().unwrap_or_default()
}

#[test]
fn mistakes_are_told() {
    let file = root().join("tools/cargo-mixer/tests/mistakes/mistakes.txt");
    let agreed = fs::read_to_string(&file).unwrap();
    let place = folder("mistakes");
    let (mut told, mut counts) = (String::new(), Vec::<(String, [usize; 4])>::new());
    let mut right: Option<Answer> = None;
    let mut lines = agreed.lines().peekable();
    let (mut shared, mut longest) = (String::new(), 0);
    while let Some(line) = lines.next() {
        match line.get(..2) {
            Some("##") => {
                counts.push((line[3..].to_owned(), [0; 4]));
                (right, shared) = (None, String::new());
            }
            Some(mark @ ("@ " | "$ ")) => {
                let mut command = line[2..].to_owned();
                let mut written = format!("{line}\n");
                while let Some(more) = lines.next_if(|line| line.starts_with("  ")) {
                    command += &format!("\n{}", &more[2..]);
                    written += &format!("{more}\n");
                }
                told += &written;
                if mark == "@ " {
                    shared = command;
                    continue;
                }
                inputs(&place);
                let answer = answer(&format!("{shared}\n{command}"), &place);
                let Some(right) = &right else {
                    assert!(answer.good, "{command}\n{}", answer.lines.join("\n"));
                    right = Some(answer);
                    continue;
                };
                let known: BTreeSet<String> = right.lines.iter().map(|line| without_numbers(line)).collect();
                let says = |line: &&String| {
                    let begins = ["error", "warning", "note", "  * ", "refused", "frame  "];
                    line.contains("warning[")
                        || (line.contains("outputs") && line.contains("upper"))
                        || begins.iter().any(|word| line.starts_with(word))
                };
                let new = answer
                    .lines
                    .iter()
                    .filter(says)
                    .find(|line| !known.contains(&without_numbers(line)));
                let reason = lines
                    .peek()
                    .and_then(|line| line.strip_prefix("= silent: "))
                    .map(str::to_owned);
                while lines
                    .next_if(|line| line.starts_with("= ") || line.starts_with("> "))
                    .is_some()
                {}
                let (outcome, words) = match (answer.good, new, same(&answer.written, &right.written)) {
                    (false, ..) => (2, "refused".to_owned()),
                    (true, Some(_), _) => (1, "told".to_owned()),
                    (true, None, true) => (0, "read".to_owned()),
                    (true, None, false) => (
                        3,
                        format!("silent: {}", reason.unwrap_or_else(|| "WHY?".to_owned())),
                    ),
                };
                counts.last_mut().expect("a kind").1[outcome] += 1;
                told += &format!("= {words}\n");
                if let Some(line) = new.filter(|_| outcome != 0) {
                    let line = line.replace(place.to_str().unwrap(), "FOLDER");
                    told += &format!("> {}\n", line.trim());
                }
                longest = longest.max(longest_message(&answer.lines));
                continue;
            }
            _ => {}
        }
        told += &format!("{line}\n");
    }
    if std::env::var_os("MIXER_BLESS").is_some_and(|value| value == "1") {
        fs::write(&file, &told).unwrap();
    } else {
        assert_eq!(agreed, told, "MIXER_BLESS=1 writes it anew");
    }
    let sum = |outcome: usize| counts.iter().map(|(_, counts)| counts[outcome]).sum::<usize>();
    println!(
        "read {}, told {}, refused {}, silent {}; longest message {longest} lines",
        sum(0),
        sum(1),
        sum(2),
        sum(3)
    );
    assert!(
        sum(0) + sum(1) + sum(2) + sum(3) >= 100 && sum(3) <= 8,
        "too few, or too many silent"
    );
    assert!(!told.contains("WHY?"), "a silent mistake without its reason");
    let mut csv = "kind,read,told,refused,silent\n".to_owned();
    for (kind, [read, told, refused, silent]) in &counts {
        let _ = writeln!(csv, "{kind},{read},{told},{refused},{silent}");
    }
    measured::hold("mistakes.csv", &csv);
}

/// Words with one blank between them, as reports break lines anywhere.
fn in_one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The parts of messages in the sources of a folder that offer an option: what stands between two values.
fn offers(folder: &Path, found: &mut Vec<String>) {
    for entry in fs::read_dir(folder).unwrap().flatten() {
        let path = entry.path();
        if path.is_dir() {
            offers(&path, found);
            continue;
        }
        if path.ends_with("tests.rs") {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let code = text.split("#[cfg(test)]").next().unwrap_or_default();
        let is_code = |line: &&str| !line.trim_start().starts_with("//");
        let code = code.lines().filter(is_code).collect::<Vec<_>>().join("\n");
        // Quotes within a text are told from its ends by their mark.
        let code = code.replace("\\\"", "\u{1}").replace("'\"'", "");
        let texts = code.split('"').skip(1).step_by(2);
        // Comments of the tables that are written are no messages.
        for text in texts.filter(|text| !text.trim_start_matches("\\n").starts_with('#')) {
            let text = text
                .replace("\\\n", " ")
                .replace("PRIOR", "{")
                .replace("IDLE", "{");
            let parts = text
                .split('{')
                .map(|part| part.split_once('}').map_or(part, |(_, rest)| rest));
            let parts = parts.map(|part| in_one_line(&part.replace('\u{1}', "\"")));
            let is_offer = |part: &String| {
                let words: Vec<&str> = part.split(' ').collect();
                words.len() > 1
                    && words
                        .iter()
                        .any(|word| word.trim_start_matches('(').starts_with("--"))
            };
            found.extend(parts.filter(is_offer));
        }
    }
}

/// Every mend that a message offers is run on the file that got it, `tests/mistakes/mends.txt`, and leads on: the command
/// succeeds and does not say the same again.
///
/// ```text
/// * grams under a header of newtons    what is wrong
/// $ c '..'; i bad.csv                  the command that is told
/// > --unit thrust=UNIT                 the words of the mend
/// $ i bad.csv --unit thrust=gf         the command with it
/// ```
#[test]
fn mends_lead_on() {
    let text = fs::read_to_string(root().join("tools/cargo-mixer/tests/mistakes/mends.txt")).unwrap();
    let place = folder("mends");
    inputs(&place);
    let (mut shared, mut said, mut complaints, mut cases) = (String::new(), String::new(), String::new(), 0);
    let mut lines = text.lines().peekable();
    let taken = |mark: &str, lines: &mut std::iter::Peekable<std::str::Lines>| {
        let first = lines.next_if(|line| line.starts_with(mark))?;
        let mut command = first[2..].to_owned();
        while let Some(more) = lines.next_if(|line| line.starts_with("  ")) {
            command += &format!("\n{}", &more[2..]);
        }
        Some(command)
    };
    while lines.peek().is_some() {
        if let Some(more) = taken("@ ", &mut lines) {
            shared = more;
        } else if let Some(title) = taken("* ", &mut lines) {
            let [told, words, mended] = ["$ ", "> ", "$ "].map(|mark| taken(mark, &mut lines).expect(&title));
            let run = |command: &str| {
                let answer = answer(&format!("{shared}\n{command}"), &place);
                (
                    answer.good,
                    in_one_line(&answer.lines.join("\n").replace("\n  * ", "\n")),
                )
            };
            let ((_, before), (leads, after)) = (run(&told), run(&mended));
            if !before.contains(&words) {
                let _ = writeln!(complaints, "{title}: no {words:?} in\n  {before}");
            } else if !leads || after.contains(&words) {
                let _ = writeln!(complaints, "{title}: does not lead on:\n  {after}");
            }
            said += &format!("{before}\n");
            cases += 1;
        } else {
            lines.next();
        }
    }
    let mut offered = Vec::new();
    offers(&root().join("tools/mixer-identify/src"), &mut offered);
    assert!(
        cases > 50 && offered.len() > 50,
        "{cases} cases, {} offers",
        offered.len()
    );
    for offer in offered.iter().filter(|offer| !said.contains(*offer)) {
        let _ = writeln!(complaints, "in no case: {offer}");
    }
    assert!(complaints.is_empty(), "\n{complaints}");
}
