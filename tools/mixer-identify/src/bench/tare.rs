//! The tare: what the load cells read while no rotor turns.
//!
//! Commands of 0 do not prove rest, since a rotor runs out for seconds. A stop is at rest where its
//! speeds are 0 or, without speeds, where several rows in a row agree. Any other stop tells nothing. An
//! offset is told; only `--tare` takes it off, one constant per load cell.

use std::ops::Range;

use crate::bench::plateau;
use crate::bench::read::{ROTOR_CELLS, Sample};
use crate::statistics::{extent, mean_of_finite, rms};

/// The share of the greatest reading that rows at rest may scatter by and an offset may have: load cells
/// that were set to zero read less.
const NOISE: f64 = 0.005;

/// Fewest rows that show by their agreement that a rotor without a speed is at rest.
const SEVERAL: usize = 2;

/// The load cells: name, unit, quantity (thrust, torque) and the cell of a row.
type Cell = fn(&mut Sample) -> &mut f64;
const CELLS: [(&str, &str, usize, Cell); 6] = [
    ("thrust", "N", 0, |s| &mut s.thrust.whole),
    (ROTOR_CELLS[0], "N", 0, |s| &mut s.thrust.rotors[0]),
    (ROTOR_CELLS[1], "N", 0, |s| &mut s.thrust.rotors[1]),
    ("torque", "N m", 1, |s| &mut s.torque.whole),
    (ROTOR_CELLS[2], "N m", 1, |s| &mut s.torque.rotors[0]),
    (ROTOR_CELLS[3], "N m", 1, |s| &mut s.torque.rotors[1]),
];

/// Offsets of the load cells, in words.
#[derive(Default)]
pub(super) struct Tare {
    /// Those that were taken off.
    pub(super) taken_off: Vec<String>,
    /// Those that remain in the rows.
    pub(super) warnings: Vec<String>,
}

/// Finds the offsets of the load cells in the stops, rows that are `commanded_off`, and takes them off
/// where that is asked for.
pub(super) fn examine(
    samples: &mut [Sample],
    commanded_off: impl Fn(&Sample) -> bool,
    takes_off: bool,
) -> Tare {
    let columns = CELLS.map(|(_, _, _, cell)| samples.iter_mut().map(|s| *cell(s)).collect::<Vec<f64>>());
    let greatest = [0, 1].map(|quantity| {
        let cells = columns.iter().zip(CELLS).filter(|(_, cell)| cell.2 == quantity);
        let readings = cells.flat_map(|(column, _)| column).map(|x| x.abs());
        readings.filter(|x| x.is_finite()).fold(0.0, f64::max)
    });
    let mean = |column: &[f64], rows: &[usize]| mean_of_finite(rows.iter().map(|&k| column[k]));
    let scatters = |rows: &[usize]| {
        columns.iter().zip(CELLS).any(|(column, cell)| {
            let middle = mean(column, rows);
            let about = rows.iter().map(|&k| column[k] - middle);
            rms(about.filter(|x| x.is_finite())) > NOISE * greatest[cell.2]
        })
    };
    let mut rests = at_rest(samples, commanded_off);
    rests.retain(|rows| !scatters(rows));
    let mut tare = Tare::default();
    let rows = rests.concat();
    let (Some(first), Some(last)) = (rows.first(), rows.last()) else {
        if takes_off {
            tare.warnings.push(
                "--tare: no rows at rest, nothing is taken off; a stop is at rest where its speeds are 0, or where several rows at \
                 throttle 0 agree"
                    .into(),
            );
        }
        return tare;
    };
    let lines = [first, last].map(|&k| samples[k].line);
    for ((name, unit, quantity, cell), column) in CELLS.into_iter().zip(&columns) {
        let [low, high] = extent(rests.iter().map(|rows| mean(column, rows)));
        let share = |x: f64| x / greatest[quantity];
        let (offset, most) = (mean(column, &rows), share(low.abs().max(high.abs())));
        if !offset.is_finite() || most <= NOISE {
            continue;
        }
        let drifts = share(high - low) > NOISE;
        let reads = match drifts {
            true => format!("varies between {low:+.4} and {high:+.4} {unit}"),
            false => format!("is {offset:+.4} {unit}"),
        };
        let told = format!(
            "the {name} at rest (lines {} to {}) {reads}, up to {:.1} % of the greatest",
            lines[0],
            lines[1],
            100.0 * most
        );
        if takes_off {
            samples.iter_mut().for_each(|s| *cell(s) -= offset);
            tare.taken_off.push(format!(
                "{told}: the mean, {offset:+.4} {unit}, is taken off all rows"
            ));
        }
        if drifts || !takes_off {
            tare.warnings.push(format!(
                "{told}: --tare takes {} off all rows",
                if drifts { "the mean" } else { "it" }
            ));
        }
    }
    tare
}

/// Takes a torque of 0 in every row for one that was not measured.
pub(super) fn no_torque(samples: &mut [Sample], turning: &[usize]) -> Option<String> {
    let own = CELLS[3..].iter().enumerate();
    let own = own.filter(|(k, _)| *k == 0 || turning.contains(&(k - 1)));
    let told = own.filter_map(|(_, (name, _, _, cell))| {
        let is_none = extent(samples.iter_mut().map(|s| *cell(s)).filter(|q| q.is_finite())) == [0.0; 2];
        is_none.then(|| {
            samples.iter_mut().for_each(|s| *cell(s) = f64::NAN);
            format!("the {name} is 0 in every row: taken as not measured")
        })
    });
    told.last()
}

