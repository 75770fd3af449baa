//! The attainable set of a unit as a polygon, and level flight inside it.

use mixer_rt::tables::{AttainableSet, Corner, LevelFlight};

/// The attainable set.
#[derive(Clone, Debug, PartialEq)]
pub struct AttainableTable {
    /// Newtons and newton metres per unit of the coordinates below.
    pub scale: [f32; 2],
    /// A point well inside, scaled.
    pub centre: [f32; 2],
    /// The corners, anticlockwise, scaled.
    pub corners: Vec<Corner>,
}

impl AttainableTable {
    /// Rounds a convex polygon `[f, Q]` (N, N m), anticlockwise, and a point inside.
    pub(crate) fn new(vertices: &[[f64; 2]], scale: [f64; 2], centre: [f64; 2]) -> Self {
        let scaled = |[f, q]: [f64; 2]| [(f / scale[0]) as f32, (q / scale[1]) as f32];
        AttainableTable {
            scale: scale.map(|x| x as f32),
            centre: scaled(centre),
            corners: corners(vertices.iter().copied().map(scaled)),
        }
    }

    /// The set as `mixer-rt` reads it.
    pub(crate) fn view(&self) -> AttainableSet<'_> {
        AttainableSet {
            scale: self.scale,
            centre: self.centre,
            corners: &self.corners,
        }
    }

    /// The set drawn in towards its centre by a share.
    pub(crate) fn drawn_in(&self, share: f32) -> Self {
        let drawn_in =
            |corner: &Corner| [0, 1].map(|k| corner.at[k] + share * (self.centre[k] - corner.at[k]));
        AttainableTable {
            corners: corners(self.corners.iter().map(drawn_in)),
            ..*self
        }
    }

    /// The corners `[f, Q]`, N and N m.
    pub fn corners(&self) -> Vec<[f32; 2]> {
        let corner = |corner: &Corner| [corner.at[0] * self.scale[0], corner.at[1] * self.scale[1]];
        self.corners.iter().map(corner).collect()
    }
}

/// The corners of a polygon with their edges.
fn corners(points: impl Iterator<Item = [f32; 2]>) -> Vec<Corner> {
    let points: Vec<[f32; 2]> = points.collect();
    let n = points.len();
    let corner = |k: usize| Corner::between(points[(k + n - 1) % n], points[k], points[(k + 1) % n]);
    (0..n).map(corner).collect()
}

/// Level flight of all units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LevelFlightTable {
    /// Least and largest thrust, N at the reference voltage.
    pub thrust_n: [f32; 2],
    /// Every unit's efforts `[f, Q]` at these two, scaled as the attainable set.
    pub efforts: Vec<[[f32; 2]; 2]>,
}

impl LevelFlightTable {
    /// Rounds every unit's efforts (N, N m) at two thrusts (N).
    pub(crate) fn new(thrust_n: [f32; 2], efforts: &[[[f64; 2]; 2]], scale: [f32; 2]) -> Self {
        let scaled = |efforts: [f64; 2]| [0, 1].map(|k| (efforts[k] / f64::from(scale[k])) as f32);
        LevelFlightTable {
            thrust_n,
            efforts: efforts.iter().map(|ends| ends.map(scaled)).collect(),
        }
    }

    /// Level flight as `mixer-rt` reads it.
    pub(crate) fn view(&self) -> LevelFlight<'_> {
        LevelFlight {
            thrust_n: self.thrust_n,
            efforts: &self.efforts,
        }
    }
}
