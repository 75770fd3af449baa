//! The polygon against the border and against the area by another way.

use super::*;
use crate::Source;
use crate::airframe::Airframe;

/// Airframes and fixtures of all bases.
fn pairs() -> Vec<(String, PairMap)> {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
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

/// The area of an injective map's image is the integral of det J, here by Simpson's rule, which is
/// exact for the low degrees.
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
fn the_polygon_is_convex_inside_the_set_and_loses_little() {
    let pairs = pairs();
    assert!(pairs.len() >= 8);
    for (name, pair) in pairs {
        let polygon = Polygon::new(&pair);
        let n = polygon.corners.len();
        assert!((3..=MOST_CORNERS).contains(&n), "{name}: {n} corners");
        let inside = |point: [f64; 2]| {
            let ends = polygon.corners.iter().cycle().skip(1);
            polygon
                .corners
                .iter()
                .zip(ends)
                .all(|(&start, &end)| cross(start, end, point) > 0.0)
        };
        for k in 0..n {
            let [before, here, after] = [n - 1, 0, 1].map(|step| polygon.corners[(k + step) % n]);
            assert!(cross(before, here, after) > 0.0, "{name}: corner {k}");
        }
        assert!(inside(polygon.centre), "{name}");
        for throttles in pair.border(2048) {
            let point = pair.efforts(throttles);
            assert!(
                !inside(point),
                "{name}: {point:?} of the border is inside the polygon"
            );
        }
        let lost = 1.0 - 0.5 * moments(&polygon.corners).0 / area(&pair);
        let AreaLoss { total, convexity } = polygon.lost;
        println!(
            "{name}: {n} corners, {:.4} % of the area lost, {:.4} % outside the convex part",
            100.0 * lost,
            100.0 * convexity
        );
        assert!((lost - total).abs() < 1e-6, "{name}: {lost} {total}");
        assert!(lost <= 0.04, "{name}: {lost}");
    }
}
