//! Fits of the coaxial maps of `MIXER_BENCH_DATA` are what a careful user has: none may raise a false
//! alarm, and the mistakes that the rules on rotors are for must be told.

use cargo_mixer::bench_files::{self, read_one};
use cargo_mixer::commands::predict::PredictArgs;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use clap::Parser;
use mixer_compiler::Source;
use mixer_compiler::airframe::Basis;
use mixer_compiler::diagnostic::Code;
use mixer_compiler::model::wake::mean_torque;
use mixer_identify::air::Air;
use mixer_identify::bench::{Bench, Point};
use mixer_identify::fit::basis::ThrottleBox;
use mixer_identify::fit::polynomial::Polynomial;
use mixer_identify::fragment;
use mixer_identify::identified::{Identified, Settings, from_benches};
use mixer_identify::numbers::{Number, Run};
use mixer_identify::rotor::predict::{PredictOptions, correct};
use mixer_identify::rotor::single::{RunFacts, Single};

use crate::{maps, measured};

const BASES: [&str; 3] = ["biquadratic", "cubic", "quartic"];

/// What is true of these airframes: maps that begin at a throttle of 0.4 idle there, and a map at one
/// supply does not tell how it depends on the voltage.
const TRUE: [Code; 2] = [Code::HighIdle, Code::NoVoltage];

/// What is true of these benches, each a part of what `identify` says.
const TRUE_WORDS: [&str; 12] = [
    "torque was not measured",
    "are left out, the first in line",
    "(--rpm-at-full)",
    "what the bench had, and a voltage outside is clamped",
    "throttle.min is 0.4",
    "throttle.min is raised",
    "throttle.max is",
    "exponent of voltage",
    "the supply sagged",
    "nothing was measured below",
    "what is beyond is extrapolated",
    "without exponents (--voltage-exponent) they are taken as one",
];

/// The one map whose record of the throttles drifted, and what more is true of it.
const DRIFTED: &str = "data2021_08_17_10_13_04";
const TRUE_OF_IT: [&str; 3] = [
    "is poorly described",
    "rows stand out",
    "the record of the former drifts",
];

/// The one map before which both rotors stood still, by their speeds, and the load cells had an offset.
const NOT_TARED: &str = "data2021_08_17_17_00_55";
const TRUE_OF_THAT: [&str; 2] = [
    "--tare takes it off all rows",
    "the load cells read something at rest",
];

/// How often each was told, and what was told and is not true.
#[derive(Default)]
struct Tally {
    counts: BTreeMap<String, usize>,
    alarms: Vec<String>,
}

impl Tally {
    /// A sentence of `identify` or `predict`.
    fn sentence(&mut self, sentence: &str, file: &Path) {
        let is_of = |words: &&&str| sentence.contains(**words);
        let is = |name| file.to_string_lossy().contains(name);
        let more: &[&str] = match () {
            () if is(DRIFTED) => &TRUE_OF_IT,
            () if is(NOT_TARED) => &TRUE_OF_THAT,
            () => &[],
        };
        match TRUE_WORDS.iter().find(is_of).or(more.iter().find(is_of)) {
            Some(words) => *self.counts.entry(format!("\"{words} ..\"")).or_default() += 1,
            None => self.alarms.push(format!("{}: {sentence}", file.display())),
        }
    }

    /// What the compiler says of an X8 of these tables.
    fn check(&mut self, tables: &str, file: &Path) {
        match mixer_compiler::compile(&source(tables)) {
            Ok(compiled) => {
                let warnings = mixer_compiler::lint(&compiled);
                for warning in warnings.faults() {
                    *self.counts.entry(format!("{:?}", warning.code)).or_default() += 1;
                    if !TRUE.contains(&warning.code) {
                        self.alarms.push(format!("{}: {warnings}", file.display()));
                    }
                }
            }
            Err(faults) => self.alarms.push(format!("{}: {faults}", file.display())),
        }
    }

