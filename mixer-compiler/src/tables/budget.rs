//! The work that the general path may do.

use mixer_rt::tables::Budget;

/// Work of the general path while all rotors work. Of the requests that were counted none takes more
/// than 20,000 instructions with it on up to four vertical units, 30,000 on up to eight vertical and
/// six tilted ones, and 45,000 on up to eight (`docs/costs.md`). Of 100,000 saturated requests on a
/// regular frame of eight units about 110 need more; of as many on a frame of six about 30.
pub(super) fn budget(units: usize, is_vertical: bool) -> Budget {
    let units = u8::try_from(units).unwrap_or(u8::MAX);
    match (is_vertical, units) {
        (true, ..=8) => Budget {
            pivots: match units {
                ..=4 => 9,
                5 | 6 => 10,
                _ => 12,
            },
            flips: 48,
        },
        (false, ..=8) => Budget {
            pivots: 8 + units,
            flips: 48,
        },
        (_, more) => Budget {
            pivots: more.saturating_add(8),
            flips: more.saturating_mul(8),
        },
    }
}
