//! A linear program in three unknowns by the dual simplex method, in bounded work.
//!
//! Its best corner so far is where three rows meet. Where that breaks another row, the corner moves to the best one that
//! keeps it. The rows need not be known beforehand: tangents of a concave function are added where the corner comes to.

/// `lead x[0] + rest x[1..]` may grow no further.
#[derive(Clone, Copy, Default)]
pub(super) struct Row {
    /// Of the first unknown while that is the yaw.
    pub(super) yaw: f32,
    /// Of the first unknown while that is the lean.
    pub(super) lean: f32,
    /// Of the other two.
    pub(super) rest: [f32; 2],
    /// By how much the corner breaks the row.
    pub(super) excess: f32,
    /// Of a tangent, where it touches: lean, then the other two.
    pub(super) point: Option<[f32; 3]>,
}

/// What belongs to one row of the corner.
#[derive(Clone, Copy)]
struct Edge {
    /// The way on which this row grows by one and the other two stay as they are.
    way: [f32; 3],
    /// The row's [`Row::lean`].
    lean: f32,
    /// The row's [`Row::point`].
    point: Option<[f32; 3]>,
}

/// The best point that keeps three rows.
pub(super) struct Corner {
    /// The point: yaw or lean, then two more.
    pub(super) at: [f32; 3],
    edges: [Edge; 3],
    /// True while the first unknown is the lean.
    leans: bool,
}

/// A row that a way meets at less than this is as good as parallel to it.
pub(super) const PARALLEL: f32 = 1e-5;

fn product(a: &[f32; 3], b: &[f32; 3]) -> f32 {
    (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]
}

impl Corner {
    /// Under the tangent `yaw <= at + slopes (x - start)`, with `x[1]` held and `x[2]` taken to its `end` in the direction
    /// of `sign`, where the yaw grows. The end comes nearer by `taken` per lean and per `x[1]`.
    pub(super) fn under(
        at: f32,
        lean: f32,
        slopes: [f32; 2],
        start: f32,
        (sign, end, taken): (f32, f32, [f32; 2]),
    ) -> Corner {
        Corner {
            at: [at + slopes[1] * (end - start), 0.0, end],
            edges: [
                Edge {
                    way: [slopes[0] - slopes[1] * taken[1], 1.0, -taken[1]],
                    lean: 0.0,
                    point: None,
                },
                Edge {
                    way: [1.0, 0.0, 0.0],
                    lean: -lean,
                    point: Some([0.0, 0.0, start]),
                },
                Edge {
                    way: [sign * slopes[1], 0.0, sign],
                    lean: sign * taken[0],
                    point: None,
                },
            ],
            leans: false,
        }
    }

    /// How fast the best yaw grows with `x[1]`, which has been held.
    pub(super) fn slope(&self) -> f32 {
        self.edges[0].way[0]
    }

    /// The average of the points where the corner's tangents touch, by what they are worth to the goal
    /// `x[0] - price x[1]`, and what they are worth together; none where fewer than two rows are tangents.
    pub(super) fn average(&self, price: f32) -> Option<([f32; 3], f32)> {
        let (mut sum, mut together, mut tangents) = ([0.0; 3], 0.0, 0);
        for edge in &self.edges {
            let Some(point) = edge.point else { continue };
            tangents += 1;
            let worth = edge.way[0] - price * edge.way[1];
            if worth > 0.0 {
                together += worth;
                for (sum, at) in sum.iter_mut().zip(point) {
                    *sum += worth * at;
                }
            }
        }
        (tangents > 1 && together > PARALLEL).then(|| (sum.map(|sum| sum / together), together))
    }

    /// Lets go of `x[1]`, as far as `limit` in the direction of `sign`.
    pub(super) fn release(&mut self, sign: f32, limit: f32) {
        let [edge, ..] = &mut self.edges;
        for (at, way) in self.at.iter_mut().zip(&mut edge.way) {
            *way *= sign;
            *at += limit * *way;
        }
    }

    /// Holds the yaw at `yaw` and takes the lean, 0 so far, as the first unknown, and the `price` in its unit; false where
    /// no lean gives more yaw.
    pub(super) fn lean(&mut self, yaw: f32, price: &mut f32) -> bool {
        // The way per lean on which all three rows stay.
        let mut way = [0.0; 3];
        for edge in &self.edges {
            for (way, along) in way.iter_mut().zip(edge.way) {
                *way -= edge.lean * along;
            }
        }
        let [slope, rest @ ..] = way;
        if slope > -PARALLEL {
            return false;
        }
        let turn = |point: &mut [f32; 3], yaw: f32| {
            let lean = yaw / slope;
            let [first, others @ ..] = point;
            *first = lean;
            for (other, rest) in others.iter_mut().zip(rest) {
                *other += rest * lean;
            }
        };
        let missing = yaw - self.at[0];
        turn(&mut self.at, missing);
        for edge in &mut self.edges {
            let given = edge.way[0];
            turn(&mut edge.way, -given);
        }
        *price /= *price * rest[0] - slope;
        self.leans = true;
        true
    }

    /// Moves the corner to the best one that keeps `row`, and as many of its first rows as are `held`, where the goal is
    /// `x[0] - price x[1]`. False where there is none.
    #[inline(always)]
    pub(super) fn keep(&mut self, row: &Row, held: usize, price: f32) -> bool {
        let normal = [
            if self.leans { row.lean } else { row.yaw },
            row.rest[0],
            row.rest[1],
        ];
        let mut rates = [0.0; 3];
        let (mut leaving, mut least, mut rate_of) = (3, f32::MAX, 1.0);
        for (index, (edge, rate)) in self.edges.iter().zip(&mut rates).enumerate() {
            *rate = product(&normal, &edge.way);
            if index < held || *rate <= PARALLEL {
                continue;
            }
            let loss = (edge.way[0] - price * edge.way[1]) / *rate;
            if loss < least {
                (leaving, least, rate_of) = (index, loss, *rate);
            }
        }
        let Some(edge) = self.edges.get_mut(leaving) else {
            return false;
        };
        (edge.lean, edge.point) = (row.lean, row.point);
        for along in &mut edge.way {
            *along /= rate_of;
        }
        let way = edge.way;
        for (at, along) in self.at.iter_mut().zip(way) {
            *at -= row.excess * along;
        }
        for (index, (edge, rate)) in self.edges.iter_mut().zip(rates).enumerate() {
            if index == leaving {
                continue;
            }
            for (along, way) in edge.way.iter_mut().zip(way) {
                *along -= rate * way;
            }
        }
        true
    }
}
