//! The attainable (roll, pitch, thrust).
//!
//! The thrusts lie in [a, b]^n, so w = C f lies in a zonotope, whose facets the compiler tabulates
//! in pairs, `low <= d w <= high`. For a given direction of (roll, pitch) a facet is a line in the
//! plane of (rho, thrust): the largest rho, and then the thrust nearest the request, are a linear
//! programme in two unknowns.
//!
//! A facet that is steep, as walls are but for unequal arms, would exchange much thrust for a trace of roll and pitch: it
//! is taken as the wall that it is at the thrust asked, within the facet. So roll and pitch are given up where that frees
//! more than twenty times as much thrust, as by the costs of the interior point method.

use core::hint::black_box;

use super::{ClosedForm, Facets, Steep};
use crate::{clamp, divisor, quotient, rolled, smaller};

/// A gap between thrust bounds that is below this share of a unit's largest thrust is none: sums of
/// four have errors of that size.
const ROUNDING: f32 = 4e-6;

impl Facets {
    /// Steps of the search for the largest rho: at most one per facet, hardly ever more than two.
    pub const STEPS: u32 = 6;
}

impl ClosedForm<'_> {
    /// The largest share of (roll, pitch) up to 1 that some thrust of at most `ceiling` allows, and
    /// the thrusts that it allows, where `thrust` is asked; by rounding the least may be above the most, which counts.
    #[inline(always)]
    pub(super) fn share(&self, roll: f32, pitch: f32, thrust: f32, ceiling: f32) -> (f32, [f32; 2]) {
        let mut share = 1.0;
        for Facets { normal, bounds } in rolled(self.walls) {
            let speed = normal[0] * roll + normal[1] * pitch;
            let limit = if speed > 0.0 { bounds[1] } else { bounds[0] };
            if speed > bounds[1] || speed < bounds[0] {
                share = smaller(quotient(limit, speed), share);
            }
        }
        for Steep { facets, thrusts_n } in rolled(self.steep) {
            let speed = facets.normal[0] * roll + facets.normal[1] * pitch;
            let side = usize::from(speed > 0.0);
            let [least, most] = thrusts_n[side];
            let limit = facets.bounds[side] - clamp(thrust, least, most);
            if speed.abs() > limit.abs() {
                share = smaller(quotient(limit, speed), share);
            }
        }
        let mut range = [0.0, 0.0];
        for _ in 0..black_box(Facets::STEPS) {
            // Thrust bounds at this share, and their velocities.
            let (mut low, mut low_speed) = (-f32::MAX, 0.0);
            let (mut high, mut high_speed) = (ceiling, 0.0);
            for Facets { normal, bounds } in rolled(self.slopes) {
                let speed = normal[0] * roll + normal[1] * pitch;
                let at = speed * share;
                if bounds[0] - at > low {
                    (low, low_speed) = (bounds[0] - at, -speed);
                }
                if bounds[1] - at < high {
                    (high, high_speed) = (bounds[1] - at, -speed);
                }
            }
            range = [low, high];
            if low - high <= ROUNDING * self.thrust_n[1] {
                break;
            }
            // Where these two lines meet: between 0 and here, as the gap is convex in the share and closed at 0.
            share -= (low - high) / divisor(low_speed - high_speed);
        }
        (share, range)
    }
}
