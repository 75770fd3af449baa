//! Tools that enclose a value between two floats: interval arithmetic, bisection.

pub(crate) mod interval;

/// Halvings that take any range of throttles to the rounding of f64.
const HALVINGS: usize = 52;

/// The least number of a range from which on `is_beyond` holds, by bisection; its end where that holds nowhere.
pub fn bisected([mut low, mut high]: [f64; 2], is_beyond: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if is_beyond(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}
