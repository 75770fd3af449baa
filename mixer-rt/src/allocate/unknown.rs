//! An unknown between two bounds, and how a Newton step eliminates it.
//!
//! With the barrier of weight mu and the multipliers of both bounds, the conditions of one unknown x
//! with gain g (what more of it is worth by the rows' multipliers) and curvature c >= 0 are
//!
//! ```text
//! g - c step + z_low - z_high = 0        z_low low = mu        z_high high = mu
//! ```
//!
//! `low` and `high` are the distances from the bounds. The bound that the gain leads to has the
//! multiplier that is left of the gain there; the other one has none but the barrier's. So the step
//! and the response to a change of the gain are closed forms with one division.

use crate::{divided, larger};

/// An unknown between two bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Unknown {
    /// The distances from both bounds. Each is kept: a difference would lose its digits near a bound.
    pub(super) low: f32,
    pub(super) high: f32,
    /// The step while the rows' multipliers stay; after [`Unknown::respond`] the whole step.
    pub(super) step: f32,
    /// The step per change of the gain.
    pub(super) response: f32,
}

impl Unknown {
    /// Before anything is known.
    pub(super) const NONE: Unknown = Unknown {
        low: 0.0,
        high: 0.0,
        step: 0.0,
        response: 0.0,
    };

    /// In the middle between bounds that are `span` apart.
    #[inline(always)]
    pub(super) fn central(span: f32) -> Self {
        Unknown {
            low: 0.5 * span,
            high: 0.5 * span,
            ..Unknown::NONE
        }
    }

    /// Finds `step` and `response` for a gain and a curvature >= 0, if any. Returns the gap: what the gain is worth
    /// over the distance from the bound that it leads to.
    #[inline(always)]
    pub(super) fn eliminate(&mut self, gain: f32, curvature: Option<f32>, mu: f32) -> f32 {
        let (low, high) = (self.low, self.high);
        let product = low * high;
        // The distance from the bound that the gain leads away from, and the one ahead.
        let (behind, ahead) = if gain > 0.0 { (low, high) } else { (high, low) };
        let gap = ahead * gain.abs();
        let left = match curvature {
            Some(curvature) => {
                let bent = curvature * ahead * ahead;
                larger(gap - bent, mu) + bent
            }
            None => larger(gap, mu),
        };
        let scale = divided(product, behind * behind * left + mu * ahead * ahead);
        self.response = product * scale;
        self.step = (gain * product + mu * (high - low)) * scale;
        gap
    }

    /// Adds the response to a change of the gain; raises `most` to the step over the room that it has.
    #[inline(always)]
    pub(super) fn respond(&mut self, change: f32, most: &mut f32) {
        self.step += self.response * change;
        let (size, room) = (
            self.step.abs(),
            if self.step > 0.0 { self.high } else { self.low },
        );
        if size > *most * room {
            *most = divided(size, room);
        }
    }

    /// Goes a share of the step.
    #[inline(always)]
    pub(super) fn advance(&mut self, share: f32) {
        self.low += share * self.step;
        self.high -= share * self.step;
    }
}
