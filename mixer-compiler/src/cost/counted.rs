//! Written by `cargo run -p mixer-tests --bin counts -- --fit` from `tests/counts.csv`; do not edit.

use super::{Counted, Frames, Kind, Overhead};

/// Firmware built by rustc 1.95.0 (59807616e 2026-04-14).
pub const COUNTED: Counted = Counted {
    per_voltage: 78.1,
    closed_form: Overhead {
        per_mix: 103.5,
        per_unit: 55.5,
        error: 0.063,
    },
    closed_form_mean: Overhead {
        per_mix: 98.6,
        per_unit: 90.7,
        error: 0.087,
    },
    path: Overhead {
        per_mix: 82.8,
        per_unit: 99.8,
        error: 0.002,
    },
    frames: &[
        Frames {
            kind: Kind::ClosedForm,
            units: 1,
            attainable_mean: [324, 378],
            saturated_mean: [575, 634],
            worst: [1119, 1173],
        },
        Frames {
            kind: Kind::ClosedForm,
            units: 2,
            attainable_mean: [692, 692],
            saturated_mean: [1065, 1065],
            worst: [1855, 1855],
        },
        Frames {
            kind: Kind::ClosedForm,
            units: 3,
            attainable_mean: [913, 915],
            saturated_mean: [1508, 1523],
            worst: [2351, 2356],
        },
        Frames {
            kind: Kind::ClosedForm,
            units: 4,
            attainable_mean: [907, 1357],
            saturated_mean: [1624, 2075],
            worst: [2347, 2798],
        },
        Frames {
            kind: Kind::Bent,
            units: 3,
            attainable_mean: [1023, 1023],
            saturated_mean: [1874, 1874],
            worst: [4298, 4298],
        },
        Frames {
            kind: Kind::Bent,
            units: 4,
            attainable_mean: [1154, 1154],
            saturated_mean: [2297, 2297],
            worst: [11131, 11131],
        },
        Frames {
            kind: Kind::Coupled,
            units: 4,
            attainable_mean: [1105, 1145],
            saturated_mean: [2979, 3432],
            worst: [8499, 10623],
        },
        Frames {
            kind: Kind::Path,
            units: 5,
            attainable_mean: [2468, 2468],
            saturated_mean: [51389, 51389],
            worst: [570332, 570332],
        },
        Frames {
            kind: Kind::Path,
            units: 6,
            attainable_mean: [2245, 2283],
            saturated_mean: [64254, 77380],
            worst: [581573, 606938],
        },
        Frames {
            kind: Kind::Path,
            units: 7,
            attainable_mean: [2167, 2167],
            saturated_mean: [82543, 82543],
            worst: [1151128, 1151128],
        },
        Frames {
            kind: Kind::Path,
            units: 8,
            attainable_mean: [2306, 2306],
            saturated_mean: [90559, 90559],
            worst: [1259448, 1259448],
        },
    ],
};
