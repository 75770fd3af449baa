//! The verdict on an airframe: what `check` says without `--verbose`, at most 30 lines.

use std::fmt;
use std::path::Path;

use mixer_compiler::Compiled;
use mixer_compiler::airframe::Axis;
use mixer_compiler::diagnostic::{Diagnostics, printable, rounded_up};
use mixer_facts::checklist::Checklist;
use mixer_facts::report::{Summary, in_words};

/// The verdict; its `Display` is the text.
pub(super) struct Verdict<'a> {
    pub(super) compiled: &'a Compiled,
    pub(super) summary: &'a Summary,
    pub(super) warnings: &'a Diagnostics,
    /// The airframe file, for the commands that come next.
    pub(super) file: &'a Path,
}

impl fmt::Display for Verdict<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Verdict {
            compiled, summary, ..
        } = self;
        let airframe = &compiled.airframe;
        writeln!(f, "{}: {}", airframe.name, airframe.description)?;
        writeln!(
            f,
            "{} coaxial units, {} rotors; serves {}\n",
            summary.units,
            summary.rotors,
            summary.axes.join(", ")
        )?;

        let [floor, ceiling] = compiled.thrust_range_n.map(f64::from);
        let at = match &airframe.voltage {
            Some(voltage) => format!(" at {} V", voltage.reference_v),
            None => String::new(),
        };
        writeln!(
            f,
            "thrust          {floor:.1} to {ceiling:.1} N without torque{at}"
        )?;
        writeln!(
            f,
            "idle            {:?} gives {:.1} % of the largest thrust; the map needs {:.3} at least",
            airframe.throttle.min,
            100.0 * floor / ceiling,
            (1e3 * summary.min_idle).ceil() / 1e3
        )?;
        match &summary.hover {
            Some(hover) => write!(f, "{hover}")?,
            None => writeln!(
                f,
                "hover           add [vehicle] mass_kg to see hover and its margins"
            )?,
        }
        if let Some(uncertainty) = &airframe.pair.uncertainty {
            writeln!(f, "pair            {}", in_words(uncertainty))?;
        }
        match &airframe.voltage {
            Some(voltage) => writeln!(
                f,
                "voltage         {} to {} V is corrected for",
                voltage.range_v[0], voltage.range_v[1]
            )?,
            None => writeln!(
                f,
                "voltage         not corrected for: no [voltage]; a pack that falls by 20 % loses 32 % of thrust"
            )?,
        }
        writeln!(
            f,
            "inverse map     proven to {} N, {} N m per unit; {} bytes of tables",
            rounded_up(summary.proven_thrust_n),
            rounded_up(summary.proven_torque_nm),
            summary.table_bytes
        )?;
        if let (Some(mean), Some(bound)) = (
            summary.cost.attainable_instructions,
            summary.cost.bound_instructions,
        ) {
            writeln!(
                f,
                "cost            about {mean} instructions of a Cortex-M4F in the mean, {bound} at most"
            )?;
        }
        self.outputs(f)?;
        match self.warnings.faults().len() {
            0 => writeln!(f, "warnings        none")?,
            count => writeln!(f, "warnings        {count}, told on stderr")?,
        }
        let file = printable(&self.file.display().to_string());
        writeln!(
            f,
            "next            cargo mixer report {file} -o report.html (pictures), or check --verbose (every number)"
        )
    }
}

impl Verdict<'_> {
    /// Which outputs rise for every axis, and by how much.
    fn outputs(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for axis in Axis::ALL {
            if let Some(rises) = Checklist(self.compiled).rises_in_words(axis) {
                writeln!(f, "{:<15} raises outputs {rises}", format!("+{}", axis.name()))?;
            }
        }
        Ok(())
    }
}
