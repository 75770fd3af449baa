//! Streaming logs: many rows per command, most of them alike.
//!
//! Successive rows of a streaming log share their noise, and the first ones after a change of
//! command show a rotor still speeding up. Fitted row by row they would give intervals several
//! times too narrow around a biased map. So each plateau of constant command becomes one point, the
//! mean of its rows after a settling time; rows of ramps between plateaus are dropped. Each
//! channel's mean is over the rows where it is not blank.

use crate::bench::header::Split;
use crate::bench::read::Sample;
use crate::statistics::mean_of_finite;

/// Fewer rows than this make no plateau.
const PLATEAU_ROWS: usize = 5;
/// Two commands closer than this are the same (1 us of 1000).
const SAME_COMMAND: f64 = 1e-3;

/// Whether most rows stand in plateaus. One row several times is none.
pub fn is_streaming(samples: &[Sample]) -> bool {
    let differ = |run: &&[Sample]| run.iter().any(|sample| !sample.equals(&run[0]));
    let lengths = runs(samples).filter(differ).map(<[Sample]>::len);
    let in_plateaus: usize = lengths.filter(|&n| n >= PLATEAU_ROWS).sum();
    2 * in_plateaus > samples.len()
}

/// Part of each plateau that is left to settle.
const SETTLE: f64 = 0.33;

/// One mean per plateau without its beginning, and the number of rows dropped.
pub fn means(samples: &[Sample]) -> (Vec<Sample>, usize) {
    let mut points = Vec::new();
    let mut dropped = 0;
    for run in runs(samples) {
        let skip = match run.len() {
            n if n < PLATEAU_ROWS => n,
            n => settling(n),
        };
        dropped += skip;
        let rows = &run[skip..];
        if rows.is_empty() {
            continue;
        }
        let mean = |of: &dyn Fn(&Sample) -> f64| mean_of_finite(rows.iter().map(of));
        let split = |of: fn(&Sample) -> Split<f64>| Split {
            whole: mean(&|s| of(s).whole),
            rotors: [0, 1].map(|r| mean(&|s| of(s).rotors[r])),
        };
        points.push(Sample {
            throttle: [0, 1].map(|r| mean(&|s| s.throttle[r])),
            thrust: split(|s| s.thrust),
            torque: split(|s| s.torque),
            voltage: [0, 1].map(|r| mean(&|s| s.voltage[r])),
            power_w: mean(&|s| s.power_w),
            speed: [0, 1].map(|r| mean(&|s| s.speed[r])),
            ..rows[0]
        });
    }
    (points, dropped)
}

/// The rows that settle of a plateau of `rows`; none of a few.
pub(super) fn settling(rows: usize) -> usize {
    match rows {
        n if n < PLATEAU_ROWS => 0,
        n => ((n as f64 * SETTLE).ceil() as usize).min(n - 1),
    }
}

/// Stretches of rows with one command, compared with the stretch's first row.
fn runs(samples: &[Sample]) -> impl Iterator<Item = &[Sample]> {
    let same = |a: f64, b: f64| (a.is_nan() && b.is_nan()) || (a - b).abs() < SAME_COMMAND;
    let mut rest = samples;
    std::iter::from_fn(move || {
        let first = rest.first()?;
        let alike = |s: &&Sample| (0..2).all(|r| same(s.throttle[r], first.throttle[r]));
        let (run, after) = rest.split_at(rest.iter().take_while(alike).count().max(1));
        rest = after;
        Some(run)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(line: u64, u: f64, thrust: f64) -> Sample {
        Sample {
            line,
            throttle: [u, 0.5],
            thrust: Split {
                whole: thrust,
                rotors: [f64::NAN; 2],
            },
            torque: Split {
                whole: f64::NAN,
                rotors: [f64::NAN; 2],
            },
            voltage: [f64::NAN; 2],
            power_w: f64::NAN,
            speed: [f64::NAN; 2],
            time_s: f64::NAN,
        }
    }

    #[test]
    fn plateaus_become_means_without_their_settling_rows() {
        let mut rows: Vec<Sample> = (0..10)
            .map(|k| sample(k, 0.2, if k < 4 { 99.0 } else { 1.0 }))
            .collect();
        rows[6].thrust.whole = f64::NAN; // a blank
        rows.extend((10..13).map(|k| sample(k, 0.2 + 0.01 * k as f64, 50.0))); // a ramp
        rows.extend((13..23).map(|k| sample(k, 0.5, if k < 15 { 9.0 } else { 2.0 })));
        assert!(is_streaming(&rows));
        let (points, dropped) = means(&rows);
        let seen: Vec<(u64, f64, f64)> = points
            .iter()
            .map(|p| (p.line, (1e6 * p.throttle[0]).round() / 1e6, p.thrust.whole))
            .collect();
        assert_eq!(seen, [(4, 0.2, 1.0), (17, 0.5, 2.0)]);
        assert_eq!(dropped, 4 + 3 + 4);
        assert!(points[0].torque.whole.is_nan());
    }

    #[test]
    fn a_map_of_single_rows_is_no_streaming_log() {
        let rows: Vec<Sample> = (0..100).map(|k| sample(k, 0.01 * (k / 2) as f64, 1.0)).collect();
        assert!(!is_streaming(&rows));
    }
}
