//! Lines that the report and the comments of the tables share.

use std::fmt::Write as _;

use crate::bench::{Bench, Kind};
use crate::fit::pair::Pair;
use crate::fit::power::LeastPower;
use crate::fit::voltage::Estimate;
use crate::rotor::{Alone, AloneFit, Turning};

/// One line on a file: format, date, rows.
pub fn provenance(file: &Bench) -> String {
    let date = file.date.as_deref().unwrap_or("date unknown");
    let kind = if file.kind == Kind::Pair {
        ""
    } else {
        ", single rotor"
    };
    let mut line = format!(
        "{}{kind}, {date}: {} of {} rows used",
        file.format,
        used_rows(file),
        file.rows
    );
    if file.start_stop_rows > 0 {
        let _ = write!(line, ", {} start and stop rows dropped", file.start_stop_rows);
    }
    if file.streaming {
        let _ = write!(
            line,
            ", {} settling, {} plateaus",
            file.settling_rows, file.points_used
        );
    }
    if !file.refused_rows.is_empty() {
        let _ = write!(line, ", {} refused", file.refused_rows.len());
    }
    line
}

fn used_rows(file: &Bench) -> usize {
    file.rows
        .saturating_sub(file.start_stop_rows + file.settling_rows + file.refused_rows.len())
}

/// The rotors of a pair that were run alone.
pub fn runs(pair: &Pair) -> impl Iterator<Item = (Turning, &Alone)> {
    let both = [
        (Turning::Upper, &pair.lower_out),
        (Turning::Lower, &pair.upper_out),
    ];
    both.into_iter()
        .filter_map(|(turning, alone)| Some((turning, alone.as_ref()?)))
}

/// Lines about a rotor alone.
pub fn alone_lines(alone: &Alone) -> Vec<String> {
    let channel = |name: &str, unit: &str, coefficients: [f64; 3], fit: &AloneFit| {
        let percent = |x: f64| 100.0 * x / fit.full_scale;
        let [a1, a2, a3] = coefficients;
        format!(
            "{name} {a1:.5} x {a2:+.5} x2 {a3:+.5} x3 {unit}: leave-one-out {:.2} % of {:.4} {unit}; the pair's polynomial at \
             zero misses this run by {:.2} %",
            percent(fit.leave_one_out_rms),
            fit.full_scale,
            percent(fit.of_the_pair_rms)
        )
    };
    let other = alone.other_at.map_or(String::new(), |level| {
        format!(
            ", of a map in which the other rotor turned at {level:.2}: taken off by the pair's polynomials"
        )
    });
    vec![
        format!(
            "{}: {} points, throttle {:.2} to {:.2}{other}",
            alone.file, alone.points, alone.measured[0], alone.measured[1]
        ),
        channel("thrust", "N", alone.thrust_n, &alone.thrust),
        channel("torque", "N m", alone.torque_nm, &alone.torque),
    ]
}

/// Lines about the torque of least power.
pub fn least_power_lines(found: &LeastPower) -> Vec<String> {
    let middle = found.at[found.at.len() / 2];
    vec![
        format!(
            "Q = c f with c = {:?} N m per N takes {:.1} % less electrical power than Q = 0, in the mean over 0.3 to 0.7 of \
             full thrust: {:.1} for {:.1} W at {:.2} N",
            found.bias_nm_per_n, found.saving_percent, middle.least_power_w, middle.power_w, middle.thrust_n
        ),
        format!(
            "that is {:.1} % of flight time where as many upper rotors turn one way as the other; with spins s of n units \
             1 - (sum s / n)^2 of it is left, none where all turn alike (a Y6)",
            100.0 * (1.0 / (1.0 - 0.01 * found.saving_percent) - 1.0)
        ),
        format!(
            "in an airframe file: power_bias_nm_per_n = {:?} under [allocation]",
            found.bias_nm_per_n
        ),
        format!(
            "power map of {} rows: residual {:.2} W rms, {:.2} % of the greatest power",
            found.points,
            found.residual_rms_w,
            100.0 * found.residual_rms_w / found.full_scale_w
        ),
    ]
}

/// One line on an exponent.
pub fn exponent_line(e: &Estimate) -> String {
    let mut line = format!(
        "exponent {:.3} +- {:.3} (95 %), by {}",
        e.exponent, e.ci95, e.method
    );
    if e.levels > 0 {
        let _ = write!(line, ", {} levels", e.levels);
    }
    if let Some([low, median, high]) = e.quartiles {
        let _ = write!(
            line,
            "; levels' median {median:.2}, quartiles {low:.2} and {high:.2}"
        );
    }
    line
}

/// Units that stay with their number, and the `m` of N m with its N.
const UNITS: [&str; 10] = ["%", "N", "m", "V", "W", "A", "g", "kg", "mm", "degrees"];

/// The words of a text, a number and its unit as one.
fn words(text: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let bare = word.trim_end_matches([',', ';', '.', ':', ')']);
        match words.last_mut() {
            Some(last)
                if UNITS.contains(&bare) && last.ends_with(|c: char| c.is_ascii_digit() || c == 'N') =>
            {
                last.push(' ');
                last.push_str(word);
            }
            _ => words.push(word.to_owned()),
        }
    }
    words
}

/// Breaks text at blanks into lines of at most `width` characters. A unit stays with its number.
pub fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in words(text) {
        let line = lines.len() - 1;
        if !lines[line].is_empty() && lines[line].chars().count() + 1 + word.chars().count() > width {
            lines.push(word);
        } else {
            if !lines[line].is_empty() {
                lines[line].push(' ');
            }
            lines[line].push_str(&word);
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::wrapped;

    #[test]
    fn a_unit_stays_with_its_number() {
        let lines = wrapped("thrust of 12.5 N, 0.2 N m at 3 % or more", 12);
        assert_eq!(lines, ["thrust of", "12.5 N,", "0.2 N m at", "3 % or more"]);
    }
}
