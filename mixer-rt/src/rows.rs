//! The rows of the wrench along which a path is followed.
//!
//! Roll and pitch are turned into the request's direction and across it, and every row is scaled to unit length, so
//! that all numbers are of order one. A row is held, and moved by the path, or slack: anywhere between two bounds,
//! which may move. The multiplier of a slack row is zero between the bounds, >= 0 at the lower and <= 0 at the upper
//! one (the conditions of Karush, Kuhn and Tucker).

use crate::{clamp, sqrt};

/// Roll and pitch along the request, and across it.
pub(crate) const ALONG: usize = 0;
pub(crate) const ACROSS: usize = 1;
pub(crate) const YAW: usize = 2;
pub(crate) const THRUST: usize = 3;

/// Where a row is allowed to be.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) low: f32,
    pub(crate) high: f32,
}

impl Bounds {
    /// Exactly `value`.
    pub(crate) const fn at(value: f32) -> Self {
        Bounds {
            low: value,
            high: value,
        }
    }

    /// These bounds, none beyond -`far` or `far`.
    pub(crate) fn within(self, far: f32) -> Self {
        Bounds {
            low: clamp(self.low, -far, far),
            high: clamp(self.high, -far, far),
        }
    }

    /// These bounds, made wide enough for `value`.
    pub(crate) fn including(self, value: f32) -> Self {
        Bounds {
            low: if value < self.low { value } else { self.low },
            high: if value > self.high { value } else { self.high },
        }
    }

    /// How far `value` is outside.
    pub(crate) fn distance(self, value: f32) -> f32 {
        if value > self.high {
            value - self.high
        } else if value < self.low {
            self.low - value
        } else {
            0.0
        }
    }
}

/// A word, like the rest of a [`Row`], which then is copied word by word.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum RowState {
    /// Wherever the efforts put it; no multiplier.
    Between,
    /// At the lower bound, multiplier >= 0.
    AtLow,
    /// At the upper bound, multiplier <= 0.
    AtHigh,
    /// Moved by the path.
    #[default]
    Held,
}

/// One row of the wrench, scaled.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Row {
    pub(crate) state: RowState,
    pub(crate) value: f32,
    pub(crate) bounds: Bounds,
    pub(crate) multiplier: f32,
}

impl Row {
    /// True where nothing need move for the bounds to become `target`.
    pub(crate) fn suits(&self, target: &Bounds) -> bool {
        match self.state {
            RowState::Between => target.low <= self.value && self.value <= target.high,
            RowState::AtLow => self.bounds.low == target.low,
            RowState::AtHigh => self.bounds.high == target.high,
            RowState::Held => self.bounds == *target,
        }
    }

    /// Of the `bounds`, the one that the row follows where it is not between them.
    pub(crate) fn followed(&self, bounds: &Bounds) -> f32 {
        match self.state {
            RowState::AtHigh => bounds.high,
            _ => bounds.low,
        }
    }

    /// At the bound that the multiplier's sign is of. Between equal bounds either may have come about; else only rounding makes
    /// it the other's, and the row is at none.
    pub(crate) fn choose_side(&mut self) {
        let other = match self.state {
            RowState::AtLow if self.multiplier < 0.0 => RowState::AtHigh,
            RowState::AtHigh if self.multiplier > 0.0 => RowState::AtLow,
            _ => return,
        };
        if self.bounds.low == self.bounds.high {
            self.state = other;
        } else {
            (self.state, self.multiplier) = (RowState::Between, 0.0);
        }
    }

    /// Held where it is.
    pub(crate) fn hold(&mut self) {
        self.state = RowState::Held;
        self.bounds = Bounds::at(self.value);
    }
}

/// From wrenches `[roll, pitch, yaw, thrust]` to rows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turned {
    /// Per axis, the factor that gives its row of B unit length; 0 for an axis that is not allocated.
    pub(crate) scale: [f32; 4],
    /// Unit vector of the request's roll and pitch, scaled.
    direction: [f32; 2],
}

impl Turned {
    pub(crate) fn new(scale: [f32; 4], [roll, pitch, ..]: [f32; 4]) -> Self {
        let [roll, pitch] = [roll * scale[0], pitch * scale[1]];
        let length = sqrt(roll * roll + pitch * pitch);
        let direction = if length > 0.0 {
            [roll / length, pitch / length]
        } else {
            [1.0, 0.0]
        };
        Turned { scale, direction }
    }

    /// The rows of a wrench.
    #[inline]
    pub(crate) fn rows(&self, [roll, pitch, yaw, thrust]: [f32; 4]) -> [f32; 4] {
        let [roll, pitch] = [roll * self.scale[0], pitch * self.scale[1]];
        let [cos, sin] = self.direction;
        [
            cos * roll + sin * pitch,
            cos * pitch - sin * roll,
            yaw * self.scale[YAW],
            thrust * self.scale[THRUST],
        ]
    }
}
