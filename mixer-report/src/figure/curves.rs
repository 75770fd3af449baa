//! The curves of a figure as CSV.

use std::fmt::Write as _;

use super::Figure;
use super::legend::parted;
use crate::number::line;

impl Figure {
    /// The named curves with a row per point and the units in the header; `None` without any.
    pub fn csv(&self) -> Option<String> {
        let [x, y] = [0, 1].map(|k| column(&self.axes[k].label));
        let mut csv = format!("curve,{x},{y}\n");
        for (name, points) in &self.series {
            // Names have commas, and no quotes.
            for point in points.iter().filter(|point| point.iter().all(|x| x.is_finite())) {
                let _ = writeln!(csv, "\"{name}\",{}", line(*point));
            }
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
    fn curves_are_rows_with_units_in_the_header() {
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
        figure.curve("series-1", "", &[[0.0, 1.0]]);
        assert_eq!(
            figure.csv().unwrap(),
            "curve,yaw_given_less_asked_nm,throttle_in_hover\n\"units 0, 2\",0,0.5\n\"units 0, 2\",1,0.25\n"
        );
    }
}
