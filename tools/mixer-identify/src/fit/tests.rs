use super::*;
use crate::fit::polynomial::Polynomial;

#[test]
fn student_t_agrees_with_the_table() {
    // Two-sided 95 %, standard tables and R's qt(0.975, df).
    let table = [
        (1, 12.706_204_736_174_7),
        (2, 4.302_652_729_749_46),
        (5, 2.570_581_835_636_31),
        (10, 2.228_138_851_986_27),
        (30, 2.042_272_456_301_24),
        (92, 1.986_086_316_951_13),
        (1000, 1.962_339_080_825_08),
    ];
    for (degrees, quantile) in table {
        let ours = student_t_975(degrees);
        assert!(
            (ours - quantile).abs() < 1e-9 * quantile,
            "{degrees}: {ours} {quantile}"
        );
    }
}

fn grid(levels: usize) -> Vec<[f64; 2]> {
    let at = |k: usize| 0.07 + 0.88 * k as f64 / (levels - 1) as f64;
    (0..levels)
        .flat_map(|i| (0..levels).map(move |j| [at(i), at(j)]))
        .collect()
}

const BOX: ThrottleBox = ThrottleBox { min: 0.07, max: 0.95 };

#[test]
fn leave_one_out_by_leverage_is_leave_one_out() {
    let points = grid(5);
    let y: Vec<f64> = points
        .iter()
        .enumerate()
        .map(|(i, p)| p[0] + ((i * 7919) % 13) as f64 * 0.1)
        .collect();
    let design = Design::new(Basis::Biquadratic, &points, BOX).expect("a design");
    let all = fit(&design, &y, BOX);
    let mut squares = 0.0;
    for left_out in 0..points.len() {
        let keep = |i: &usize| *i != left_out;
        let p: Vec<_> = (0..points.len()).filter(keep).map(|i| points[i]).collect();
        let v: Vec<_> = (0..points.len()).filter(keep).map(|i| y[i]).collect();
        let without = fit(
            &Design::new(Basis::Biquadratic, &p, BOX).expect("a design"),
            &v,
            BOX,
        );
        let [u, l] = points[left_out];
        let miss = y[left_out] - Polynomial::of(Basis::Biquadratic, &without.coefficients).at(u, l);
        squares += miss * miss;
    }
    let direct = (squares / points.len() as f64).sqrt();
    assert!(
        (direct - all.leave_one_out_rms).abs() < 1e-7 * direct,
        "{direct} {}",
        all.leave_one_out_rms
    );
}

#[test]
fn designs_that_do_not_determine_the_map_are_refused() {
    let line: Vec<[f64; 2]> = (1..=30)
        .map(|k| [k as f64 / 30.0, k as f64 / 30.0 * 0.98])
        .collect();
    let error = Design::new(Basis::Cubic, &line, BOX).err().expect("refused");
    assert!(error.0.contains("on one line"), "{error:?}");
    // Near a line: rank enough, but a guess away from it.
    let bent: Vec<[f64; 2]> = (1..=30)
        .map(|k| [k as f64 / 30.0, k as f64 / 30.0 + 0.01 * ((k * 7) % 5) as f64])
        .collect();
    let error = Design::new(Basis::Biquadratic, &bent, BOX)
        .err()
        .expect("refused");
    assert!(error.0.contains("do not determine the map"), "{error:?}");
    let error = Design::new(Basis::Quartic, &grid(4), BOX).err().expect("refused");
    assert_eq!(error.0, "16 distinct throttle pairs, at least 18 are needed");
    // Repeats of a few pairs are no new pairs.
    let few: Vec<[f64; 2]> = grid(3).into_iter().cycle().take(90).collect();
    let error = Design::new(Basis::Biquadratic, &few, BOX).err().expect("refused");
    assert_eq!(error.0, "9 distinct throttle pairs, at least 12 are needed");
}

#[test]
fn ten_digits_round() {
    assert_eq!(ten_digits(1.234_567_890_123), 1.234_567_890);
    assert_eq!(ten_digits(-9.876_543_210_987e-7), -9.876_543_211e-7);
    assert_eq!(ten_digits(0.0), 0.0);
}
