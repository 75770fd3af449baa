//! The tare: what the load cells read while no rotor turns.
//!
//! Rows at rest before, between and after the measurements tell the offset of every load cell, and
//! how it drifted. It is taken off all rows, on a straight line between two stops. A rotor that still
//! runs out gives thrust, so that the last row of a stop is an upper bound of the offset; a lower one
//! is below it by what the stop still lost at its end, or by [`RUN_OUT`] where it has one row. Only an
//! offset that these bounds prove to be none of noise is taken off.

use std::ops::Range;

use crate::bench::read::Sample;

/// Thrust and torque that a rotor running out gives, as a share of the greatest value: up to
/// 0.027 and 0.036 in single rows of the stops of 15 real runs.
const RUN_OUT: [f64; 2] = [0.03, 0.05];

/// An offset that is left alone, likewise; load cells that were set to zero read up to 0.004 in those.
const NOISE: f64 = 0.005;

/// A reading above this is of rotors that have not stopped, unless the stop is steady.
const STOPPED: f64 = 0.15;

/// The load cells: name, quantity (thrust, torque) and the cell of a row.
type Cell = fn(&mut Sample) -> &mut f64;
const CELLS: [(&str, usize, Cell); 6] = [
    ("thrust", 0, |s| &mut s.thrust.whole),
    ("thrust of the upper rotor", 0, |s| &mut s.thrust.rotors[0]),
    ("thrust of the lower rotor", 0, |s| &mut s.thrust.rotors[1]),
    ("torque", 1, |s| &mut s.torque.whole),
    ("torque of the upper rotor", 1, |s| &mut s.torque.rotors[0]),
    ("torque of the lower rotor", 1, |s| &mut s.torque.rotors[1]),
];

/// What a load cell reads at the end of a stop, and the bounds of its offset there.
#[derive(Clone, Copy)]
struct Stop {
    line: f64,
    /// Whether it has several rows.
    steady: bool,
    reads: f64,
    bounds: [f64; 2],
}

/// Takes the offsets that the rows at rest tell off all rows; what was taken off.
pub(super) fn take_off(samples: &mut [Sample], at_rest: impl Fn(&Sample) -> bool) -> Vec<String> {
    let stops = stops(samples, at_rest);
    let mut told = Vec::new();
    let lines: Vec<f64> = samples.iter().map(|s| s.line as f64).collect();
    let mut greatest = [0.0_f64; 2];
    for (_, quantity, cell) in CELLS {
        let sizes = samples
            .iter_mut()
            .map(|s| cell(s).abs())
            .filter(|x| x.is_finite());
        greatest[quantity] = sizes.fold(greatest[quantity], f64::max);
    }
    let mut whole = [false; 2];
    for (k, (name, quantity, cell)) in CELLS.into_iter().enumerate() {
        let column: Vec<f64> = samples.iter_mut().map(|s| *cell(s)).collect();
        let greatest = greatest[quantity];
        // Of a rotor that never turns nothing is used.
        if !column.iter().any(|x| x.abs() > STOPPED * greatest) {
            continue;
        }
        let upward = column.iter().filter(|x| x.is_finite()).sum::<f64>().signum();
        let stop = |rows: &Range<usize>| {
            let cells: Vec<f64> = column[rows.clone()]
                .iter()
                .copied()
                .filter(|x| x.is_finite())
                .collect();
            Stop::of(lines[rows.end - 1], &cells, quantity, upward, greatest)
        };
        let Some(offset) = Offset::of(stops.iter().filter_map(stop).collect(), NOISE * greatest) else {
            continue;
        };
        for (sample, line) in samples.iter_mut().zip(&lines) {
            *cell(sample) -= offset.at(*line);
        }
        // The whole, which stands before the rotors' parts, speaks for them.
        if !whole[quantity] {
            told.push(offset.told(name, ["N", "N m"][quantity], greatest));
        }
        whole[quantity] |= k % 3 == 0;
    }
    told
}

/// The stretches of rows at rest.
fn stops(samples: &[Sample], at_rest: impl Fn(&Sample) -> bool) -> Vec<Range<usize>> {
    let mut stops: Vec<Range<usize>> = Vec::new();
    for k in (0..samples.len()).filter(|&k| at_rest(&samples[k])) {
        match stops.last_mut().filter(|stop| stop.end == k) {
            Some(stop) => stop.end += 1,
            None => stops.push(k..k + 1),
        }
    }
    stops
}

impl Stop {
    fn of(line: f64, cells: &[f64], quantity: usize, upward: f64, greatest: f64) -> Option<Stop> {
        let part = (cells.len() / 4).max(1);
        let mean = |cells: &[f64]| cells.iter().sum::<f64>() / cells.len() as f64;
        let (before, last) = cells.split_at_checked(cells.len().checked_sub(part)?)?;
        let reads = mean(last);
        let run_out = match before.len() {
            0 => RUN_OUT[quantity] * greatest,
            n => (mean(&before[n.saturating_sub(part)..]) - reads).abs(),
        };
        // Thrust falls while a rotor runs out; its torque may be of either sign.
        let bounds = match (quantity, upward > 0.0) {
            (0, true) => [reads - run_out, reads],
            (0, false) => [reads, reads + run_out],
            _ => [reads - run_out, reads + run_out],
        };
        let stopped = reads.abs() <= STOPPED * greatest || run_out <= NOISE * greatest;
        let steady = !before.is_empty();
        stopped.then_some(Stop {
            line,
            steady,
            reads,
            bounds,
        })
    }
}

