//! What the page's script reads in a figure, and the room for it.

use maud::{Markup, PreEscaped, html};

use super::{Figure, MARGIN, legend};

impl Figure {
    /// What the page's script reads at the pointer or by the keyboard: all `curves` at one x, thrust
    /// and torque of a place in the `plane`, the values of the nearest of `dots`, or what the maps
    /// (`forward`, `inverse`, `error-thrust`, `error-torque`) are there.
    #[must_use]
    pub fn reading(mut self, hover: &'static str, quantities: &[(&str, &str)]) -> Self {
        self.hover = hover;
        let owned = |(name, unit): &(&str, &str)| ((*name).to_owned(), (*unit).to_owned());
        self.quantities = quantities.iter().map(owned).collect();
        self
    }

    /// Every curve is read at one x.
    #[must_use]
    pub fn reading_curves(self) -> Self {
        self.reading("curves", &[])
    }

    /// The picture for the page's script, with the read-out below it. Where curves are read, their
    /// names stand there and not in a legend.
    pub fn with_readout(&self) -> Markup {
        let (svg, x) = match self.hover {
            "curves" => (self.drawn(&[]), legend::parted(&self.axes[0].label)),
            _ => (self.svg(), ("", "")),
        };
        let unit = legend::parted(&self.axes[1].label).1;
        html! {
            (PreEscaped(svg))
            div.readout {
                @if self.hover == "curves" {
                    (legend::reading(None, x.0, x.1))
                    @for (class, name) in &self.curves { (legend::reading(Some(class), name, unit)) }
                } @else {
                    @for (name, unit) in &self.quantities { (legend::reading(None, name, unit)) }
                }
            }
        }
    }

    /// What the page's script needs to turn pixels into quantities; the picture itself is reached
    /// by the Tab key where its curves are not.
    pub(super) fn attributes(&self) -> String {
        if self.hover.is_empty() {
            return String::new();
        }
        let [[left, right], [bottom, top]] = [&self.axes[0].range, &self.axes[1].range];
        let [x, y] = self.start.unwrap_or([0.5 * (left + right), 0.5 * (bottom + top)]);
        let focus = match self.is_along_curves() {
            true => "",
            false => " tabindex=\"0\"",
        };
        format!(
            "{focus} data-hover=\"{}\" data-x=\"{left:?} {right:?}\" data-y=\"{bottom:?} {top:?}\" \
             data-box=\"{} {} {} {}\" data-at=\"{x:?} {y:?}\"",
            self.hover, MARGIN[0], MARGIN[1], self.size[0], self.size[1]
        )
    }

    /// Whether the Tab key reaches the curves; else it reaches the picture.
    pub(super) fn is_along_curves(&self) -> bool {
        matches!(self.hover, "curves" | "plane")
    }
}
