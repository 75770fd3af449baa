//! From bench files to throttles: identify -> check -> mix over all coaxial maps of
//! `MIXER_BENCH_DATA`.
//!
//! The mixer is asked for what the model gives at every bench point inside its throttle range; it
//! must answer with the commands of that point, and what the bench measured there is what the pair
//! would really have given. The difference from what was asked is the error of the whole way: of
//! the model, of the tables and of the inverse map.

use std::path::Path;

use mixer_compiler::{Compiled, Source};
use mixer_identify::fragment;
use mixer_identify::identified::Identified;
use mixer_rt::Wrench;

use crate::maps;

/// The fragment completed to a single pair on a stand, as its comments say.
fn compiled(identified: &Identified) -> Compiled {
    let text = format!(
        "name = \"bench\"\n{}\n[[unit]]\nposition_m = [0.0, 0.0, 0.0]\nupper_spin = \"cw\"\nchannels = [0, 1]\n\
         [allocation]\naxes = [\"yaw\", \"thrust\"]\n",
        fragment::text(identified)
    );
    mixer_compiler::compile(&Source::new("bench.toml", text)).unwrap_or_else(|faults| panic!("{faults}"))
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn every_map_flies_as_it_was_measured() {
    let files = maps::files();

    println!("end-to-end error: asked less measured, in % of the largest on the bench (rms, max)");
    println!(
        "{:<14} {:>6} {:>14} {:>14}  map",
        "basis", "points", "thrust", "torque"
    );
    for map in &files {
        for basis in ["cubic", "auto"] {
            fly(map, basis);
        }
    }
}

/// Share of the largest torque by which the border of the attainable set may be missed.
const BORDER: f64 = 3e-2;

/// One map in one basis.
fn fly(map: &Path, basis: &str) {
    let name = map.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let identified = maps::identified(map, basis);
    let compiled = compiled(&identified);
    let pair = mixer_compiler::model::PairMap::new(&compiled.airframe.pairs[0], &compiled.airframe.throttle);
    let (low, high) = (compiled.airframe.throttle.min, compiled.airframe.throttle.max);
    let inside = |throttle: f64| (low..=high).contains(&throttle);
    let points = || identified.files[0].points.iter();
    let full = points().fold([0.0f64; 2], |[f, q], p| {
        [f.max(p.thrust.abs()), q.max(p.torque.abs())]
    });

    let (mut count, mut squares, mut largest) = (0, [0.0f64; 2], [0.0f64; 2]);
    for point in points().filter(|point| inside(point.u) && inside(point.l)) {
        let [f, q] = pair.efforts([point.u, point.l]);
        let setpoint = Wrench {
            yaw_nm: q as f32,
            thrust_n: f as f32,
            ..Wrench::default()
        };
        let (throttle, achieved, saturation) = compiled.tables.mix(&setpoint, 0.0).expect("finite");
        // The sides that the mixer knows are inside the attainable set: most where Q hardly changes
        // f, next to a fold.
        let missed = (f64::from(achieved.yaw_nm) - q).abs() / full[1];
        let is_border = [point.u, point.l]
            .iter()
            .any(|throttle| [low, high].contains(throttle));
        assert!(
            !saturation.any_axis() || (is_border && missed < BORDER),
            "{name}, {basis}: an attainable effort saturates at {point:?}, {missed}"
        );
        if saturation.any_axis() {
            continue;
        }
        // What these throttles would really give is known where they are the bench's: to the
        // tolerance of the inverse, seen through the least slope of thrust that a map without a
        // fold leaves.
        for (throttle, commanded) in throttle.iter().zip([point.u, point.l]) {
            let off = (f64::from(*throttle) - commanded).abs();
            assert!(
                off < 0.02,
                "{name}, {basis}: throttle {throttle} where the bench had {commanded}"
            );
        }
        for (k, error) in [f - point.thrust, q - point.torque].into_iter().enumerate() {
            let share = (error / full[k]).abs();
            squares[k] += share * share;
            largest[k] = largest[k].max(share);
        }
        count += 1;
    }
    assert!(count >= 25, "{name}, {basis}: {count} points inside the range");
    let rms = squares.map(|sum| 100.0 * (sum / f64::from(count)).sqrt());
    let max = largest.map(|share| 100.0 * share);
    println!(
        "{basis:<14} {count:>6} {:>6.2} {:>6.2}  {:>6.2} {:>6.2}   {name}",
        rms[0], max[0], rms[1], max[1]
    );
    // The repeat of the corrupt run is sound; the corrupt run itself has rows that are wrong by a
    // fifth.
    if !name.contains("data2021_08_17_10_13_04") {
        assert!(rms[0] < 2.5 && rms[1] < 4.5, "{name}, {basis}: {rms:?} % rms");
    }
}
