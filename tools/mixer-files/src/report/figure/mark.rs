//! Marks of a state, such as hover, at which the read-out begins.

use std::fmt::Write as _;

use super::{Figure, MARGIN};
use crate::report::number::escaped;

impl Figure {
    /// A vertical line with its word above the plot; the read-out begins there.
    pub fn mark_x(&mut self, x: f64, word: &str) {
        let [low, high] = self.axes[1].range;
        let data = self.path(&[[x, low], [x, high]], false);
        let _ = writeln!(self.layers, "<path class=\"mark\" d=\"{data}\"/>");
        let [px, _] = self.at([x, high]);
        let _ = writeln!(
            self.above,
            "<text class=\"mark-label\" x=\"{:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
            px.clamp(MARGIN[0], MARGIN[0] + self.size[0] - 20.0),
            MARGIN[1] - 3.0,
            escaped(word)
        );
        self.start = Some([x, 0.5 * (low + high)]);
    }

    /// The sign of a value within its point, for those who do not tell the colours apart.
    pub fn sign(&mut self, value: f64, radius: f64, point: [f64; 2], ink: &str) {
        let [x, y] = self.at(point);
        let half = 0.55 * radius;
        let upright = match value > 0.0 {
            true => format!("M{x:.1} {:.1}v{:.1}", y - half, 2.0 * half),
            false => String::new(),
        };
        let _ = writeln!(
            self.above,
            "<path class=\"sign\" stroke=\"{ink}\" d=\"M{:.1} {y:.1}h{:.1}{upright}\"/>",
            x - half,
            2.0 * half
        );
    }

    /// A diamond at every point; the read-out begins at the first.
    pub fn mark(&mut self, points: &[[f64; 2]], word: &str) {
        for &point in points {
            let [x, y] = self.at(point);
            let _ = writeln!(
                self.above,
                "<path class=\"mark-point\" d=\"M{x:.1} {:.1}l5 5l-5 5l-5 -5Z\"><title>{}</title></path>",
                y - 5.0,
                escaped(word)
            );
        }
        if let Some(&first) = points.first() {
            self.start = Some(first);
            self.entry("mark-dot", word);
        }
    }
}
