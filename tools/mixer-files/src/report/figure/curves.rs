//! The curves of a figure as CSV.

use std::collections::BTreeMap;
use std::iter::once;

use super::Figure;
use super::legend::parted;
use crate::report::number::cell;

impl Figure {
    /// The named curves, each a column over the abscissae of all, with units in the header; empty
    /// where a curve is not. `None` without any.
    pub fn csv(&self) -> Option<String> {
        let [x, y] = [0, 1].map(|k| column(&self.axes[k].label));
        // Names have commas, and no quotes.
        let names = self.series.iter().map(|(name, _)| format!("\"{y}, {name}\""));
        let header = once(x).chain(names);
        let finite = |points: &[[f64; 2]]| -> Vec<[f64; 2]> {
            let points = points.iter().filter(|point| point.iter().all(|x| x.is_finite()));
            points.copied().collect()
        };
        let curves: Vec<_> = self.series.iter().map(|(_, points)| finite(points)).collect();
        let mut places: Vec<f64> = curves.iter().flatten().map(|point| point[0]).collect();
        places.sort_by(f64::total_cmp);
        let mut places: Vec<String> = places.into_iter().map(cell).collect();
        places.dedup();
        let heights = |points: Vec<[f64; 2]>| -> BTreeMap<String, String> {
            points.into_iter().map(|[x, y]| (cell(x), cell(y))).collect()
        };
        let curves: Vec<_> = curves.into_iter().map(heights).collect();
        let mut csv = itertools::join(header, ",") + "\n";
        for place in &places {
            let heights = curves
                .iter()
                .map(|curve| curve.get(place).map_or("", String::as_str));
            let row = once(place.as_str()).chain(heights);
            csv += &(itertools::join(row, ",") + "\n");
        }
        (!self.series.is_empty()).then_some(csv)
    }
}

/// The column of an axis: `total thrust (N)` is `total_thrust_n`.
fn column(label: &str) -> String {
    let (quantity, unit) = parted(label);
    let words = quantity.replace('\u{2212}', "less").replace(' ', "_");
    let unit = unit.replace(' ', "").to_lowercase();
    if unit.is_empty() {
        words
    } else {
        format!("{words}_{unit}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_are_columns_with_units_in_the_header() {
        let axes = (
            ("yaw given \u{2212} asked (N m)", [0.0, 1.0]),
            ("throttle in hover", [0.0, 1.0]),
        );
        let mut figure = Figure::new("", axes.0, axes.1);
        assert_eq!(figure.csv(), None);
        figure.curve(
            "series-1",
            "units 0, 2",
            &[[0.0, 0.5], [0.5, f64::NAN], [1.0, 0.25]],
        );
        figure.curve("series-2", "all", &[[0.0, 1.0], [1.0 + 1e-12, 0.0]]);
        figure.curve("series-1", "", &[[0.0, 1.0]]);
        assert_eq!(
            figure.csv().unwrap(),
            "yaw_given_less_asked_nm,\"throttle_in_hover, units 0, 2\",\"throttle_in_hover, all\"\n0,0.5,1\n1,0.25,0\n"
        );
    }
}
