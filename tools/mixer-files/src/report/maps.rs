//! Colour maps: forward (Fig. 3 and 4 of the paper), inverse over the attainable set (Fig. 5),
//! error of the inverse.

use std::slice::from_ref;

use mixer_compiler::diagnostic::rounded_up;

use crate::report::bench::{BenchPoint, BenchPoints};
use crate::report::colour::Scale;
use crate::report::effort::{EFFORTS, Effort, THRUST, TORQUE};
use crate::report::field::{Field, Painting, paint};
use crate::report::figure::Figure;
use crate::report::number::{Ticks, fixed, range, significant, widened};
use crate::report::study::Study;

/// Points per side of the grid from which smooth maps are traced.
const SIDE: usize = 41;

/// Points per side of the grid of the error, which oscillates.
pub const ERROR_SIDE: usize = 97;

const UPPER: &str = "upper throttle u";
const LOWER: &str = "lower throttle l";

/// Thrust or torque over both throttles, with the bench points and the flight on it.
pub fn forward(study: &Study<'_>, effort: Effort, bench: Option<&BenchPoints>) -> Figure {
    let field = Field::new(SIDE, |square| study.efforts(square)[effort as usize]);
    let values = range(field.values().iter().copied());
    let points = bench.map_or(&[][..], |bench| &bench.points);
    let flown = study.flown.as_ref().map_or(&[][..], |flown| &flown.throttles);
    let throttles = |k: usize| {
        let measured = points.iter().map(|point| point.throttles[k]);
        let measured = measured.chain(flown.iter().map(|throttles| throttles[k]));
        // Markers stay within the frame.
        let room = if points.is_empty() && flown.is_empty() {
            0.0
        } else {
            0.025
        };
        widened(range(measured.chain(study.pair.range())), room)
    };
    let title = format!("{} of one unit over both throttles", effort.name());
    let mut figure = Figure::new(title, (UPPER, throttles(0)), (LOWER, throttles(1)))
        .beside_bar(200.0)
        .reading("forward", &[(UPPER, ""), (LOWER, ""), EFFORTS[0], EFFORTS[1]]);
    let painting = Painting {
        scale: match effort {
            Effort::Thrust => Scale::sequential(values),
            Effort::Torque => Scale::signed(values),
        },
        range: values,
        levels: 7,
        bands: 4,
        iso_curves: true,
        ticks: None,
        label: effort.label(),
    };
    figure.keep_clear(
        points
            .iter()
            .map(|point| point.throttles)
            .chain(study.hover_throttles()),
    );
    paint(&mut figure, &field, &painting, |square| study.throttles(square));
    figure.cloud("flown-dot", 1.6, flown);
    let measured: Vec<[f64; 2]> = points.iter().map(|point| point.throttles).collect();
    figure.cloud("bench-dot", 2.6, &measured);
    figure.mark(&study.hover_throttles(), "hover");
    figure
}

/// Model less measured at every bench point over both throttles, in percent of the pair's largest
/// effort; small where it lies outside the throttle range. `None` without points.
pub fn residuals(study: &Study<'_>, effort: Effort, bench: &BenchPoints) -> Option<Figure> {
    let scale = study.pair.scale()[effort as usize];
    let percent = |point: &BenchPoint| 100.0 * point.residual(effort) / scale;
    let sizes = bench.points.iter().map(|point| percent(point).abs());
    let largest = sizes.fold(0.0, f64::max);
    if largest <= 0.0 {
        return None;
    }
    let all = || bench.points.iter().chain(&bench.outside);
    let throttles = |k: usize| {
        let measured = all().map(|point| point.throttles[k]);
        widened(range(measured.chain(study.pair.range())), 0.05)
    };
    let quantity = effort.name();
    let title = format!("{quantity} by the model less {} measured", effort.word());
    let unit = effort.unit();
    let [place, upper, lower] = ["", UPPER, LOWER].map(|name| (name, ""));
    let [measured, model, difference] = ["measured", "model", "difference"].map(|name| (name, unit));
    let quantities = [place, upper, lower, measured, model, difference, ("that is", "%")];
    let mut figure = Figure::new(title, (UPPER, throttles(0)), (LOWER, throttles(1)))
        .beside_bar(200.0)
        .reading("dots", &quantities);
    let [low, high] = study.pair.range();
    let corners = [[low, low], [high, low], [high, high], [low, high]];
    figure.outline("border", "throttle range", &corners);
    let colours = Scale::signed([-largest, largest]);
    for point in all() {
        let is_within = |t: &f64| (low - 1e-9..=high + 1e-9).contains(t);
        let value = percent(point).clamp(-largest, largest);
        let radius = if point.throttles.iter().all(is_within) {
            6.0
        } else {
            3.5
        };
        let [u, l] = point.throttles;
        let [measured, model] = [point.measured, point.model].map(|efforts| efforts[effort as usize]);
        let values = [
            bench.place(point),
            fixed(u, 3),
            fixed(l, 3),
            significant(measured, 4),
            significant(model, 4),
            significant(model - measured, 2),
            fixed(percent(point), 2),
        ];
        let paint = format!("class=\"residual\" fill=\"{}\"", colours.hex(value));
        figure.read_dot(&paint, radius, point.throttles, &values);
        figure.sign(value, radius, point.throttles, colours.ink(value));
    }
    let bands = (0..RESIDUAL_BANDS).map(|k| {
        let edge = |k: usize| largest * (2.0 * k as f64 / RESIDUAL_BANDS as f64 - 1.0);
        (edge(k), edge(k + 1), colours.hex(0.5 * (edge(k) + edge(k + 1))))
    });
    let ticks = Ticks::within([-largest, largest], 6);
    let label = format!("model \u{2212} measured (% of {} {unit})", significant(scale, 3));
    figure.colour_bar(&label, bands.collect(), ticks.texts());
    Some(figure)
}

