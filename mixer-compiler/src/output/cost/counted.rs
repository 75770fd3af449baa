//! Written by `cargo run -p mixer-tests --bin counts -- --fit` from `tests/counts.csv`; do not edit.

use super::{Counted, Overhead};

/// Firmware built by rustc 1.96.0 (ac68faa20 2026-05-25) (built from a source tarball).
pub const COUNTED: Counted = Counted {
    per_voltage: 49.0,
    closed_form: Overhead {
        per_mix: 102.8,
        per_unit: 100.1,
        error: 0.101,
    },
    closed_form_mean: Overhead {
        per_mix: 64.3,
        per_unit: 147.6,
        error: 0.125,
    },
    general: Overhead {
        per_mix: 145.0,
        per_unit: 301.6,
        error: 0.03,
    },
};
