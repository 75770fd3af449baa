//! The report on standard output, at most 100 columns wide.

use std::fmt::Write as _;

use crate::bench::Bench;
use crate::fit::Fit;
use crate::fit::cross::Candidate;
use crate::fit::fold::Fold;
use crate::fit::pair::Pair;
use crate::fit::power::Power;
use crate::fit::voltage::{Exponent, Voltage};
use crate::identified::Identified;
use crate::wording::{alone_lines, exponent_line, least_power_lines, provenance, runs, wrapped};

/// The whole report.
pub fn text(identified: &Identified) -> String {
    let mut out = String::new();
    // Writing to a String cannot fail; the results are dropped.
    let _ = write_report(&mut out, identified);
    out
}

fn write_report(out: &mut String, id: &Identified) -> std::fmt::Result {
    writeln!(out, "Data")?;
    for file in &id.files {
        write_file(out, file)?;
    }
    if let Some(pair) = &id.pair {
        write_pair(out, pair)?;
    }
    for (turning, alone) in id.pair.iter().flat_map(runs) {
        writeln!(out, "\nAlone: [pair.{}]", turning.key())?;
        for line in alone_lines(alone) {
            paragraph(out, "  ", &line)?;
        }
    }
    if let Some(voltage) = &id.voltage {
        write_voltage(out, voltage)?;
    }
    if let Some(power) = &id.power {
        write_power(out, power)?;
    }
    if !id.warnings.is_empty() {
        writeln!(out, "\nTo know")?;
        for warning in &id.warnings {
            paragraph(out, "  * ", warning)?;
        }
    }
    Ok(())
}

fn write_file(out: &mut String, file: &Bench) -> std::fmt::Result {
    paragraph(out, "  ", &file.file)?;
    paragraph(out, "    ", &provenance(file))?;
    let signs = |signs: &[f64]| {
        signs
            .iter()
            .map(|s| if *s < 0.0 { "-" } else { "+" })
            .collect::<Vec<_>>()
            .join(",")
    };
    let s = &file.signs;
    let mut line = format!("signs applied: thrust {} ({})", signs(&s.thrust), s.thrust_policy);
    if !s.torque.is_empty() {
        let _ = write!(line, ", torque {} ({})", signs(&s.torque), s.torque_policy);
    }
    paragraph(out, "    ", &line)?;
    for note in &file.notes {
        paragraph(out, "    ", note)?;
    }
    Ok(())
}

fn write_voltage(out: &mut String, v: &Voltage) -> std::fmt::Result {
    writeln!(
        out,
        "\nVoltage  {:.2} to {:.2} V, mean {:.2} V",
        v.range_v[0], v.range_v[1], v.mean_v
    )?;
    for (name, exponent) in v.channels() {
        match exponent {
            Exponent::Identified(e) => {
                paragraph(out, "  ", &format!("{name}: {}", exponent_line(e)))?;
                if let Some([low, high]) = e.low_and_high_throttle {
                    paragraph(
                        out,
                        "    ",
                        &format!("median {low:.2} in the lower half of the throttle range, {high:.2} above"),
                    )?;
                }
            }
            Exponent::Refused { reason, needed } => {
                paragraph(out, "  ", &format!("{name}: no exponent: {reason}"))?;
                paragraph(out, "    ", &format!("needed: {needed}"))?;
            }
            Exponent::Declared { exponent, .. } => {
                writeln!(
                    out,
                    "  {name}: exponent {exponent}, declared by --voltage-exponent"
                )?;
            }
            Exponent::NotMeasured => writeln!(out, "  {name}: not measured")?,
        }
    }
    Ok(())
}

fn write_power(out: &mut String, power: &Power) -> std::fmt::Result {
    writeln!(out, "\nLeast power")?;
    match power {
        Power::Refused { reason } => paragraph(out, "  ", &format!("none: {reason}")),
        Power::Identified(found) => {
            for line in least_power_lines(found) {
                paragraph(out, "  ", &line)?;
            }
            Ok(())
        }
    }
}

/// Wraps text to 100 columns behind an indentation.
fn paragraph(out: &mut String, indent: &str, text: &str) -> std::fmt::Result {
    let blank = " ".repeat(indent.len());
    for (k, line) in wrapped(text, 100 - indent.len()).iter().enumerate() {
        writeln!(out, "{}{line}", if k == 0 { indent } else { &blank })?;
    }
    Ok(())
}

fn write_pair(out: &mut String, pair: &Pair) -> std::fmt::Result {
    write_cross_validation(out, &pair.cross_validation)?;
    write_coefficients(out, pair)?;
    write_statistics(out, pair)?;
    write_outliers(out, pair)?;
    write_fold(out, &pair.fold)?;
    writeln!(out, "  throttle {} .. {}", pair.throttle.min, pair.throttle.max)
}

fn write_cross_validation(out: &mut String, candidates: &[Candidate]) -> std::fmt::Result {
    writeln!(out, "\nBasis: error in cross-validation, % of full scale")?;
    writeln!(
        out,
        "                        leave one point out    leave one throttle level out   least"
    )?;
    writeln!(
        out,
        "               terms    thrust    torque       thrust    torque     idle"
    )?;
    for candidate in candidates {
        write_candidate(out, candidate)?;
    }
    Ok(())
}

