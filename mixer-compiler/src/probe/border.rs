//! Probes of the border of the closed form, which wrenches alone reach only here and there.

use mixer_rt::tables::ClosedForm;

use crate::compiled::Compiled;

/// Border points per edge of the throttle box.
const SAMPLES: usize = 256;

/// Thrusts at which the sides are probed.
const SECTIONS: usize = 192;

/// Share of a unit's largest effort by which efforts on the border may be missed, beside the tolerance.
/// Where the set bends inwards chords are outside by a little, most on maps next to their fold.
const BORDER: f64 = 2e-3;

/// Share of the attainable set's area by which a description may be smaller than stated.
const AREA: f64 = 5e-3;

/// Points on the sides are attainable, and between them is the area that is stated.
pub(super) fn check(compiled: &Compiled) -> Result<(), String> {
    let (Some(table), Ok(lost)) = (&compiled.tables.closed_form, compiled.lost_outside_border) else {
        return Ok(());
    };
    let (scale, area) = (
        compiled.maps[0].scale(),
        twice_area(&compiled.maps[0].scaled_border(SAMPLES)),
    );
    let ClosedForm {
        border,
        thrust_n: [least, most],
        ..
    } = table.view();
    let step = (most - least) / SECTIONS as f32;
    let mut between = 0.0;
    for k in 0..SECTIONS {
        let f = least + (k as f32 + 0.5) * step;
        let [middle, half] = border.torques(f);
        // Where the set is a point but for rounding, there is nothing to give.
        if half > 0.0 {
            check_attained(compiled, scale, [f, middle + half], "upper side")?;
            check_attained(compiled, scale, [f, middle - half], "lower side")?;
            between += 2.0 * f64::from(half) * f64::from(step);
        }
    }
    // `area` is twice that of the set, in shares of the scales.
    let covered = 2.0 * between / (scale[0] * scale[1] * area);
    if covered >= 1.0 - lost - AREA {
        return Ok(());
    }
    Err(format!(
        "the emitted sides lose {:.2} % of the attainable set's area, {:.2} % is stated",
        100.0 * (1.0 - covered),
        100.0 * lost
    ))
}

/// The efforts are attained by the emitted inverse; else the words for what they are of.
fn check_attained(compiled: &Compiled, scale: [f64; 2], efforts: [f32; 2], of: &str) -> Result<(), String> {
    let tables = &compiled.tables;
    let throttles = tables.throttles(0, efforts).unwrap_or_default();
    let given = compiled.maps[0].efforts(throttles.map(f64::from));
    for k in 0..2 {
        let missed = (given[k] - f64::from(efforts[k])).abs();
        let is_near = missed <= 2.0 * f64::from(tables.tolerance.efforts[k]) + BORDER * scale[k];
        if !is_near {
            return Err(format!(
                "the emitted {of} is not attainable: f {:.4} N, Q {:.5} N m gives f {:.4} N, Q {:.5} N m",
                efforts[0], efforts[1], given[0], given[1]
            ));
        }
    }
    Ok(())
}

/// Twice the area within a closed border of an even number of points per edge. Chords of a smooth
/// border lose the square of their length: that of every other point tells how much (Richardson).
fn twice_area(border: &[[f64; 2]]) -> f64 {
    let shoelace = |points: &[[f64; 2]]| -> f64 {
        let next = points.iter().cycle().skip(1);
        let parts = points.iter().zip(next);
        parts.map(|([f0, q0], [f1, q1])| f0 * q1 - f1 * q0).sum()
    };
    let every_other: Vec<[f64; 2]> = border.iter().copied().step_by(2).collect();
    let (fine, coarse) = (shoelace(border), shoelace(&every_other));
    fine + (fine - coarse) / 3.0
}