    /// Nothing was told but what is true.
    #[track_caller]
    fn is_true(&self, of: &str) {
        println!("{of}: {} false alarms", self.alarms.len());
        for (what, count) in &self.counts {
            println!("{count:5} {what}");
        }
        assert!(self.alarms.is_empty(), "{}", self.alarms.join("\n"));
    }
}

/// An X8 of the identified pair, arms by its thrust as frames have them.
fn source(tables: &str) -> Source {
    let text = format!("name = \"x8\"\n{tables}\n[layout]\narm_m = 0.45\nunits = 4\nfirst_angle_deg = 45\n");
    Source::new("x8.toml", text)
}

/// The mass that such an X8 carries at 40 % of its largest thrust.
fn vehicle(greatest_thrust_n: f64) -> String {
    format!(
        "[vehicle]\nmass_kg = {:?}\n",
        0.4 * 4.0 * greatest_thrust_n / 9.81
    )
}

/// Propeller and motor in the name of a file, between the time and what was run.
fn rotors(file: &Path) -> String {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let ends = ["_map10x10", "_single_rotor", "_bottom_rotor"];
    let end = ends
        .iter()
        .find_map(|end| name.find(end))
        .expect("a map or a run");
    name[24..end].to_owned()
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn no_real_map_warns() {
    let files = maps::files();
    let runs = ["single_rotor", "bottom_rotor"].map(|word| maps::named(&[word]));
    let mut told = Tally::default();
    let mut with_runs = 0;
    for (index, map) in files.iter().enumerate() {
        // Every run of the same rotors has its turn.
        let run = |runs: &Vec<PathBuf>| {
            let own: Vec<&PathBuf> = runs.iter().filter(|run| rotors(run) == rotors(map)).collect();
            (!own.is_empty()).then(|| own[index % own.len()].clone())
        };
        let [upper, lower] = runs.each_ref().map(run);
        with_runs += usize::from(upper.is_some() && lower.is_some());
        for basis in BASES {
            let identified = maps::with_runs(map, [upper.as_deref(), lower.as_deref()], basis);
            let notes = identified.files.iter().flat_map(|bench| &bench.notes);
            for sentence in identified.warnings.iter().chain(notes) {
                told.sentence(sentence, map);
            }
            let pair = identified.pair.as_ref().expect("a map");
            let tables = fragment::text(&identified) + "\n" + &vehicle(pair.thrust.full_scale);
            told.check(&tables, map);
        }
    }
    told.is_true(&format!(
        "{} fits of {} maps, {with_runs} of them with runs of both rotors alone",
        BASES.len() * files.len(),
        files.len()
    ));
}

/// The command's arguments, so that its defaults are tested.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    predict: PredictArgs,
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn no_prediction_of_a_real_run_warns() {
    let runs = maps::named(&["single_rotor", "bottom_rotor"]);
    let mut told = Tally::default();
    for run in &runs {
        let arguments = Arguments::try_parse_from(["predict".as_ref(), run.as_os_str()]);
        let arguments = arguments.unwrap_or_else(|error| panic!("{error}")).predict;
        let predicted = arguments
            .answer(&bench_files::text)
            .unwrap_or_else(|refusals| panic!("{refusals:?}"));
        for sentence in &predicted.found.warnings {
            told.sentence(sentence, run);
        }
        told.check(&predicted.tables, run);
    }
    told.is_true(&format!("{} predictions", runs.len()));
    assert!(runs.len() >= 6, "{} runs", runs.len());
}

/// The tables of a pair with these coefficients and the throttles that were identified.
fn tables(identified: &Identified, basis: Basis, [thrust, torque]: [&[f64]; 2]) -> String {
    let pair = identified.pair.as_ref().expect("a map");
    format!(
        "[throttle]\nmin = {:?}\nmax = {:?}\n[pair]\nbasis = \"{}\"\nthrust_n = {thrust:?}\ntorque_nm = {torque:?}\nupper_spin = \"cw\"",
        pair.throttle.min,
        pair.throttle.max,
        basis.name()
    )
}

/// What the compiler says of these tables: the codes of faults and warnings.
fn codes(tables: &str) -> Vec<Code> {
    let told = match mixer_compiler::compile(&source(tables)) {
        Ok(compiled) => mixer_compiler::lint(&compiled),
        Err(faults) => faults,
    };
    told.faults().iter().map(|fault| fault.code).collect()
}

/// Every so many coefficients are taken ten times: each takes a compilation.
const COEFFICIENTS: usize = 10;

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn mistakes_in_real_maps_are_told() {
    let files = maps::files();
    let (mut exchanged, mut fits) = (0, 0);
    let (mut off, mut all) = (0, 0);
    let mut means = Vec::new();
    for map in &files {
        for word in BASES {
            let identified = maps::identified(map, word);
            let pair = identified.pair.as_ref().expect("a map");
            let (basis, thrust, torque) = (pair.basis, &pair.thrust_n, &pair.torque_nm);
            fits += 1;
            // Exchanged rotors turn its sign.
            let polynomial = Polynomial::of(basis, torque);
            let ends = [pair.throttle.min, pair.throttle.max];
            means.push(mean_torque(|[u, l]| polynomial.at(u, l), ends));
            // u and l exchanged, and the torque turned so that det J stays positive.
            let at = |k: usize| {
                let (i, j) = basis.exponents()[k];
                let other = basis.exponents().iter().position(|term| *term == (j, i));
                other.expect("a symmetric basis")
            };
            let turned: Vec<f64> = (0..thrust.len()).map(|k| thrust[at(k)]).collect();
            let mirrored: Vec<f64> = (0..thrust.len()).map(|k| -torque[at(k)]).collect();
            let told = codes(&tables(&identified, basis, [&turned, &mirrored]));
            exchanged += usize::from(told.contains(&Code::RotorsExchanged));
            for k in 0..2 * thrust.len() {
                all += 1;
                if all % COEFFICIENTS == 0 {
                    let mut both = [thrust.clone(), torque.clone()];
                    both[k % 2][k / 2] *= 10.0;
                    let told = codes(&tables(&identified, basis, [&both[0], &both[1]]));
                    off += usize::from(told.iter().any(|code| *code != Code::HighIdle));
                }
            }
        }
    }
    let coefficients = all / COEFFICIENTS;
    means.sort_by(f64::total_cmp);
    let ends = [means.first(), means.last()].map(|mean| 100.0 * mean.expect("a fit"));
    println!(
        "{exchanged} of {fits} exchanged fits are told, {off} of {coefficients} coefficients ten times off; mean torque {ends:.1?} % of \
         the largest"
    );
    assert_eq!(exchanged, fits);
    assert!(10 * off >= 9 * coefficients, "{off} of {coefficients}");
}

/// What `identify` says of a bench.
fn warnings(bench: Bench) -> String {
    let notes = bench.notes.join("\n");
    let told = match from_benches(vec![bench], &Settings::default().wishes) {
        Ok(identified) => identified.warnings.join("\n"),
        Err(refusal) => refusal.to_string(),
    };
    format!("{notes}\n{told}")
}

/// Honest files of one laboratory, how they are read, and the diameter of the propeller where it is known.
struct Laboratory {
    name: &'static str,
    files: Vec<PathBuf>,
    options: &'static [&'static str],
    diameter: fn(&Path) -> Option<f64>,
}

