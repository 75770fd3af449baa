//! Numbers as people read them: round ticks, few digits, a true minus sign.

use mixer_compiler::diagnostic::is_plain;

/// `x` with `digits` significant digits, without trailing zeros of an exponent form; `-0` is `0`.
pub fn significant(x: f64, digits: usize) -> String {
    if x == 0.0 || !x.is_finite() {
        return if x == 0.0 { "0".into() } else { x.to_string() };
    }
    let exponent = libm::floor(libm::log10(x.abs())) as i32;
    if (-4..6).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        signed(format!("{x:.decimals$}"))
    } else {
        signed(format!("{x:.*e}", digits.saturating_sub(1)))
    }
}

/// `x` with four significant digits at most and no zeros at the end.
pub fn shortest(x: f64) -> String {
    let rounded: f64 = format!("{x:.3e}").parse().unwrap_or(x);
    signed(rounded.to_string())
}

/// `x` with `decimals` digits after the point.
pub fn fixed(x: f64, decimals: usize) -> String {
    signed(format!("{x:.decimals$}"))
}

/// A typographic minus instead of the hyphen, and none before a zero.
fn signed(text: String) -> String {
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|byte| matches!(byte, b'0' | b'.')) => rest.to_owned(),
        Some(rest) => format!("\u{2212}{}", rest.replace("e-", "e\u{2212}")),
        None => text.replace("e-", "e\u{2212}"),
    }
}

/// A positive `x` to the nearest multiple of half its leading digit's unit: 39.5 to 40, 148 to 150,
/// 7.3 to 7.5.
pub fn round_half_digit(x: f64) -> f64 {
    let half = 0.5 * libm::pow(10.0, libm::floor(libm::log10(x)));
    let rounded = libm::round(x / half) * half;
    if rounded.is_finite() { rounded } else { x }
}

/// Round values 1, 2 or 5 times a power of ten apart within a range.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ticks {
    /// The values, ascending.
    pub values: Vec<f64>,
    decimals: usize,
}

impl Ticks {
    /// About `count` ticks within `[low, high]`; none where the range is empty.
    pub fn within([low, high]: [f64; 2], count: usize) -> Self {
        let span = high - low;
        if !(span > 0.0 && span.is_finite()) || count == 0 {
            return Ticks::default();
        }
        let rough = span / count as f64;
        let exponent = libm::floor(libm::log10(rough));
        let power = libm::pow(10.0, exponent);
        let share = rough / power;
        // Between two round steps the nearer one in proportion.
        let (factor, carry) = match share {
            s if s < 1.414 => (1.0, 0.0),
            s if s < 3.162 => (2.0, 0.0),
            s if s < 7.071 => (5.0, 0.0),
            _ => (1.0, 1.0),
        };
        let exponent = exponent + carry;
        let step = factor * libm::pow(10.0, exponent);
        let slack = 1e-9 * span;
        let first = libm::ceil((low - slack) / step) as i64;
        let last = libm::floor((high + slack) / step) as i64;
        Ticks {
            values: (first..=last).map(|k| k as f64 * step).collect(),
            decimals: (-exponent).max(0.0) as usize,
        }
    }

    /// A value as it stands beside its tick.
    pub fn text(&self, value: f64) -> String {
        fixed(value, self.decimals)
    }

    /// All values with their texts.
    pub fn texts(&self) -> Vec<(f64, String)> {
        self.values
            .iter()
            .map(|&value| (value, self.text(value)))
            .collect()
    }

    /// Distance of neighbours; 0 where there are none.
    pub fn step(&self) -> f64 {
        match self.values.as_slice() {
            [first, second, ..] => second - first,
            _ => 0.0,
        }
    }
}

/// `range` widened by `share` of itself on both sides.
pub fn widened([low, high]: [f64; 2], share: f64) -> [f64; 2] {
    let room = (high - low) * share;
    [low - room, high + room]
}

/// The range of the finite values; `[0, 1]` where there are none, and never empty.
pub fn range(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let [low, high] = values
        .into_iter()
        .filter(|x| x.is_finite())
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
            [low.min(x), high.max(x)]
        });
    if low < high {
        [low, high]
    } else if low == high {
        let room = if low == 0.0 { 1.0 } else { 0.05 * low.abs() };
        [low - room, high + room]
    } else {
        [0.0, 1.0]
    }
}

/// Text as it stands in HTML and SVG, attributes included.
pub fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' | '\t' => out.push(letter),
            // Control characters are no XML, not even escaped.
            c if !is_plain(c) => out.push('\u{fffd}'),
            '\u{fffe}' | '\u{ffff}' => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

/// A number with seven significant digits at most, those of single precision.
pub(crate) fn cell(x: f64) -> String {
    // Rounding residues of sums are zeros.
    let x = if x.abs() < 1e-12 { 0.0 } else { x };
    let rounded: f64 = format!("{x:.6e}").parse().unwrap_or(x);
    format!("{}", rounded + 0.0)
}

/// Numbers as a row of CSV.
pub(crate) fn line(values: impl IntoIterator<Item = f64>) -> String {
    let cells = values.into_iter().map(cell);
    itertools::join(cells, ",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_within() {
        let ticks = Ticks::within([-0.217, 0.2049], 5);
        assert_eq!(
            ticks.values.iter().map(|&x| ticks.text(x)).collect::<Vec<_>>(),
            ["−0.2", "−0.1", "0.0", "0.1", "0.2"]
        );
        assert_eq!(Ticks::within([0.1, 1.0], 9).values.len(), 10);
        assert!(Ticks::within([1.0, 1.0], 5).values.is_empty());
        assert!(Ticks::within([0.0, f64::NAN], 5).values.is_empty());
    }

    #[test]
    fn numbers_are_short_and_signed() {
        assert_eq!(significant(-0.003_211, 2), "−0.0032");
        assert_eq!(significant(1.23e-7, 2), "1.2e−7");
        assert_eq!(significant(39.66, 2), "40");
        assert_eq!(fixed(-0.0001, 2), "0.00");
        assert_eq!(
            [39.5, 148.0, 7.3, 0.23].map(round_half_digit),
            [40.0, 150.0, 7.5, 0.25]
        );
    }

    #[test]
    fn ranges_are_never_empty() {
        assert_eq!(range([]), [0.0, 1.0]);
        assert_eq!(range([f64::NAN, 2.0]), [1.9, 2.1]);
        assert_eq!(range([0.0, 3.0, -1.0]), [-1.0, 3.0]);
    }

    #[test]
    fn markup_is_escaped() {
        assert_eq!(
            escaped("<a b=\"c\">&\u{1}"),
            "&lt;a b=&quot;c&quot;&gt;&amp;\u{fffd}"
        );
    }
}
