//! Thrust and torque of one rotor alone, `[pair.lower_out]` and `[pair.upper_out]`, from runs in
//! which the other one stands still.
//!
//! Model: a1 x + a2 x2 + a3 x3 in the throttle x of the rotor that turns, for thrust and torque, by
//! least squares (QR). Left out, a point would miss by e_i / (1 - h_i). The polynomials of the pair
//! say the same at a throttle of zero, but are extrapolated there from the lowest throttle that was
//! measured.

use faer::Mat;

use crate::bench::{Bench, BenchKind, Point, mean_voltage};
use crate::fit::basis::ThrottleBox;
use crate::fit::pair::Pair;
use crate::fit::polynomial::Polynomial;
use crate::fit::voltage::Voltage;
use crate::fit::{distinct_pairs, ten_digits};
use crate::refusal::Refusal;
use crate::rotor::{Alone, AloneFit, Turning};
use crate::statistics::{extent, greatest, rms};

/// Distinct throttles that three terms take, to judge themselves as well.
const FEWEST: usize = 6;
/// Voltages of a run and of the map, as a ratio less 1, above which they belong together only by
/// exponents.
const OTHER_VOLTAGE: f64 = 0.03;
/// Throttle by which a run may end inside the range that is commanded.
const SHORT: f64 = 0.05;
/// Where the lowest measured throttle is above this, throttle 0 is an extrapolation.
const LOW: f64 = 0.15;

/// Identifies a rotor alone from its run; warnings are added to `warnings`.
///
/// # Errors
/// A run in which both rotors turn or the other one does, or that has too few throttles or no torque.
pub fn identify(
    run: &Bench,
    turning: Turning,
    pair: &Pair,
    voltage: Option<&Voltage>,
    warnings: &mut Vec<String>,
) -> Result<Alone, Refusal> {
    let [flag, rotor, other] = turning.words();
    let refuse = |reason: String| {
        let needed =
            format!("a run of the {rotor} rotor over all throttles with the {other} one standing still");
        Err(Refusal::of(&run.file, format!("{flag}: {reason}"), needed))
    };
    if run.kind == BenchKind::Pair {
        return refuse("both rotors turn in it".into());
    }
    if run.turning.is_some_and(|found| found != turning) {
        return refuse(format!(
            "the {other} rotor turns in it, the {rotor} one stands still"
        ));
    }
    let points = at_reference(run, turning, pair, voltage, warnings);
    let x: Vec<f64> = points.iter().map(|p| p.u).collect();
    let places: Vec<[f64; 2]> = x.iter().map(|&x| turning.throttles(x)).collect();
    let distinct = distinct_pairs(&places);
    if distinct < FEWEST {
        return refuse(format!(
            "{distinct} distinct throttles, at least {FEWEST} are needed"
        ));
    }
    if points.iter().any(|p| !p.torque.is_finite()) {
        return refuse("rows without torque".into());
    }
    let channel = |of: fn(&Point) -> f64, model: &[f64]| {
        let y: Vec<f64> = points.iter().map(of).collect();
        let model = Polynomial::of(pair.basis, model);
        fit(&x, &y, |x| {
            let [u, l] = turning.throttles(x);
            model.at(u, l)
        })
    };
    let (thrust_n, thrust) = channel(|p| p.thrust, &pair.thrust_n);
    let (torque_nm, torque) = channel(|p| p.torque, &pair.torque_nm);
    let measured = extent(x.iter().copied());
    let ThrottleBox { min, max } = pair.throttle;
    if let Some(at) = falls(thrust_n, pair.throttle) {
        return refuse(format!(
            "the fitted thrust does not grow with the throttle at {at:.2}"
        ));
    }
    if measured[0] > min + SHORT || measured[1] < max - SHORT {
        warnings.push(format!(
            "{flag} was measured from {:.2} to {:.2}, the pair is commanded from {min} to {max}: what is beyond is \
             extrapolated",
            measured[0], measured[1]
        ));
    }
    Ok(Alone {
        file: run.file.clone(),
        thrust_n,
        torque_nm,
        thrust,
        torque,
        measured,
        points: points.len(),
    })
}

