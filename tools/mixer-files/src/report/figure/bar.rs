//! The colour bar of a map.

use std::fmt::Write as _;

use crate::report::number::escaped;

/// Room that a bar takes at the right of its plot, px: ticks of seven digits, each 7.2 px wide on
/// average in 12 px type, and the label.
pub(super) const ROOM: f64 = 94.0;

/// From the plot to the bar, px.
const GAP: f64 = 12.0;

/// From the left of the bar to its ticks, px.
const TICKS: f64 = 16.0;

/// Bands of colour with ticks and a label.
#[derive(Clone, Debug)]
pub(super) struct Bar {
    label: String,
    /// (value, text).
    ticks: Vec<(f64, String)>,
    range: [f64; 2],
    /// (lower end, upper end, colour).
    bands: Vec<(f64, f64, String)>,
}

impl Bar {
    /// A bar of bands `(low, high, colour)` in ascending order; `None` without any.
    pub(super) fn new(
        label: &str,
        bands: Vec<(f64, f64, String)>,
        ticks: Vec<(f64, String)>,
    ) -> Option<Self> {
        let range = [bands.first()?.0, bands.last()?.1];
        Some(Bar {
            label: label.to_owned(),
            ticks,
            range,
            bands,
        })
    }

    /// Draws the bar at the right of a plot with this top right corner, `height` px high.
    pub(super) fn draw(&self, svg: &mut String, [right, top]: [f64; 2], height: f64) {
        let left = right + GAP;
        let span = self.range[1] - self.range[0];
        let y = |value: f64| top + height * (1.0 - (value - self.range[0]) / span);
        // From the top; each reaches a pixel into the next, which is painted over it: no gaps.
        for (low, high, colour) in self.bands.iter().rev() {
            let _ = writeln!(
                svg,
                "<path fill=\"{colour}\" d=\"M{left} {:.1}h12V{:.1}h-12\"/>",
                y(*high),
                (y(*low) + 1.0).min(top + height)
            );
        }
        for (value, text) in &self.ticks {
            let _ = writeln!(
                svg,
                "<text class=\"tick\" x=\"{}\" y=\"{:.1}\" dy=\".35em\">{}</text>",
                left + TICKS,
                y(*value),
                text
            );
        }
        let letters = self.ticks.iter().map(|(_, text)| text.chars().count()).max();
        let letters = letters.unwrap_or(0);
        let _ = writeln!(
            svg,
            "<text class=\"label\" transform=\"translate({} {}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
            left + (TICKS + 7.2 * letters as f64 + 18.0).min(ROOM - GAP - 5.0),
            top + height / 2.0,
            escaped(&self.label)
        );
    }
}
