//! Written by `cargo run -p mixer-tests --bin counts -- --fit` from `tests/counts.csv`; do not edit.

use super::{Counted, Frames, Kind, Overhead};

/// Firmware built by rustc 1.96.0 (ac68faa20 2026-05-25) (built from a source tarball).
pub const COUNTED: Counted = Counted {
    per_voltage: 78.0,
    closed_form: Overhead {
        per_mix: 95.4,
        per_unit: 59.1,
        error: 0.062,
    },
    closed_form_mean: Overhead {
        per_mix: 93.7,
        per_unit: 92.3,
        error: 0.092,
    },
    path: Overhead {
        per_mix: 17.2,
        per_unit: 118.4,
        error: 0.017,
    },
    frames: &[
        Frames {
            kind: Kind::ClosedForm,
            units: 1,
            attainable_mean: [320, 374],
            saturated_mean: [572, 631],
            worst: [1113, 1167],
        },
        Frames {
            kind: Kind::ClosedForm,
            units: 2,
            attainable_mean: [694, 694],
            saturated_mean: [1067, 1067],
            worst: [1922, 1922],
        },
        Frames {
            kind: Kind::ClosedForm,
            units: 3,
            attainable_mean: [915, 917],
            saturated_mean: [1509, 1525],
            worst: [2351, 2356],
        },
        Frames {
            kind: Kind::ClosedForm,
            units: 4,
            attainable_mean: [907, 1357],
            saturated_mean: [1623, 2074],
            worst: [2347, 2798],
        },
        Frames {
            kind: Kind::Path,
            units: 5,
            attainable_mean: [5745, 5745],
            saturated_mean: [66538, 66538],
            worst: [1583263, 1583263],
        },
        Frames {
            kind: Kind::Path,
            units: 6,
            attainable_mean: [3557, 4093],
            saturated_mean: [85320, 92533],
            worst: [488850, 522273],
        },
        Frames {
            kind: Kind::Path,
            units: 7,
            attainable_mean: [3335, 3335],
            saturated_mean: [102765, 102765],
            worst: [2625385, 2625385],
        },
        Frames {
            kind: Kind::Path,
            units: 8,
            attainable_mean: [3251, 3251],
            saturated_mean: [128738, 128738],
            worst: [2443705, 2443705],
        },
    ],
};
