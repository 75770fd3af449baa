//! The tables of an airframe file as TOML, with where they come from in comments.

use std::fmt::Write as _;

use crate::fit::Fit;
use crate::fit::pair::Pair;
use crate::fit::power::Power;
use crate::fit::voltage::{Exponent, Voltage};
use crate::identified::Identified;
use crate::wording::{alone_lines, exponent_line, least_power_lines, provenance, runs, wrapped};

/// The fragment: `[throttle]` and `[pair]` where a pair was identified, `[voltage]` where its
/// exponents are sound.
pub fn text(identified: &Identified) -> String {
    let mut out = format!("# Identified by {}.{INSTRUCTIONS}", identified.generator);
    // Writing to a String cannot fail; the result is dropped.
    let _ = write_tables(&mut out, identified);
    if let Some(bias) = identified.power_bias() {
        let _ = writeln!(out, "{BIAS}{bias:?}{BIAS_FOR}");
    }
    out
}

/// The same for a file that has the rest of an airframe.
pub fn tables(identified: &Identified) -> String {
    let mut out = format!("# Identified by {}.", identified.generator);
    let _ = write_tables(&mut out, identified);
    out
}

/// What a user does with the tables alone.
const INSTRUCTIONS: &str = " To make an airframe of it, add at the top
#   name = \"my-airframe\"
# and, for each pair of rotors, at the end
#   [[unit]]
#   position_m = [x, y, 0.0]    # forward, right, down
#   upper_spin = \"cw\"           # seen from above
#   channels = [upper, lower]   # outputs";

/// The torque of least power behind the tables, in a comment: of which airframe it is decides
/// whether it saves anything.
const BIAS: &str = "\n# power_bias_nm_per_n = ";
const BIAS_FOR: &str =
    "    # for [allocation]; cargo mixer new takes it over where upper rotors turn against each other";

/// Tables that [`text`] wrote, for a file that has the rest of an airframe, and the torque of least
/// power beside them, N m per N.
pub fn of_text(text: &str) -> (String, Option<f64>) {
    let text = text.replacen(INSTRUCTIONS, "", 1);
    let Some((before, rest)) = text.split_once(BIAS) else {
        return (text, None);
    };
    let (line, after) = rest.split_once('\n').unwrap_or((rest, ""));
    let bias = line
        .split('#')
        .next()
        .and_then(|number| number.trim().parse().ok());
    (format!("{before}{after}"), bias)
}

fn write_tables(out: &mut String, id: &Identified) -> std::fmt::Result {
    writeln!(out, "\n#\n# Data:")?;
    for file in &id.files {
        writeln!(out, "#   {}", file.file)?;
        writeln!(out, "#     {}", provenance(file))?;
    }
    for warning in &id.warnings {
        for (k, line) in wrapped(warning, 104).iter().enumerate() {
            writeln!(out, "# {} {line}", if k == 0 { "!" } else { " " })?;
        }
    }
    if let Some(pair) = &id.pair {
        write_pair(out, pair)?;
    }
    for (turning, alone) in id.pair.iter().flat_map(runs) {
        writeln!(out)?;
        for line in alone_lines(alone).iter().flat_map(|line| wrapped(line, 104)) {
            writeln!(out, "# {line}")?;
        }
        writeln!(
            out,
            "[pair.{}]\nthrust_n = {:?}\ntorque_nm = {:?}",
            turning.key(),
            alone.thrust_n,
            alone.torque_nm
        )?;
    }
    if let Some(Power::Identified(found)) = &id.power {
        writeln!(out, "\n# Least power:")?;
        for line in least_power_lines(found) {
            for line in wrapped(&line, 104) {
                writeln!(out, "#   {line}")?;
            }
        }
        match &found.power_w {
            Some(power_w) => writeln!(out, "[pair.power]\npower_w = {power_w:?}")?,
            None => writeln!(
                out,
                "#   No [pair.power]: the fit is not positive, or does not grow, over the throttles to command."
            )?,
        }
    }
    if let Some(voltage) = &id.voltage {
        write_voltage(out, voltage, id)
    } else {
        writeln!(
            out,
            "\n# No [voltage]: no file has a voltage column. The mixer takes k = 1 at any voltage."
        )?;
        to_fill_in(out, None, id.pack_v)
    }
}

fn write_pair(out: &mut String, pair: &Pair) -> std::fmt::Result {
    writeln!(out, "\n[throttle]")?;
    let fold = &pair.fold;
    let what = if fold.folds {
        "folds"
    } else {
        "is not proven injective"
    };
    if let (false, Some(idle)) = (fold.injective, fold.least_idle) {
        writeln!(out, "# The map {what} below an idle of {idle:.4}.")?;
    }
    writeln!(out, "min = {:?}", pair.throttle.min)?;
    writeln!(out, "max = {:?}", pair.throttle.max)?;

    writeln!(out)?;
    if pair.outliers_left_out {
        for o in &pair.outliers {
            writeln!(out, "# left out, as it stands out: {}:{}", o.file, o.line)?;
        }
    }
    for (name, unit, fit) in [("thrust", "N", &pair.thrust), ("torque", "N m", &pair.torque)] {
        let percent = |x: f64| 100.0 * x / fit.full_scale;
        writeln!(
            out,
            "# {name}: R2 {:.2} %, residual {:.3e} {unit} rms, {:.3e} at most\n\
             #   leave-one-out {:.3e} {unit} rms, {:.2} % of the greatest value",
            100.0 * fit.r2,
            fit.residual_rms,
            fit.residual_max,
            fit.leave_one_out_rms,
            percent(fit.leave_one_out_rms)
        )?;
    }
    writeln!(
        out,
        "# {} points, condition number {:.0}; behind each coefficient its 95 % interval",
        pair.thrust.points, pair.thrust.condition_number
    )?;
    writeln!(
        out,
        "# Torque is positive where the lower rotor outweighs the upper, which is clockwise on the"
    )?;
    writeln!(
        out,
        "# airframe for an upper rotor that turns clockwise, and the mirror image for the other."
    )?;
    writeln!(out, "[pair]\nbasis = \"{}\"", pair.basis.name())?;
    coefficients(out, "thrust_n", &pair.terms, &pair.thrust)?;
    coefficients(out, "torque_nm", &pair.terms, &pair.torque)?;
    writeln!(out, "upper_spin = \"{}\"", pair.upper_spin)?;
    match &pair.uncertainty {
        Some(uncertainty) => write!(
            out,
            "\n# The error on throttle levels that were left out.\n{uncertainty}"
        ),
        None => Ok(()),
    }
}

