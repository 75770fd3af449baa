//! Written by `cargo run -p mixer-tests --bin counts -- --fit` from `tests/counts.csv`; do not edit.

use super::{Counted, Overhead};

/// Firmware built by rustc 1.96.0 (ac68faa20 2026-05-25) (built from a source tarball).
pub const COUNTED: Counted = Counted {
    per_voltage: 45.6,
    closed_form: Overhead {
        per_mix: 101.3,
        per_unit: 99.2,
        error: 0.101,
    },
    closed_form_mean: Overhead {
        per_mix: 62.8,
        per_unit: 146.1,
        error: 0.11,
    },
    general: Overhead {
        per_mix: 256.0,
        per_unit: 319.0,
        error: 0.011,
    },
};
