//! One plot: axes with units, and layers of curves, areas and points, as SVG.
//!
//! Colours that belong to the page (ink, grid, series) are CSS classes, so that one picture serves
//! light, dark and paper; those of colour maps are part of the data and written out. `data-`
//! attributes tell the page's script how pixels become quantities.

mod bar;
mod curves;
mod legend;
mod mark;
mod panels;
pub(crate) mod path;
mod reading;

use std::fmt::Write as _;

use self::bar::Bar;
use self::path::Label;
use crate::report::number::{Ticks, escaped};

/// Width of every picture, px: no less than it is shown at on a phone, or in a column of the page,
/// so that its type of 12 px is no smaller there.
pub(crate) const WIDTH: f64 = 360.0;

/// Room around the plot for labels, px: left, top, right, bottom.
const MARGIN: [f64; 4] = [66.0, 12.0, 14.0, 44.0];

/// Distances of an iso-curve's value from others and from points, px: below the first it is left
/// out, and beyond the second a place nearer the curve's middle is preferred.
const LABEL_ROOM: [f64; 2] = [11.0, 18.0];

/// Where on a curve its value is tried, as shares of the length.
const LABEL_PLACES: [f64; 9] = [0.5, 0.45, 0.55, 0.4, 0.6, 0.33, 0.67, 0.25, 0.75];

/// One axis.
#[derive(Clone, Debug, Default)]
pub struct Axis {
    /// Quantity and unit.
    pub label: String,
    /// Values at its ends.
    pub range: [f64; 2],
}

