//! A review in words, a screen of them.

use std::fmt;

use crate::review::result::{Hover, Power, Range, Review};
use crate::review::rotors::Lag;
use crate::review::saturated::{Saturated, Source};
use crate::review::thrust::Part;

/// Where a point is, m: `12 mm forward and 7 mm left`.
pub(crate) fn beside([x, y]: [f64; 2]) -> String {
    format!(
        "{:.0} mm {} and {:.0} mm {}",
        1e3 * x.abs(),
        if x < 0.0 { "back" } else { "forward" },
        1e3 * y.abs(),
        if y < 0.0 { "left" } else { "right" }
    )
}

/// Parts of a log that have a line.
const MOST_PARTS: usize = 10;

/// A line: its name and its text.
type Line = (&'static str, String);

/// A part of a log: `1.012 (1.001 to 1.023) from 14 to 82 s, 21.1 V`.
fn part(part: &Part) -> String {
    let [low, high] = part.interval;
    format!(
        "{:.3} ({low:.3} to {high:.3}) in take-off {}, from {:.0} to {:.0} s, {:.1} V",
        part.scale, part.flight, part.from_s, part.to_s, part.voltage_v
    )
}

fn range(range: &Range, unit: &str, key: &str) -> String {
    let of_file = range
        .range
        .map_or(format!("; the file has no {key}"), |[low, high]| {
            let percent = 100.0 * range.outside;
            format!("; {key} is {low} to {high}, outside for {percent:.1} % of the time")
        });
    format!("{:.2} to {:.2} {unit}{of_file}", range.least, range.largest)
}

fn or_dash(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
}

fn hover(hover: &Hover) -> Vec<Line> {
    let [upper, lower] = hover.model.map_or([None; 2], |model| model.map(Some));
    let [upper, by_upper, lower, by_lower] =
        [hover.upper, upper, hover.lower, lower].map(|throttle| or_dash(throttle, 3));
    let throttle = format!("upper {upper} flown, {by_upper} by this mixer; lower {lower}, {by_lower}");
    let torque = hover.roll_nm.zip(hover.pitch_nm).zip(hover.yaw_nm).map(|((roll, pitch), yaw)| {
        let [roll, pitch, yaw] = [roll, pitch, yaw].map(|torque_nm| (1e3 * torque_nm).round() / 1e3 + 0.0);
        format!("roll {roll}, pitch {pitch}, yaw {yaw} N m by the model in a straight hover, where there is none")
    });
    let centre = hover
        .centre_m
        .zip(hover.centre_interval_m)
        .map(|(centre, interval)| {
            let [x, y] = interval.map(|[low, high]| format!("{:.0}", 500.0 * (high - low)));
            format!(
                "{} of the file's, +- {x} and {y} mm, by roll and pitch",
                beside(centre)
            )
        });
    let all = [
        ("hover throttle", Some(throttle)),
        ("torque left", torque),
        ("centre of gravity", centre),
    ];
    all.into_iter()
        .filter_map(|(name, text)| Some((name, text?)))
        .collect()
}

fn power(power: &Power) -> String {
    let left = power.hover_left_s.map_or(String::new(), |left_s| {
        format!("; at the log's end charge for {:.1} min of hover", left_s / 60.0)
    });
    format!(
        "model over measured {:.3}: {:.0} W are measured in hover{left}",
        power.scale, power.measured_w
    )
}

fn lag(of: &Lag) -> String {
    let [low, high] = of.interval_s;
    format!(
        "{:.3} s ({low:.3} to {high:.3}) at throttle {:.2}, `rotor_lag_s` of `[vehicle]`; `mix_dynamic` takes {:.3} s",
        of.lag_s, of.throttle, of.of_mixer_s
    )
}

fn saturated(cut: &Saturated) -> String {
    let [roll, pitch, yaw, thrust] =
        [cut.roll, cut.pitch, cut.yaw, cut.thrust].map(|share| or_dash(share.map(|share| 100.0 * share), 1));
    let by = match cut.by {
        Source::Mixer => "by this mixer",
        Source::Allocator => "by control_allocator_status",
        Source::Controllers => "by the flags of PIDR, PIDP and PIDY",
        Source::None => "the log does not say of which axis",
    };
    let [full, idle] = [cut.at_full, cut.at_idle].map(|share| 100.0 * share);
    format!(
        "roll {roll}, pitch {pitch}, yaw {yaw}, thrust {thrust} % of the time ({by}); a rotor at full {full:.1}, at idle {idle:.1} %"
    )
}

impl Review {
    /// Names and texts, at most 30 lines of them; those of a warning have one name.
    pub fn lines(&self) -> Vec<(&'static str, String)> {
        let [log, air, hovers] = self.seconds;
        let [low, high] = self.thrust.interval;
        let with = match self.saturated.by {
            Source::Mixer => "; this mixer gives the logged throttles",
            _ => "",
        };
        let scale = self.thrust.scale.map_or_else(
            || format!("no one scale: {low:.3} to {high:.3}"),
            |scale| format!("{scale:.3}; in 19 of 20 flights between {low:.3} and {high:.3}"),
        );
        let mut lines = vec![
            (
                "flight",
                format!(
                    "{} of {log:.0} s: {air:.0} s in the air, {hovers:.0} s of them hover{with}",
                    self.stack.name()
                ),
            ),
            (
                "thrust",
                format!("model over measured {scale}, at {} kg +- 0.5 %", self.mass_kg),
            ),
        ];
        let parts = self.thrust.parts.iter().filter(|_| self.thrust.parts.len() > 1);
        lines.extend(parts.take(MOST_PARTS).map(|of| ("  part", part(of))));
        lines.extend(hover(&self.hover));
        lines.extend(
            self.voltage
                .iter()
                .map(|voltage| ("voltage", range(voltage, "V", "range_v"))),
        );
        lines.extend(
            self.density
                .iter()
                .map(|density| ("density", range(density, "kg/m3", "range_kg_m3"))),
        );
        lines.extend(self.power.iter().map(|of| ("power", power(of))));
        lines.extend(self.lag.iter().map(|of| ("rotors' lag", lag(of))));
        lines.push(("saturated", saturated(&self.saturated)));
        lines.extend(self.warnings.iter().map(|warning| ("warning", warning.clone())));
        lines
    }
}

impl fmt::Display for Review {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.lines()
            .iter()
            .try_for_each(|(name, text)| writeln!(f, "{name:<18}  {text}"))
    }
}
