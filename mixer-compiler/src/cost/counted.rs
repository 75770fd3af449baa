//! Written by `cargo run -p mixer-tests --bin counts -- --fit` from `tests/counts.csv`; do not edit.

use super::{Counted, Frames, Kind, Overhead};

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
    path: Overhead {
        per_mix: 106.4,
        per_unit: 97.0,
        error: 0.005,
    },
    frames: &[
        Frames {
            kind: Kind::Path,
            units: 5,
            attainable_mean: [2686, 2686],
            saturated_mean: [64748, 64748],
            worst: [990784, 990784],
        },
        Frames {
            kind: Kind::Path,
            units: 6,
            attainable_mean: [2359, 2401],
            saturated_mean: [75846, 95923],
            worst: [1035696, 1175613],
        },
        Frames {
            kind: Kind::Path,
            units: 7,
            attainable_mean: [2212, 2212],
            saturated_mean: [110906, 110906],
            worst: [3086606, 3086606],
        },
        Frames {
            kind: Kind::Path,
            units: 8,
            attainable_mean: [2341, 2341],
            saturated_mean: [108342, 108342],
            worst: [1523188, 1523188],
        },
    ],
};
