//! The polygon against the border and against the area by another way.

use super::corners::is_seen_from;
use super::*;
use crate::Source;
use crate::airframe::Airframe;

/// Airframes and fixtures of all bases.
fn pairs() -> Vec<(String, PairMap)> {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut files: Vec<_> = ["airframes", "tests/fixtures"]
        .into_iter()
        .flat_map(|folder| std::fs::read_dir(root.join(folder)).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    files.sort();
    files
        .into_iter()
        .map(|path| {
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            let airframe =
                Airframe::read(&Source::new(&name, std::fs::read_to_string(&path).unwrap())).unwrap();
            (name, PairMap::new(&airframe.pair, &airframe.throttle))
        })
        .collect()
}

/// The area of an injective map's image is the integral of det J, here by Simpson's rule, which is exact for the low
/// degrees.
fn area(pair: &PairMap) -> f64 {
    const POINTS: usize = 41;
    let [low, high] = pair.range();
    let step = (high - low) / (POINTS - 1) as f64;
    let weight = |k: usize| match k {
        0 => 1.0,
        k if k + 1 == POINTS => 1.0,
        k => 2.0 + 2.0 * (k % 2) as f64,
    };
    let mut sum = 0.0;
    for i in 0..POINTS {
        for j in 0..POINTS {
            let [[f_u, f_l], [q_u, q_l]] = pair.jacobian([low + step * i as f64, low + step * j as f64]);
            sum += weight(i) * weight(j) * (f_u * q_l - f_l * q_u);
        }
    }
    sum * step * step / 9.0
}

#[test]
fn the_polygon_is_inside_the_set_and_loses_little() {
    let pairs = pairs();
    assert!(pairs.len() >= 8);
    for (name, pair) in pairs {
        let polygon = Polygon::new(&pair);
        let n = polygon.corners.len();
        assert!(is_seen_from(&polygon.corners, polygon.centre), "{name}");
        for throttles in pair.border(2048) {
            let point = pair.efforts(throttles);
            // Seen from the centre through this edge.
            let ends = polygon.corners.iter().cycle().skip(1);
            let seen = polygon.corners.iter().zip(ends).any(|(&start, &end)| {
                cross(polygon.centre, start, point) >= 0.0
                    && cross(polygon.centre, point, end) > 0.0
                    && cross(start, end, point) > 0.0
            });
            assert!(!seen, "{name}: {point:?} of the border is inside the polygon");
        }
        let lost = 1.0 - 0.5 * moments(&polygon.corners).0 / area(&pair);
        let AreaLoss { total, convexity } = polygon.lost;
        println!(
            "{name}: {n} corners, {:.4} % of the area lost, a convex one {:.4} %",
            100.0 * lost,
            100.0 * convexity
        );
        assert!((lost - total).abs() < 1e-6, "{name}: {lost} {total}");
        // What the inset costs comes on top.
        assert!(lost <= 1.1 * LOSS, "{name}: {lost}");
    }
}

/// One corner fewer than found loses too much: checked on a polygon small enough to try all choices.
#[test]
fn the_corners_are_the_fewest() {
    let n = 14;
    let polygon: Vec<[f64; 2]> = (0..n)
        .map(|k| {
            let angle = 0.3 + std::f64::consts::TAU * (k as f64 + 0.2 * libm::sin(3.0 * k as f64)) / n as f64;
            [2.0 * libm::cos(angle), libm::sin(angle)]
        })
        .collect();
    let whole = moments(&polygon).0;
    for share in [0.05, 0.15, 0.4] {
        let found = fewest_corners(&polygon, [0.0; 2], share * whole).unwrap();
        assert!(whole - moments(&found).0 <= share * whole * (1.0 + 1e-12));
        let best = (0u32..1 << n)
            .filter(|mask| mask.count_ones() as usize == found.len() - 1 && found.len() > 3)
            .map(|mask| {
                let kept: Vec<[f64; 2]> = (0..n)
                    .filter(|k| mask >> k & 1 == 1)
                    .map(|k| polygon[k])
                    .collect();
                moments(&kept).0
            })
            .fold(0.0, f64::max);
        // The sharpest corner is always kept, which may cost one.
        let one_less = (0u32..1 << n)
            .filter(|mask| mask.count_ones() as usize + 2 == found.len() && found.len() > 4)
            .map(|mask| {
                let kept: Vec<[f64; 2]> = (0..n)
                    .filter(|k| mask >> k & 1 == 1)
                    .map(|k| polygon[k])
                    .collect();
                moments(&kept).0
            })
            .fold(0.0, f64::max);
        assert!(
            best < (1.0 - 0.8 * share) * whole && one_less < (1.0 - share) * whole,
            "{share}: {}",
            found.len()
        );
    }
}
