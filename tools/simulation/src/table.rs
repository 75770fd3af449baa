//! The printed tables: Table II over the seeds beside the paper's, thrust command against weight
//! (Fig. 10).

use std::fmt;

use crate::flight::{FlightPair, Scenario};
use crate::mixer::Method;
use crate::tracking::{PAPER_COAXIAL, PAPER_CONVENTIONAL, Spread, TrackingError, figure, ratio};

/// A scenario flown over several seeds; prints as its tables.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// What was flown.
    pub scenario: Scenario,
    /// One pair of flights per seed.
    pub flights: Vec<FlightPair>,
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let flights = &self.flights;
        let (scenario, seeds) = (self.scenario, flights.len());
        writeln!(f, "{scenario}, {seeds} seeds (mean ± standard deviation)\n")?;
        writeln!(
            f,
            "  {:<12} {:^21} {:^21} {:^15} | paper {:>8} {:>12} {:>6}",
            "Table II", "coaxial", "conventional", "ratio", "coaxial", "conventional", "ratio"
        )?;
        for (row, name) in TrackingError::NAMES.into_iter().enumerate() {
            // Metres to millimetres, squared in the first row.
            let (unit, scale) = if row == 0 { ("mm2", 1e6) } else { ("mm", 1e3) };
            for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
                let of = |method| scaled(figure(flights, method, row, axis), scale);
                let [coaxial, conventional] =
                    [PAPER_COAXIAL, PAPER_CONVENTIONAL].map(|paper| paper.rows()[row][axis]);
                writeln!(
                    f,
                    "  {:<12} {:>21} {:>21} {:>15} |       {:>8} {:>12} {:>6.2}",
                    format!("{name} {letter}, {unit}"),
                    of(Method::Coaxial),
                    of(Method::Conventional),
                    format!("{:.2}", ratio(flights, row, axis)),
                    format!("{:.0}", coaxial * scale),
                    format!("{:.0}", conventional * scale),
                    coaxial / conventional,
                )?;
            }
        }
        writeln!(f)?;
        for method in Method::BOTH {
            let over = |value: fn(&crate::flight::Flight) -> f64| {
                Spread::of(flights.iter().map(|pair| value(pair.with(method))))
            };
            let saturated: usize = flights.iter().map(|pair| pair.with(method).saturated()).sum();
            writeln!(
                f,
                "  {method:<12} thrust command / weight in hover {:.3}, mean yaw error {:.2} degrees, \
                 {saturated} periods saturated",
                over(|flight| flight.hover_thrust()),
                over(|flight| flight.yaw_error().to_degrees()),
            )?;
        }
        Ok(())
    }
}

/// Mean ± deviation in another unit, with three digits of the mean.
fn scaled(spread: Spread, scale: f64) -> String {
    let spread = Spread {
        mean: spread.mean * scale,
        deviation: spread.deviation * scale,
    };
    match spread.mean {
        mean if mean >= 100.0 => format!("{spread:.0}"),
        mean if mean >= 1.0 => format!("{spread:.1}"),
        _ => format!("{spread:.3}"),
    }
}

impl fmt::Display for Spread {
    /// `mean ± deviation`, both with the precision that is asked for.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.mean.fmt(f)?;
        f.write_str(" ± ")?;
        self.deviation.fmt(f)
    }
}