/// The files in a folder of the bench data with one of these words in their name.
fn honest(folder: &str, words: &[&str]) -> Vec<PathBuf> {
    let folder = maps::bench_data().join(folder);
    let entries = std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    let has = |path: &PathBuf, word: &&str| path.to_string_lossy().contains(*word);
    files.retain(|path| words.iter().any(|word| has(path, word)));
    // A drifting record, a load cell that was not set to zero, and rows that were copied over others.
    files.retain(|path| {
        ![DRIFTED, NOT_TARED, "modifieddata"]
            .iter()
            .any(|word| has(path, word))
    });
    files.sort();
    files
}

fn laboratories() -> [Laboratory; 5] {
    let source = |name, files, options, diameter| Laboratory {
        name,
        files,
        options,
        diameter,
    };
    let inches = |path: &Path| {
        let rotors = rotors(path);
        let inches = rotors.split("in").next()?.replace('p', ".").parse::<f64>();
        Some(0.0254 * inches.expect("a number"))
    };
    let maps = honest("newdexterity", &["map10x10"]);
    let runs = honest("newdexterity", &["single_rotor", "bottom_rotor"]);
    const SPEEDS: &[&str] = &[
        "--column",
        "thrust=T(N)",
        "--column",
        "torque=Q(Nm)",
        "--rpm-at-full",
        "2700",
    ];
    [
        source("New Dexterity, pairs", maps, &[], inches),
        source("New Dexterity, one rotor", runs, &[], inches),
        source(
            "StrawsonDesign",
            honest("strawson", &[".csv"]),
            &["--kappa", "0.012"],
            |_| None,
        ),
        source("pyBEMT", honest("pybemt", &["tmotor28_data"]), SPEEDS, |_| {
            Some(0.7112)
        }),
        source("Aerostack2", honest("aerostack2", &["steps.csv"]), &[], |_| None),
    ]
}

