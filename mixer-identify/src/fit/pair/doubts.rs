//! Doubts that the statistics of a fit do not show: files of different pairs, throttles that were
//! not measured, exchanged rotors, a missing tare.

use mixer_compiler::airframe::Basis;
use mixer_compiler::model::wake::{Wake, mean_torque};

use super::placed::Placed;
use crate::fit::Fit;
use crate::fit::basis::ThrottleBox;
use crate::fit::polynomial::Polynomial;
use crate::refusal::Refusal;

/// Full throttle, but for what pulse widths are rounded to.
const FULL: f64 = 0.995;

/// What files differ by that each fits well, rms about their common map, as a share of the greatest
/// thrust. Repeats on another day differ by 0.004 to 0.008 so, real pairs of one propeller at other
/// spacings or with another motor by as much.
const APART: f64 = 0.01;

/// An idle that benches reach; maps that begin above leave much of the thrust always on.
const LOW: f64 = 0.25;

/// Throttles below and above those that were measured.
pub(super) fn coverage(throttle: ThrottleBox, warnings: &mut Vec<String>) {
    let ThrottleBox { min, max } = throttle;
    if min > LOW {
        warnings.push(format!(
            "throttle.min is {min}: what is below is never commanded and its thrust always on; measure down to 0.05 to 0.15, then \
             identify says the least idle"
        ));
    }
    if max < FULL {
        warnings.push(format!(
            "throttle.max is {max}: what is above is never commanded; measure up to full throttle"
        ));
    }
}

/// Files that each fit well, and together less so: of different pairs. `together` and `apart` are
/// the residuals of thrust, rms.
pub(super) fn joined_files(
    files: &[&str],
    [together, apart]: [f64; 2],
    full_scale: f64,
    warnings: &mut Vec<String>,
) {
    let between = (together * together - apart * apart).max(0.0).sqrt();
    let (percent, files) = (100.0 * between / full_scale, files.join(", "));
    if between > APART * full_scale {
        warnings.push(format!(
            "the files differ from their common map by {between:.3} N rms, {percent:.1} % of the greatest thrust, beyond what each \
             misses by itself: files of one pair at one spacing belong into one fit ({files})"
        ));
    }
}

/// The share of the variance of thrust or torque that the throttles must explain. Fits of 53 real
/// maps explain 0.993 and more, of one whose record of the throttles drifts 0.939; columns or rows
/// in disorder and two pairs in one file do not.
const EXPLAINED: f64 = 0.9;

/// Refuses points that the throttles do not explain; says so where they explain little.
pub(super) fn unexplained(
    files: &str,
    [thrust, torque]: [&Fit; 2],
    warnings: &mut Vec<String>,
) -> Result<(), Refusal> {
    for (name, r2) in [("thrust", thrust.r2), ("torque", torque.r2)] {
        let percent = 100.0 * r2.max(0.0);
        if r2 < EXPLAINED {
            return Err(Refusal::of(
                files,
                format!(
                    "the throttles explain {percent:.0} % of the variance of {name} (R2 = {r2:.3}), in real maps 99 % and more: \
                     columns or rows are in disorder, or there is more than one pair in it"
                ),
                "each command in one row with what it gave, columns by their names (--column), one pair per file; --robust leaves out \
                 single bad rows",
            ));
        }
        if r2 < 0.98 {
            warnings.push(format!("{name} is poorly described: R2 = {r2:.4}"));
        }
    }
    Ok(())
}

/// Says whether the rotors are exchanged, by the mean torque; asks where that does not tell and
/// nobody said which sign the torque has.
pub(super) fn exchanged(
    basis: Basis,
    torque: &Fit,
    throttle: ThrottleBox,
    sign_is_found: bool,
    warnings: &mut Vec<String>,
) {
    let torque = Polynomial::of(basis, &torque.coefficients);
    let mean = mean_torque(|[u, l]| torque.at(u, l), [throttle.min, throttle.max]);
    let percent = 100.0 * mean;
    match Wake::told_by(mean) {
        Wake::Above => warnings.push(format!(
            "upper and lower rotor look exchanged: at equal throttles the one taken as lower takes more torque (mean {percent:+.1} % \
             of the largest), though the rotor in the wake takes less; --swap exchanges them"
        )),
        Wake::Untold if sign_is_found => warnings.push(format!(
            "the torque does not tell which rotor is the upper one (mean {percent:+.1} % of the largest): make sure that the columns \
             are the right way round (--swap exchanges them)"
        )),
        Wake::Below | Wake::Untold => {}
    }
}

/// Power of the throttle below which thrust does not grow with equal throttles: 1.5 to 1.9 on real
/// maps, 1.4 and less where 2 % of the greatest thrust was not tared.
const GROWTH: f64 = 1.45;

/// Throttles that a map must reach for that: from this or below, to this or above.
const FULL_RANGE: [f64; 2] = [0.15, 0.5];

/// Throttles that differ by less are equal.
const EQUAL: f64 = 0.01;

/// A constant in the thrust: a load cell that was not set to zero.
pub(super) fn tare(points: &[Placed], warnings: &mut Vec<String>) {
    let near = |p: &&Placed| (p.point.u - p.point.l).abs() < EQUAL;
    let equal = points
        .iter()
        .filter(near)
        .map(|p| (0.5 * (p.point.u + p.point.l), p.thrust));
    let by_throttle = |a: &(f64, f64), b: &(f64, f64)| a.0.total_cmp(&b.0);
    let (Some((low, least)), Some((high, most))) =
        (equal.clone().min_by(by_throttle), equal.max_by(by_throttle))
    else {
        return;
    };
    if low > FULL_RANGE[0] || high < FULL_RANGE[1] || least <= 0.0 {
        return;
    }
    let growth = libm::log(most / least) / libm::log(high / low);
    if growth < GROWTH {
        warnings.push(format!(
            "from ({low:.2}, {low:.2}) to ({high:.2}, {high:.2}) the thrust grows from {least:.2} to {most:.2} N, with the power \
             {growth:.2} of the throttle; real pairs have 1.5 to 1.9: set the load cell to zero at rest before a run"
        ));
    }
}