fn write_coefficients(out: &mut String, pair: &Pair) -> std::fmt::Result {
    writeln!(out, "\nModel: {}", pair.basis.name())?;
    writeln!(out, "           thrust, N                            torque, N m")?;
    writeln!(
        out,
        "           estimate      +- 95 %                estimate      +- 95 %"
    )?;
    for (k, term) in pair.terms.iter().enumerate() {
        let cell = |f: &Fit| format!("{:>12.5} {:>12.5}", f.coefficients[k], f.ci95[k]);
        writeln!(
            out,
            "  {term:<6} {}            {}",
            cell(&pair.thrust),
            cell(&pair.torque)
        )?;
    }
    Ok(())
}

fn write_statistics(out: &mut String, pair: &Pair) -> std::fmt::Result {
    writeln!(out)?;
    let both = |of: fn(&Fit) -> f64| (of(&pair.thrust), of(&pair.torque));
    let si = ["N", "N m"];
    let rows = [
        ("R2", both(|f| f.r2), ["", ""]),
        ("residual rms", both(|f| f.residual_rms), si),
        ("residual maximum", both(|f| f.residual_max), si),
        ("leave-one-out rms", both(|f| f.leave_one_out_rms), si),
        (
            "  of full scale",
            both(|f| 100.0 * f.leave_one_out_rms / f.full_scale),
            ["%", "%"],
        ),
        ("full scale", both(|f| f.full_scale), si),
        ("prediction +- least", both(|f| f.prediction.least), si),
        ("prediction +- greatest", both(|f| f.prediction.greatest), si),
    ];
    for (name, (thrust, torque), [of_thrust, of_torque]) in rows {
        let line = format!("  {name:<24}{thrust:>12.5} {of_thrust:<3}{torque:>16.5} {of_torque}");
        writeln!(out, "{}", line.trim_end())?;
    }
    let [u, l] = pair.thrust.prediction.greatest_at;
    writeln!(
        out,
        "  {} points, {} degrees of freedom, condition number {:.1}; prediction widest at ({u:.2}, {l:.2})",
        pair.thrust.points, pair.thrust.degrees_of_freedom, pair.thrust.condition_number
    )?;
    for (name, fit) in [("thrust", &pair.thrust), ("torque", &pair.torque)] {
        let terms = fit.coefficients.iter().zip(&fit.ci95);
        let weak = terms.filter(|(c, ci)| c.abs() < **ci).count();
        if weak > 0 {
            writeln!(
                out,
                "  {weak} of {} {name} coefficients are smaller than their interval: trust the map, not its single terms",
                fit.coefficients.len()
            )?;
        }
    }
    if let Some(v) = pair.normalised_to_v {
        writeln!(out, "  all points brought to {v} V by the exponents below")?;
    }
    Ok(())
}

fn write_outliers(out: &mut String, pair: &Pair) -> std::fmt::Result {
    writeln!(
        out,
        "\nRows that stand out: {}",
        if pair.outliers.is_empty() { "none" } else { "" }
    )?;
    for o in &pair.outliers {
        paragraph(out, "  ", &format!("{}:{}", o.file, o.line))?;
        writeln!(
            out,
            "    at ({:.3}, {:.3}): thrust {:+.3} N ({:+.0} sigma), torque {:+.4} N m ({:+.0} sigma){}",
            o.u,
            o.l,
            o.thrust_residual,
            o.thrust_deviations,
            o.torque_residual,
            o.torque_deviations,
            if pair.outliers_left_out { ", left out" } else { "" }
        )?;
    }
    Ok(())
}

fn write_fold(out: &mut String, fold: &Fold) -> std::fmt::Result {
    let [u, l] = fold.least_det_at;
    writeln!(
        out,
        "\nFold in the box {} .. {}",
        fold.commanded.min, fold.commanded.max
    )?;
    if !fold.folds {
        writeln!(
            out,
            "  none: det J > 0 is proven; least {:.4} at ({u:.3}, {l:.3})",
            fold.least_det
        )?;
    }
    if !fold.injective {
        if !fold.folds {
            writeln!(
                out,
                "  but the map could not be proven injective: two commands may give one effort"
            )?;
        }
        for region in &fold.regions {
            let ([ua, ub], [la, lb], [u, l]) = (region.u, region.l, region.least_det_at);
            writeln!(
                out,
                "  det J <= 0 within u {ua:.3} .. {ub:.3}, l {la:.3} .. {lb:.3}; least {:.4} at ({u:.3}, {l:.3})",
                region.least_det
            )?;
        }
        match fold.least_idle {
            Some(idle) => writeln!(out, "  least idle without fold: {idle:.4}")?,
            None => writeln!(out, "  no idle up to 0.9 of the range is without fold")?,
        }
    }
    Ok(())
}

fn write_candidate(out: &mut String, c: &Candidate) -> std::fmt::Result {
    let name = c.basis.name();
    match (&c.errors, &c.refused) {
        (Some(e), _) => writeln!(
            out,
            "  {name:<12} {:>4}    {:>7.2}   {:>7.2}      {:>7.2}   {:>7.2}    {:>7}{}",
            c.terms,
            e.thrust_leave_one_out,
            e.torque_leave_one_out,
            e.thrust_leave_level_out,
            e.torque_leave_level_out,
            c.least_idle.map_or("none".into(), |idle| format!("{idle:.3}")),
            if c.chosen { "   <- chosen" } else { "" }
        ),
        (None, reason) => {
            let chosen = if c.chosen { " <- chosen" } else { "" };
            let reason = reason.as_deref().unwrap_or_default();
            paragraph(
                out,
                &format!("  {name:<12} {:>4}    ", c.terms),
                &format!("{reason}{chosen}"),
            )
        }
    }
}