/// The offset of a load cell: one for all rows, or a line from stop to stop.
struct Offset(Vec<Stop>);

impl Offset {
    fn of(stops: Vec<Stop>, noise: f64) -> Option<Offset> {
        let low = stops
            .iter()
            .map(|s| s.bounds[0])
            .fold(f64::NEG_INFINITY, f64::max);
        let high = stops.iter().map(|s| s.bounds[1]).fold(f64::INFINITY, f64::min);
        if low > high + noise {
            return Some(Offset(stops));
        }
        // Of a stop of several rows the last is surely at rest.
        let sharpest = *stops.iter().max_by_key(|stop| stop.steady)?;
        let reads = sharpest.reads.clamp(low.min(high), high.max(low));
        (low > noise || high < -noise).then(|| Offset(vec![Stop { reads, ..sharpest }]))
    }

    fn at(&self, line: f64) -> f64 {
        let Offset(stops) = self;
        let after = stops.partition_point(|stop| stop.line < line);
        match (after.checked_sub(1).map(|k| stops[k]), stops.get(after)) {
            (Some(a), Some(b)) => a.reads + (b.reads - a.reads) * (line - a.line) / (b.line - a.line),
            (Some(only), None) => only.reads,
            (None, first) => first.map_or(0.0, |first| first.reads),
        }
    }

    fn told(&self, name: &str, unit: &str, greatest: f64) -> String {
        let Offset(stops) = self;
        let reading = |s: &Stop| format!("{:+.3} {unit} (line {})", s.reads, s.line);
        let largest = stops.iter().fold(0.0_f64, |most, s| most.max(s.reads.abs()));
        let percent = 100.0 * largest / greatest;
        match &stops[..] {
            [only] => format!(
                "at rest the {name} reads {}, {percent:.1} % of the greatest: taken off all rows",
                reading(only)
            ),
            [first, .., last] => format!(
                "at rest the {name} drifts from {} to {}, {percent:.1} % of the greatest: taken off row by row",
                reading(first),
                reading(last)
            ),
            [] => String::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::header::Split;

    /// Rows of (throttle, thrust); the torque is 0.01 of the true thrust.
    fn rows(rows: &[(f64, f64)]) -> Vec<Sample> {
        let sample = |(k, (throttle, thrust)): (usize, &(f64, f64))| Sample {
            line: 2 + k as u64,
            throttle: [*throttle; 2],
            thrust: Split {
                whole: *thrust,
                rotors: [f64::NAN; 2],
            },
            torque: Split {
                whole: 0.1 * throttle,
                rotors: [f64::NAN; 2],
            },
            voltage: [f64::NAN; 2],
            power_w: f64::NAN,
        };
        rows.iter().enumerate().map(sample).collect()
    }

    #[test]
    fn rows_at_rest_tell_the_offset_and_its_drift() {
        let turning = [(0.5, 3.0), (1.0, 10.0)];
        // Rows before and after the two that turn; the offsets of these; what is told.
        type Case = (
            &'static [(f64, f64)],
            &'static [(f64, f64)],
            [f64; 2],
            &'static str,
        );
        let cases: [Case; 9] = [
            (&[(0.0, 0.3), (0.0, 0.0)], &[(0.0, 0.25)], [0.0, 0.0], ""),
            (
                &[(0.0, -0.4), (0.0, -0.5)],
                &[(0.0, -0.45)],
                [-0.5, -0.5],
                "reads -0.500 N (line 3), 5.0 %",
            ),
            (
                &[(0.0, 0.5), (0.0, 0.5)],
                &[],
                [0.5, 0.5],
                "reads +0.500 N (line 3)",
            ),
            // A single row may be of rotors that run out; below zero it is not.
            (&[(0.0, 0.25)], &[], [0.0, 0.0], ""),
            (&[(0.0, -0.25)], &[], [-0.25, -0.25], "reads -0.250 N (line 2)"),
            (&[], &[(0.0, 0.5)], [0.5, 0.5], "reads +0.500 N (line 4)"),
            (
                &[(0.0, 0.0), (0.0, 0.0)],
                &[(0.0, -0.6)],
                [-0.2, -0.4],
                "drifts from +0.000 N (line 3) to -0.600 N (line 6), 6.0 %",
            ),
            // A rotor that still turns, and a command that was lost for a row.
            (&[(0.0, 4.0)], &[(0.0, 0.0), (0.0, 0.0)], [0.0, 0.0], ""),
            (&[], &[], [0.0, 0.0], ""),
        ];
        for (before, after, offsets, wanted) in cases {
            let all: Vec<(f64, f64)> = [before, &turning, after].concat();
            let mut samples = rows(&all);
            let told = take_off(&mut samples, |s| s.throttle[0] <= 0.0).join("; ");
            assert!(
                told.contains(wanted) && told.is_empty() == wanted.is_empty(),
                "{told} for {wanted}"
            );
            for ((sample, (_, read)), offset) in samples[before.len()..].iter().zip(turning).zip(offsets) {
                assert!(
                    (sample.thrust.whole - (read - offset)).abs() < 1e-9,
                    "{told}: {sample:?}"
                );
                assert!(!sample.torque.whole.is_nan());
            }
        }
    }
}
