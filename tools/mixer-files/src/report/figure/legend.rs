//! Names of curves: as a legend below the plot, or as rows of the page's read-out.

use std::fmt::Write as _;

use maud::{Markup, PreEscaped, html};

use crate::report::number::escaped;

/// Height of a row of the legend, px.
pub(super) const ROW: f64 = 18.0;

/// A class and a name.
pub(super) type Entry = (String, String);

/// Entries by rows of `width` px, each with its distance from the left edge of the plot.
pub(super) fn rows(entries: &[Entry], width: f64) -> Vec<Vec<(f64, &Entry)>> {
    let mut rows: Vec<Vec<(f64, &Entry)>> = Vec::new();
    let mut left = f64::INFINITY;
    for entry in entries {
        // A letter of 12 px type is at most 6.8 px wide on average.
        let needed = 28.0 + 6.8 * entry.1.chars().count() as f64 + 18.0;
        if left + needed > width {
            rows.push(Vec::new());
            left = 0.0;
        }
        if let Some(row) = rows.last_mut() {
            row.push((left, entry));
        }
        left += needed;
    }
    rows
}

/// Draws rows with their top left corner at a pixel.
pub(super) fn draw(svg: &mut String, [left, top]: [f64; 2], rows: &[Vec<(f64, &Entry)>]) {
    for (row, entries) in rows.iter().enumerate() {
        let y = top + ROW * (row as f64 + 0.4);
        for (from, (class, name)) in entries {
            let x = left + from;
            svg.push_str(&sample(class, [x, y]));
            let _ = writeln!(
                svg,
                "<text class=\"legend\" x=\"{}\" y=\"{y}\" dy=\".35em\">{}</text>",
                x + 28.0,
                escaped(name)
            );
        }
    }
}

/// A piece of a curve, or a point, 22 px wide.
fn sample(class: &str, [x, y]: [f64; 2]) -> String {
    let is = |wanted: &str| class.split(' ').any(|word| word == wanted);
    // A mark is the diamond of [`Figure::mark`]; `dotted` and `dash-dot` are lines.
    if is("mark-dot") {
        let (x, y) = (x + 11.0, y - 5.0);
        format!("<path class=\"{class}\" d=\"M{x} {y}l5 5l-5 5l-5 -5Z\"/>\n")
    } else if is("dot") {
        format!(
            "<circle class=\"{class}\" cx=\"{}\" cy=\"{y}\" r=\"3.5\"/>\n",
            x + 11.0
        )
    } else {
        format!("<path class=\"line {class}\" d=\"M{x} {y}h22\"/>\n")
    }
}

/// One value of a read-out. The page's script fills the `output`; its room is there from the
/// start, so that values do not move the page.
pub(super) fn reading(class: Option<&str>, name: &str, unit: &str) -> Markup {
    html! {
        span {
            @if let Some(class) = class {
                svg class="figure key" viewBox="0 0 22 10" aria-hidden="true" {
                    (PreEscaped(sample(class, [0.0, 5.0])))
                }
            }
            (name) " " output { "\u{2013}" } " " (unit)
        }
    }
}

/// Name and unit of an axis' label: `thrust f (N)` is `thrust f` in `N`.
pub(super) fn parted(label: &str) -> (&str, &str) {
    match label.strip_suffix(')').and_then(|text| text.rsplit_once(" (")) {
        Some((name, unit)) => (name, unit),
        None => (label, ""),
    }
}

#[cfg(test)]
mod tests {
    use super::parted;

    #[test]
    fn labels_end_in_their_unit() {
        assert_eq!(parted("total thrust (N)"), ("total thrust", "N"));
        assert_eq!(parted("upper throttle u"), ("upper throttle u", ""));
    }
}