/// The run's points at the reference voltage, torque with the sign of the airframe file.
fn at_reference(
    run: &Bench,
    turning: Turning,
    pair: &Pair,
    voltage: Option<&Voltage>,
    warnings: &mut Vec<String>,
) -> Vec<Point> {
    let [flag, ..] = turning.words();
    let volts = mean_voltage(&run.points).and_then(|(mean, all)| all.then_some(mean));
    let exponents = voltage.and_then(Voltage::exponents);
    let brought = pair.normalised_to_v.zip(exponents).filter(|_| volts.is_some());
    if let (None, Some(of_pair), Some(mean)) = (brought, pair.mean_v, volts)
        && (mean / of_pair - 1.0).abs() > OTHER_VOLTAGE
    {
        warnings.push(format!(
            "{flag} was run at {mean:.2} V, the map at {of_pair:.2} V: without exponents (--voltage-exponent) they are \
             taken as one"
        ));
    }
    let place = |p: &Point| {
        let p = brought.map_or(*p, |(reference, exponents)| {
            p.at_voltage(p.voltage, reference, exponents)
        });
        Point {
            torque: turning.sign() * p.torque,
            ..p
        }
    };
    run.points.iter().map(place).collect()
}

fn fit(x: &[f64], y: &[f64], of_the_pair: impl Fn(f64) -> f64) -> ([f64; 3], AloneFit) {
    let qr = Mat::from_fn(x.len(), 3, |i, j| [x[i], x[i] * x[i], x[i] * x[i] * x[i]][j]).qr();
    let (q, r) = (qr.compute_thin_Q(), qr.thin_R());
    let along = |k: usize| y.iter().enumerate().map(|(i, y)| q[(i, k)] * y).sum::<f64>();
    let z = [0, 1, 2].map(along);
    let a3 = z[2] / r[(2, 2)];
    let a2 = (z[1] - r[(1, 2)] * a3) / r[(1, 1)];
    let a1 = (z[0] - r[(0, 1)] * a2 - r[(0, 2)] * a3) / r[(0, 0)];
    let coefficients = [a1, a2, a3].map(ten_digits);
    let points = 0..y.len();
    let missed = |i: usize| y[i] - ((a3 * x[i] + a2) * x[i] + a1) * x[i];
    let leverage = |i: usize| (0..3).map(|k| q[(i, k)] * q[(i, k)]).sum::<f64>();
    let left_out = |i: usize| missed(i) / (1.0 - leverage(i)).max(1e-12);
    let statistics = AloneFit {
        residual_rms: rms(points.clone().map(missed)),
        leave_one_out_rms: rms(points.clone().map(left_out)),
        of_the_pair_rms: rms(points.map(|i| y[i] - of_the_pair(x[i]))),
        full_scale: greatest(y),
    };
    (coefficients, statistics)
}

/// A throttle of the range at which a1 x + a2 x2 + a3 x3 does not grow.
fn falls([a1, a2, a3]: [f64; 3], throttle: ThrottleBox) -> Option<f64> {
    let slope = |x: &f64| (3.0 * a3 * x + 2.0 * a2) * x + a1;
    throttle.grid(200).find(|x| slope(x) <= 0.0)
}

/// A warning that the map is extrapolated where a rotor is out; none where both rotors were run
/// alone or it begins low.
pub fn extrapolated(pair: &Pair) -> Option<String> {
    let lowest = pair.measured[0][0].max(pair.measured[1][0]);
    let flags = [(&pair.lower_out, "--lower-out"), (&pair.upper_out, "--upper-out")];
    let missing = flags.into_iter().filter(|(alone, _)| alone.is_none());
    let missing: Vec<&str> = missing.map(|(_, flag)| flag).collect();
    (lowest > LOW && !missing.is_empty()).then(|| {
        format!(
            "nothing was measured below a throttle of {lowest:.2}: with a rotor out the map is extrapolated to 0, on real \
             maps by 5 to 15 % of thrust and 30 % of torque; runs of one rotor alone mend it ({})",
            missing.join(", ")
        )
    })
}
