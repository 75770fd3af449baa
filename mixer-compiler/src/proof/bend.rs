//! The remainder of a linear model of both quantities about one point: G of
//! [`expansion`](super::expansion).

use super::expansion::{Curvature, Derivatives, Expansion, beyond_linear, powers};
use super::taylor::Taylor;

/// Both quantities around t = t* + d.
pub(super) enum Bend {
    /// Bounds of the second derivatives, for all t within reach: what they leave open grows with
    /// d3.
    Bounds(Box<[Curvature; 2]>),
    /// All derivatives as functions over the cell: what they leave open shrinks with the cell,
    /// whatever d is.
    Functions(Box<[Derivatives; 2]>),
}

impl Bend {
    /// Around t* + `deviation` over a cell of the half widths `half`: bounds, unless they say too
    /// little. Next to a fold they do, since a small residual of m leaves a large error of the
    /// throttles there.
    pub(super) fn new(expansions: &[Expansion; 2], half: [f64; 2], deviation: &[Taylor; 2]) -> Self {
        let size = deviation.map(|d| d.magnitude());
        let reach = [0, 1].map(|k| half[k] + size[k]);
        let curvature = expansions.each_ref().map(|expansion| expansion.curvature(reach));
        if !curvature.iter().any(|curvature| curvature.is_vague(size)) {
            return Bend::Bounds(Box::new(curvature));
        }
        let offset = [0, 1].map(|k| Taylor::coordinate(0.0, half[k], k == 1).plus(&deviation[k]));
        let powers = powers(&offset, 2);
        let derivatives = expansions
            .each_ref()
            .map(|expansion| expansion.derivatives(&powers));
        Bend::Functions(Box::new(derivatives))
    }

    /// G(t; v) of both quantities.
    pub(super) fn remainders(&self, v: &[Taylor; 2]) -> [Taylor; 2] {
        match self {
            Bend::Bounds(curvature) => {
                let (squares, size) = squares(v);
                curvature
                    .each_ref()
                    .map(|curvature| curvature.remainder(&squares, size))
            }
            Bend::Functions(derivatives) => {
                let powers = powers(v, 4);
                derivatives
                    .each_ref()
                    .map(|derivatives| beyond_linear(derivatives, &powers))
            }
        }
    }
}

/// vu2, vu vl and vl2, and bounds of |vu| and |vl|.
pub(super) fn squares(v: &[Taylor; 2]) -> ([Taylor; 3], [f64; 2]) {
    let squares = [v[0].product(&v[0]), v[0].product(&v[1]), v[1].product(&v[1])];
    (squares, v.map(|v| v.magnitude()))
}
