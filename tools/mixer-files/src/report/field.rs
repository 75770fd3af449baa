//! A scalar over the throttle box as a colour map with iso-curves.
//!
//! Bands and curves are traced on a grid in the throttle box and drawn through a projection: the
//! identity for forward maps over (u, l), the forward map itself for maps over the attainable set
//! of (f, Q). The latter needs no masking: the image of the box is the set, and its border is
//! exact.

use contour::ContourBuilder;

use crate::report::colour::Scale;
use crate::report::figure::Figure;
use crate::report::number::Ticks;

/// A scalar on a grid over the unit square.
#[derive(Clone, Debug)]
pub struct Field {
    side: usize,
    values: Vec<f64>,
}

/// Rings or lines of points `[s, t]` in the unit square.
type Lines = Vec<Vec<[f64; 2]>>;

impl Field {
    /// `value` at `side` x `side` points of the unit square, the first coordinate fastest.
    pub fn new(side: usize, mut value: impl FnMut([f64; 2]) -> f64) -> Self {
        let share = |k: usize| k as f64 / (side - 1) as f64;
        let values = (0..side * side)
            .map(|k| value([share(k % side), share(k / side)]))
            .collect();
        Field { side, values }
    }

    /// All values, the first coordinate fastest.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Every `stride`-th row, of each every `stride`-th value.
    pub fn rows(&self, stride: usize) -> impl Iterator<Item = impl Iterator<Item = &f64>> {
        self.values
            .chunks(self.side)
            .step_by(stride)
            .map(move |row| row.iter().step_by(stride))
    }

    /// Points per side.
    pub fn side(&self) -> usize {
        self.side
    }

    /// Rings around the region where the scalar is at least `level`.
    fn rings(&self, level: f64) -> Lines {
        // Samples lie in the middle of the crate's cells, and what is beyond the grid counts as
        // below the level: rings close half a cell outside, which clamping brings back to the
        // border.
        let cell = |x: f64| ((x - 0.5) / (self.side - 1) as f64).clamp(0.0, 1.0);
        let Ok(lines) = ContourBuilder::new(self.side, self.side, true).lines(&self.values, &[level]) else {
            // The only error is a grid of another size.
            return Vec::new();
        };
        let rings = lines.into_iter().flat_map(|line| line.into_inner().0.0);
        let clamped = rings.map(|ring| ring.0.iter().map(|at| [cell(at.x), cell(at.y)]).collect());
        clamped.collect()
    }

    /// The parts of the rings that are not the square's border.
    fn iso_curves(&self, level: f64) -> Lines {
        let mut curves: Lines = Vec::new();
        for mut ring in self.rings(level) {
            // Begin at the border, so that no curve is cut in its middle.
            ring.pop();
            let start = ring.windows(2).position(|pair| on_one_edge(pair[0], pair[1]));
            if let Some(start) = start {
                ring.rotate_left(start + 1);
            }
            if let Some(&first) = ring.first() {
                ring.push(first);
            }
            let mut curve: Vec<[f64; 2]> = Vec::new();
            for pair in ring.windows(2) {
                if on_one_edge(pair[0], pair[1]) {
                    if curve.len() > 1 {
                        curves.push(std::mem::take(&mut curve));
                    }
                    curve.clear();
                } else {
                    if curve.is_empty() {
                        curve.push(pair[0]);
                    }
                    curve.push(pair[1]);
                }
            }
            if curve.len() > 1 {
                curves.push(curve);
            }
        }
        curves
    }
}

fn on_one_edge(a: [f64; 2], b: [f64; 2]) -> bool {
    (0..2).any(|k| a[k] == b[k] && (a[k] == 0.0 || a[k] == 1.0))
}

