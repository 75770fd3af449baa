//! Convex polygons about the curves of single rotors.
//!
//! Over such polygons the priorities can be served at least as well as on the curves. An end on the curves that serves
//! them as well is the best there is, and nothing need be tried elsewhere ([`crate::search`]).

use crate::attainable::AttainableSet;
use crate::chord::{Rotors, edge};
use crate::linear::unknown_zero;
use crate::{Edge, Pair, Quantity};

/// Equal parts of the range, from one to the next of which the slope must rise, or fall, throughout.
const PARTS: usize = 4;

/// A curve that is nowhere further than this from its chord, scaled, is as good as straight.
const STRAIGHT: f32 = 1e-4;

/// Nearer to an end of the range than this share of it a tangent is drawn in the middle: that of the end is there already.
const NEAR_END: f32 = 0.1;

/// The chord of a curve and the tangents at its ends and in between, scaled.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hull {
    edges: [Edge; 4],
    centre: [f32; 2],
}

/// How a curve bends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Bend {
    /// Not at all: its chord stands about it.
    None,
    /// One way: its hull does.
    OneWay,
    /// Both ways, or there is no curve: nothing does.
    BothWays,
}

/// A scaled point of a curve and the slope there.
#[derive(Clone, Copy, Default)]
struct Tangent {
    at: [f32; 2],
    slope: f32,
}

impl Tangent {
    /// At a throttle; `None` with both or no rotor.
    fn of<P: Quantity>(pair: &Pair<P>, rotors: Rotors, scale: [f32; 2], throttle: f32) -> Option<Self> {
        let ([f, q], jacobian) = pair.efforts_and_jacobian(rotors.throttles(throttle)?);
        let [f_by, q_by] = rotors.derivative(jacobian);
        Some(Tangent {
            at: [f / scale[0], q / scale[1]],
            slope: (q_by * scale[0]) / (f_by * scale[1]),
        })
    }

    /// How far above the line `p` is.
    fn below(&self, p: [f32; 2]) -> f32 {
        p[1] - (self.at[1] + self.slope * (p[0] - self.at[0]))
    }

    /// Where it crosses another one.
    fn crossing(&self, other: &Tangent) -> [f32; 2] {
        let f = self.at[0] + other.below(self.at) / (other.slope - self.slope);
        [f, self.at[1] + self.slope * (f - self.at[0])]
    }
}

impl Default for Hull {
    fn default() -> Self {
        let zero = unknown_zero();
        let edge = Edge {
            start: [zero; 2],
            along: [zero; 2],
            length: zero,
        };
        Hull {
            edges: [edge; 4],
            centre: [zero; 2],
        }
    }
}

impl Hull {
    /// Draws it about the curve of a unit that has lost a rotor over a range of throttles, touching it at `throttle`, if that
    /// bends one way. With both or no rotor there is no curve to be about.
    #[inline(never)]
    pub(crate) fn draw<P: Quantity>(
        &mut self,
        pair: &Pair<P>,
        range: [f32; 2],
        rotors: Rotors,
        scale: [f32; 2],
        throttle: f32,
    ) -> Bend {
        let [low, high] = range;
        let tangent = |share: f32| Tangent::of(pair, rotors, scale, low + share * (high - low));
        let (Some(first), Some(last)) = (tangent(0.0), tangent(1.0)) else {
            return Bend::BothWays;
        };
        let chord = Tangent {
            slope: (last.at[1] - first.at[1]) / (last.at[0] - first.at[0]),
            ..first
        };
        // Above the chord slopes fall along the curve, below it they rise.
        let (mut rises, mut falls, mut furthest) = (true, true, 0.0);
        let mut before = first;
        for part in 1..=PARTS {
            let Some(next) = tangent(part as f32 / PARTS as f32) else {
                return Bend::BothWays;
            };
            rises &= next.slope > before.slope;
            falls &= next.slope < before.slope;
            let height = chord.below(next.at).abs();
            furthest = if height > furthest { height } else { furthest };
            before = next;
        }
        if furthest < STRAIGHT {
            return Bend::None;
        }
        let share = (throttle - low) / (high - low);
        let is_near_end = !(NEAR_END..=1.0 - NEAR_END).contains(&share);
        let Some(between) = tangent(if is_near_end { 0.5 } else { share }) else {
            return Bend::BothWays;
        };
        let (below, above) = (first.crossing(&between), between.crossing(&last));
        let ordered = first.at[0] < below[0] && below[0] < above[0] && above[0] < last.at[0];
        if !(ordered && (rises || falls)) {
            return Bend::BothWays;
        }
        // Anticlockwise.
        let corners = if rises {
            [first.at, below, above, last.at]
        } else {
            [first.at, last.at, above, below]
        };
        let [a, b, c, d] = corners;
        let mean = |axis: usize| 0.25 * corners.iter().map(|corner| corner[axis]).sum::<f32>();
        self.edges = [edge(a, b), edge(b, c), edge(c, d), edge(d, a)];
        self.centre = [mean(0), mean(1)];
        Bend::OneWay
    }

