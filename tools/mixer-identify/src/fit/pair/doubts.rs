//! Doubts that the statistics of a fit do not show: files of different pairs, throttles that were
//! not measured, exchanged rotors.

use mixer_compiler::airframe::Basis;
use mixer_compiler::model::wake::{Wake, mean_torque};

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
    let wake = Wake::of_torque(mean);
    match wake {
        Wake::Above if !by_hand => warnings.push(format!(
            "upper and lower rotor look exchanged, or the lower one is the stronger (more pitch, KV or diameter): at equal throttles \
             the one taken as lower takes more torque (mean {percent:+.1} % of the largest), though of equal rotors the one in the wake \
             takes less; exchanged columns are mended by --swap, right ones confirmed by --column upper=HEADER --column lower=HEADER"
        )),
        Wake::Unknown if sign_is_found && !by_hand => warnings.push(format!(
            "the torque does not tell which rotor is the upper one (mean {percent:+.1} % of the largest): make sure that the columns \
             are the right way round, and say so by --column upper=HEADER --column lower=HEADER"
        )),
        Wake::Above | Wake::Below | Wake::Unknown => {}
    }
    by_hand && wake == Wake::Above
}
