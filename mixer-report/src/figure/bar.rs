//! The colour bar of a map.

use std::fmt::Write as _;

use crate::number::escaped;

/// From the plot to the bar, px.
const GAP: f64 = 14.0;

/// From the left of the bar to its ticks, px.
const TICKS: f64 = 17.0;

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

    /// From the left of the bar to the middle of its label, px: clear of the longest tick, whose
    /// digits of 12 px type are 7.2 px wide on average.
    fn label_at(&self) -> f64 {
        let letters = self.ticks.iter().map(|(_, text)| text.chars().count()).max();
        (TICKS + 7.2 * letters.unwrap_or(0) as f64 + 12.0).max(66.0)
    }

    /// Room that the bar takes at the right of its plot, px.
    pub(super) fn room(&self) -> f64 {
        GAP + self.label_at() + 6.0
    }

    /// Draws the bar at the right of a plot with this top right corner, `height` px high.
    pub(super) fn draw(&self, svg: &mut String, [right, top]: [f64; 2], height: f64) {
        let left = right + GAP;
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
                left + TICKS,
                y(*value),
                text
            );
        }
        let _ = writeln!(
            svg,
            "<text class=\"label\" transform=\"translate({} {}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
            left + self.label_at(),
            top + height / 2.0,
            escaped(&self.label)
        );
    }
}