/// How a field is painted.
#[derive(Clone, Debug)]
pub struct Painting<'a> {
    /// Colours.
    pub scale: Scale,
    /// Ends of the colour bar.
    pub range: [f64; 2],
    /// About so many round levels.
    pub levels: usize,
    /// Bands of colour between two levels.
    pub bands: usize,
    /// Whether levels are drawn as iso-curves with their values.
    pub iso_curves: bool,
    /// Ticks of the bar, `(value, text)`; `None` for the levels.
    pub ticks: Option<Vec<(f64, String)>>,
    /// Quantity and unit beside the bar.
    pub label: &'a str,
}

/// Paints `field` into `figure`, each point `[s, t]` of the unit square at `project([s, t])`.
pub fn paint(
    figure: &mut Figure,
    field: &Field,
    painting: &Painting<'_>,
    project: impl Fn([f64; 2]) -> [f64; 2],
) {
    let levels = Ticks::within(painting.range, painting.levels);
    let [low, high] = painting.range;
    let step = levels.step() / painting.bands.max(1) as f64;
    let mut edges = vec![low];
    if let (Some(&first), true) = (levels.values.first(), step > 0.0) {
        let from = libm::ceil((low - first) / step) as i64;
        let to = libm::floor((high - first) / step) as i64;
        let inner = (from..=to).map(|k| first + k as f64 * step);
        edges.extend(inner.filter(|x| *x > low + 1e-3 * step && *x < high - 1e-3 * step));
    }
    edges.push(high);
    let mut bands = Vec::new();
    for (index, pair) in edges.windows(2).enumerate() {
        let colour = painting.scale.hex(0.5 * (pair[0] + pair[1]));
        // Each area also covers all higher ones, which are painted over it: no gaps.
        let level = if index == 0 { f64::MIN } else { pair[0] };
        let rings = project_all(&field.rings(level), &project);
        if !rings.is_empty() {
            figure.area(&rings, &colour);
        }
        bands.push((pair[0], pair[1], colour));
    }
    let ticks = painting.ticks.clone().unwrap_or_else(|| levels.texts());
    figure.colour_bar(painting.label, bands, ticks);
    let curves = levels.values.iter().filter(|_| painting.iso_curves);
    for &level in curves {
        let curves = project_all(&field.iso_curves(level), &project);
        figure.iso_curves(&curves, painting.scale.ink(level), &levels.text(level));
    }
}

fn project_all(lines: &Lines, project: impl Fn([f64; 2]) -> [f64; 2]) -> Lines {
    let lines = lines.iter();
    lines
        .map(|line| line.iter().map(|&at| project(at)).collect())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Area within rings, by the shoelace formula; rings of one region run one way, holes the
    /// other.
    fn area(rings: &Lines) -> f64 {
        let ring = |ring: &Vec<[f64; 2]>| -> f64 {
            ring.windows(2)
                .map(|p| 0.5 * (p[0][0] * p[1][1] - p[1][0] * p[0][1]))
                .sum()
        };
        rings.iter().map(ring).sum::<f64>().abs()
    }

    #[test]
    fn regions_reach_the_border_exactly() {
        let field = Field::new(21, |[s, t]| s + t);
        assert!((area(&field.rings(f64::MIN)) - 1.0).abs() < 1e-12);
        assert!((area(&field.rings(1.0)) - 0.5).abs() < 1e-12);
        assert!((area(&field.rings(0.5)) - 0.875).abs() < 1e-12);
        assert!(field.rings(3.0).is_empty());
    }

    #[test]
    fn iso_curves_leave_the_border_out() {
        let field = Field::new(21, |[s, t]| s + t);
        let curves = field.iso_curves(0.5);
        assert_eq!(curves.len(), 1);
        assert!(
            curves[0].iter().all(|[s, t]| (s + t - 0.5).abs() < 1e-12),
            "{curves:?}"
        );
        // A hill in the middle has one closed curve.
        let hill = Field::new(21, |[s, t]| -(s - 0.5) * (s - 0.5) - (t - 0.5) * (t - 0.5));
        let curves = hill.iso_curves(-0.1);
        assert_eq!(curves.len(), 1);
        assert_eq!(curves[0].first(), curves[0].last());
    }
}
