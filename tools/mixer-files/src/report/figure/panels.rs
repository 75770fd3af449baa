//! Several plots as one picture.

use std::fmt::Write as _;

use super::{Figure, WIDTH};
use crate::report::number::escaped;

/// Where the title and the headings of the columns stand, and where the plots begin, px.
const ROWS: [f64; 3] = [22.0, 50.0, 56.0];

impl Figure {
    /// Plots in columns, each below its heading, and all below a title.
    pub(in crate::report) fn panels(title: &str, columns: &[(String, Vec<Figure>)]) -> String {
        let [first, second, begin] = ROWS;
        let (mut inner, mut bottom, mut left) = (String::new(), begin, 0.0);
        let heading = |x: f64, y: f64, size: u8, text: &str| {
            let text = escaped(text);
            format!("<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" text-anchor=\"middle\">{text}</text>\n")
        };
        for (name, figures) in columns {
            inner += &heading(left + 0.5 * WIDTH, second, 14, name);
            let mut top = begin;
            for figure in figures {
                let (plot, height) = figure.inner(&figure.legend);
                let _ = write!(inner, "<g transform=\"translate({left} {top})\">\n{plot}</g>\n");
                top += height;
            }
            bottom = bottom.max(top);
            left += WIDTH;
        }
        inner += &heading(0.5 * left, first, 16, title);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"figure\" viewBox=\"0 0 {left} {bottom}\" \
             role=\"img\" aria-label=\"{}\">\n{inner}</svg>\n",
            escaped(title)
        )
    }
}