/// A plot under construction.
#[derive(Clone, Debug, Default)]
pub struct Figure {
    title: String,
    axes: [Axis; 2],
    size: [f64; 2],
    /// Areas of colour, the later ones above.
    areas: String,
    layers: String,
    above: String,
    legend: Vec<legend::Entry>,
    bar: Option<Bar>,
    /// What it tells at the pointer, by the name that the page's script knows; empty for nothing.
    hover: &'static str,
    /// Quantities of the read-out with their units.
    quantities: Vec<(String, String)>,
    /// Curves with names.
    curves: Vec<legend::Entry>,
    /// Their points.
    series: Vec<(String, Vec<[f64; 2]>)>,
    /// Where the read-out begins; the middle where nothing is marked.
    start: Option<[f64; 2]>,
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
            size: [WIDTH - MARGIN[0] - MARGIN[2], 220.0],
            ..Figure::default()
        }
    }

    /// The height of the plot itself without its labels, px.
    #[must_use]
    pub fn high(mut self, height: f64) -> Self {
        self.size[1] = height;
        self
    }

    /// A plot that leaves room for a colour bar, `height` px high without its labels.
    #[must_use]
    pub fn beside_bar(mut self, height: f64) -> Self {
        self.size = [WIDTH - MARGIN[0] - bar::ROOM, height];
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
        let parts = pixels.split(|pixel| !pixel.iter().all(|x| x.is_finite()));
        parts.map(|part| path::data(part, closed)).collect()
    }

    /// A curve of a series, with its name in the legend where it has one.
    pub fn curve(&mut self, class: &str, name: &str, points: &[[f64; 2]]) {
        self.unlisted_curve(class, name, points);
        self.entry(class, name);
    }

    /// A curve whose name stands in the read-out only. With a name it is reached by the Tab key.
    pub fn unlisted_curve(&mut self, class: &str, name: &str, points: &[[f64; 2]]) {
        self.line(class, name, points, false);
    }

    /// A closed line without filling.
    pub fn outline(&mut self, class: &str, name: &str, points: &[[f64; 2]]) {
        self.line(class, name, points, true);
        self.entry(class, name);
    }

    fn line(&mut self, class: &str, name: &str, points: &[[f64; 2]], closed: bool) {
        let data = self.path(points, closed);
        let mut named = String::new();
        if !name.is_empty() {
            self.series.push((name.to_owned(), points.to_vec()));
            self.curves.push((class.to_owned(), name.to_owned()));
            let focus = match self.is_along_curves() {
                true => " tabindex=\"0\"",
                false => "",
            };
            let name = escaped(name);
            named = format!(" data-name=\"{name}\"{focus} role=\"img\" aria-label=\"{name}\"");
        }
        let _ = writeln!(self.layers, "<path class=\"line {class}\"{named} d=\"{data}\"/>");
    }

    /// An area of any number of rings (even-odd) in a colour of the data.
    pub fn area(&mut self, rings: &[Vec<[f64; 2]>], colour: &str) {
        let mut data = String::new();
        for ring in rings {
            data.push_str(&self.path(ring, true));
        }
        let _ = writeln!(self.areas, "<path fill=\"{colour}\" d=\"{data}\"/>");
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
        let [least, enough] = LABEL_ROOM;
        let room = |[x, y]: [f64; 2]| {
            let others = self
                .labels
                .iter()
                .map(|other| libm::hypot(other[0] - x, other[1] - y));
            others.fold(enough, f64::min)
        };
        let places = LABEL_PLACES.iter().rev();
        let places = places.filter_map(|share| Label::along(&pixels, *share));
        let places = places.map(|label| (room(label.at), label));
        // Of equals the last, which is that nearest the middle.
        let best = places.max_by(|(a, _), (b, _)| a.total_cmp(b));
        let Some((_, label)) = best.filter(|(room, _)| *room >= least) else {
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

    /// Points without numbers.
    pub fn cloud(&mut self, class: &str, radius: f64, points: &[[f64; 2]]) {
        if points.is_empty() {
            return;
        }
        let _ = writeln!(self.above, "<g class=\"{class}\">");
        for point in points {
            let [x, y] = self.at(*point);
            let _ = writeln!(self.above, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\"/>");
        }
        self.above.push_str("</g>\n");
    }

    /// A point whose values the read-out shows, in the order of its quantities; `paint` is a class
    /// or a colour as an attribute.
    pub fn read_dot(&mut self, paint: &str, radius: f64, point: [f64; 2], values: &[String]) {
        let [x, y] = self.at(point);
        let _ = writeln!(
            self.above,
            "<circle {paint} cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" data-values=\"{}\"/>",
            escaped(&values.join("|"))
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
        self.drawn(&self.legend)
    }

    fn drawn(&self, entries: &[legend::Entry]) -> String {
        let (inner, height) = self.inner(entries);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"figure\" viewBox=\"0 0 {WIDTH} {height}\" \
             role=\"{}\" aria-label=\"{}\"{}>\n{inner}</svg>\n",
            if self.is_along_curves() { "group" } else { "img" },
            escaped(&self.title),
            self.attributes()
        )
    }

    /// The content of the SVG element, and its height, px.
    fn inner(&self, entries: &[legend::Entry]) -> (String, f64) {
        let height = self.size[1];
        let rows = legend::rows(entries, WIDTH - MARGIN[0]);
        let mut svg = String::new();
        if !self.areas.is_empty() {
            let _ = write!(svg, "<g class=\"areas\">\n{}</g>\n", self.areas);
        }
        self.frame(&mut svg);
        svg.push_str(&self.layers);
        svg.push_str(&self.above);
        if let Some(bar) = &self.bar {
            bar.draw(&mut svg, [MARGIN[0] + self.size[0], MARGIN[1]], self.size[1]);
        }
        legend::draw(&mut svg, [MARGIN[0], MARGIN[1] + height + MARGIN[3]], &rows);
        let full_height = MARGIN[1] + height + MARGIN[3] + legend::ROW * rows.len() as f64;
        (svg, full_height)
    }

    /// Grid, frame, ticks and labels.
    fn frame(&self, svg: &mut String) {
        let [left, top] = [MARGIN[0], MARGIN[1]];
        let [width, height] = self.size;
        let (right, bottom) = (left + width, top + height);
        let (mut grid, mut marks, mut words) = (String::new(), String::new(), String::new());
        let ticks = Ticks::within(self.axes[0].range, (width / 50.0) as usize);
        for &value in &ticks.values {
            let [x, _] = self.at([value, self.axes[1].range[0]]);
            let (y, text) = (bottom + 18.0, ticks.text(value));
            let _ = write!(grid, "M{x:.1} {top}V{bottom}");
            let _ = write!(marks, "M{x:.1} {bottom}v5");
            let place = format!("x=\"{x:.1}\" y=\"{y}\" text-anchor=\"middle\"");
            let _ = writeln!(words, "<text class=\"tick\" {place}>{text}</text>");
        }
        let ticks = Ticks::within(self.axes[1].range, (height / 36.0) as usize);
        for &value in &ticks.values {
            let [_, y] = self.at([self.axes[0].range[0], value]);
            let (x, text) = (left - 8.0, ticks.text(value));
            let _ = write!(grid, "M{left} {y:.1}H{right}");
            let _ = write!(marks, "M{left} {y:.1}h-5");
            let place = format!("x=\"{x}\" y=\"{y:.1}\" dy=\".35em\" text-anchor=\"end\"");
            let _ = writeln!(words, "<text class=\"tick\" {place}>{text}</text>");
        }
        if self.bar.is_none() {
            let _ = writeln!(svg, "<path class=\"grid\" d=\"{grid}\"/>");
        }
        let _ = writeln!(
            svg,
            "<path class=\"frame\" d=\"{marks}M{left} {top}H{right}V{bottom}H{left}Z\"/>\n{words}\
             <text class=\"label\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n\
             <text class=\"label\" transform=\"translate(13 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
            left + width / 2.0,
            bottom + 38.0,
            escaped(&self.axes[0].label),
            top + height / 2.0,
            escaped(&self.axes[1].label)
        );
    }
}