/// Bands of colour of the residuals' bar.
const RESIDUAL_BANDS: usize = 20;

/// A plot over thrust and torque that has the whole attainable sets in view.
pub(super) fn over_efforts(studies: &[Study<'_>], title: &str, k: [f64; 2]) -> Figure {
    let border: Vec<[f64; 2]> = studies.iter().flat_map(Study::border_efforts).collect();
    let extent = |index: usize| {
        let values = border.iter().map(|efforts| efforts[index] * k[index]);
        widened(range(values), 0.04)
    };
    Figure::new(title, (THRUST, extent(0)), (TORQUE, extent(1)))
}

/// The throttle of one rotor (0 upper, 1 lower) over the attainable set.
pub fn inverse(study: &Study<'_>, rotor: usize) -> Figure {
    let field = Field::new(SIDE, |square| study.throttles(square)[rotor]);
    let title = format!("{} throttle over the attainable set", ["Upper", "Lower"][rotor]);
    let mut figure = over_efforts(from_ref(study), &title, [1.0, 1.0])
        .beside_bar(200.0)
        .reading("inverse", &[EFFORTS[0], EFFORTS[1], (UPPER, ""), (LOWER, "")]);
    let painting = Painting {
        scale: Scale::sequential(study.pair.range()),
        range: study.pair.range(),
        levels: 5,
        bands: 6,
        iso_curves: true,
        ticks: None,
        label: [UPPER, LOWER][rotor],
    };
    figure.keep_clear(study.hover_efforts());
    paint(&mut figure, &field, &painting, |square| study.efforts(square));
    outline(study, &mut figure);
    figure.mark(&study.hover_efforts(), "hover");
    figure
}

/// The error of the emitted inverse in thrust or in torque over the throttle box, absolute.
pub fn error_field(study: &Study<'_>, effort: Effort) -> Field {
    Field::new(ERROR_SIDE, |square| {
        study.error(study.throttles(square))[effort as usize].abs()
    })
}

/// The error of the emitted inverse over the attainable set, up to its bound.
pub fn error(study: &Study<'_>, effort: Effort, field: &Field) -> Figure {
    let title = format!("{} that the inverse misses", effort.name());
    let hover = ["error-thrust", "error-torque"][effort as usize];
    let quantities = [EFFORTS[0], EFFORTS[1], ("error about", effort.unit())];
    let mut figure = over_efforts(from_ref(study), &title, [1.0, 1.0])
        .beside_bar(200.0)
        .reading(hover, &quantities);
    let bound = error_bound(study, effort);
    let decades = |x: f64| libm::log10(x / bound).max(-DECADES);
    let mut values = field.values().iter();
    let logarithms = Field::new(field.side(), |_| values.next().map_or(-DECADES, |&x| decades(x)));
    let range = [-DECADES, 0.0];
    let painting = Painting {
        scale: Scale::sequential(range),
        range,
        levels: 4,
        bands: 3,
        iso_curves: false,
        ticks: Some(log_ticks(bound)),
        label: &format!("|error of {}| ({})", effort.word(), effort.unit()),
    };
    let project = |square| study.efforts(square);
    paint(&mut figure, &logarithms, &painting, project);
    outline(study, &mut figure);
    figure
}

/// Decades of the error that are told apart below its bound.
const DECADES: f64 = 2.0;

/// Ticks at 1, 2 and 5 times powers of ten and at the bound itself, placed by their logarithm in
/// units of `bound`.
fn log_ticks(bound: f64) -> Vec<(f64, String)> {
    let lowest = libm::floor(libm::log10(bound) - DECADES) as i32;
    let round = (lowest..lowest + 4).flat_map(|exponent| {
        let power = libm::pow(10.0, f64::from(exponent));
        [1.0, 2.0, 5.0].map(|digit| digit * power)
    });
    let mut ticks: Vec<(f64, String)> = round
        .map(|value| (libm::log10(value / bound), significant(value, 1)))
        // Not on top of the bound's own tick.
        .filter(|(place, _)| (-DECADES - 1e-9..-0.08).contains(place))
        .collect();
    ticks.push((0.0, rounded_up(bound)));
    ticks
}

/// The border of the attainable set around a map over it.
fn outline(study: &Study<'_>, figure: &mut Figure) {
    figure.outline("border", "", &study.border_efforts());
}

/// The proven bound of the error at the reference voltage, N or N m.
pub fn error_bound(study: &Study<'_>, effort: Effort) -> f64 {
    let of_pair = study.of_pair();
    of_pair.map_or(0.0, |(_, of)| of.certificate.reference[effort as usize])
}
