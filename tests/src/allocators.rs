//! Allocators compared on wrenches that random throttles give, so that every one is attainable.
//!
//! `tests/measurements/allocators.csv` holds a [`Row`] per frame and allocator. It is written by
//! `cargo allocators` only.

use std::fmt;
use std::path::PathBuf;

use isolated_rotors::IsolatedTables;
use mixer_compiler::Compiled;
use mixer_rt::{Wrench, tables::Airmode};

use crate::frames::{self, Options};
use crate::root;
use mixer_setpoints::Random;

/// Wrenches per frame.
pub const COUNT: usize = 20_000;
/// A wrench counts as delivered when every axis is within this share of the frame's authority.
const DELIVERED: f64 = 0.01;
/// A yaw below this share of its authority has no sign worth the name.
const SIGNED: f64 = 0.02;

/// What is counted.
#[derive(Default)]
struct Tally {
    delivered: usize,
    reversed: usize,
    error_sum: f64,
    error_worst: f64,
}

impl Tally {
    fn count(&mut self, request: [f64; 4], achieved: [f64; 4], authority: [f64; 4]) {
        let error = (0..4)
            .map(|axis| (request[axis] - achieved[axis]).abs() / authority[axis])
            .fold(0.0, f64::max);
        self.delivered += usize::from(error <= DELIVERED);
        let threshold = SIGNED * authority[2];
        let reversed = request[2].abs() > threshold && request[2] * achieved[2] < 0.0;
        self.reversed += usize::from(reversed);
        self.error_sum += error;
        self.error_worst = self.error_worst.max(error);
    }

    fn row(&self, frame: &str, allocator: &str) -> Row {
        let share = |count: usize| 100.0 * count as f64 / COUNT as f64;
        Row {
            frame: frame.to_owned(),
            allocator: allocator.to_owned(),
            percent: [
                share(self.delivered),
                100.0 * self.error_sum / COUNT as f64,
                100.0 * self.error_worst,
                share(self.reversed),
            ]
            .map(|value| format!("{value:.2}")),
        }
    }
}

/// One allocator on one frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// Name of the frame.
    pub frame: String,
    /// What allocates.
    pub allocator: String,
    /// Percent with two decimals: wrenches delivered, mean and worst error as a share of the
    /// authority, wrenches whose yaw is reversed.
    pub percent: [String; 4],
}

/// One line of CSV.
impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{},{}", self.frame, self.allocator, self.percent.join(","))
    }
}

const HEADER: &str = "frame,allocator,delivered,mean_error,worst_error,yaw_reversed";

/// The file of the measurement.
pub fn file() -> PathBuf {
    root().join("tests/measurements/allocators.csv")
}

/// The text of the file.
pub fn text(rows: &[Row]) -> String {
    let rows: String = rows.iter().map(|row| format!("{row}\n")).collect();
    format!("{HEADER}\n{rows}")
}

/// Measures all frames.
///
/// # Errors
/// A frame that does not compile.
pub fn measure() -> Result<Vec<Row>, String> {
    let mut rows = Vec::new();
    for (name, places) in frames::regular_frames() {
        let compiled = frames::compile(&places, Options::default()).map_err(|faults| faults.to_string())?;
        rows.extend(compare(name, &compiled));
    }
    Ok(rows)
}

fn compare(name: &str, compiled: &Compiled) -> [Row; 4] {
    let pair = &compiled.maps[0];
    let matrix = &compiled.effectiveness.matrix;
    let n = compiled.airframe.units.len();
    let [size_f, size_q] = pair.scale();
    let authority: [f64; 4] = std::array::from_fn(|axis| {
        (0..n)
            .map(|i| matrix[(axis, i)].abs() * size_f + matrix[(axis, n + i)].abs() * size_q)
            .sum()
    });
    let wrench = |throttles: &[[f64; 2]]| -> [f64; 4] {
        let mut wrench = [0.0; 4];
        for (i, &throttles) in throttles.iter().enumerate() {
            let [f, q] = pair.efforts(throttles);
            for (axis, wrench) in wrench.iter_mut().enumerate() {
                *wrench += matrix[(axis, i)] * f + matrix[(axis, n + i)] * q;
            }
        }
        wrench
    };
    let isolated = IsolatedTables::new(compiled);
    let reference_v = compiled.airframe.reference_v() as f32;
    let [low, high] = pair.range();
    let mut random = Random::new(20);
    let (mut exact, mut least_norm) = (Tally::default(), Tally::default());
    let (mut conventional, mut sequential) = (Tally::default(), Tally::default());
    for _ in 0..COUNT {
        let throttles: Vec<[f64; 2]> = (0..n)
            .map(|_| [random.uniform(low, high), random.uniform(low, high)])
            .collect();
        let request = wrench(&throttles);
        let setpoint = Wrench::from_array(request.map(|x| x as f32));
        if let Ok((_, achieved, _)) = compiled.tables.mix(&setpoint, reference_v) {
            exact.count(request, achieved.to_array().map(f64::from), authority);
        }
        // M+ u, then the inverse map's clamps.
        let view = compiled.tables.view();
        let throttles: Vec<[f64; 2]> = view
            .units
            .iter()
            .map(|unit| {
                let efforts = unit
                    .allocation
                    .map(|row| row.iter().zip(setpoint.to_array()).map(|(a, b)| a * b).sum());
                compiled
                    .tables
                    .throttles(0, efforts)
                    .unwrap_or_default()
                    .map(f64::from)
            })
            .collect();
        least_norm.count(request, wrench(&throttles), authority);
        let given = |(throttles, _): (Vec<f32>, bool)| {
            let units = compiled.airframe.units.iter();
            let pairs: Vec<[f64; 2]> = units.map(|unit| unit.throttles(&throttles)).collect();
            wrench(&pairs)
        };
        if let Ok(mix) = isolated.conventional(&setpoint, reference_v) {
            conventional.count(request, given(mix), authority);
        }
        if let Ok(mix) = isolated.sequential(Airmode::Disabled, &setpoint, reference_v) {
            sequential.count(request, given(mix), authority);
        }
    }
    [
        exact.row(name, "this mixer"),
        least_norm.row(name, "least norm with clamping"),
        sequential.row(name, "isolated rotors with sequential desaturation after PX4"),
        conventional.row(
            name,
            "isolated rotors with clipping (the paper's conventional mixer)",
        ),
    ]
}
