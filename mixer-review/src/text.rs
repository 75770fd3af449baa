//! A review in words, a screen of them.

use std::fmt;

use mixer_compiler::diagnostic::rounded;

use crate::review::{Range, Review, beside};
use crate::saturated::Source;
use crate::thrust::Part;

/// Width of the names.
const NAMES: usize = 18;

fn say(f: &mut fmt::Formatter<'_>, name: &str, text: impl fmt::Display) -> fmt::Result {
    writeln!(f, "{name:<NAMES$}  {text}")
}

/// Parts of a flight: `21.1 V: 1.012 (14 s)`.
fn parts(parts: &[Part], unit: &str) -> String {
    let part = |part: &Part| {
        format!(
            "{:.3} at {:.2}{unit} ({:.0} s)",
            part.scale, part.at, part.seconds
        )
    };
    parts.iter().map(part).collect::<Vec<_>>().join(", ")
}

fn range(range: &Range, unit: &str, key: &str) -> String {
    let Range {
        least,
        largest,
        range,
        outside,
    } = range;
    let of_file = range.map_or(format!("; the file has no {key}"), |[low, high]| {
        format!(
            "; {key} is {low} to {high}, outside for {:.1} % of the time",
            100.0 * outside
        )
    });
    format!("{least:.2} to {largest:.2} {unit}{of_file}")
}

fn or_dash(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
}

impl fmt::Display for Review {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [log, air, hover] = self.seconds;
        let with = match self.saturated.by {
            Source::Mixer => "with this mixer: it gives the logged throttles",
            _ => "with another mixer than this",
        };
        say(
            f,
            "flight",
            format_args!(
                "{} of {log:.0} s: {air:.0} s in the air, {hover:.0} s of them hover; {with}",
                self.stack
            ),
        )?;
        let [low, high] = self.thrust.interval;
        say(
            f,
            "thrust",
            format_args!(
                "model over measured {:.3}; in 19 of 20 flights between {low:.3} and {high:.3}, at {} kg +- 0.5 %",
                self.thrust.scale, self.mass_kg
            ),
        )?;
        if !self.thrust.by_voltage.is_empty() {
            say(f, "  by voltage", parts(&self.thrust.by_voltage, " V"))?;
        }
        if !self.thrust.by_thrust.is_empty() {
            say(
                f,
                "  by thrust",
                format_args!("{} of the weight", parts(&self.thrust.by_thrust, "")),
            )?;
        }
        let [upper, lower] = self.hover.model.map_or([None; 2], |model| model.map(Some));
        say(
            f,
            "hover throttle",
            format_args!(
                "upper {} flown, {} by this mixer; lower {}, {}",
                or_dash(self.hover.upper, 3),
                or_dash(upper, 3),
                or_dash(self.hover.lower, 3),
                or_dash(lower, 3)
            ),
        )?;
        if let (Some(roll), Some(pitch), Some(yaw)) =
            (self.hover.roll_nm, self.hover.pitch_nm, self.hover.yaw_nm)
        {
            say(
                f,
                "torque left",
                format_args!(
                    "roll {}, pitch {}, yaw {} N m by the model in a straight hover, where there is none",
                    rounded(roll),
                    rounded(pitch),
                    rounded(yaw)
                ),
            )?;
        }
        if let Some(centre) = self.hover.centre_m {
            say(
                f,
                "centre of gravity",
                format_args!("{} of the file's, by roll and pitch", beside(centre)),
            )?;
        }
        if let Some(voltage) = &self.voltage {
            say(f, "voltage", range(voltage, "V", "range_v"))?;
        }
        if let Some(density) = &self.density {
            say(f, "density", range(density, "kg/m3", "range_kg_m3"))?;
        }
        let cut = &self.saturated;
        let percent = |share: Option<f64>| or_dash(share.map(|share| 100.0 * share), 1);
        let by = match cut.by {
            Source::Mixer => "by this mixer",
            Source::Allocator => "by control_allocator_status",
            Source::None => "the log does not say of which axis",
        };
        say(
            f,
            "saturated",
            format_args!(
                "roll {}, pitch {}, yaw {}, thrust {} % of the time ({by}); a rotor at full {:.1}, at idle {:.1} %",
                percent(cut.roll),
                percent(cut.pitch),
                percent(cut.yaw),
                percent(cut.thrust),
                100.0 * cut.at_full,
                100.0 * cut.at_idle
            ),
        )?;
        say(
            f,
            "least margin",
            format_args!(
                "{:.3} of throttle, output {} at {:.1} s",
                self.margin.throttle, self.margin.output, self.margin.time_s
            ),
        )?;
        self.warnings
            .iter()
            .try_for_each(|warning| say(f, "warning", warning))?;
        self.not_told.iter().try_for_each(|what| say(f, "not told", what))
    }
}