/// The one file whose current is that of a whole vehicle, and what says so.
const OF_A_VEHICLE: (&str, &str) = ("Aerostack2", "shaft power over electrical power");

/// A sentence without file, numbers and what follows a colon, to be counted.
fn kind(sentence: &str, file: &Path) -> String {
    let name = file
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let sentence = sentence.replace(&name, "FILE");
    let sentence = sentence
        .strip_prefix("FILE: ")
        .unwrap_or(&sentence)
        .replace(',', " ");
    let words = sentence
        .split_whitespace()
        .take_while(|word| !word.ends_with(':'));
    let words = words.filter(|word| !word.contains(|c: char| c.is_ascii_digit()));
    words.take(12).collect::<Vec<_>>().join(" ")
}

/// Every number and every alarm over the honest files, per source: no number is outside in more than 1 % of them, and nothing is
/// said but what is true.
#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn alarms_of_honest_files_are_counted() {
    let mut numbers = "number,low,high,source,files,least,greatest,outside\n".to_owned();
    let mut alarms = "source,files,told of,what is said\n".to_owned();
    let mut outside = BTreeMap::<String, [usize; 2]>::new();
    let mut told_of_all = Tally::default();
    for source in laboratories() {
        let mut found: BTreeMap<String, (Number, Vec<f64>, usize)> = BTreeMap::new();
        let mut said: BTreeMap<String, usize> = BTreeMap::new();
        for path in &source.files {
            let diameter = (source.diameter)(path);
            let mut words: Vec<String> = vec!["predict".into(), path.to_string_lossy().into_owned()];
            words.extend(source.options.iter().map(|word| (*word).to_owned()));
            if let Some(diameter) = diameter {
                words.extend(["--diameter".to_owned(), diameter.to_string()]);
            }
            let arguments = Arguments::try_parse_from(&words).unwrap_or_else(|error| panic!("{error}"));
            let arguments = arguments.predict;
            let bench = read_one(path, &arguments.settings()).unwrap_or_else(|refusal| panic!("{refusal}"));
            for (_, number, [value, error]) in Run::new(&bench, diameter).values() {
                let [low, high] = number.limits;
                let is_outside = value + 4.0 * error < low || value - 4.0 * error > high;
                let key = format!("{} {:?}", number.name, number.limits);
                let of = found.entry(key.clone()).or_insert((*number, Vec::new(), 0));
                of.1.push(value);
                of.2 += usize::from(is_outside);
                if (source.name, number.name) == OF_A_VEHICLE {
                    continue;
                }
                let all = outside.entry(key).or_default();
                *all = [all[0] + usize::from(is_outside), all[1] + 1];
            }
            let (sentences, tables) = match source.name.contains("pairs") {
                true => {
                    let found = maps::identified(path, "auto");
                    let pair = found.pair.as_ref().expect("a map");
                    let tables = fragment::text(&found) + "\n" + &vehicle(pair.thrust.full_scale);
                    (found.warnings.clone(), tables)
                }
                false => match arguments.answer(&bench_files::text) {
                    Ok(predicted) => (predicted.found.warnings, predicted.tables),
                    Err(refusals) => {
                        let reason = format!("refused: {}", kind(&refusals[0].reason, path));
                        *said.entry(reason).or_default() += 1;
                        continue;
                    }
                },
            };
            for sentence in &sentences {
                *said.entry(kind(sentence, path)).or_default() += 1;
                told_of_all.sentence(sentence, path);
            }
            told_of_all.check(&tables, path);
        }
        let files = source.files.len();
        for (number, values, outside) in found.values() {
            let [least, most] =
                [f64::min, f64::max].map(|of| values.iter().copied().reduce(of).expect("a value"));
            let [low, high] = number.limits.map(|limit| {
                if limit.is_finite() {
                    limit.to_string()
                } else {
                    String::new()
                }
            });
            numbers += &format!(
                "\"{}\",{low},{high},\"{}\",{},{least:.3},{most:.3},{outside}\n",
                number.name,
                source.name,
                values.len()
            );
        }
        for (what, count) in said {
            alarms += &format!("\"{}\",{files},{count},{what}\n", source.name);
        }
    }
    measured::hold("numbers.csv", &numbers);
    measured::hold("alarms.csv", &alarms);
    for (number, [outside, files]) in &outside {
        assert!(100 * outside <= *files, "{number}: {outside} of {files}");
    }
    told_of_all.is_true("honest files");
}

