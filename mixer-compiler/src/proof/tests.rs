//! The proof against dense sampling, and against sabotage.

use super::enclosure_tests::numbers;
use super::*;
use crate::airframe::Airframe;
use crate::diagnostic::source::Source;

fn airframe_text(name: &str) -> String {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let path = folder.join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

fn compiled(text: String) -> crate::compiled::Compiled {
    crate::compile(&Source::new("test.toml", text)).unwrap_or_else(|faults| panic!("{faults}"))
}

fn prove_again(compiled: &crate::compiled::Compiled, tables: &crate::tables::MixerTables) -> Certificate {
    let correction = CorrectionBounds::new(&compiled.airframe, &tables.corrections);
    let tolerance = correction.tolerance_at_reference(&compiled.airframe);
    let aim = [0, 1].map(|k| (1.15 * compiled.of_pairs[0].residual.efforts[k]).min(tolerance[k]));
    prove(
        &compiled.airframe.pair_views().next().unwrap(),
        &tables.map(),
        &correction,
        aim,
        Patience::Thorough,
    )
}

/// Every basis and every kind of evaluator: no residual at any of 40,000 throttles and voltages, as
/// the mixer corrects for them, is above the proven bound, and the bound is not far above the
/// residuals.
#[test]
fn nothing_is_observed_beyond_the_bound() {
    let isae = airframe_text("airframes/isae-x8.toml");
    let loose = |text: &str, method: &str| {
        text.replace("thrust_tolerance_n = 0.01", "thrust_tolerance_n = 2.4")
            .replace(
                "torque_tolerance_nm = 1e-4",
                &format!("torque_tolerance_nm = 0.0217\nmethod = {method}"),
            )
    };
    let mut texts = vec![
        ("isae-x8".to_owned(), isae.clone()),
        (
            "polynomial 5".to_owned(),
            loose(&isae, "\"polynomial\"\ndegree = 5"),
        ),
    ];
    for fixture in ["cubic-tilted-x8", "polynomial-x10", "quartic-y6"] {
        texts.push((
            fixture.into(),
            airframe_text(&format!("tests/fixtures/{fixture}.toml")),
        ));
    }
    for (name, text) in texts {
        let compiled = compiled(text);
        let (airframe, tables) = (&compiled.airframe, &compiled.tables);
        let certificate = &compiled.of_pairs[0].certificate;
        assert!(certificate.agrees(&compiled.of_pairs[0].residual), "{name}");
        let mut next = numbers();
        let mut worst = [0.0f64; 2];
        let pair = &compiled.maps[0];
        let view = tables.view();
        for index in 0..40_000 {
            // Half of the points on the border and close to it.
            let throttles = [0, 1].map(|_| {
                let near = if index % 2 == 0 { 1.0 } else { 1.1 };
                pair.clamp(
                    0.5 * (airframe.throttle.min + airframe.throttle.max)
                        + 0.5 * near * (airframe.throttle.max - airframe.throttle.min) * next(),
                )
            });
            let efforts = pair.efforts(throttles);
            // As the mixer does it: the product of the factors in f32, then its reciprocal.
            let corrections = [(&airframe.voltage, &view.voltage), (&airframe.air, &view.air)];
            let (mut k, mut computed) = ([1.0; 2], [1.0f32; 2]);
            for (correction, table) in corrections {
                let (Some(correction), Some(table)) = (correction, table) else {
                    continue;
                };
                let [low, high] = table.range;
                let x = low + (high - low) * (0.5 + 0.5 * next() as f32);
                let (exact, rounded) = (correction.factors(f64::from(x)), table.factors(x));
                (k, computed) = (
                    [0, 1].map(|m| k[m] * exact[m]),
                    [0, 1].map(|m| computed[m] * rounded[m]),
                );
            }
            let per = computed.map(|factor| 1.0 / factor);
            let asked = [0, 1].map(|m: usize| (k[m] * efforts[m]) as f32 * per[m]);
            let found = tables.throttles(0, asked).unwrap();
            for throttle in found {
                assert!(throttle >= tables.throttle.min && throttle <= tables.throttle.max);
            }
            let given = pair.efforts(found.map(f64::from));
            for m in 0..2 {
                worst[m] = worst[m].max(k[m] * (given[m] - efforts[m]).abs());
            }
        }
        for m in 0..2 {
            assert!(
                worst[m] <= certificate.stated[m],
                "{name}: {worst:?} {certificate:?}"
            );
            assert!(certificate.stated[m] <= airframe_tolerance(airframe)[m], "{name}");
        }
        // Rounding, the voltage table's included, is some 2e-5 N: where the bound is well above, it
        // is within a quarter of what was seen.
        let sharp = compiled.of_pairs[0].residual.efforts[0] > 2e-4;
        let ratio = certificate.over_observed(&compiled.of_pairs[0].residual);
        assert!(
            !sharp || ratio.iter().all(|&ratio| ratio <= 1.25),
            "{name}: {ratio:?}"
        );
    }
}

fn airframe_tolerance(airframe: &Airframe) -> [f64; 2] {
    [
        airframe.inverse.thrust_tolerance_n,
        airframe.inverse.torque_tolerance_nm,
    ]
}

/// Any bit of any number of the inverse and of the forward map: either the flip changes next to
/// nothing, or the proof fails, and it never claims less than what the flipped tables really do.
#[test]
fn flipped_bits_are_refused_where_they_matter() {
    let compiled = compiled(airframe_text("airframes/isae-x8.toml"));
    let pair = &compiled.maps[0];
    let (mut refused, mut harmless) = (0, 0);
    for place in 0..18 {
        for bit in [30, 26, 23, 22, 20, 17, 8, 0] {
            let mut tables = compiled.tables.clone();
            let slot = {
                let inverse = &mut tables.pairs[0].inverse;
                let factors = inverse.forms.iter_mut().flatten();
                factors
                    .chain(inverse.coefficients.iter_mut().flatten())
                    .nth(place)
                    .unwrap()
            };
            *slot = f32::from_bits(slot.to_bits() ^ (1 << bit));
            let certificate = prove_again(&compiled, &tables);
            let observed = Residual::over_set(pair, &tables.map());
            if certificate.holds() {
                assert!(
                    certificate.agrees(&observed),
                    "{place} {bit}: {observed:?} {certificate:?}"
                );
                harmless += 1;
            } else {
                refused += 1;
            }
            // Of the small coefficient of x2 some smaller flips are harmless.
            if bit == 30 || bit >= 23 && place != 6 {
                assert!(!certificate.holds(), "{place} {bit}: {certificate:?}");
            }
            if bit == 0 {
                assert!(certificate.holds(), "{place}: {certificate:?}");
            }
        }
    }
    assert!(refused >= 18 * 3 && harmless >= 18, "{refused} {harmless}");
}

/// A Newton step corrects the seed whatever the forward table says of it: a wrong forward table
/// must show.
#[test]
fn a_wrong_forward_map_is_refused() {
    let compiled = compiled(airframe_text("airframes/isae-x8.toml"));
    for bit in [23, 20, 16] {
        let mut tables = compiled.tables.clone();
        let crate::tables::QuantityTable::Biquadratic(mixer_rt::tables::Biquadratic(terms)) =
            &mut tables.pairs[0].pair.thrust
        else {
            panic!("{:?}", tables.pairs[0].pair)
        };
        terms[2] = f32::from_bits(terms[2].to_bits() ^ (1 << bit));
        assert!(!prove_again(&compiled, &tables).holds(), "bit {bit}");
    }
}

/// A voltage table that is off must show in full; off by more than the tolerance leaves, it is
/// refused.
#[test]
fn a_wrong_voltage_table_is_refused() {
    let compiled = compiled(airframe_text("airframes/isae-x8.toml"));
    let bound = |factor: f32| {
        let mut tables = compiled.tables.clone();
        let voltage = tables.corrections.voltage.as_mut().expect("a correction");
        voltage.pieces[0].thrust[4] *= factor;
        prove_again(&compiled, &tables)
    };
    let (right, off, wrong) = (bound(1.0), bound(1.0 + 5e-5), bound(1.001));
    assert!(off.holds() && off.stated[0] > right.stated[0] + 5e-4, "{off:?}");
    assert!(!wrong.holds(), "{wrong:?}");
}

/// Tolerances below what f32 can do are refused with a bound that was proven.
#[test]
fn too_small_a_tolerance_is_refused() {
    let text = airframe_text("airframes/isae-x8.toml").replace("tolerance_n = 0.01", "tolerance_n = 1e-6");
    let faults = crate::compile(&Source::new("test.toml", text)).unwrap_err();
    assert!(faults.to_string().contains("is proven within"), "{faults}");
}

/// Where the map folds, no Newton step can be bounded: the proof itself notices, not only the stage
/// before it.
#[test]
fn a_fold_cannot_be_proven() {
    let mut compiled = compiled(airframe_text("airframes/isae-x8.toml"));
    compiled.airframe.throttle.min = 0.05;
    compiled.tables.throttle.min = 0.05;
    let certificate = prove_again(&compiled, &compiled.tables.clone());
    assert!(!certificate.holds(), "{certificate:?}");
}

/// At a tolerance near rounding level: what the runtime computes of its own throttles is off by no
/// more than it allows for, and it allows for little more.
#[test]
fn delivered_efforts_do_not_look_missed() {
    let text = airframe_text("airframes/isae-x8.toml")
        .replace("tolerance_n = 0.01", "tolerance_n = 5e-5")
        .replace("tolerance_nm = 1e-4", "tolerance_nm = 8e-7");
    let compiled = compiled(text);
    let tables = &compiled.tables;
    let pair = &compiled.maps[0];
    let proven = compiled.of_pairs[0].certificate.reference;
    let slack = [0, 1].map(|k| f64::from(tables.tolerance.efforts[k]) - proven[k]);
    let mut next = numbers();
    let mut largest = [0.0f64; 2];
    for _ in 0..20_000 {
        let throttles = [0, 1].map(|_| (0.55 + 0.45 * next()) as f32);
        let (computed, exactly) = (
            tables.pairs[0].pair.efforts(throttles),
            pair.efforts(throttles.map(|throttle| pair.clamp(f64::from(throttle)))),
        );
        let asked = exactly.map(|effort| effort as f32);
        for k in 0..2 {
            largest[k] = largest[k].max((f64::from(computed[k]) - f64::from(asked[k])).abs());
        }
    }
    for k in 0..2 {
        assert!(
            largest[k] > 0.05 * slack[k] && largest[k] <= slack[k],
            "{largest:?} {slack:?}"
        );
    }
}

/// Cells at the corners of the box, where both throttles are limited, and an inverse that is off by up to a tenth: what
/// the runtime does at drawn throttles of the cell is within the bound.
#[test]
fn limited_corners_are_bounded() {
    let compiled = compiled(airframe_text("airframes/isae-x8.toml"));
    let (airframe, pair) = (&compiled.airframe, &compiled.maps[0]);
    let correction = CorrectionBounds::new(airframe, &compiled.tables.corrections);
    let [low, high] = [airframe.throttle.min, airframe.throttle.max];
    let mut next = numbers();
    let (mut bounded, mut limited, mut nearest) = (0, 0, 0.0f64);
    for round in 0..600 {
        let mut tables = compiled.tables.clone();
        for coefficient in tables.pairs[0].inverse.coefficients.iter_mut().flatten() {
            *coefficient *= 1.0 + 0.1 * next() as f32;
        }
        let share = next().abs();
        let half = 0.05 * share * share * share + 1e-6;
        let corner = [round & 1, round >> 1 & 1].map(|side| if side == 1 { high - half } else { low + half });
        let map = tables.map();
        let subject = Subject::new(&airframe.pair_views().next().unwrap(), &map, &correction);
        let bound = subject.residual(&ThrottleCell {
            centre: corner,
            half: [half; 2],
        });
        bounded += u32::from(bound.iter().all(|bound| bound.is_finite()));
        for _ in 0..20 {
            let throttles = corner.map(|centre| pair.clamp(centre + 1.02 * half * next().clamp(-0.98, 0.98)));
            let efforts = pair.efforts(throttles);
            let found = tables
                .throttles(0, efforts.map(|effort| effort as f32))
                .unwrap()
                .map(f64::from);
            limited += u32::from(found.iter().all(|found| *found <= low || *found >= high));
            let given = pair.efforts(found);
            for k in 0..2 {
                let missed = (given[k] - efforts[k]).abs();
                assert!(
                    missed <= bound[k],
                    "{round} {throttles:?} {found:?}: {missed} {bound:?}"
                );
                nearest = nearest.max(missed / bound[k]);
            }
        }
    }
    // Bounds that are never nearly met would hold by being useless.
    assert!(
        bounded > 500 && limited > 200 && nearest > 0.5,
        "{bounded} {limited} {nearest}"
    );
}
