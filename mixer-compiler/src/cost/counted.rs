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
        per_mix: 82.5,
        per_unit: 100.5,
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
            attainable_mean: [1022, 1022],
            saturated_mean: [1870, 1870],
            worst: [4268, 4268],
        },
        Frames {
            kind: Kind::Bent,
            units: 4,
            attainable_mean: [1154, 1154],
            saturated_mean: [2295, 2295],
            worst: [11170, 11170],
        },
        Frames {
            kind: Kind::Coupled,
            units: 4,
            attainable_mean: [1105, 1145],
            saturated_mean: [3161, 3666],
            worst: [9100, 11437],
        },
        Frames {
            kind: Kind::Path,
            units: 5,
            attainable_mean: [2590, 2590],
            saturated_mean: [48691, 48691],
            worst: [235998, 235998],
        },
        Frames {
            kind: Kind::Path,
            units: 6,
            attainable_mean: [2204, 2252],
            saturated_mean: [63446, 66562],
            worst: [364914, 374948],
        },
        Frames {
            kind: Kind::Path,
            units: 7,
            attainable_mean: [2151, 2151],
            saturated_mean: [71180, 71180],
            worst: [303167, 303167],
        },
        Frames {
            kind: Kind::Path,
            units: 8,
            attainable_mean: [2304, 2304],
            saturated_mean: [90223, 90223],
            worst: [531475, 531475],
        },
    ],
};
