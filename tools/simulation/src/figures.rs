//! Fig. 8, 9 and 10 of the paper as SVG, the conventional mixer on the left and the coaxial one on
//! the right.

use mixer_files::report::figure::Figure;
use mixer_files::report::pictures::panels;

use crate::flight::{FlightPair, Sample, Scenario};
use crate::manoeuvre::END_S;
use crate::mixer::Method;
use crate::vehicle::WEIGHT_N;

/// Samples from one point of a line to the next: 0.1 s.
const EVERY: usize = 20;

/// Height of a panel without its labels, px.
const HIGH: f64 = 170.0;

/// A line of a panel: its class, its name, what it shows.
type Line = (&'static str, &'static str, fn(&Sample) -> f64);

/// One row of panels: what both columns show. Lines in the order of drawing.
type Row = (&'static str, [f64; 2], [Line; 2]);

/// File names and texts of the three figures of a pair of flights. Axes are the same for all
/// scenarios.
pub fn draw(scenario: &Scenario, pair: &FlightPair) -> [(String, String); 3] {
    let reference = |value: fn(&Sample) -> f64| ("series-2", "reference", value);
    let flown = |value: fn(&Sample) -> f64| ("series-1", "flown", value);
    let horizontal =
        |label, position, aim| -> Row { (label, [-0.2, 0.2], [flown(position), reference(aim)]) };
    let heights = [flown(|s| -s.position.z), reference(|s| -s.reference.position.z)];
    let altitude: Row = ("altitude (m)", [0.8, 2.0], heights);
    let position = [
        horizontal("x (m)", |s| s.position.x, |s| s.reference.position.x),
        horizontal("y (m)", |s| s.position.y, |s| s.reference.position.y),
        altitude,
    ];
    let yaws = [
        reference(|s| s.reference.yaw.to_degrees()),
        flown(|s| s.yaw.to_degrees()),
    ];
    let thrusts: [Line; 2] = [
        ("series-1", "command", |s| s.command.w),
        ("", "weight", |_| WEIGHT_N),
    ];
    let figure = |file: &str, title: &str, rows: &[Row]| {
        let column = |method: Method| {
            let panels = rows.iter().map(|row| panel(row, pair, method));
            (format!("{method} mixer"), panels.collect())
        };
        let title = format!("{title}: simulated flight, {scenario}, seed {}", pair.seed);
        let columns = [Method::Conventional, Method::Coaxial].map(column);
        (
            format!("{file}-{}.svg", scenario.slug()),
            panels(&title, &columns),
        )
    };
    [
        figure("fig8-position", "Position", &position),
        figure("fig9-yaw", "Yaw", &[("yaw (degrees)", [-110.0, 110.0], yaws)]),
        figure(
            "fig10-thrust",
            "Thrust command and weight",
            &[altitude, ("thrust (N)", [15.0, 55.0], thrusts)],
        ),
    ]
}

fn panel((label, range, lines): &Row, pair: &FlightPair, method: Method) -> Figure {
    let mut figure = Figure::new("", ("time (s)", [0.0, END_S]), (label, *range)).high(HIGH);
    for (class, name, value) in lines {
        let samples = pair.with(method).samples.iter().step_by(EVERY);
        let points: Vec<_> = samples.map(|sample| [sample.time_s, value(sample)]).collect();
        figure.curve(class, name, &points);
    }
    figure
}
