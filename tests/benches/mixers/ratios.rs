//! Times of one run as multiples of this mixer's.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Where Criterion keeps what it measured.
pub(crate) fn folder() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("mixers")
}

/// The median of one benchmark, ns per iteration; `None` where it was not measured since `start`.
fn median(group: &str, name: &str, start: SystemTime) -> Option<f64> {
    let path = folder().join(group).join(name).join("new/estimates.json");
    if path.metadata().ok()?.modified().ok()? < start {
        return None;
    }
    let estimates: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(path).ok()?).ok()?;
    estimates["median"]["point_estimate"].as_f64()
}

/// Prints a line per group: medians of `mixers` over that of the first.
pub(crate) fn print(groups: &[String], mixers: &[&str], start: SystemTime) {
    let times = |group: &str| -> Option<Vec<f64>> {
        let times = mixers.iter().map(|mixer| median(group, mixer, start));
        times.collect()
    };
    let rows: Vec<(&String, Vec<f64>)> = groups
        .iter()
        .filter_map(|group| Some((group, times(group)?)))
        .collect();
    if rows.is_empty() {
        return;
    }
    println!("time per request over that of {}, medians of this run", mixers[0]);
    let heads: String = mixers.iter().map(|mixer| format!("{mixer:>14}")).collect();
    println!("{:<24}{heads}", "");
    for (group, times) in rows {
        let ratios: String = times
            .iter()
            .map(|time| format!("{:>14.2}", time / times[0]))
            .collect();
        println!("{group:<24}{ratios}");
    }
}
