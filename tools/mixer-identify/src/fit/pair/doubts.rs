//! Doubts that the statistics of a fit do not show: files of different pairs, throttles that were
//! not measured, exchanged rotors, a missing tare.

use mixer_compiler::airframe::Basis;
use mixer_compiler::model::wake::{Wake, mean_torque};
use mixer_compiler::model::{TORQUE_PER_THRUST_M, TORQUE_SPAN_M};

use super::placed::Placed;
use crate::fit::Fit;
use crate::fit::basis::ThrottleBox;
use crate::fit::polynomial::Polynomial;
use crate::refusal::Refusal;
use crate::statistics::extent;

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

/// Refuses torque over thrust that no propeller has, and warns of one that few have: a unit.
pub(super) fn units(
    files: &str,
    points: &[Placed],
    [thrust, torque]: [&Fit; 2],
    warnings: &mut Vec<String>,
) -> Result<(), Refusal> {
    let [least, most] = extent(points.iter().map(|p| p.torque));
    let ratio = (most - least) / thrust.full_scale;
    let within = |[low, high]: [f64; 2]| (low..=high).contains(&ratio);
    let [low, high] = TORQUE_SPAN_M;
    if !within(TORQUE_SPAN_M) {
        let told = format!(
            "the torque of up to {:.3} N m spans {ratio:.2e} m times the greatest thrust, {:.2} N; propellers of 4 to 40 inch have {low} \
             to {high} m: a unit is another one",
            torque.full_scale, thrust.full_scale
        );
        let mend = "--unit thrust=UNIT, --unit torque=UNIT";
        if !within(TORQUE_PER_THRUST_M) {
            return Err(Refusal::of(files, told, format!("the units of both: {mend}")));
        }
        warnings.push(format!("{told} ({mend})"));
    }
    Ok(())
}

/// Whether the lower rotor is the stronger one: the mean torque says so of it, or of rotors that are exchanged, which
/// `by_hand` rules out. Warns of both causes where nobody said which rotor is which; asks where the mean does not tell and
/// nobody said which sign the torque has.
pub(super) fn lower_is_stronger(
    basis: Basis,
    torque: &Fit,
    throttle: ThrottleBox,
    by_hand: bool,
    sign_is_found: bool,
    warnings: &mut Vec<String>,
) -> bool {
    let torque = Polynomial::of(basis, &torque.coefficients);
    let mean = mean_torque(|[u, l]| torque.at(u, l), [throttle.min, throttle.max]);
    let percent = 100.0 * mean;
    let wake = Wake::told_by(mean);
    match wake {
        Wake::Above if !by_hand => warnings.push(format!(
            "upper and lower rotor look exchanged, or the lower one is the stronger (more pitch, KV or diameter): at equal throttles \
             the one taken as lower takes more torque (mean {percent:+.1} % of the largest), though of equal rotors the one in the wake \
             takes less; exchanged columns are mended by --swap, right ones confirmed by --column upper=HEADER --column lower=HEADER"
        )),
        Wake::Untold if sign_is_found && !by_hand => warnings.push(format!(
            "the torque does not tell which rotor is the upper one (mean {percent:+.1} % of the largest): make sure that the columns \
             are the right way round (--swap exchanges them)"
        )),
        Wake::Above | Wake::Below | Wake::Untold => {}
    }
    by_hand && wake == Wake::Above
}

/// Powers of the throttle with which thrust grows along equal throttles: 1.5 to 1.9 on real maps, less
/// where 2 % of the greatest thrust was not tared, more where the load cell reads low.
const GROWTH: [f64; 2] = [1.45, 2.15];

/// Throttles that a map must reach for that: from this or below, to this or above.
const FULL_RANGE: [f64; 2] = [0.15, 0.5];

/// Throttles that differ by less are equal.
const EQUAL: f64 = 0.01;

/// Torque at the lowest equal throttles, as a share of the greatest: this, and a part of the share
/// that thrust has there. Tared maps have 0.005 and 0.2 of it at most, one with an untared torque
/// 0.016, which its rows at rest tell.
const AT_LOWEST: [f64; 2] = [0.03, 0.2];

/// Constants in thrust and torque: load cells that were not set to zero. Whether that of torque is
/// told.
pub(super) fn tare(points: &[Placed], [thrust, torque]: [&Fit; 2], warnings: &mut Vec<String>) -> bool {
    const MEND: &str = "set the load cells to zero at rest, or record some rows at rest (throttle 0) \
                        before and after, which --tare takes off";
    let near = |p: &&Placed| (p.point.u - p.point.l).abs() < EQUAL;
    let throttle = |p: &Placed| 0.5 * (p.point.u + p.point.l);
    let by_throttle = |a: &&Placed, b: &&Placed| throttle(a).total_cmp(&throttle(b));
    let equal = || points.iter().filter(near);
    let (Some(lowest), Some(highest)) = (equal().min_by(by_throttle), equal().max_by(by_throttle)) else {
        return false;
    };
    let ([low, high], [least, most]) = (
        [lowest, highest].map(throttle),
        [lowest, highest].map(|p| p.thrust),
    );
    if low <= FULL_RANGE[0] && high >= FULL_RANGE[1] {
        let growth = libm::log(most / least) / libm::log(high / low);
        if least <= 0.0 {
            warnings.push(format!(
                "at ({low:.2}, {low:.2}) the thrust is {least:.2} N though both rotors turn: {MEND}"
            ));
        } else if !(GROWTH[0]..=GROWTH[1]).contains(&growth) {
            warnings.push(format!(
                "from ({low:.2}, {low:.2}) to ({high:.2}, {high:.2}) the thrust grows from {least:.2} to {most:.2} N, with the power \
                 {growth:.2} of the throttle; real pairs have 1.5 to 1.9: {MEND}"
            ));
        }
    }
    let share = lowest.torque / torque.full_scale;
    let told = share.abs() > AT_LOWEST[0] + AT_LOWEST[1] * least.max(0.0) / thrust.full_scale;
    if told {
        warnings.push(format!(
            "at ({low:.2}, {low:.2}) the torque is {:+.4} N m, {:.0} % of the greatest, where both rotors hardly load the stand: {MEND}",
            lowest.torque,
            100.0 * share
        ));
    }
    told
}
