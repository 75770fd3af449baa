//! Real bench files, where `MIXER_BENCH_DATA` names their folder. None of them is part of the
//! project.

use std::path::{Path, PathBuf};

use mixer_compiler::airframe::Basis;
use mixer_compiler::model::injectivity::EnclosedPairMap;
use mixer_identify::bench::{self, Point};
use mixer_identify::fit::Fit;
use mixer_identify::fit::basis::ThrottleBox;
use mixer_identify::fit::power::Power;

use cargo_mixer::bench_files::{identify, identify_with_runs, read_one};
use mixer_identify::fit::pair::Pair;
use mixer_identify::fit::polynomial::Polynomial;
use mixer_identify::fragment;
use mixer_identify::identified::{Identified, from_benches};

use super::sweep::settings;
use crate::{bench_data, measured};

/// The files of a folder whose name holds `part`, in order.
fn files(folder: &Path, part: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    let mut found: Vec<PathBuf> = entries.flatten().map(|e| e.path()).collect();
    let name = |p: &PathBuf| {
        p.file_name()
            .map(|n| n.to_string_lossy().into_owned())
            .unwrap_or_default()
    };
    found.retain(|p| name(p).contains(part) && name(p).ends_with(".csv"));
    found.sort();
    assert!(!found.is_empty(), "no file like {part} in {}", folder.display());
    found
}

/// The maps of 10 x 10 throttles from 0.07 on; without the corrupt one.
pub(crate) fn full_range_maps(data: &Path) -> Vec<PathBuf> {
    let mut maps = files(&data.join("newdexterity"), "full_range");
    maps.retain(|path| !path.to_string_lossy().contains(CORRUPT));
    assert!(maps.len() >= 5, "{maps:?}");
    maps
}

pub(crate) fn coaxial(data: &Path, part: &str) -> PathBuf {
    files(&data.join("newdexterity"), part).remove(0)
}

pub(crate) fn fitted(path: &Path, basis: Option<Basis>, robust: bool) -> Identified {
    let mut settings = settings(basis);
    settings.wishes.robust = robust;
    let found = identify(&[path.to_path_buf()], &settings);
    found.unwrap_or_else(|e| panic!("{}: {}", path.display(), e[0]))
}

fn pair(path: &Path, basis: Option<Basis>, robust: bool) -> Pair {
    fitted(path, basis, robust).pair.expect("a pair")
}

