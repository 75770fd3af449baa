//! Known truth comes back, in every format.

use mixer_compiler::airframe::Basis;
use mixer_identify::bench::Bench;
use mixer_identify::fit::basis::ThrottleBox;

use mixer_identify::fit::pair::Pair;
use mixer_identify::fit::polynomial::Polynomial;
use mixer_identify::fit::{Design, fit, student_t_975};
use mixer_identify::identified::{Settings, from_benches};

use super::sweep::{FORMATS, Normal, bench, plain, rows, settings};
use mixer_identify::paper::{THRUST, TORQUE};

/// How many of the coefficients lie within their 95 % intervals.
fn inside(estimate: &[f64], interval: &[f64], truth: &[f64]) -> usize {
    let all = estimate.iter().zip(interval).zip(truth);
    all.filter(|((c, ci), truth)| (*c - *truth).abs() <= **ci).count()
}

fn identified(bench: Bench, settings: &Settings) -> Pair {
    let found = from_benches(vec![bench], &settings.wishes).expect("a map");
    found.pair.expect("a pair")
}

#[test]
fn intervals_hold_the_truth_at_their_rate() {
    const SEEDS: u64 = 40;
    let settings = settings(Some(Basis::Biquadratic));
    let mut held = 0;
    for seed in 0..SEEDS {
        let bench = bench("a.csv", &plain(&rows(seed)), &settings).expect("a bench");
        let pair = identified(bench, &settings);
        let rms = pair.thrust.residual_rms;
        assert!((rms - 0.1).abs() < 0.04, "{rms}");
        held += inside(&pair.thrust_n, &pair.thrust.ci95, &THRUST);
        held += inside(&pair.torque_nm, &pair.torque.ci95, &TORQUE);
    }
    // 640 coefficients. The eight of one fit go together, so that the standard deviation of the
    // rate is nearer to that of 160 independent ones: 1.7 %.
    let rate = held as f64 / (SEEDS * 16) as f64;
    assert!(
        (0.95 - rate).abs() < 0.045,
        "{rate:.3} of the intervals hold the truth"
    );
}

/// One sweep in every format is one map, so that what holds of its intervals in one format holds in
/// all.
#[test]
fn every_format_gives_the_same_map() {
    const SEEDS: u64 = 3;
    let settings = settings(Some(Basis::Biquadratic));
    for seed in 0..SEEDS {
        let reference = bench("a.csv", &plain(&rows(seed)), &settings).expect("a bench");
        let reference = identified(reference, &settings);
        for (format, write) in FORMATS {
            let name = format!("map2024-05-0{}_{seed}.csv", seed + 1);
            let bench =
                bench(&name, &write(&rows(seed)), &settings).unwrap_or_else(|e| panic!("{format}: {e}"));
            assert_eq!(bench.points_used, 100, "{format}");
            assert_eq!(
                bench.start_stop_rows,
                if format == "coaxial map" { 3 } else { 0 },
                "{format}"
            );
            assert_eq!(bench.streaming, format == "streaming", "{format}");
            assert!(
                bench.refused_rows.is_empty(),
                "{format}: {:?}",
                bench.refused_rows
            );
            let pair = identified(bench, &settings);
            for (ours, same) in [
                (&pair.thrust, &reference.thrust),
                (&pair.torque, &reference.torque),
            ] {
                for k in 0..8 {
                    let far = 1e-6 * same.ci95[k];
                    assert!(
                        (ours.coefficients[k] - same.coefficients[k]).abs() < far,
                        "{format} {k}"
                    );
                    assert!((ours.ci95[k] - same.ci95[k]).abs() < far, "{format} {k}");
                }
            }
        }
    }
}

#[test]
fn every_coefficient_of_every_basis_holds_at_its_rate() {
    const SEEDS: u64 = 1500;
    let throttle_box = ThrottleBox { min: 0.1, max: 1.0 };
    let points: Vec<[f64; 2]> = (0..49)
        .map(|k| [k / 7, k % 7].map(|j| 0.1 + 0.15 * j as f64))
        .collect();
    for basis in Basis::ALL {
        let truth: Vec<f64> = (0..basis.exponents().len())
            .map(|k| 3.0 - ((k * 5) % 7) as f64)
            .collect();
        let polynomial = Polynomial::of(basis, &truth);
        let clean: Vec<f64> = points.iter().map(|p| polynomial.at(p[0], p[1])).collect();
        let design = Design::new(basis, &points, throttle_box).expect("a design");
        let errors = design.standard_errors();
        let mut held = vec![0; basis.exponents().len()];
        for seed in 0..SEEDS {
            let mut normal = Normal::new(seed);
            let y: Vec<f64> = clean.iter().map(|y| y + 0.2 * normal.next()).collect();
            let z = design.coordinates(&y);
            let sse: f64 = design.residuals(&y, &z).iter().map(|e| e * e).sum();
            let degrees = points.len() - basis.exponents().len();
            let wide = student_t_975(degrees) * (sse / degrees as f64).sqrt();
            for (k, c) in design.coefficients(&z).into_iter().enumerate() {
                held[k] += u64::from((c - truth[k]).abs() <= wide * errors[k]);
            }
        }
        // The standard deviation of a rate is sqrt(0.95 * 0.05 / 1500) = 0.56 %; four of them among
        // 31 coefficients.
        for (term, held) in basis.term_names().iter().zip(held) {
            let rate = held as f64 / SEEDS as f64;
            assert!((rate - 0.95).abs() < 0.0225, "{basis:?} {term}: {rate}");
        }
    }
}

