//! Written by `cargo run -p mixer-tests --bin counts -- --fit` from `tests/counts.csv`; do not edit.

use super::{Counted, Frames, Kind, Overhead};

/// Firmware built by rustc 1.96.0 (ac68faa20 2026-05-25) (built from a source tarball).
pub const COUNTED: Counted = Counted {
    per_voltage: 66.3,
    closed_form: Overhead {
        per_mix: 109.0,
        per_unit: 15.2,
        error: 0.043,
    },
    closed_form_mean: Overhead {
        per_mix: 106.7,
        per_unit: 49.9,
        error: 0.074,
    },
    path: Overhead {
        per_mix: -67.5,
        per_unit: 129.0,
        error: 0.03,
    },
    frames: &[
        Frames {
            kind: Kind::ClosedForm,
            units: 1,
            attainable_mean: [290, 340],
            saturated_mean: [543, 598],
            worst: [1084, 1136],
        },
        Frames {
            kind: Kind::ClosedForm,
            units: 2,
            attainable_mean: [589, 590],
            saturated_mean: [960, 961],
            worst: [1815, 1816],
        },
        Frames {
            kind: Kind::ClosedForm,
            units: 3,
            attainable_mean: [775, 775],
            saturated_mean: [1386, 1400],
            worst: [2232, 2236],
        },
        Frames {
            kind: Kind::ClosedForm,
            units: 4,
            attainable_mean: [741, 1190],
            saturated_mean: [1471, 1928],
            worst: [2199, 2658],
        },
        Frames {
            kind: Kind::Path,
            units: 5,
            attainable_mean: [5543, 5543],
            saturated_mean: [67917, 67917],
            worst: [1432466, 1432466],
        },
        Frames {
            kind: Kind::Path,
            units: 6,
            attainable_mean: [3438, 3981],
            saturated_mean: [82131, 86666],
            worst: [357974, 418894],
        },
        Frames {
            kind: Kind::Path,
            units: 7,
            attainable_mean: [3250, 3250],
            saturated_mean: [129678, 129678],
            worst: [2471074, 2471074],
        },
        Frames {
            kind: Kind::Path,
            units: 8,
            attainable_mean: [3244, 3244],
            saturated_mean: [125369, 125369],
            worst: [2043457, 2043457],
        },
    ],
};
