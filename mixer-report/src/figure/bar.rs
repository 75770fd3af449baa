//! The colour bar of a map.

use std::fmt::Write as _;

use crate::number::escaped;

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

    /// Draws the bar with its top left corner at a pixel, `height` px high.
    pub(super) fn draw(&self, svg: &mut String, [left, top]: [f64; 2], height: f64) {
        let span = self.range[1] - self.range[0];
        let y = |value: f64| top + height * (1.0 - (value - self.range[0]) / span);
        for (low, high, colour) in &self.bands {
            let _ = writeln!(
                svg,
                "<rect x=\"{left}\" y=\"{:.1}\" width=\"12\" height=\"{:.1}\" fill=\"{colour}\" stroke=\"{colour}\" stroke-width=\".5\"/>",
                y(*high),
                y(*low) - y(*high)
            );
        }
        for (value, text) in &self.ticks {
            let _ = writeln!(
                svg,
                "<text class=\"tick\" x=\"{}\" y=\"{:.1}\" dy=\".35em\">{}</text>",
                left + 17.0,
                y(*value),
                text
            );
        }
        let _ = writeln!(
            svg,
            "<text class=\"label\" transform=\"translate({} {}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
            left + 66.0,
            top + height / 2.0,
            escaped(&self.label)
        );
    }
}