const CORRUPT: &str = "data2021_08_17_10_13_04";
const REPEAT: &str = "data2021_08_17_11_11_55";

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn eight_terms_agree_with_the_independent_fit() {
    let data = bench_data();
    let text = std::fs::read_to_string(data.join("newdexterity/reference_fit.json")).expect("the reference");
    let reference: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let (name, reference) = reference
        .as_object()
        .and_then(|o| o.iter().next())
        .expect("one map");
    let pair = pair(
        &data.join("newdexterity").join(name),
        Some(Basis::Biquadratic),
        false,
    );
    let within = |what: &str, ours: f64, theirs: &serde_json::Value, relative: f64| {
        let theirs = theirs.as_f64().unwrap_or_else(|| panic!("{what} is no number"));
        assert!(
            (ours - theirs).abs() <= relative * theirs.abs(),
            "{what}: {ours} {theirs}"
        );
    };
    let close = |what: &str, ours: f64, theirs: &serde_json::Value| within(what, ours, theirs, 1e-6);
    // x is the upper, y the lower throttle.
    let terms = ["x2y2", "x2y", "x2", "xy2", "xy", "x", "y2", "y"];
    for (key, fit) in [("thrust_N", &pair.thrust), ("torque_Nm", &pair.torque)] {
        let theirs = &reference[key];
        for (k, term) in terms.iter().enumerate() {
            close(term, fit.coefficients[k], &theirs["coef"][term]);
            // The reference took t(0.975, 92) as 1.9860830, 1.7e-6 below the quantile.
            within(
                &format!("interval of {term}"),
                fit.ci95[k],
                &theirs["ci95"][term],
                2e-6,
            );
        }
        close("R2", fit.r2, &theirs["r2"]);
        close("rms", fit.residual_rms, &theirs["rms"]);
        close("maximum", fit.residual_max, &theirs["max_abs"]);
        close("condition", fit.condition_number, &theirs["cond"]);
        assert_eq!(Some(fit.points as u64), theirs["n"].as_u64());
    }
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn every_map_is_identified() {
    let data = bench_data();
    for path in files(&data.join("newdexterity"), "map10x10") {
        let robust = path.to_string_lossy().contains(CORRUPT);
        let found = fitted(&path, None, robust);
        let file = &found.files[0];
        assert_eq!(
            (
                file.rows,
                file.start_stop_rows + file.refused_rows.len(),
                file.points_used
            ),
            (103, 3, 100),
            "{}",
            path.display()
        );
        // A start row of it has a pulse width of 320 us.
        assert_eq!(file.refused_rows.len(), usize::from(robust));
        assert_eq!(
            file.notes.iter().any(|n| n.contains("drifts")),
            robust,
            "{:?}",
            file.notes
        );
        let pair = found.pair.as_ref().expect("a pair");
        for (fit, least) in [(&pair.thrust, 0.995), (&pair.torque, 0.994)] {
            assert!(fit.r2 > least, "{}: R2 {}", path.display(), fit.r2);
        }
        assert!(pair.thrust.leave_one_out_rms < 0.01 * pair.thrust.full_scale);
        if !robust {
            assert!(
                pair.outliers.is_empty(),
                "{}: {:?}",
                path.display(),
                pair.outliers
            );
        }
        let map = EnclosedPairMap::of(pair.basis, &pair.thrust_n, &pair.torque_nm);
        let proof = map.prove_injective(pair.throttle.into());
        assert!(proof.is_ok(), "{}: {proof:?}", path.display());
        assert!(
            pair.throttle.min <= pair.measured[0][0].max(0.235),
            "{:?}",
            pair.throttle
        );
        let table: toml::Table = fragment::text(&found).parse().expect("TOML");
        assert_eq!(table["pair"]["basis"].as_str(), Some(pair.basis.name()));
        println!(
            "{:<60.60} {:<11} leave-one-out {:.2} % {:.2} %, throttle {} .. {}",
            file.file,
            pair.basis.name(),
            100.0 * pair.thrust.leave_one_out_rms / pair.thrust.full_scale,
            100.0 * pair.torque.leave_one_out_rms / pair.torque.full_scale,
            pair.throttle.min,
            pair.throttle.max
        );
    }
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn nine_terms_more_than_halve_the_error_of_large_full_range_maps() {
    let data = bench_data();
    for path in files(&data.join("newdexterity"), "full_range") {
        if path.to_string_lossy().contains(CORRUPT) {
            continue;
        }
        let percent = |basis| {
            let pair = pair(&path, Some(basis), false);
            100.0 * pair.thrust.leave_one_out_rms / pair.thrust.full_scale
        };
        let (eight, nine) = (percent(Basis::Biquadratic), percent(Basis::Cubic));
        println!("{}: {eight:.2} % -> {nine:.2} %", path.display());
        assert!((0.55..0.95).contains(&nine), "{}: {nine}", path.display());
        if path.to_string_lossy().contains("_11in_") {
            // The 11 inch pair is described by either: 0.87 and 0.93 %.
            assert!((eight - nine).abs() < 0.05, "{}: {eight} {nine}", path.display());
        } else {
            assert!(
                (1.3..2.3).contains(&eight) && nine < 0.6 * eight,
                "{}: {eight} {nine}",
                path.display()
            );
            let chosen = pair(&path, None, false).basis;
            assert_ne!(chosen, Basis::Biquadratic, "{}", path.display());
        }
    }
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn the_corrupt_rows_are_named_and_the_fit_without_them_is_the_repeats() {
    let data = bench_data();
    let path = coaxial(&data, CORRUPT);
    for basis in [None, Some(Basis::Biquadratic), Some(Basis::Cubic)] {
        let plain = pair(&path, basis, false);
        let mut worst: Vec<_> = plain.outliers.iter().collect();
        worst.sort_by(|a, b| b.thrust_residual.abs().total_cmp(&a.thrust_residual.abs()));
        let lines: Vec<u64> = worst.iter().map(|o| o.line).collect();
        // Rows 83, 93 and 103 miss by 3.4 to 6.1 of 18 N; row 73 by 1.3 N, ten standard deviations.
        assert_eq!(lines[..3], [103, 93, 83], "{lines:?}");
        assert!(
            lines.len() <= 4 && worst[2].thrust_residual.abs() > 3.0,
            "{worst:?}"
        );
        assert!(plain.warnings.iter().any(|w| w.contains("--robust")));
    }
    let clean = pair(&coaxial(&data, REPEAT), Some(Basis::Biquadratic), false);
    let difference = |robust: bool| {
        let ours = pair(&path, Some(Basis::Biquadratic), robust);
        let grid = ThrottleBox { min: 0.07, max: 0.95 }.grid(20);
        let worst = |a: &[f64], b: &[f64]| {
            let [a, b] = [a, b].map(|c| Polynomial::of(Basis::Biquadratic, c));
            let places = grid.clone().flat_map(|u| grid.clone().map(move |l| (u, l)));
            places
                .map(|(u, l)| (a.at(u, l) - b.at(u, l)).abs())
                .fold(0.0, f64::max)
        };
        let thrust = worst(&ours.thrust_n, &clean.thrust_n) / clean.thrust.full_scale;
        let torque = worst(&ours.torque_nm, &clean.torque_nm) / clean.torque.full_scale;
        (ours.thrust.r2, 100.0 * thrust, 100.0 * torque)
    };
    let ((r2, f, q), (robust_r2, robust_f, robust_q)) = (difference(false), difference(true));
    println!("R2 {r2:.4} -> {robust_r2:.4} (repeat {:.4})", clean.thrust.r2);
    println!(
        "greatest difference to the repeat {f:.1} % -> {robust_f:.1} %, torque {q:.1} % -> {robust_q:.1} %"
    );
    assert!((r2 - 0.959).abs() < 0.001 && (robust_r2 - clean.thrust.r2).abs() < 0.001);
    // What remains is no outlier: the recorded command of the upper rotor drifts by up to 50 us in
    // the second half of the run, while its speed stays that of the repeat.
    assert!(f > 7.0 && robust_f < 4.5, "{f} {robust_f}");
    assert!(q > 15.0 && robust_q < 8.5, "{q} {robust_q}");
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn exponents_of_the_pairs_at_two_voltages() {
    let data = bench_data();
    let folder = data.join("strawson");
    // Runs of one rotor without torque.
    let mut settings = settings(None);
    settings.wishes.run.diameter_m = Some(0.2);
    let mut exponents = Vec::new();
    for name in ["a1", "h6"] {
        let paths = [format!("{name}_7.csv"), format!("{name}_11.csv")].map(|n| folder.join(n));
        let found = identify(&paths, &settings).expect("an exponent");
        assert!(found.pair.is_none());
        let voltage = found.voltage.expect("voltages");
        let e = voltage.thrust.estimate().expect("sound").clone();
        println!("{name}: {:.3} +- {:.3}", e.exponent, e.ci95);
        assert_eq!((e.method, e.levels), ("equal throttles", 11));
        assert!(
            (1.55..1.86).contains(&e.exponent) && e.ci95 < 0.12,
            "{name}: {e:?}"
        );
        exponents.push(e.exponent);
    }
    // 1.75 is the median over 104 pairs, 1.67 to 1.86 its quartiles; these two lie on either side.
    let mean = exponents.iter().sum::<f64>() / exponents.len() as f64;
    assert!((1.67..1.86).contains(&mean), "{exponents:?}");
    // Latin-1 with CR line ends: the same pair, retyped.
    let retyped = [folder.join("a1_7.csv"), folder.join("modifieddata_a1_11.csv")];
    let again = identify(&retyped, &settings)
        .expect("an exponent")
        .voltage
        .expect("voltages");
    assert!((again.thrust.estimate().expect("sound").exponent - 1.82).abs() < 0.2);
    // Two rotors under one command are noticed.
    let mixed = ["a1_7.csv", "a1_11.csv", "h6_7.csv", "h6_11.csv"].map(|n| folder.join(n));
    let error = identify(&mixed, &settings).unwrap_err()[0].to_string();
    assert!(
        error.contains("two propellers or voltages in one table"),
        "{error}"
    );
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn files_that_cannot_serve_are_refused() {
    let data = bench_data();
    let cases = [
        ("aerostack2", "steps", "the run stops at a throttle of 0.61"),
        ("esc_test", "Log_", "is empty in all 4814 rows"),
        ("pybemt", "coaxial_data", "no throttle column"),
        ("pybemt", "tmotor28_data", "no throttle column"),
        ("newdexterity", "optimal_fit_cmd", "do not determine the map"),
        ("strawson", "a1_7", "torque was not measured"),
    ];
    for (folder, part, reason) in cases {
        let path = files(&data.join(folder), part).remove(0);
        let error = identify(&[path], &settings(None)).unwrap_err()[0].to_string();
        assert!(
            error.contains(reason) && error.contains("needed: "),
            "{part}: {error}"
        );
    }
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn rotor_speeds_mapped_by_hand_are_still_one_line() {
    let data = bench_data();
    let mut settings = settings(None);
    let roles = [
        ("upper", "RPM"),
        ("lower", "RPM_B"),
        ("upper_thrust", "T_A(N)"),
        ("lower_thrust", "T_B(N)"),
        ("upper_torque", "Q_A(Nm)"),
        ("lower_torque", "Q_B(Nm)"),
    ];
    settings.reading.by_hand.columns = roles.map(|(r, h)| (r.to_string(), h.to_string())).to_vec();
    settings.reading.by_hand.full_rpm = Some(3200.0);
    let path = files(&data.join("pybemt"), "coaxial_data").remove(0);
    let error = identify(&[path], &settings).unwrap_err()[0].to_string();
    assert!(error.contains("both rotors turn by one signal"), "{error}");
}

/// Indices of `count` levels of ten, from the lowest to the highest, evenly.
fn thinned(count: usize) -> Vec<usize> {
    (0..count)
        .map(|k| (9 * k + (count - 1) / 2) / (count - 1))
        .collect()
}

/// Root mean square errors of thrust and torque on the rows left out, percent of the greatest
/// value, when a bench runs only `count` x `count` of the map's 10 x 10 levels; nothing where
/// `identify` refuses so few.
fn left_out(path: &Path, basis: Basis, count: usize) -> Option<[f64; 2]> {
    let settings = settings(Some(basis));
    let whole = read_one(path, &settings).expect("a bench");
    let level = |throttle: f64| (9.0 * (throttle - 0.07) / 0.88).round() as usize;
    let kept = thinned(count);
    let is_kept = |p: &Point| kept.contains(&level(p.u)) && kept.contains(&level(p.l));
    let (rows, rest): (Vec<Point>, Vec<Point>) = whole.points.iter().partition(|p| is_kept(p));
    assert_eq!(rows.len(), count * count, "{}", path.display());
    let thin = bench::Bench {
        points: rows,
        ..whole.clone()
    };
    let pair = from_benches(vec![thin], &settings.wishes).ok()?.pair?;
    // Of ten levels none is left out: the leave-one-out error is the comparison.
    if rest.is_empty() {
        let percent = |fit: &Fit| 100.0 * fit.leave_one_out_rms / fit.full_scale;
        return Some([percent(&pair.thrust), percent(&pair.torque)]);
    }
    let percent = |coefficients: &[f64], of: fn(&Point) -> f64| {
        let model = Polynomial::of(basis, coefficients);
        let missed = rest.iter().map(|p| model.at(p.u, p.l) - of(p));
        let square: f64 = missed.map(|e| e * e).sum();
        let full = whole.points.iter().map(|p| of(p).abs()).fold(0.0, f64::max);
        100.0 * (square / rest.len() as f64).sqrt() / full
    };
    Some([
        percent(&pair.thrust_n, |p| p.thrust),
        percent(&pair.torque_nm, |p| p.torque),
    ])
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn five_levels_suffice_as_the_page_says() {
    let data = bench_data();
    let maps = full_range_maps(&data);
    let mut text = String::from("levels,basis,thrust_percent,torque_percent\n");
    let mut cubic = Vec::new();
    for count in [10, 6, 5, 4, 3] {
        for basis in Basis::ALL {
            let errors: Option<Vec<[f64; 2]>> =
                maps.iter().map(|path| left_out(path, basis, count)).collect();
            let percent = errors.as_ref().map_or(",".to_string(), |errors| {
                let [f, q] = [0, 1].map(|c| errors.iter().map(|e| e[c]).sum::<f64>() / errors.len() as f64);
                if basis == Basis::Cubic {
                    cubic.push((count, f, q));
                }
                format!("{f:.2},{q:.2}")
            });
            text += &format!("{count},{},{percent}\n", basis.name());
        }
    }
    measured::hold("levels.csv", &text);
    let of = |count: usize| cubic.iter().find(|c| c.0 == count).map(|&(_, f, q)| (f, q));
    let ((all_f, all_q), (five_f, five_q)) = (of(10).expect("a fit"), of(5).expect("a fit"));
    assert!(five_f < 1.2 * all_f && five_q < 1.25 * all_q);
    assert_eq!(of(3), None, "3 x 3 levels do not determine nine terms");
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn torque_of_least_power_saves_on_every_full_range_map() {
    let data = bench_data();
    let maps = full_range_maps(&data);
    let mut savings = Vec::new();
    for path in &maps {
        let Some(Power::Identified(least)) = fitted(path, None, false).power else {
            panic!("no power map of {}", path.display());
        };
        println!(
            "{}: c = {}, {:.2} %",
            path.display(),
            least.bias_nm_per_n,
            least.saving_percent
        );
        assert!(
            (0.0028..0.011).contains(&least.bias_nm_per_n),
            "{}",
            least.bias_nm_per_n
        );
        assert!(
            least.at.iter().all(|at| at.least_power_w < at.power_w),
            "{:?}",
            least.at
        );
        assert!(
            least.residual_rms_w < 0.006 * least.full_scale_w,
            "{}",
            least.residual_rms_w
        );
        savings.push(least.saving_percent);
    }
    let mean = savings.iter().sum::<f64>() / savings.len() as f64;
    assert!(mean > 2.35, "{mean} of {savings:?}");
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn single_rotors_are_described_by_three_terms() {
    let data = bench_data();
    let coaxial = |part: &str| coaxial(&data, part);
    // The upper and the lower rotor's runs, with a full-range map of the same pair and with one
    // from 0.40, where there is one.
    let pairs = [
        (
            "_11in_prop_910kv_11V_propdrivev2_single_rotor_good",
            "_11in_prop_910kv_11V_propdrivev2_bottom",
        ),
        (
            "_16p2in_prop_400kv_22V_U5_T_motor_single",
            "_16p2in_prop_400kv_22V_U5_T_motor_bottom",
        ),
        (
            "_22in_prop_240kv_25V_MN501S_T_motor_single",
            "_22in_prop_240kv_25V_MN501S_T_motor_bottom",
        ),
    ];
    let maps = [
        ("08_17_09_33_47_11in", "07_23_08_27_27_11in"),
        ("08_09_18_15_06_16p2in", "07_22_10_20_01_16p2in"),
        ("08_17_17_00_55_22in", "07_20_14_17_57_22in"),
    ];
    let mut errors = Vec::new();
    let mut from_idle = Vec::new();
    let mut from_forty = Vec::new();
    for ((upper, lower), (full, forty)) in pairs.into_iter().zip(maps) {
        for (map, of_the_pair) in [(full, &mut from_idle), (forty, &mut from_forty)] {
            let settings = settings(Some(Basis::Cubic));
            let [upper, lower] = [upper, lower].map(coaxial);
            let found = identify_with_runs(&[coaxial(map)], [Some(&upper), Some(&lower)], &settings)
                .unwrap_or_else(|e| panic!("{map}: {}", e[0]));
            assert!(
                !found
                    .warnings
                    .iter()
                    .any(|w| w.contains("nothing was measured below"))
            );
            let pair = found.pair.expect("a pair");
            for alone in [&pair.lower_out, &pair.upper_out] {
                let alone = alone.as_ref().expect("a rotor alone");
                let [f, q] = [alone.thrust, alone.torque];
                let percent = |x: f64, of: f64| 100.0 * x / of;
                of_the_pair.push([
                    percent(f.of_the_pair_rms, f.full_scale),
                    percent(q.of_the_pair_rms, q.full_scale),
                ]);
                // Whatever throttle the map begins at.
                assert!(f.leave_one_out_rms < 0.015 * f.full_scale, "{map}: {f:?}");
                if map == full {
                    errors.push([
                        percent(f.leave_one_out_rms, f.full_scale),
                        percent(q.leave_one_out_rms, q.full_scale),
                    ]);
                }
                println!("{map}: {} {f:?} {q:?}", alone.file);
            }
        }
    }
    let mean = |errors: &[[f64; 2]], k: usize| errors.iter().map(|e| e[k]).sum::<f64>() / errors.len() as f64;
    let figures = [&errors, &from_idle, &from_forty].map(|errors| [0, 1].map(|k| mean(errors, k)));
    let [alone, idle, forty] = figures;
    println!("alone {alone:.2?}, polynomial of full-range maps {idle:.2?}, of maps from 0.40 {forty:.2?}");
    assert!(alone[0] < 0.9 && alone[1] < 0.95, "{alone:?}");
    assert!(errors.iter().all(|[f, q]| *f < 1.5 && *q < 1.5), "{errors:?}");
    // What these runs replace.
    assert!(
        idle[0] > 1.0 && forty[0] > 4.0 && forty[1] > 9.0,
        "{idle:?} {forty:?}"
    );
}