/// The rows of each stop in which every speed is 0 or, without speeds, which are several; of a streaming
/// log without those that settle.
fn at_rest(samples: &[Sample], commanded_off: impl Fn(&Sample) -> bool) -> Vec<Vec<usize>> {
    let mut stops: Vec<Range<usize>> = Vec::new();
    for k in (0..samples.len()).filter(|&k| commanded_off(&samples[k])) {
        match stops.last_mut().filter(|stop| stop.end == k) {
            Some(stop) => stop.end += 1,
            None => stops.push(k..k + 1),
        }
    }
    // A speed that is 0 throughout is none.
    let told = [0, 1].map(|rotor| samples.iter().any(|s| s.speed[rotor].abs() > 0.0));
    let stands = |k: &usize| (0..2).all(|rotor| !told[rotor] || samples[*k].speed[rotor] == 0.0);
    let least = if told == [false; 2] { SEVERAL } else { 1 };
    let settled = stops.into_iter().map(|stop| {
        let start = stop.start + plateau::settling(stop.len());
        (start..stop.end).filter(stands).collect::<Vec<usize>>()
    });
    settled.filter(|rows| rows.len() >= least).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::header::Split;

    /// A row of (throttle, thrust, speed); the torque is 0.1 of the throttle.
    type Row = (f64, f64, f64);
    const X: f64 = f64::NAN;

    fn samples(rows: &[Row]) -> Vec<Sample> {
        let rotors = [f64::NAN; 2];
        let row = |(k, &(throttle, whole, speed)): (usize, &Row)| Sample {
            line: 2 + k as u64,
            throttle: [throttle; 2],
            thrust: Split { whole, rotors },
            torque: Split {
                whole: 0.1 * throttle,
                rotors,
            },
            voltage: rotors,
            power_w: f64::NAN,
            speed: [speed; 2],
            time_s: f64::NAN,
        };
        rows.iter().enumerate().map(row).collect()
    }

    #[test]
    fn rows_that_are_surely_at_rest_tell_the_tare_and_no_others() {
        // Rows before and after two that turn; the offset that --tare takes off; what is told without it.
        type Case = (&'static [Row], &'static [Row], f64, &'static str);
        let cases: [Case; 11] = [
            (&[(0.0, 0.3, X), (0.0, 0.0, X)], &[(0.0, 0.25, X)], 0.0, ""),
            (
                &[(0.0, -0.5, X), (0.0, -0.5, X)],
                &[],
                -0.5,
                "(lines 2 to 3) is -0.5000 N, up to 5.0 % of the greatest: --tare",
            ),
            (&[(0.0, 0.01, X), (0.0, 0.01, X)], &[], 0.0, ""),
            // One row may be of rotors that run out, unless its speed is 0.
            (&[(0.0, -0.5, X)], &[], 0.0, ""),
            (&[(0.0, -0.5, 0.0)], &[], -0.5, "(lines 2 to 2) is -0.5000 N"),
            (
                &[(0.0, 0.8, 540.0), (0.0, 0.5, 0.0)],
                &[],
                0.5,
                "(lines 3 to 3) is +0.5000 N",
            ),
            (&[], &[(0.0, 0.9, 1100.0), (0.0, 0.9, 1100.0)], 0.0, ""),
            // A stand that rings at a speed of 0.
            (&[], &[(0.0, 0.2, 0.0), (0.0, 0.7, 0.0), (0.0, 0.3, 0.0)], 0.0, ""),
            (
                &[(0.0, 0.0, 0.0)],
                &[(0.0, -0.6, 0.0)],
                -0.3,
                "(lines 2 to 5) varies between -0.6000 and +0.0000 N, up to 6.0 % of the greatest: --tare takes the mean off",
            ),
            // A column of speeds that was not recorded.
            (&[(0.0, 0.5, X)], &[(0.0, 0.5, X)], 0.0, ""),
            (&[], &[], 0.0, ""),
        ];
        for (before, after, offset, wanted) in cases {
            let turning = [(0.5, 3.0, 5000.0), (1.0, 10.0, 9000.0)];
            let speeds = |row: &Row| {
                if before.iter().chain(after).any(|r| !r.2.is_nan()) {
                    *row
                } else {
                    (row.0, row.1, X)
                }
            };
            let all: Vec<Row> = [before, &turning, after].concat().iter().map(speeds).collect();
            for taken in [false, true] {
                let mut rows = samples(&all);
                let tare = examine(&mut rows, |s| s.throttle[0] <= 0.0, taken);
                let told = tare.warnings.join("; ");
                if !taken {
                    assert!(
                        told.contains(wanted) && told.is_empty() == wanted.is_empty(),
                        "{told} for {wanted}"
                    );
                    assert!(tare.taken_off.is_empty());
                }
                assert_eq!(
                    tare.taken_off.is_empty(),
                    offset == 0.0 || !taken,
                    "{:?}",
                    tare.taken_off
                );
                let by = if taken { offset } else { 0.0 };
                for (row, (_, read, _)) in rows[before.len()..].iter().zip(turning) {
                    assert!((row.thrust.whole - (read - by)).abs() < 1e-9, "{wanted}: {row:?}");
                    assert!(!row.torque.whole.is_nan());
                }
            }
        }
    }
}