/// Runs that are cut and predicted to their ends: the deviation that is stated holds within two.
#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn runs_that_are_cut_lie_within_two_deviations() {
    let mut files = honest("strawson", &[".csv"]);
    files.extend(honest("newdexterity", &["single_rotor", "bottom_rotor"]));
    let (mut cuts, mut worst) = (0, 0.0_f64);
    for path in &files {
        let words = ["predict".as_ref(), path.as_os_str()];
        let arguments = Arguments::try_parse_from(words).unwrap_or_else(|error| panic!("{error}"));
        let whole =
            read_one(path, &arguments.predict.settings()).unwrap_or_else(|refusal| panic!("{refusal}"));
        let last = whole
            .points
            .iter()
            .max_by(|a, b| a.u.total_cmp(&b.u))
            .expect("points");
        for cut in [0.72, 0.8, 0.85, 0.9] {
            let mut part = whole.clone();
            part.points.retain(|p| p.u <= cut);
            let known = RunFacts {
                kappa_m: Some(0.012),
                ..RunFacts::default()
            };
            let Ok(single) = Single::of(&part, &known, &mut Vec::new()) else {
                continue;
            };
            let wishes = PredictOptions {
                throttle: Some(ThrottleBox {
                    min: 0.2,
                    max: last.u,
                }),
                ..PredictOptions::default()
            };
            let (measured, rotor) = (single.voltage_v.expect("a voltage"), single.rotor);
            let truth = last.at_voltage(last.voltage, measured, [1.75; 2]).thrust;
            let Ok(found) = correct(single, None, &[], Air::default(), &wishes, Vec::new()) else {
                continue;
            };
            let off = 100.0 * (rotor.thrust.at(last.u) / truth - 1.0).abs();
            worst = worst.max(off / found.pair.uncertainty.thrust_percent);
            cuts += 1;
        }
    }
    println!(
        "{cuts} cuts of {} runs, {worst:.2} deviations off at most",
        files.len()
    );
    assert!(cuts >= 20 && worst < 2.0, "{worst} deviations in {cuts} cuts");
}

/// A mistake in a bench: its name, the words of its cause, what it does.
type Mistake = (&'static str, &'static str, fn(&mut Vec<Point>));

/// Each point gets what `of` makes of it and of the one before.
fn with_before(points: &mut [Point], of: fn(&mut Point, &Point)) {
    let given = points.to_vec();
    for (point, before) in points.iter_mut().skip(1).zip(&given) {
        of(point, before);
    }
}

