//! One plot: axes with units, and layers of curves, areas and points, as SVG.
//!
//! Colours that belong to the page (ink, grid, series) are CSS classes, so that one picture serves
//! light, dark and paper; those of colour maps are part of the data and written out. `data-`
//! attributes tell the page's script how pixels become quantities.

mod bar;
mod path;

use std::fmt::Write as _;

use self::bar::Bar;
use self::path::Label;
use crate::number::{Ticks, escaped, pixel};

/// Room around the plot for labels, px: left, top, right, bottom.
const MARGIN: [f64; 4] = [74.0, 14.0, 16.0, 46.0];

/// Room for a colour bar at the right, px.
const BAR_ROOM: f64 = 86.0;

/// Values of iso-curves keep this distance, px.
const LABEL_ROOM: f64 = 15.0;

/// Where on a curve its value is tried, as shares of the length.
const LABEL_PLACES: [f64; 9] = [0.5, 0.45, 0.55, 0.4, 0.6, 0.33, 0.67, 0.25, 0.75];

/// Height of a row of the legend, px.
const LEGEND_ROW: f64 = 18.0;

/// One axis.
#[derive(Clone, Debug)]
pub struct Axis {
    /// Quantity and unit.
    pub label: String,
    /// Values at its ends.
    pub range: [f64; 2],
}

/// A plot under construction.
#[derive(Clone, Debug)]
pub struct Figure {
    title: String,
    axes: [Axis; 2],
    size: [f64; 2],
    below: String,
    layers: String,
    above: String,
    legend: Vec<(String, String)>,
    bar: Option<Bar>,
    hover: String,
    /// Where values stand on iso-curves.
    labels: Vec<[f64; 2]>,
}

impl Figure {
    /// An empty plot; `title` is for those who do not see it.
    pub fn new(title: impl Into<String>, x: (&str, [f64; 2]), y: (&str, [f64; 2])) -> Self {
        let axis = |(label, range): (&str, [f64; 2])| Axis {
            label: label.to_owned(),
            range,
        };
        Figure {
            title: title.into(),
            axes: [axis(x), axis(y)],
            size: [372.0, 290.0],
            below: String::new(),
            layers: String::new(),
            above: String::new(),
            legend: Vec::new(),
            bar: None,
            hover: String::new(),
            labels: Vec::new(),
        }
    }

    /// The size of the plot itself without its labels, px.
    #[must_use]
    pub fn sized(mut self, width: f64, height: f64) -> Self {
        self.size = [width, height];
        self
    }

    /// One unit of x as long as one of y: the shorter axis is widened about its middle.
    #[must_use]
    pub fn equal_scales(mut self) -> Self {
        let span = |axis: &Axis| axis.range[1] - axis.range[0];
        let per_pixel = [0, 1].map(|k| span(&self.axes[k]) / self.size[k]);
        let coarser = per_pixel[0].max(per_pixel[1]);
        for (axis, size) in self.axes.iter_mut().zip(self.size) {
            let room = 0.5 * (coarser * size - (axis.range[1] - axis.range[0]));
            axis.range = [axis.range[0] - room, axis.range[1] + room];
        }
        self
    }

    /// What the page's script shows at the pointer: `curves`, `plane`, or a map's kind.
    #[must_use]
    pub fn hovering(mut self, kind: &str) -> Self {
        self.hover = kind.to_owned();
        self
    }

