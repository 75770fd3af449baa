//! Written by `cargo run -p mixer-tests --bin counts -- --fit` from `tests/counts.csv`; do not edit.

use super::{Counted, Overhead};

/// Firmware built by rustc 1.96.0 (ac68faa20 2026-05-25) (built from a source tarball).
pub const COUNTED: Counted = Counted {
    per_voltage: 51.1,
    closed_form: Overhead {
        per_mix: 96.1,
        per_unit: 102.3,
        error: 0.1,
    },
    closed_form_mean: Overhead {
        per_mix: 57.5,
        per_unit: 149.6,
        error: 0.125,
    },
    general: Overhead {
        per_mix: 207.1,
        per_unit: 294.5,
        error: 0.025,
    },
};