fn throttles(points: &mut Vec<Point>, of: fn(f64) -> f64) {
    points.iter_mut().for_each(|p| (p.u, p.l) = (of(p.u), of(p.l)));
    points.retain(|p| [p.u, p.l].iter().all(|t| (0.005..1.02).contains(t)));
}

fn greatest_thrust(points: &[Point]) -> f64 {
    points.iter().map(|p| p.thrust).fold(0.0, f64::max)
}

const MISTAKES: [Mistake; 13] = [
    (
        "torque of an arm 2.5 times too long",
        "a force at an arm",
        |points| {
            points
                .iter_mut()
                .for_each(|p| (p.torque, p.shaft_w) = (2.5 * p.torque, 2.5 * p.shaft_w));
        },
    ),
    (
        "lower stand in pounds under kg",
        "stand of the lower rotor is in another unit",
        |points| {
            points.iter_mut().for_each(|p| {
                p.thrust -= 0.546 * p.cells[1].abs();
                p.cells[1] *= 0.454;
            });
        },
    ),
    (
        "load cell 2 % up at rest",
        "load cells read something at rest",
        |points| {
            let offset = 0.02 * greatest_thrust(points);
            points.iter_mut().for_each(|p| p.thrust += offset);
        },
    ),
    (
        "load cell 2 % down at rest",
        "load cells read something at rest",
        |points| {
            let offset = 0.02 * greatest_thrust(points);
            points.iter_mut().for_each(|p| p.thrust -= offset);
        },
    ),
    (
        "throttle of pulses of another range",
        "another range of pulses",
        |points| {
            throttles(points, |t| (t - 0.1) / 0.84);
        },
    ),
    ("throttle that was linearised", "something linearised", |points| {
        throttles(points, |t| 0.35 * t + 0.65 * t * t);
    }),
    ("voltage a row late", "that of the row before", |points| {
        with_before(points, |p, before| {
            (p.voltage, p.imbalance) = (before.voltage, before.imbalance)
        });
    }),
    (
        "voltages of the rotors exchanged",
        "voltages of the rotors are exchanged",
        |points| {
            points.iter_mut().for_each(|p| p.imbalance = -p.imbalance);
        },
    ),
    ("one meter 5 % up", "two meters of one supply", |points| {
        points.iter_mut().for_each(|p| p.imbalance -= 0.025);
    }),
    ("voltage of the pack at rest", "pack at rest", |points| {
        let volts = points.iter().map(|p| p.voltage).fold(0.0, f64::max) + 0.1;
        points
            .iter_mut()
            .for_each(|p| (p.voltage, p.imbalance) = (volts, 0.0));
    }),
    (
        "10 % of the row before",
        "what the one before it gave",
        |points| {
            for k in 1..points.len() {
                let before = points[k - 1];
                let p = &mut points[k];
                (p.thrust, p.torque) = (
                    0.9 * p.thrust + 0.1 * before.thrust,
                    0.9 * p.torque + 0.1 * before.torque,
                );
            }
        },
    ),
    ("a moving average of three rows", "a moving average", |points| {
        let given = points.clone();
        for k in 1..points.len() - 1 {
            let mean = |of: fn(&Point) -> f64| given[k - 1..=k + 1].iter().map(of).sum::<f64>() / 3.0;
            (points[k].thrust, points[k].torque) = (mean(|p| p.thrust), mean(|p| p.torque));
        }
    }),
    ("thrust and torque a row late", "in disorder", |points| {
        with_before(points, |p, before| {
            (p.thrust, p.torque) = (before.thrust, before.torque)
        });
    }),
];

