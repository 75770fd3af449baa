//! Colours of maps: viridis for magnitudes, purple to orange about zero for signed quantities. Both
//! are read alike by people of every colour vision; viridis also in grey.

use colorous::{Gradient, PURPLE_ORANGE, VIRIDIS};

/// How a scalar becomes a colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    range: [f64; 2],
    signed: bool,
}

impl Scale {
    /// From `low` (dark) to `high` (light).
    pub fn sequential(range: [f64; 2]) -> Self {
        Scale { range, signed: false }
    }

    /// Symmetric about zero: purple below, orange above.
    pub fn signed(range: [f64; 2]) -> Self {
        let size = range[0].abs().max(range[1].abs());
        Scale {
            range: [-size, size],
            signed: true,
        }
    }

    fn rgb(&self, value: f64) -> [u8; 3] {
        let share = ((value - self.range[0]) / (self.range[1] - self.range[0])).clamp(0.0, 1.0);
        // PuOr runs from orange to purple.
        let (gradient, at): (Gradient, f64) = if self.signed {
            (PURPLE_ORANGE, 1.0 - share)
        } else {
            (VIRIDIS, share)
        };
        gradient.eval_continuous(at).as_array()
    }

    /// `#rrggbb` at `value`; beyond the range that of its nearer end.
    pub fn hex(&self, value: f64) -> String {
        let [r, g, b] = self.rgb(value);
        format!("#{r:02x}{g:02x}{b:02x}")
    }

    /// Black or white, whichever stands out on the colour at `value`.
    pub fn ink(&self, value: f64) -> &'static str {
        let [r, g, b] = self.rgb(value).map(f64::from);
        // Luma of ITU-R BT.601, which is how bright a screen colour looks.
        if 0.299 * r + 0.587 * g + 0.114 * b > 128.0 {
            "#000"
        } else {
            "#fff"
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_end_where_they_say() {
        let scale = Scale::sequential([0.0, 2.0]);
        assert_eq!(scale.hex(-1.0), scale.hex(0.0));
        assert_eq!(scale.hex(3.0), scale.hex(2.0));
        assert_eq!([scale.ink(0.0), scale.ink(2.0)], ["#fff", "#000"]);
        let signed = Scale::signed([-1.0, 0.5]);
        assert_eq!(signed.ink(0.0), "#000");
        assert_ne!(signed.hex(-0.5), signed.hex(0.5));
    }
}
