//! Written by `cargo run -p mixer-tests --bin counts -- --fit` from `tests/counts.csv`; do not edit.

use super::{Counted, Overhead};

/// Firmware built by rustc 1.96.0 (ac68faa20 2026-05-25) (built from a source tarball).
pub const COUNTED: Counted = Counted {
    per_voltage: 78.0,
    closed_form: Overhead {
        per_mix: 103.5,
        per_unit: 55.5,
        error: 0.063,
    },
    closed_form_mean: Overhead {
        per_mix: 99.2,
        per_unit: 89.4,
        error: 0.086,
    },
    general: Overhead {
        per_mix: 106.4,
        per_unit: 97.0,
        error: 0.005,
    },
};
