//! Figures of one airframe as files of their own, for documents.

use std::collections::BTreeMap;

use mixer_compiler::Compiled;

use crate::report::comparison::Comparison;
use crate::report::data::YAW_COMMANDS;
use crate::report::effort::Effort;
use crate::report::figure::Figure;
use crate::report::number::{range, widened};
use crate::report::page::FIGURE_STYLE;
use crate::report::study::Study;
use crate::report::{maps, plots};

/// The files by name: forward, inverse and error map, attainable set, thrust over yaw.
pub fn pictures(compiled: &Compiled) -> BTreeMap<String, String> {
    let study = Study::new(compiled, None);
    let thrust = Effort::Thrust;
    let mut figures = vec![
        ("forward-thrust", maps::forward(&study, thrust, None)),
        ("inverse-upper", maps::inverse(&study, 0)),
        (
            "error-thrust",
            maps::error(&study, thrust, &maps::error_field(&study, thrust)),
        ),
        ("attainable", plots::attainable(&study)),
    ];
    if let Some(comparison) = Comparison::sweep(&study, YAW_COMMANDS) {
        figures.push(("yaw", plots::yaw_plane(&study, &comparison)));
        figures.push(("yaw-total", plots::yaw_total(&comparison)));
    }
    let name = &compiled.airframe.name;
    let file = |(picture, figure): (&str, Figure)| (format!("{name}-{picture}.svg"), styled(&figure.svg()));
    figures.into_iter().map(file).collect()
}

/// Thrust over weight against time, s, in a flight's step of yaw: a curve for each mixer, with its name.
pub fn yaw_step(mixers: &[(String, Vec<[f64; 2]>)]) -> String {
    let points = || mixers.iter().flat_map(|(_, points)| points);
    let axis = |k: usize| range(points().map(|point| point[k]).chain((k == 1).then_some(1.0)));
    let mut figure = Figure::new(
        "Thrust of an X8 in a step of 175 degrees of yaw in PX4's simulator, with PX4's allocator and with this mixer",
        ("time from the step (s)", axis(0)),
        ("thrust over weight", widened(axis(1), 0.06)),
    )
    .high(200.0);
    figure.level("axis-line", "", 1.0);
    for ((name, points), class) in mixers.iter().zip(["series-1", "series-2", "series-3"]) {
        figure.curve(class, name, points);
    }
    styled(&figure.svg())
}

/// Plots in columns, each below its heading, and all below a title.
pub fn panels(title: &str, columns: &[(String, Vec<Figure>)]) -> String {
    styled(&Figure::panels(title, columns))
}

/// A picture with the style that the page would give it, and a ground of its own: documents may be
/// light or dark.
fn styled(svg: &str) -> String {
    let style = format!("<style>\n{FIGURE_STYLE}svg.figure {{ background: var(--paper); }}\n</style>\n");
    match svg.split_once('\n') {
        Some((start, rest)) => format!("{start}\n{style}{rest}"),
        None => svg.to_owned(),
    }
}
