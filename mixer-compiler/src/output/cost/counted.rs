//! Written by `cargo run -p mixer-tests --bin counts -- --fit` from `tests/counts.csv`; do not edit.

use super::{Counted, Overhead};

/// Firmware built by rustc 1.96.0 (ac68faa20 2026-05-25) (built from a source tarball).
pub const COUNTED: Counted = Counted {
    per_voltage: 44.9,
    closed_form: Overhead {
        per_mix: 106.5,
        per_unit: 97.6,
        error: 0.099,
    },
    closed_form_mean: Overhead {
        per_mix: 68.5,
        per_unit: 144.4,
        error: 0.108,
    },
    general: Overhead {
        per_mix: 269.6,
        per_unit: 298.8,
        error: 0.036,
    },
};
