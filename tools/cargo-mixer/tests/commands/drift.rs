//! Drift in run order, on the real maps of `MIXER_BENCH_DATA`: their rows as measured and in a drawn order.

use mixer_identify::bench::{Bench, Point};
use mixer_identify::fit::pair::drift::Drift;
use mixer_identify::fit::wishes::FitOptions;
use mixer_identify::identified::{Identified, Settings, from_benches};

use cargo_mixer::bench_files::read_one;

use crate::maps;

/// What a drift does to a row at `x` of the run, 0 to 1, in shares of the greatest thrust and torque.
type Change = fn(&mut Point, x: f64, greatest: [f64; 2]);
const DRIFTS: [(&str, Change); 4] = [
    ("clean", |_, _, _| ()),
    ("tare", |p, x, [f, _]| p.thrust += 0.04 * x * f),
    ("scale", |p, x, _| p.thrust *= 1.0 - 0.06 * x),
    ("torque", |p, x, [_, q]| p.torque += 0.1 * x * q),
];

/// The bench with its rows in the order of `order`, and drifted in that order.
fn drifted(bench: &Bench, order: &[usize], change: Change) -> Bench {
    let mut bench = bench.clone();
    let greatest = [|p: &Point| p.thrust.abs(), |p: &Point| p.torque.abs()]
        .map(|of| bench.points.iter().map(of).fold(0.0, f64::max));
    bench.points = order.iter().map(|&k| bench.points[k]).collect();
    let last = bench.points.len() as f64 - 1.0;
    for (k, point) in bench.points.iter_mut().enumerate() {
        // The rotors' own cells are left as they are.
        point.cells = [f64::NAN; 4];
        change(point, k as f64 / last, greatest);
    }
    bench
}

/// A drawn order of `count` rows.
fn drawn(count: usize, seed: u64) -> Vec<usize> {
    let mut state = seed;
    let mut keyed: Vec<(u64, usize)> = (0..count)
        .map(|k| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 33, k)
        })
        .collect();
    keyed.sort_unstable();
    keyed.into_iter().map(|(_, k)| k).collect()
}

fn shown(found: &Identified, of: &str) -> Option<Drift> {
    let pair = found.pair.as_ref().expect("a map");
    pair.drift
        .iter()
        .find(|shown| shown.of == of)
        .expect("thrust and torque")
        .drift
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn a_drift_is_told_in_a_drawn_order_and_nothing_in_that_of_a_grid() {
    let files = maps::files();
    println!(
        "t of thrust and torque: {}",
        DRIFTS.map(|(name, _)| name).join(", ")
    );
    for (index, file) in files.iter().enumerate() {
        let bench = read_one(file, &Settings::default()).unwrap_or_else(|refusal| panic!("{refusal}"));
        // The record of this one's throttles drifts, which hides any other drift and is told by itself.
        let is_told_otherwise = bench.file.contains("data2021_08_17_10_13_04");
        let count = bench.points.len();
        let seeds = [2 * index as u64, 2 * index as u64 + 1];
        let [a, b] = seeds.map(|seed| drawn(count, seed));
        for (order, is_drawn) in [((0..count).collect(), false), (a, true), (b, true)] {
            let mut line = format!(
                "{:.30} {}:",
                bench.file,
                ["measured", "drawn"][usize::from(is_drawn)]
            );
            for (name, change) in DRIFTS {
                let found =
                    from_benches(vec![drifted(&bench, &order, change)], &FitOptions::default()).unwrap();
                let both = ["thrust", "torque"].map(|of| shown(&found, of));
                let t = both.map(|drift| drift.map_or("-".to_owned(), |drift| format!("{:.1}", drift.t)));
                line += &format!(" {},", t.join(" "));
                let told = both.map(|drift| drift.is_some_and(|drift| drift.significant));
                assert_eq!(both.map(|drift| drift.is_some()), [is_drawn; 2], "{line}");
                let wanted = [["tare", "scale"].contains(&name), name == "torque"].map(|is| is && is_drawn);
                assert!(told == wanted || is_told_otherwise, "{line} {name}");
                let words = found
                    .warnings
                    .iter()
                    .any(|warning| warning.contains("drifts with the order"));
                assert_eq!(words, told != [false; 2], "{:?}", found.warnings);
            }
            println!("{line}");
        }
    }
}
