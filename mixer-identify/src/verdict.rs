//! The verdict on what was identified: at most [`MOST_LINES`] lines of 100 columns, for a reader
//! who wants to know whether the map serves. [`report`](crate::report) has every number.

use crate::fit::Fit;
use crate::fit::pair::Pair;
use crate::fit::polynomial::Polynomial;
use crate::fit::power::Power;
use crate::fit::voltage::{Exponent, Voltage};
use crate::identified::Identified;
use crate::wording::{provenance, runs, wrapped};

/// Lines of a verdict, at most; the command adds what it wrote and what comes next.
pub const MOST_LINES: usize = 27;

/// Files that are named one by one.
const MOST_FILES: usize = 4;

/// Column at which the text of a line begins.
const INDENT: usize = 16;

/// Columns of a line.
const WIDTH: usize = 100;

/// The verdict.
pub fn text(identified: &Identified) -> String {
    let mut lines = Lines::default();
    for file in identified.files.iter().take(MOST_FILES) {
        lines.add("read", &format!("{}: {}", file.file, provenance(file)));
    }
    let more = identified.files.len().saturating_sub(MOST_FILES);
    if more > 0 {
        lines.add("", &format!("and {more} files more"));
    }
    if let Some(pair) = &identified.pair {
        of_pair(&mut lines, pair);
    }
    if let Some(voltage) = &identified.voltage {
        lines.add("voltage", &of_voltage(voltage));
    } else {
        lines.add("voltage", "not corrected for: no file has a voltage column");
    }
    match &identified.power {
        Some(Power::Identified(found)) => lines.add(
            "least power",
            &format!(
                "Q = c f with c = {} N m per N takes {:.1} % less than Q = 0 at 0.3 to 0.7 of full thrust",
                found.bias_nm_per_n, found.saving_percent
            ),
        ),
        Some(Power::Refused { reason }) => lines.add("least power", &format!("none: {reason}")),
        None => {}
    }
    let notes = identified.files.iter().flat_map(|file| &file.notes);
    let warnings: Vec<&String> = identified.warnings.iter().chain(notes).collect();
    lines.warnings(&warnings);
    lines.0.join("\n")
}

/// Lines of the text.
#[derive(Default)]
struct Lines(Vec<String>);

impl Lines {
    /// A name and what there is to say of it.
    fn add(&mut self, name: &str, text: &str) {
        for (k, line) in wrapped(text, WIDTH - INDENT).iter().enumerate() {
            let name = if k == 0 { name } else { "" };
            self.0.push(format!("{name:<INDENT$}{line}"));
        }
    }

    /// As many of the warnings as there is room for.
    fn warnings(&mut self, warnings: &[&String]) {
        match warnings.len() {
            0 => self.add("warnings", "none"),
            count => self.add("warnings", &count.to_string()),
        }
        for (k, warning) in warnings.iter().enumerate() {
            let lines = wrapped(warning, WIDTH - 4);
            // One line for how many are left.
            if self.0.len() + lines.len() + 1 > MOST_LINES {
                self.0
                    .push(format!("  and {} more: --verbose", warnings.len() - k));
                return;
            }
            for (k, line) in lines.iter().enumerate() {
                self.0
                    .push(format!("  {} {line}", if k == 0 { "*" } else { " " }));
            }
        }
    }
}

fn of_pair(lines: &mut Lines, pair: &Pair) {
    let [thrust, torque] =
        [&pair.thrust_n, &pair.torque_nm].map(|coefficients| Polynomial::of(pair.basis, coefficients));
    let (min, max) = (pair.throttle.min, pair.throttle.max);
    let [floor, full] = [min, max].map(|t| thrust.at(t, t));
    lines.add(
        "thrust",
        &format!(
            "{floor:.1} to {full:.1} N of one pair; torque {:+.3} N m to {:+.3} N m",
            torque.at(max, min),
            torque.at(min, max)
        ),
    );
    let fold = &pair.fold;
    let least = match fold.least_idle {
        _ if fold.injective => "the map has no fold".to_owned(),
        Some(least) => format!("the map folds below {least:.3}"),
        None => "the map folds".to_owned(),
    };
    lines.add(
        "throttle",
        &format!(
            "{min} to {max}; at idle {:.1} % of the largest thrust; {least}",
            100.0 * floor / full
        ),
    );
    let share = |fit: &Fit, x: f64| 100.0 * x / fit.full_scale;
    let errors = match &pair.uncertainty {
        Some(levels) => format!(
            "{} % of the largest thrust and {} % of the largest torque at throttles left out",
            levels.thrust_percent, levels.torque_percent
        ),
        None => format!(
            "{:.1} % of the largest thrust and {:.1} % of the largest torque at rows left out",
            share(&pair.thrust, pair.thrust.leave_one_out_rms),
            share(&pair.torque, pair.torque.leave_one_out_rms)
        ),
    };
    lines.add("model error", &format!("{errors}; {} basis", pair.basis.name()));
    lines.add(
        "worst row",
        &format!(
            "{:.2} N ({:.1} %) and {:.4} N m ({:.1} %) off; {}",
            pair.thrust.residual_max,
            share(&pair.thrust, pair.thrust.residual_max),
            pair.torque.residual_max,
            share(&pair.torque, pair.torque.residual_max),
            match (pair.outliers.len(), pair.outliers_left_out) {
                (0, _) => "no row stands out".to_owned(),
                (count, true) => format!("{count} rows stand out and are left out"),
                (count, false) => format!("{count} rows stand out"),
            }
        ),
    );
    let alone: Vec<String> = runs(pair)
        .map(|(turning, alone)| format!("[pair.{}] from {}", turning.key(), alone.file))
        .collect();
    lines.add(
        "rotor out",
        &match alone.is_empty() {
            true => {
                "by the map, extrapolated to a throttle of 0 (--lower-out, --upper-out take runs)".to_owned()
            }
            false => alone.join(", "),
        },
    );
}

fn of_voltage(voltage: &Voltage) -> String {
    let exponent = |exponent: &Exponent| match exponent {
        Exponent::Identified(e) => format!("exponent {:.2} +- {:.2}", e.exponent, e.ci95),
        Exponent::Declared { exponent, .. } => format!("exponent {exponent} as declared"),
        // Where voltages differ, a warning has the reason and what is needed.
        Exponent::Refused { .. } if voltage.varies() => "not corrected for: no exponent".to_owned(),
        Exponent::Refused { reason, .. } => format!("not corrected for: {reason}"),
        Exponent::NotMeasured => "not measured".to_owned(),
    };
    let channels = voltage.channels();
    let told: Vec<String> = channels
        .iter()
        .map(|(name, found)| match channels.len() {
            1 => exponent(found),
            _ => format!("{name} {}", exponent(found)),
        })
        .collect();
    told.join("; ")
}
