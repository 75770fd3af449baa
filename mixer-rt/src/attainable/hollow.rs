//! Hollows: where the border bends inwards.

use core::num::NonZeroU8;

use crate::attainable::{AttainableSet, Face, Point};
use crate::sqrt;

/// Hollows less deep than this, scaled, are none.
const HOLLOW: f32 = 1e-3;

/// The border may fall by this much, scaled, before it rises: from one end of a hollow it falls before it rises to the other.
const FALL: f32 = 5e-3;

impl AttainableSet<'_> {
    /// Of the hollow that holds back a point drawn in `direction` both ends: the corners up to which the border rises in that
    /// direction, but for falls of [`FALL`], before the point and after it; one more than their indices.
    pub(crate) fn hollow(&self, point: &Point, direction: [f32; 2]) -> [Option<NonZeroU8>; 2] {
        let length = sqrt(direction[0] * direction[0] + direction[1] * direction[1]);
        let (least, fall) = (HOLLOW * length, FALL * length);
        let from = self.project(point);
        [false, true].map(|forwards| {
            let next = |index| {
                if forwards {
                    self.after(index)
                } else {
                    self.before(index)
                }
            };
            let mut index = point.index;
            if forwards || point.face == Face::Corner {
                index = next(index);
            }
            let (mut end, mut furthest) = (index, 0.0);
            for _ in self.edges {
                let [f, q] = self.corner(index);
                let height = (f - from[0]) * direction[0] + (q - from[1]) * direction[1];
                if height < furthest - fall {
                    break;
                }
                if height > furthest {
                    (end, furthest) = (index, height);
                }
                index = next(index);
            }
            if furthest > least {
                NonZeroU8::MIN.checked_add(end)
            } else {
                None
            }
        })
    }
}
