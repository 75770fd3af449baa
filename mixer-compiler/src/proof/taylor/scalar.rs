//! The operations of the runtime on Taylor models.

use mixer_rt::tables::Scalar;

use super::{Taylor, UP};
use crate::bounds::interval::Interval;

impl Scalar for Taylor {
    fn constant(value: f32) -> Taylor {
        Taylor::exact(f64::from(value))
    }

    fn reciprocal(self) -> Taylor {
        let Interval { low, high } = self.range();
        let least = if low > 0.0 { low } else { -high };
        if least <= self.error || least.is_nan() {
            return Taylor::unbounded();
        }
        // 1/(c + p) = 1/c - p/c2 + p2/c3 - p3/(c3 (c + p))
        let per = 1.0 / self.c;
        let size = self.deviation();
        let rest = size * size * size * (per * per * per).abs() / least;
        let carried = self.error / (least * (least - self.error));
        self.composed([per, -per * per, per * per * per], rest * UP)
            .rounded(carried * UP)
    }

    fn root(self) -> Taylor {
        let Interval { low, high } = self.range();
        // The radicand is limited to zero, in f32 and in truth: limits bring numbers no further
        // apart.
        if low <= 0.0 || low.is_nan() {
            let above = high.max(0.0).sqrt() * UP;
            let error = self.error.sqrt();
            return Taylor::from_interval(Interval {
                low: 0.0,
                high: above,
            })
            .rounded(error * UP);
        }
        // sqrt(c + p) = s + p/(2 s) - p2/(8 s3) + p3/(16 x^(5/2)), x between c and c + p
        let root = self.c.sqrt();
        let size = self.deviation();
        let rest = size * size * size / (16.0 * low * low * low.sqrt());
        let carried = (self.error / low.sqrt()).min(self.error.sqrt());
        self.composed([root, 0.5 / root, -0.125 / (root * root * root)], rest * UP)
            .rounded(carried * UP)
    }

    fn within(self, low: f32, high: f32) -> Taylor {
        let range = self.range();
        let beyond = (range.high - f64::from(high)).max(f64::from(low) - range.low);
        // Limiting moves a number by no more than it lies outside, and two numbers no further
        // apart.
        if beyond <= 0.0 { self } else { self.widened(beyond) }
    }
}