#[test]
fn without_noise_the_truth_comes_back_to_ten_digits() {
    let throttle_box = ThrottleBox { min: 0.4, max: 0.95 };
    let points: Vec<[f64; 2]> = (0..100)
        .map(|k| [k / 10, k % 10].map(|j| 0.4 + 0.55 / 9.0 * j as f64))
        .collect();
    let polynomial = Polynomial::of(Basis::Biquadratic, &THRUST);
    let y: Vec<f64> = points.iter().map(|p| polynomial.at(p[0], p[1])).collect();
    let fit = fit(
        &Design::new(Basis::Biquadratic, &points, throttle_box).expect("a design"),
        &y,
        throttle_box,
    );
    assert!(
        fit.condition_number > 1000.0,
        "the case is meant to be hard: {}",
        fit.condition_number
    );
    for (c, truth) in fit.coefficients.iter().zip(THRUST) {
        assert!((c - truth).abs() <= 1e-9 * truth.abs(), "{c} {truth}");
    }
}

#[test]
fn repeats_join_and_different_pairs_do_not() {
    let settings = settings(Some(Basis::Biquadratic));
    let file = |name: &str, seed: u64, factor: f64| {
        let mut rows = rows(seed);
        rows.iter_mut()
            .for_each(|r| r.thrust = r.thrust.map(|f| f * factor));
        bench(name, &plain(&rows), &settings).expect("a bench")
    };
    let two = from_benches(
        vec![file("a.csv", 1, 1.0), file("b.csv", 2, 1.0)],
        &settings.wishes,
    )
    .expect("a pair");
    assert_eq!(two.pair.expect("a pair").thrust.points, 200);
    let error = from_benches(
        vec![file("a.csv", 1, 1.0), file("b.csv", 2, 1.3)],
        &settings.wishes,
    )
    .unwrap_err();
    assert!(error.reason.contains("do not describe one pair"), "{error}");
    let error = from_benches(
        vec![file("a.csv", 1, 1.0), file("a.csv", 2, 1.0)],
        &settings.wishes,
    )
    .unwrap_err();
    assert!(error.reason.contains("given twice"), "{error}");
}

#[test]
fn the_idle_is_raised_above_the_fold_or_the_map_unfolded() {
    let mut settings = settings(Some(Basis::Biquadratic));
    settings.wishes.throttle = Some(ThrottleBox { min: 0.02, max: 1.0 });
    let bench = bench("a.csv", &plain(&rows(5)), &settings).expect("a bench");
    let free = from_benches(vec![bench.clone()], &settings.wishes)
        .expect("a pair")
        .pair
        .expect("a pair");
    let least = free.fold.least_idle.expect("an idle");
    assert!(
        free.fold.folds && free.throttle.min >= least && free.throttle.min < least + 0.005,
        "{} and {least}",
        free.throttle.min
    );
    assert!(
        free.warnings.iter().any(|w| w.contains("throttle.min is raised")),
        "{:?}",
        free.warnings
    );
    assert!(
        free.warnings.iter().any(|w| w.contains("extrapolated")),
        "{:?}",
        free.warnings
    );
}

#[test]
fn any_bytes_end_in_a_result() {
    // The choice of the basis takes four times the time of one fit: it is made in one of four.
    let (chosen, given) = (settings(None), settings(Some(Basis::Biquadratic)));
    let mut normal = Normal::new(99);
    for (_, write) in FORMATS {
        let clean = write(&rows(5));
        for round in 0..12 {
            let settings = if round % 4 == 0 { &chosen } else { &given };
            let mut bytes = clean.clone();
            for _ in 0..1 + (60.0 * normal.uniform()) as usize {
                let at = (normal.uniform() * bytes.len() as f64) as usize;
                match (normal.uniform() * 4.0) as usize {
                    0 => bytes[at] = (normal.uniform() * 256.0) as u8,
                    1 => drop(bytes.remove(at)),
                    2 => bytes.insert(at, b"0;,e-\"\r\n9"[(normal.uniform() * 9.0) as usize]),
                    _ => bytes.truncate(bytes.len() - bytes.len() / 40),
                }
            }
            if let Ok(bench) = bench("x.csv", &bytes, settings) {
                let _ = from_benches(vec![bench], &settings.wishes);
            }
        }
    }
}