    /// As an attainable set.
    pub(crate) fn set(&self, scale: [f32; 2]) -> AttainableSet<'_> {
        AttainableSet {
            scale,
            centre: self.centre,
            edges: &self.edges,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Biquadratic, Cubic};

    /// The paper's pair.
    const PAIR: Pair<Biquadratic> = Pair {
        thrust: Biquadratic([
            5.2075, -2.1892, 12.3604, -10.2432, 4.4427, 2.7640, 12.2092, 0.2363,
        ]),
        torque: Biquadratic([-0.0673, -0.0606, -0.1312, 0.0953, 0.0364, -0.0907, 0.1441, 0.0720]),
    };
    const RANGE: [f32; 2] = [0.1, 1.0];
    const SCALE: [f32; 2] = [20.0, 0.3];

    /// The scaled point of a curve.
    fn point(rotors: Rotors, throttle: f32) -> [f32; 2] {
        let throttles = rotors.throttles(throttle).expect("a single rotor");
        let [f, q] = PAIR.efforts(throttles);
        [f / SCALE[0], q / SCALE[1]]
    }

    #[test]
    fn a_hull_is_about_its_curve_and_touches_it() {
        let [low, high] = RANGE;
        for (rotors, outwards) in [(Rotors::Upper, -1.0), (Rotors::Lower, 1.0)] {
            for (throttle, touched) in [(0.1, 0.55), (0.15, 0.55), (0.3, 0.3), (0.7, 0.7), (1.0, 0.55)] {
                let mut hull = Hull::default();
                assert_eq!(hull.draw(&PAIR, RANGE, rotors, SCALE, throttle), Bend::OneWay);
                let set = hull.set(SCALE);
                for step in 0..=100 {
                    let point = point(rotors, low + 0.01 * step as f32 * (high - low));
                    assert!(set.distance(point) < 1e-6, "{rotors:?}, {throttle}: {point:?}");
                }
                for touched in [low, touched, high] {
                    let [f, q] = point(rotors, touched);
                    let beyond = set.distance([f, q + 1e-3 * outwards]);
                    assert!(beyond > 3e-4, "{rotors:?}, {throttle}: {beyond} at {touched}");
                }
            }
        }
    }

    /// Torque in proportion to thrust, as of isolated rotors.
    #[test]
    fn a_straight_curve_is_its_chord() {
        let thrust = Biquadratic([0.0, 0.0, 9.0, 0.0, 0.5, 0.0, 9.0, 0.5]);
        let pair = Pair {
            thrust,
            torque: Biquadratic(thrust.0.map(|coefficient| -0.02 * coefficient)),
        };
        let bend = Hull::default().draw(&pair, RANGE, Rotors::Upper, SCALE, 0.5);
        assert_eq!(bend, Bend::None);
    }

    #[test]
    fn a_curve_that_bends_both_ways_has_no_hull() {
        let pair = Pair {
            thrust: Cubic([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 20.0, 20.0]),
            torque: Cubic([0.4, 0.0, 0.0, 0.0, -0.66, 0.0, 0.0, 0.1, 0.1]),
        };
        let bend = Hull::default().draw(&pair, RANGE, Rotors::Upper, SCALE, 0.5);
        assert_eq!(bend, Bend::BothWays);
    }
}