/// One mistake of each kind in five real maps, in their own order and in that of a plan: told by its cause, by
/// another one, or not.
#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn planted_mistakes_are_told_by_their_cause() {
    let maps = maps::named(&["map10x10_full_range"]);
    let maps = maps
        .iter()
        .filter(|path| !path.to_string_lossy().contains(DRIFTED));
    let benches: Vec<Bench> = maps
        .map(|path| read_one(path, &Settings::default()).unwrap_or_else(|refusal| panic!("{refusal}")))
        .collect();
    assert_eq!(benches.len(), 5);
    let drawn = |bench: &Bench| {
        let count = bench.points.len();
        let points = (0..count).map(|k| bench.points[37 * k % count]);
        let points = points.enumerate().map(|(k, p)| Point {
            line: 2 + k as u64,
            ..p
        });
        Bench {
            points: points.collect(),
            rests: Vec::new(),
            ..bench.clone()
        }
    };
    let mut text = "mistake,order,maps,by its cause,by another one,not told\n".to_owned();
    for (name, cause, plant) in MISTAKES {
        for (order, arranged) in [("grid", Bench::clone as fn(&Bench) -> Bench), ("drawn", drawn)] {
            let mut counts = [0; 3];
            for bench in benches.iter().map(arranged) {
                let mut wrong = bench.clone();
                plant(&mut wrong.points);
                let before = warnings(bench);
                let told = warnings(wrong);
                let more = told.lines().any(|line| {
                    !TRUE_WORDS.iter().any(|words| line.contains(words)) && !before.contains(line)
                });
                counts[if told.contains(cause) {
                    0
                } else {
                    1 + usize::from(!more)
                }] += 1;
            }
            text += &format!(
                "{name},{order},{},{},{},{}\n",
                benches.len(),
                counts[0],
                counts[1],
                counts[2]
            );
        }
    }
    measured::hold("planted.csv", &text);
}

/// The same rows with something done to each.
fn changed(bench: &Bench, change: impl Fn(&mut Point)) -> Bench {
    let mut bench = bench.clone();
    bench.points.iter_mut().for_each(change);
    bench
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn mistakes_in_real_benches_are_told() {
    let files = maps::files();
    let (exchanged, tare, disorder) = ("look exchanged", "set the load cells to zero", "in disorder");
    let (mut full_range, mut tares) = (0, 0);
    for map in &files {
        let name = map.display();
        let bench = read_one(map, &Settings::default()).unwrap_or_else(|refusal| panic!("{refusal}"));
        let swapped = changed(&bench, |p| (p.u, p.l, p.torque) = (p.l, p.u, -p.torque));
        // Of rows that stand out nothing else is asked.
        assert!(
            warnings(swapped).contains(exchanged) || name.to_string().contains(DRIFTED),
            "{name}"
        );
        let lowest = bench.points.iter().map(|p| p.u).fold(1.0, f64::min);
        let greatest = bench.points.iter().map(|p| p.thrust).fold(0.0, f64::max);
        // Of the shape of rows that the throttles explain badly nothing is said.
        if lowest < 0.15 && !name.to_string().contains(DRIFTED) {
            full_range += 1;
            let torque = bench.points.iter().map(|p| p.torque.abs()).fold(0.0, f64::max);
            let offsets: [[f64; 2]; 4] = [[0.02, 0.0], [-0.02, 0.0], [0.0, 0.06], [0.0, -0.06]];
            let told = offsets.map(|[f, q]| {
                let told = warnings(changed(&bench, |p| {
                    (p.thrust, p.torque) = (p.thrust + f * greatest, p.torque + q * torque);
                }));
                told.contains(tare) && !told.contains(exchanged)
            });
            tares += told.iter().filter(|told| **told).count();
            let is_tared = !name.to_string().contains(NOT_TARED);
            assert!(!is_tared || !warnings(bench.clone()).contains(tare), "{name}");
        }
        // Each row with what the row before it gave.
        let mut late = bench.clone();
        for (point, before) in late.points.iter_mut().skip(1).zip(&bench.points) {
            (point.thrust, point.torque) = (before.thrust, before.torque);
        }
        assert!(warnings(late).contains(disorder), "{name}");
    }
    println!(
        "exchanged columns and rows in disorder are told of {0} of {0} maps, {tares} missing tares of {full_range} full-range maps",
        files.len()
    );
    assert_eq!(tares, 4 * full_range);
}
