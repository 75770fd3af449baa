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
        per_mix: 99.5,
        per_unit: 90.1,
        error: 0.087,
    },
    path: Overhead {
        per_mix: 97.3,
        per_unit: 97.7,
        error: 0.001,
    },
    frames: &[
        Frames {
            kind: Kind::ClosedForm,
            units: 1,
            attainable_mean: [324, 378],
            saturated_mean: [572, 631],
            worst: [1097, 1151],
        },
        Frames {
            kind: Kind::ClosedForm,
            units: 2,
            attainable_mean: [691, 691],
            saturated_mean: [1062, 1062],
            worst: [1818, 1818],
        },
        Frames {
            kind: Kind::ClosedForm,
            units: 3,
            attainable_mean: [912, 914],
            saturated_mean: [1501, 1517],
            worst: [2299, 2304],
        },
        Frames {
            kind: Kind::ClosedForm,
            units: 4,
            attainable_mean: [905, 1355],
            saturated_mean: [1621, 2072],
            worst: [2475, 2926],
        },
        Frames {
            kind: Kind::Bent,
            units: 3,
            attainable_mean: [1026, 1026],
            saturated_mean: [1885, 1885],
            worst: [4447, 4447],
        },
        Frames {
            kind: Kind::Bent,
            units: 4,
            attainable_mean: [1156, 1156],
            saturated_mean: [2313, 2313],
            worst: [11144, 11144],
        },
        Frames {
            kind: Kind::Coupled,
            units: 4,
            attainable_mean: [1105, 1145],
            saturated_mean: [3059, 3616],
            worst: [9324, 13000],
        },
        Frames {
            kind: Kind::Path,
            units: 5,
            attainable_mean: [2478, 2478],
            saturated_mean: [52761, 52761],
            worst: [799439, 799439],
        },
        Frames {
            kind: Kind::Path,
            units: 6,
            attainable_mean: [2247, 2285],
            saturated_mean: [66067, 81710],
            worst: [754025, 836786],
        },
        Frames {
            kind: Kind::Path,
            units: 7,
            attainable_mean: [2169, 2169],
            saturated_mean: [85603, 85603],
            worst: [1784884, 1784884],
        },
        Frames {
            kind: Kind::Path,
            units: 8,
            attainable_mean: [2307, 2307],
            saturated_mean: [93264, 93264],
            worst: [1071426, 1071426],
        },
    ],
};
