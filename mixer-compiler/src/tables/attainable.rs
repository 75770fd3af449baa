//! The attainable set of a unit as a polygon, and level flight inside it.

use mixer_rt::tables::{AttainableSet, CORNERS, Corner, LevelFlight, SingleRotor, ThrottleRange};

/// The attainable set.
#[derive(Clone, Debug, PartialEq)]
pub struct AttainableTable {
    /// Newtons and newton metres per unit of the coordinates below.
    pub scale: [f32; 2],
    /// A point well inside, scaled.
    pub centre: [f32; 2],
    /// The corners of the polygon, anticlockwise, and the ends of single rotors' chords, scaled:
    /// [`AttainableSet::corners`].
    pub corners: [Corner; CORNERS],
    /// How many corners the polygon has.
    pub count: u8,
}

impl AttainableTable {
    /// Rounds a convex polygon `[f, Q]` (N, N m) of at most eight corners, anticlockwise, and a point
    /// inside.
    pub(crate) fn new(vertices: &[[f64; 2]], scale: [f64; 2], centre: [f64; 2]) -> Self {
        let scaled = |[f, q]: [f64; 2]| [(f / scale[0]) as f32, (q / scale[1]) as f32];
        let points: Vec<[f32; 2]> = vertices.iter().copied().map(scaled).collect();
        let mut table = AttainableTable {
            scale: scale.map(|x| x as f32),
            centre: scaled(centre),
            corners: [Corner::default(); CORNERS],
            count: points.len() as u8,
        };
        table.put(0, &points);
        table
    }

    /// The same with the chords of the upper and of the lower rotor alone.
    pub(crate) fn with_singles(&self, singles: &[SingleRotor; 2], range: &ThrottleRange) -> Self {
        let (mut table, scale) = (self.clone(), self.scale);
        for (first, single) in [AttainableSet::UPPER, AttainableSet::LOWER]
            .into_iter()
            .zip(singles)
        {
            let ends = [range.min, range.max].map(|throttle| {
                let [f, q] = single.efforts(throttle);
                [f / scale[0], q / scale[1]]
            });
            table.put(first, &ends);
        }
        table
    }

    /// Puts the corners of a set into the table from an index on.
    fn put(&mut self, first: u8, points: &[[f32; 2]]) {
        let n = points.len();
        for (k, slot) in self.corners[usize::from(first)..][..n].iter_mut().enumerate() {
            let (before, next) = ((k + n - 1) % n, (k + 1) % n);
            let links = [next, before].map(|k| first + k as u8);
            *slot = Corner::between(points[before], points[k], points[next], links);
        }
    }

    /// The set as `mixer-rt` reads it.
    pub(crate) fn view(&self) -> AttainableSet<'_> {
        AttainableSet {
            scale: self.scale,
            centre: self.centre,
            corners: &self.corners,
            count: self.count,
        }
    }

    /// The set drawn in towards its centre by a share.
    pub(crate) fn drawn_in(&self, share: f32) -> Self {
        let drawn_in =
            |corner: &Corner| [0, 1].map(|k| corner.at[k] + share * (self.centre[k] - corner.at[k]));
        let points: Vec<[f32; 2]> = self.polygon().iter().map(drawn_in).collect();
        self.with_polygon(&points)
    }

    /// The set with another polygon of as many corners, scaled.
    pub(crate) fn with_polygon(&self, points: &[[f32; 2]]) -> Self {
        let mut table = self.clone();
        table.put(0, points);
        table
    }

    /// The corners of the polygon.
    pub fn polygon(&self) -> &[Corner] {
        &self.corners[..usize::from(self.count)]
    }

    /// The corners `[f, Q]`, N and N m.
    pub fn corners(&self) -> Vec<[f32; 2]> {
        let corner = |corner: &Corner| [corner.at[0] * self.scale[0], corner.at[1] * self.scale[1]];
        self.polygon().iter().map(corner).collect()
    }
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