    /// The pixel of a point.
    pub fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let share = |axis: &Axis, value: f64| (value - axis.range[0]) / (axis.range[1] - axis.range[0]);
        [
            MARGIN[0] + self.size[0] * share(&self.axes[0], x),
            MARGIN[1] + self.size[1] * (1.0 - share(&self.axes[1], y)),
        ]
    }

    /// SVG path data through points; closed for an area. Points that are not finite break it.
    pub fn path(&self, points: &[[f64; 2]], closed: bool) -> String {
        let pixels: Vec<[f64; 2]> = points.iter().map(|&point| self.at(point)).collect();
        let mut data = String::new();
        for part in pixels.split(|pixel| !pixel.iter().all(|x| x.is_finite())) {
            for (index, [x, y]) in path::simplified(part).into_iter().enumerate() {
                data.push(if index == 0 { 'M' } else { 'L' });
                pixel(&mut data, x);
                data.push(' ');
                pixel(&mut data, y);
            }
            if closed && !part.is_empty() {
                data.push('Z');
            }
        }
        data
    }

    /// A curve of a series, with its name in the legend where it has one.
    pub fn curve(&mut self, class: &str, name: &str, points: &[[f64; 2]]) {
        self.unlisted_curve(class, name, points);
        self.entry(class, name);
    }

    /// A curve whose name is shown under the pointer only.
    pub fn unlisted_curve(&mut self, class: &str, name: &str, points: &[[f64; 2]]) {
        let data = self.path(points, false);
        let _ = writeln!(
            self.layers,
            "<path class=\"line {class}\" data-name=\"{}\" d=\"{data}\"/>",
            escaped(name)
        );
    }

    /// A closed line without filling.
    pub fn outline(&mut self, class: &str, name: &str, points: &[[f64; 2]]) {
        let data = self.path(points, true);
        let title = match name {
            "" => String::new(),
            name => format!("<title>{}</title>", escaped(name)),
        };
        let _ = writeln!(
            self.layers,
            "<path class=\"line {class}\" d=\"{data}\">{title}</path>"
        );
        self.entry(class, name);
    }

    /// An area of any number of rings (even-odd) in a colour of the data.
    pub fn area(&mut self, rings: &[Vec<[f64; 2]>], colour: &str) {
        let mut data = String::new();
        for ring in rings {
            data.push_str(&self.path(ring, true));
        }
        // The stroke closes the hairline between neighbours.
        let _ = writeln!(
            self.below,
            "<path fill=\"{colour}\" stroke=\"{colour}\" stroke-width=\".6\" fill-rule=\"evenodd\" d=\"{data}\"/>"
        );
    }

    /// Iso-curves in a given ink with their value written on the longest of them.
    pub fn iso_curves(&mut self, lines: &[Vec<[f64; 2]>], ink: &str, text: &str) {
        let mut data = String::new();
        for line in lines {
            data.push_str(&self.path(line, false));
        }
        if data.is_empty() {
            return;
        }
        let _ = writeln!(self.layers, "<path class=\"iso\" stroke=\"{ink}\" d=\"{data}\"/>");
        let Some(longest) = lines.iter().max_by_key(|line| line.len()) else {
            return;
        };
        let pixels: Vec<[f64; 2]> = longest.iter().map(|&p| self.at(p)).collect();
        let is_free = |label: &Label| {
            let far =
                |other: &[f64; 2]| libm::hypot(other[0] - label.at[0], other[1] - label.at[1]) >= LABEL_ROOM;
            self.labels.iter().all(far)
        };
        let mut places = LABEL_PLACES
            .iter()
            .filter_map(|share| Label::along(&pixels, *share));
        let Some(label) = places.find(is_free) else {
            return;
        };
        self.labels.push(label.at);
        let halo = if ink == "#000" { "#fff" } else { "#000" };
        let _ = writeln!(
            self.above,
            "<text class=\"iso-label\" fill=\"{ink}\" stroke=\"{halo}\" transform=\"translate({:.1} {:.1}) rotate({:.0})\" \
             dy=\".32em\">{text}</text>",
            label.at[0], label.at[1], label.degrees
        );
    }

    /// A point with its numbers for the pointer.
    pub fn dot(&mut self, class: &str, radius: f64, point: [f64; 2], title: &str) {
        let [x, y] = self.at(point);
        let _ = writeln!(
            self.above,
            "<circle class=\"{class}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\"><title>{}</title></circle>",
            escaped(title)
        );
    }

    /// A point in a colour of the data with its numbers for the pointer.
    pub fn coloured_dot(&mut self, colour: &str, radius: f64, point: [f64; 2], title: &str) {
        let [x, y] = self.at(point);
        let _ = writeln!(
            self.above,
            "<circle class=\"residual\" fill=\"{colour}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\"><title>{}</title></circle>",
            escaped(title)
        );
    }

    /// Values of iso-curves keep clear of these points.
    pub fn keep_clear(&mut self, points: impl IntoIterator<Item = [f64; 2]>) {
        for point in points {
            let pixel = self.at(point);
            self.labels.push(pixel);
        }
    }

    /// Words at a point; `class` also sets the alignment.
    pub fn text(&mut self, class: &str, point: [f64; 2], text: &str) {
        let [x, y] = self.at(point);
        let _ = writeln!(
            self.above,
            "<text class=\"{class}\" x=\"{x:.1}\" y=\"{y:.1}\">{}</text>",
            escaped(text)
        );
    }

    /// SVG of the caller's own in pixels of this plot.
    pub fn raw(&mut self, svg: &str) {
        self.layers.push_str(svg);
        self.layers.push('\n');
    }

    /// A horizontal line over the whole width.
    pub fn level(&mut self, class: &str, name: &str, y: f64) {
        let [low, high] = self.axes[0].range;
        self.curve(class, name, &[[low, y], [high, y]]);
    }

    /// A line of the legend.
    pub fn entry(&mut self, class: &str, name: &str) {
        if !name.is_empty() && !self.legend.iter().any(|(_, known)| known == name) {
            self.legend.push((class.to_owned(), name.to_owned()));
        }
    }

    /// The colour bar of a map: bands `(low, high, colour)` in ascending order, ticks `(value,
    /// text)`.
    pub fn colour_bar(&mut self, label: &str, bands: Vec<(f64, f64, String)>, ticks: Vec<(f64, String)>) {
        self.bar = Bar::new(label, bands, ticks);
    }

    /// The picture for a page that has the classes.
    pub fn svg(&self) -> String {
        let [width, height] = self.size;
        let rows = self.legend_rows();
        let full_width = MARGIN[0] + width + if self.bar.is_some() { BAR_ROOM } else { MARGIN[2] };
        let full_height = MARGIN[1] + height + MARGIN[3] + LEGEND_ROW * rows.len() as f64;
        let [x, y] = &self.axes;
        let mut svg = String::new();
        let _ = writeln!(
            svg,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"figure\" viewBox=\"0 0 {full_width} {full_height}\" \
             role=\"img\" aria-label=\"{}\" data-hover=\"{}\" data-x=\"{:?} {:?}\" data-y=\"{:?} {:?}\" \
             data-box=\"{} {} {width} {height}\" data-labels=\"{}|{}\">",
            escaped(&self.title),
            self.hover,
            x.range[0],
            x.range[1],
            y.range[0],
            y.range[1],
            MARGIN[0],
            MARGIN[1],
            escaped(&x.label),
            escaped(&y.label)
        );
        svg.push_str(&self.below);
        self.frame(&mut svg);
        svg.push_str(&self.layers);
        svg.push_str(&self.above);
        if let Some(bar) = &self.bar {
            let left = MARGIN[0] + self.size[0] + 14.0;
            bar.draw(&mut svg, [left, MARGIN[1]], self.size[1]);
        }
        for (row, entries) in rows.iter().enumerate() {
            let y = MARGIN[1] + height + MARGIN[3] + LEGEND_ROW * (row as f64 + 0.4);
            for (left, (class, name)) in entries {
                let x = MARGIN[0] + left;
                if class.contains("dot") {
                    let _ = writeln!(
                        svg,
                        "<circle class=\"{class}\" cx=\"{}\" cy=\"{y}\" r=\"3.5\"/>",
                        x + 11.0
                    );
                } else {
                    let _ = writeln!(svg, "<path class=\"line {class}\" d=\"M{x} {y}h22\"/>");
                }
                let _ = writeln!(
                    svg,
                    "<text class=\"legend\" x=\"{}\" y=\"{y}\" dy=\".35em\">{}</text>",
                    x + 28.0,
                    escaped(name)
                );
            }
        }
        svg.push_str("</svg>\n");
        svg
    }

    /// Grid, frame, ticks and labels.
    fn frame(&self, svg: &mut String) {
        let [left, top] = [MARGIN[0], MARGIN[1]];
        let [width, height] = self.size;
        let (right, bottom) = (left + width, top + height);
        let map = self.bar.is_some();
        let mut grid = String::new();
        let mut marks = String::new();
        let mut words = String::new();
        let ticks = Ticks::within(self.axes[0].range, (width / 62.0) as usize);
        for &value in &ticks.values {
            let [x, _] = self.at([value, self.axes[1].range[0]]);
            let _ = write!(grid, "M{x:.1} {top}V{bottom}");
            let _ = write!(marks, "M{x:.1} {bottom}v5");
            let _ = writeln!(
                words,
                "<text class=\"tick\" x=\"{x:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
                bottom + 18.0,
                ticks.text(value)
            );
        }
        let ticks = Ticks::within(self.axes[1].range, (height / 42.0) as usize);
        for &value in &ticks.values {
            let [_, y] = self.at([self.axes[0].range[0], value]);
            let _ = write!(grid, "M{left} {y:.1}H{right}");
            let _ = write!(marks, "M{left} {y:.1}h-5");
            let _ = writeln!(
                words,
                "<text class=\"tick\" x=\"{}\" y=\"{y:.1}\" dy=\".35em\" text-anchor=\"end\">{}</text>",
                left - 8.0,
                ticks.text(value)
            );
        }
        if !map {
            let _ = writeln!(svg, "<path class=\"grid\" d=\"{grid}\"/>");
        }
        let _ = writeln!(
            svg,
            "<path class=\"frame\" d=\"{marks}M{left} {top}H{right}V{bottom}H{left}Z\"/>\n{words}\
             <text class=\"label\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n\
             <text class=\"label\" transform=\"translate(14 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
            left + width / 2.0,
            bottom + 38.0,
            escaped(&self.axes[0].label),
            top + height / 2.0,
            escaped(&self.axes[1].label)
        );
    }

    /// Legend entries by rows, each with its distance from the left edge of the plot.
    fn legend_rows(&self) -> Vec<Vec<(f64, &(String, String))>> {
        let mut rows: Vec<Vec<(f64, &(String, String))>> = Vec::new();
        let mut left = f64::INFINITY;
        for entry in &self.legend {
            // A letter of 12 px type is at most 6.8 px wide on average.
            let width = 28.0 + 6.8 * entry.1.chars().count() as f64 + 18.0;
            if left + width > self.size[0] + MARGIN[2] + 18.0 {
                rows.push(Vec::new());
                left = 0.0;
            }
            if let Some(row) = rows.last_mut() {
                row.push((left, entry));
            }
            left += width;
        }
        rows
    }
}
