//! The work that the general path may do.

use mixer_rt::tables::Budget;

/// Work of the general path while all rotors work: so that few saturated requests need more, which
/// then are answered on the way from level flight, and the dearest one costs no more than is stated in
/// `docs/costs.md`. More pivots for eight units still spare jumps where optima tie (test
/// `throttles_do_not_jump_where_optima_tie`).
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
