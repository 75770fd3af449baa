//! The report on standard output, at most 100 columns wide: statements, and what the user should know.

use mixer_compiler::diagnostic::{hanging, wrapped};

use super::fit::Fit;
use super::fit::cross::Candidate;
use super::fit::pair::Pair;
use super::identified::Identified;
use super::lag::RotorLag;
use super::rotor::predict::Predicted;
use super::statement::{Detail, Statement, of_identified, of_predicted};

/// Lines of the short report, at most; the command adds what it wrote and what comes next.
pub const MOST_LINES: usize = 27;

/// Column at which the text of a statement begins.
const INDENT: usize = 16;

/// Columns of a line.
const WIDTH: usize = 100;

/// What serves to judge a map, in at most [`MOST_LINES`] lines.
pub fn verdict(identified: &Identified) -> String {
    let statements = of_identified(identified);
    let mut lines = statements_in_lines(
        statements
            .iter()
            .filter(|statement| statement.detail != Detail::Long),
    );
    warnings(&mut lines, &doubts(identified), MOST_LINES);
    lines.join("\n")
}

/// Every number.
pub fn text(identified: &Identified) -> String {
    let mut lines = statements_in_lines(&of_identified(identified));
    if let Some(pair) = &identified.pair {
        bases(&mut lines, &pair.cross_validation);
        coefficients(&mut lines, pair);
    }
    warnings(&mut lines, &doubts(identified), usize::MAX);
    lines.join("\n") + "\n"
}

/// What was predicted, from what, how far to trust it.
pub fn of_prediction(predicted: &Predicted) -> String {
    let mut lines = vec!["Predicted from ONE rotor alone, not measured".to_owned()];
    lines.extend(statements_in_lines(&of_predicted(predicted)));
    let told: Vec<&str> = predicted.warnings.iter().map(String::as_str).collect();
    warnings(&mut lines, &told, usize::MAX);
    lines.join("\n") + "\n"
}

/// How a rotor follows, and the lines of the airframe file.
pub fn of_lag(found: &RotorLag) -> String {
    let seconds = |s: f64| format!("{s:.4}");
    let [low, high] = found.interval_s.map(seconds);
    let [up, down] = found.up_down_s;
    let lag = seconds(found.lag_s);
    let [ups, downs] = found.steps;
    let measured = if found.by_speed { "speeds" } else { "thrusts" };
    let brakes = match found.brakes {
        Some(true) => "brakes",
        Some(false) => "does not brake: rotors coast where they are to turn slower",
        None => "the steps down are too small to tell whether it brakes: let the throttle fall by a third",
    };
    let told = [
        (
            "read",
            format!(
                "{}: {ups} steps up and {downs} down, {measured}",
                found.files.join(", ")
            ),
        ),
        (
            "lag",
            format!(
                "{lag} s at throttle {}; 95 % interval {low} to {high} s",
                found.throttle
            ),
        ),
        ("up, down", format!("{} s, {} s", seconds(up), seconds(down))),
        ("controller", brakes.to_owned()),
    ];
    let mut lines: Vec<String> = told
        .into_iter()
        .map(|(name, text)| format!("{name:<INDENT$}{text}"))
        .collect();
    let slow = found.brakes != Some(false) && down > SLOW_DOWN * up;
    let slow = slow.then(|| {
        format!(
            "the way down takes {:.1} times the way up: look whether the controller brakes",
            down / up
        )
    });
    warnings(
        &mut lines,
        &slow.as_deref().into_iter().collect::<Vec<_>>(),
        MOST_LINES,
    );
    let coasts = if found.brakes == Some(false) {
        "rotor_brakes = false\n"
    } else {
        ""
    };
    lines.join("\n") + &format!("\n\n[vehicle]\nrotor_lag_s = {lag}\n{coasts}")
}

/// Lag of steps down over that of steps up above which a controller that brakes is in doubt.
const SLOW_DOWN: f64 = 1.5;

/// Warnings and the notes of the files.
fn doubts(identified: &Identified) -> Vec<&str> {
    let notes = identified.files.iter().flat_map(|file| &file.notes);
    identified
        .warnings
        .iter()
        .chain(notes)
        .map(String::as_str)
        .collect()
}

/// Names in a column of their own, each once.
fn statements_in_lines<'a>(statements: impl IntoIterator<Item = &'a Statement>) -> Vec<String> {
    let mut lines = Vec::new();
    let mut before = "";
    for statement in statements {
        let mut name = statement.name;
        if name == before {
            name = "";
        } else if !name.is_empty() {
            before = name;
        }
        for line in wrapped(&statement.text, WIDTH - INDENT) {
            lines.push(format!("{name:<INDENT$}{line}"));
            name = "";
        }
    }
    lines
}

/// As many of the warnings as there is room for in `most` lines.
fn warnings(lines: &mut Vec<String>, warnings: &[&str], most: usize) {
    let count = match warnings.len() {
        0 => "none".to_owned(),
        count => count.to_string(),
    };
    lines.push(format!("{:<INDENT$}{count}", "warnings"));
    for (k, warning) in warnings.iter().enumerate() {
        let listed = hanging("* ", warning, WIDTH - 4);
        // One line for how many are left.
        if lines.len() + listed.len() + 1 > most {
            lines.push(format!("  and {} more: --verbose", warnings.len() - k));
            return;
        }
        lines.extend(listed.map(|line| format!("  {line}")));
    }
}

fn bases(lines: &mut Vec<String>, candidates: &[Candidate]) {
    lines.extend(
        [
            "",
            "Basis: error in cross-validation, % of full scale",
            "                        leave one point out    leave one throttle level out   least",
            "               terms    thrust    torque       thrust    torque     idle",
        ]
        .map(str::to_owned),
    );
    for c in candidates {
        let chosen = if c.chosen { "   <- chosen" } else { "" };
        let found = match &c.errors {
            Some(e) => format!(
                "{:>7.2}   {:>7.2}      {:>7.2}   {:>7.2}    {:>7}",
                e.thrust_leave_one_out,
                e.torque_leave_one_out,
                e.thrust_leave_level_out,
                e.torque_leave_level_out,
                c.least_idle.map_or("none".into(), |idle| format!("{idle:.3}"))
            ),
            None => c.refused.clone().unwrap_or_default(),
        };
        lines.push(format!(
            "  {:<12} {:>4}    {found}{chosen}",
            c.basis.name(),
            c.terms
        ));
    }
}

fn coefficients(lines: &mut Vec<String>, pair: &Pair) {
    lines.extend([
        format!("\nModel: {}", pair.basis.name()),
        "           thrust, N                            torque, N m".to_owned(),
        "           estimate      +- 95 %                estimate      +- 95 %".to_owned(),
    ]);
    for (k, term) in pair.terms.iter().enumerate() {
        let cell = |f: &Fit| format!("{:>12.5} {:>12.5}", f.coefficients[k], f.ci95[k]);
        let (thrust, torque) = (cell(&pair.thrust), cell(&pair.torque));
        lines.push(format!("  {term:<6} {thrust}            {torque}"));
    }
    lines.push(String::new());
}
