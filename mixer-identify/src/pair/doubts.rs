//! Doubts that the statistics of a fit do not show: files of different pairs, throttles that were
//! not measured, a costly constraint.

use super::placed::Placed;
use crate::basis::ThrottleBox;
use crate::fit::Fit;
use crate::monotone::MonotoneCost;

/// Full throttle, but for what pulse widths are rounded to.
const FULL: f64 = 0.995;

/// What files differ by that each fits well, rms about their common map, as a share of the greatest
/// thrust. Repeats on another day differ by 0.004 to 0.008 so, real pairs of one propeller at other
/// spacings or with another motor by as much.
const APART: f64 = 0.01;

/// Cost of the shape constraint in torque, as a share of the greatest torque.
const COSTLY: f64 = 0.05;

/// Throttles below and above those that were measured.
pub(super) fn coverage(throttle: ThrottleBox, warnings: &mut Vec<String>) {
    if throttle.max < FULL {
        warnings.push(format!(
            "throttle.max is {}: what is above is never commanded; measure up to full throttle",
            throttle.max
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
    if between <= APART * full_scale {
        return;
    }
    warnings.push(format!(
        "the files differ from their common map by {between:.3} N rms, {:.1} % of the greatest thrust, beyond what each \
         misses by itself: files of one pair at one spacing belong into one fit ({})",
        100.0 * between / full_scale,
        files.join(", ")
    ));
}

/// The cost in torque of det J > 0, and where: the row that it moves furthest from what was
/// measured.
pub(super) fn costly_constraint(
    cost: &MonotoneCost,
    points: &[Placed],
    torque: &Fit,
    warnings: &mut Vec<String>,
) {
    let furthest = points
        .iter()
        .zip(&torque.residuals)
        .max_by(|(_, a), (_, b)| a.abs().total_cmp(&b.abs()));
    let Some((at, residual)) = furthest else { return };
    if residual.abs() <= COSTLY * torque.full_scale {
        return;
    }
    warnings.push(format!(
        "--monotone misses the torque by {:.3} N m at (u, l) = ({:.2}, {:.2}), {:.0} % of the greatest; its rms is \
         {:.2} times that of the free fit",
        residual.abs(),
        at.point.u,
        at.point.l,
        100.0 * residual.abs() / torque.full_scale,
        torque.residual_rms / cost.free_torque_rms
    ));
}
