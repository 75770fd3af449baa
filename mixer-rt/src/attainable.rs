//! The attainable set of one unit: all efforts (f, Q) that its two rotors can give together.
//!
//! It is the image of the throttle box under the forward map, a curved quadrangle ("the zone of achievable
//! thrust-torque pairs", section IV-B2). The compiler encloses a polygon in it.

/// A simple polygon inside the attainable set at the reference voltage; at another voltage it is scaled by
/// `[k_f, k_Q]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttainableSet<'a> {
    /// Vertices `[f, Q]` (N, N m), anticlockwise in the plane with f to the right and Q upwards.
    pub vertices: &'a [[f32; 2]],
}

/// How far beyond its ends an edge still counts, as a share of its length: neighbouring edges overlap, so that no
/// ray slips through at a vertex.
const OVERLAP: f32 = 1e-4;

impl AttainableSet<'_> {
    /// The largest `s` in [0, 1] such that `from + t step` stays in the polygon for all `t` in [0, s], for a point
    /// `from` inside it.
    pub fn clip(&self, from: [f32; 2], step: [f32; 2]) -> f32 {
        let Some(mut start) = self.vertices.last() else {
            return 0.0;
        };
        let mut share = 1.0;
        for end in self.vertices {
            // from + s step = start + t edge  =>  s = (w x edge) / c, t = (w x step) / c
            let edge = [end[0] - start[0], end[1] - start[1]];
            let w = [start[0] - from[0], start[1] - from[1]];
            let c = cross(step, edge);
            // c > 0: the ray crosses this edge outwards, since the interior lies to the edge's left.
            if c > 0.0 {
                let along_edge = cross(w, step);
                let along_ray = cross(w, edge);
                let within = along_edge >= -OVERLAP * c && along_edge <= (1.0 + OVERLAP) * c;
                if within && along_ray < share * c {
                    let exit = along_ray / c;
                    // An edge that lies behind the start belongs to a dent elsewhere.
                    if exit > -OVERLAP {
                        share = if exit > 0.0 { exit } else { 0.0 };
                    }
                }
            }
            start = end;
        }
        share
    }
}

#[inline(always)]
fn cross(a: [f32; 2], b: [f32; 2]) -> f32 {
    a[0] * b[1] - a[1] * b[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quadrangle with a dent at (2, 1).
    const DENTED: AttainableSet<'static> = AttainableSet {
        vertices: &[[0.0, 0.0], [4.0, 0.0], [2.0, 1.0], [4.0, 2.0], [0.0, 2.0]],
    };

    #[test]
    fn clips_at_the_first_edge() {
        let close = |a: f32, b: f32| assert!((a - b).abs() < 1e-3, "{a} is not {b}");
        close(DENTED.clip([1.0, 1.0], [2.0, 0.0]), 0.5); // into the dent
        close(DENTED.clip([1.0, 0.5], [1.0, 0.0]), 1.0); // stays inside
        close(DENTED.clip([1.0, 0.5], [4.0, 0.0]), 0.5);
        close(DENTED.clip([1.0, 0.5], [0.0, -1.0]), 0.5);
        close(DENTED.clip([1.0, 1.0], [-4.0, -4.0]), 0.25); // through a vertex
        close(DENTED.clip([0.0, 1.0], [-1.0, 0.0]), 0.0); // already on the border
        close(DENTED.clip([1.0, 1.0], [0.0, 0.0]), 1.0);
    }
}
