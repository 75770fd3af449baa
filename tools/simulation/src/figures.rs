//! Fig. 8, 9 and 10 of the paper as SVG, the conventional mixer on the left and the coaxial one on
//! the right.
//!
//! Blue and vermilion of Okabe and Ito's palette, black for what is given: told apart with any
//! colour vision.

use std::error::Error;
use std::ops::Range;

use plotters::coord::Shift;
use plotters::prelude::*;

use crate::flight::{Flight, FlightPair, Sample, Scenario};
use crate::manoeuvre::END_S;
use crate::mixer::Method;
use crate::vehicle::WEIGHT_N;

const FLOWN: RGBColor = RGBColor(0, 114, 178);
const REFERENCE: RGBColor = RGBColor(213, 94, 0);
const GIVEN: RGBColor = RGBColor(0, 0, 0);

/// Width of a figure, pixels.
const WIDTH: u32 = 1000;

/// Samples from one point of a line to the next: 0.1 s.
const EVERY: usize = 20;

/// Left and right column.
const COLUMNS: [Method; 2] = [Method::Conventional, Method::Coaxial];

/// A line of a panel: its label, its colour, what it shows.
type Line = (&'static str, RGBColor, fn(&Sample) -> f64);

/// One row of panels: what both columns show. Lines in the order of drawing.
type Row = (&'static str, Range<f64>, Vec<Line>);

/// File names and texts of the three figures of a pair of flights. Axes are the same for all
/// scenarios.
///
/// # Errors
/// What the drawing library cannot draw.
pub fn draw(scenario: &Scenario, pair: &FlightPair) -> Result<[(String, String); 3], Box<dyn Error>> {
    let reference = |value: fn(&Sample) -> f64| ("reference", REFERENCE, value);
    let flown = |value: fn(&Sample) -> f64| ("flown", FLOWN, value);
    let horizontal =
        |label, position, aim| -> Row { (label, -0.2..0.2, vec![flown(position), reference(aim)]) };
    let heights = vec![flown(|s| -s.position.z), reference(|s| -s.reference.position.z)];
    let altitude: Row = ("altitude, m", 0.8..2.0, heights);
    let position = [
        horizontal("x, m", |s| s.position.x, |s| s.reference.position.x),
        horizontal("y, m", |s| s.position.y, |s| s.reference.position.y),
        altitude.clone(),
    ];
    let yaws = vec![
        reference(|s| s.reference.yaw.to_degrees()),
        flown(|s| s.yaw.to_degrees()),
    ];
    let yaw: [Row; 1] = [("yaw, degrees", -110.0..110.0, yaws)];
    let thrusts: Vec<Line> = vec![
        ("command", FLOWN, |s| s.command.w),
        ("weight", GIVEN, |_| WEIGHT_N),
    ];
    let thrust = [altitude, ("thrust, N", 15.0..55.0, thrusts)];
    let name = |figure: &str| format!("{figure}-{}.svg", scenario.slug());
    let subject = format!("simulated flight, {scenario}, seed {}", pair.seed);
    let draw = |title: &str, rows: &[Row]| figure(pair, &format!("{title}: {subject}"), rows);
    Ok([
        (name("fig8-position"), draw("Position", &position)?),
        (name("fig9-yaw"), draw("Yaw", &yaw)?),
        (name("fig10-thrust"), draw("Thrust command and weight", &thrust)?),
    ])
}

/// A title over a grid of panels, one row per entry and one column per mixer.
fn figure(pair: &FlightPair, title: &str, rows: &[Row]) -> Result<String, Box<dyn Error>> {
    let mut svg = String::new();
    {
        let height = 60 + 240 * rows.len() as u32;
        let root = SVGBackend::with_string(&mut svg, (WIDTH, height)).into_drawing_area();
        root.fill(&WHITE)?;
        let root = root.titled(title, ("sans-serif", 20))?;
        for (panel, place) in root.split_evenly((rows.len(), 2)).iter().zip(0..) {
            let (row, method) = (&rows[place / 2], COLUMNS[place % 2]);
            draw_panel(panel, row, method, pair.with(method))?;
        }
        root.present()?;
    }
    Ok(svg)
}

fn draw_panel(
    area: &DrawingArea<SVGBackend<'_>, Shift>,
    (label, range, lines): &Row,
    method: Method,
    flight: &Flight,
) -> Result<(), Box<dyn Error>> {
    let mut chart = ChartBuilder::on(area)
        .caption(format!("{method} mixer"), ("sans-serif", 16))
        .margin(8)
        .margin_right(24)
        .x_label_area_size(38)
        .y_label_area_size(58)
        .build_cartesian_2d(0.0..END_S, range.clone())?;
    chart
        .configure_mesh()
        .x_desc("time, s")
        .y_desc(*label)
        .x_labels(11)
        .x_label_formatter(&|time| format!("{time:.0}"))
        .y_labels(6)
        .label_style(("sans-serif", 13))
        .axis_desc_style(("sans-serif", 14))
        .light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.12))
        .draw()?;
    for &(label, colour, value) in lines {
        let points = flight.samples.iter().step_by(EVERY);
        let points = points.map(|sample| (sample.time_s, value(sample)));
        chart
            .draw_series(LineSeries::new(points, colour.stroke_width(2)))?
            .label(label)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(2)));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE.mix(0.85))
        .label_font(("sans-serif", 13))
        .draw()?;
    Ok(())
}