fn coefficients(out: &mut String, key: &str, terms: &[String], fit: &Fit) -> std::fmt::Result {
    writeln!(out, "{key} = [")?;
    for ((c, ci), term) in fit.coefficients.iter().zip(&fit.ci95).zip(terms) {
        writeln!(out, "    {:<18}  # {term:<4} +- {ci:.3e}", format!("{c:?},"))?;
    }
    writeln!(out, "]")
}

/// `[voltage]`. Beside a pair it must be complete, or `check` would refuse the airframe: with one
/// exponent only, or without the voltage of the map, it is written as a comment, for the user to
/// complete.
fn write_voltage(out: &mut String, voltage: &Voltage, id: &Identified) -> std::fmt::Result {
    let (reference, beside_pair) = (id.reference_v, id.pair.is_some());
    // Outwards to hundredths, and around the reference.
    let [low, high] = id.pack_v.unwrap_or(voltage.range_v);
    let low = (100.0 * reference.map_or(low, |v| v.min(low))).floor() / 100.0;
    let high = (100.0 * reference.map_or(high, |v| v.max(high))).ceil() / 100.0;
    let at = reference.map_or("?".to_string(), |v| format!("{v:?}"));
    writeln!(out)?;
    let (thrust, torque) = (voltage.thrust.value(), voltage.torque.value());
    if thrust.is_none() && torque.is_none() {
        writeln!(
            out,
            "# No [voltage]: these files give no exponents, so that the mixer takes k = 1 at any voltage."
        )?;
        writeln!(
            out,
            "# The map holds at about {at} V (rows from {low:.2} to {high:.2} V)."
        )?;
    }
    for (name, exponent) in voltage.channels() {
        let told = match exponent {
            Exponent::Identified(e) => exponent_line(e),
            Exponent::Refused { reason, .. } => format!("no exponent: {reason}"),
            Exponent::Declared { exponent, .. } => {
                format!("exponent {exponent}, declared by --voltage-exponent")
            }
            Exponent::NotMeasured => {
                "not measured, no file has its column. Thrust and torque both follow the square of rotor speed, so \
                 that the other's exponent is the usual stand-in; it is for you to decide."
                    .to_string()
            }
        };
        for (k, line) in wrapped(&format!("{name}: {told}"), 104).iter().enumerate() {
            writeln!(out, "# {}{line}", if k == 0 { "" } else { "  " })?;
        }
    }
    if thrust.is_none() && torque.is_none() {
        return to_fill_in(out, reference, id.pack_v);
    }
    writeln!(
        out,
        "# The voltage of the flight must be measured where the bench's was: at the same point of the wiring, under\n\
         # load. Behind other leads, or at no load, k is wrong by what the voltage drops in between."
    )?;
    let complete = thrust.is_some() && torque.is_some() && reference.is_some();
    let mark = if beside_pair && !complete { "# " } else { "" };
    writeln!(
        out,
        "{mark}[voltage]\n{mark}reference_v = {at}\n{mark}range_v = [{low:?}, {high:?}]"
    )?;
    for (name, exponent) in [("thrust", thrust), ("torque", torque)] {
        match exponent {
            Some(e) => writeln!(out, "{mark}{name}_exponent = {:?}", thousandths(e))?,
            None => writeln!(out, "# {name}_exponent = ?")?,
        }
    }
    Ok(())
}

/// `[voltage]` in comments, where the files do not give it.
fn to_fill_in(out: &mut String, reference: Option<f64>, pack_v: Option<[f64; 2]>) -> std::fmt::Result {
    let reference = reference.map_or("?".to_owned(), |volts| format!("{volts:?}"));
    let range = pack_v.map_or("[?, ?]".to_owned(), |range| format!("{range:?}"));
    writeln!(
        out,
        "# To follow the battery, fill in what is open and uncomment; 1.75 is the median of 104 motors with propellers:"
    )?;
    for (line, comment) in [
        ("[voltage]".to_owned(), ""),
        (
            format!("reference_v = {reference}"),
            "supply of the bench, under load",
        ),
        (
            format!("range_v = {range}"),
            "pack in flight, empty and full: 3.2 and 4.2 V a LiPo cell",
        ),
        ("thrust_exponent = 1.75".to_owned(), ""),
        ("torque_exponent = 1.75".to_owned(), ""),
    ] {
        let line = if comment.is_empty() {
            line
        } else {
            format!("{line:<34} # {comment}")
        };
        writeln!(out, "# {line}")?;
    }
    Ok(())
}

fn thousandths(x: f64) -> f64 {
    (1000.0 * x).round() / 1000.0
}
