//! `cargo mixer compare`: airframes side by side.

use std::path::PathBuf;
use std::process::ExitCode;

use mixer_compiler::Compiled;
use mixer_compiler::diagnostic::rounded_up;
use mixer_compiler::hover::HoverAt;
use mixer_facts::cost::Cost;
use mixer_facts::hover::Hover;
use mixer_facts::report::Summary;

/// Share of the largest bare thrust at which authorities are compared.
const SHARE: f64 = 0.4;

/// Prints airframes side by side: thrust, authority, hover, evaluator, cost
#[derive(clap::Args, Debug)]
pub struct CompareArgs {
    /// The airframe files
    #[arg(required = true, num_args = 2.., value_name = "AIRFRAME.toml")]
    airframes: Vec<PathBuf>,
}

/// Runs the command.
pub fn run(args: &CompareArgs) -> ExitCode {
    let mut all = Vec::new();
    for path in &args.airframes {
        match crate::compile(path) {
            Ok(compiled) => all.push(compiled),
            Err(refusal) => return refusal.report(),
        }
    }
    crate::print(&comparison(&all))
}

/// One row per property, one column per airframe.
pub fn comparison(all: &[Compiled]) -> String {
    let columns: Vec<Vec<(&str, String)>> = all.iter().map(column).collect();
    let Some(first) = columns.first() else {
        return String::new();
    };
    let widths: Vec<usize> = columns
        .iter()
        .map(|column| {
            column
                .iter()
                .map(|(_, value)| value.chars().count())
                .max()
                .unwrap_or(0)
        })
        .collect();
    let names = first
        .iter()
        .map(|(name, _)| name.chars().count())
        .max()
        .unwrap_or(0);
    let mut text = String::new();
    for (row, (name, _)) in first.iter().enumerate() {
        let mut line = format!("{name:<names$}");
        for (column, width) in columns.iter().zip(&widths) {
            let value = column.get(row).map_or("", |(_, value)| value.as_str());
            line.push_str(&format!("  {value:>width$}"));
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

/// What is said of one airframe: the same rows for all.
fn column(compiled: &Compiled) -> Vec<(&'static str, String)> {
    let summary = Summary::new(compiled);
    let cost = Cost::new(compiled);
    let [floor, ceiling] = summary.thrust_range_n.map(f64::from);
    let reference = compiled
        .airframe
        .voltage
        .as_ref()
        .map(|voltage| voltage.reference_v);
    let at = HoverAt::new(compiled, SHARE * ceiling, reference);
    let authority = |axis: &str| {
        let margin = at.margins.iter().find(|margin| margin.axis == axis);
        margin.map_or("not served".to_owned(), |margin| {
            let [least, largest] = margin.torque_nm;
            format!("{least:.3} to {largest:.3}")
        })
    };
    let count = |count: Option<u32>| count.map_or("not counted".to_owned(), |count| count.to_string());
    let hover = Hover::new(compiled);
    let of_hover =
        |value: &dyn Fn(&Hover) -> Option<String>| hover.as_ref().and_then(value).unwrap_or("-".to_owned());
    let throttles = |hover: &Hover| {
        let at = hover.at.last()?;
        Some(format!("{:.3}, {:.3}", at.upper_throttle?, at.lower_throttle?))
    };
    vec![
        ("", summary.name.clone()),
        ("rotors", summary.rotors.to_string()),
        (
            "throttle",
            format!(
                "{:?} to {:?}",
                compiled.airframe.throttle.min, compiled.airframe.throttle.max
            ),
        ),
        (
            "reference voltage (V)",
            reference.map_or("none".to_owned(), |volts| format!("{volts:?}")),
        ),
        ("bare thrust (N)", format!("{floor:.1} to {ceiling:.1}")),
        ("at 40 % of it: roll (N m)", authority("roll")),
        ("  pitch (N m)", authority("pitch")),
        ("  yaw (N m)", authority("yaw")),
        (
            "mass (kg)",
            of_hover(&|hover| Some(format!("{:?}", hover.mass_kg))),
        ),
        (
            "  thrust over weight",
            of_hover(&|hover| Some(format!("{:.2}", hover.thrust_over_weight))),
        ),
        ("  hover throttles, upper, lower", of_hover(&throttles)),
        ("evaluator", summary.evaluator.clone()),
        ("proven error (N)", rounded_up(summary.proven_thrust_n)),
        ("  (N m)", rounded_up(summary.proven_torque_nm)),
        ("tables (bytes)", summary.table_bytes.to_string()),
        (
            "instructions, inverse of a unit",
            count(cost.inverse_instructions),
        ),
        (
            "  mix delivered by least norm",
            count(cost.delivered_instructions),
        ),
        (
            "warnings",
            mixer_compiler::lint(compiled).faults().len().to_string(),
        ),
    ]
}
