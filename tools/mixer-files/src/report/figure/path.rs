//! Polylines in pixels: their path data, fewer points where they are not seen, and a place for the
//! value of an iso-curve.

use std::fmt::Write as _;

/// Points nearer than this to a chord are left out, px.
const UNSEEN: f64 = 0.1;

/// SVG path data through the points that are seen, from point to point in tenths of a pixel, which
/// are enough for any screen and printer.
pub(crate) fn data(pixels: &[[f64; 2]], closed: bool) -> String {
    let mut data = String::new();
    let mut last: Option<[i32; 2]> = None;
    for point in simplified(pixels) {
        let tenths = point.map(|x| libm::round(10.0 * x) as i32);
        let step = match last {
            Some(last) if last == tenths => continue,
            Some(last) => [tenths[0] - last[0], tenths[1] - last[1]],
            None => tenths,
        };
        data.push(if last.is_none() { 'M' } else { 'l' });
        last = Some(tenths);
        let [x, y] = step.map(|tenths| f64::from(tenths) / 10.0);
        let _ = write!(data, "{x} {y}");
    }
    if closed && !data.is_empty() {
        data.push('Z');
    }
    data
}

/// The points that are seen: Douglas and Peucker's selection, ends kept.
pub(super) fn simplified(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let Some(last) = points.len().checked_sub(1) else {
        return Vec::new();
    };
    let mut kept = vec![false; points.len()];
    kept[0] = true;
    kept[last] = true;
    let mut open = vec![(0, last)];
    while let Some((start, end)) = open.pop() {
        let between = (start + 1..end).map(|k| (k, distance(points[k], points[start], points[end])));
        let farther = |best: (usize, f64), next: (usize, f64)| if next.1 > best.1 { next } else { best };
        let farthest = between.fold((start, UNSEEN), farther);
        if farthest.0 != start {
            kept[farthest.0] = true;
            open.extend([(start, farthest.0), (farthest.0, end)]);
        }
    }
    let points = points.iter().zip(kept).filter(|(_, kept)| *kept);
    points.map(|(point, _)| *point).collect()
}

/// From a point to the chord from `a` to `b`.
fn distance(point: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (along, to) = ([b[0] - a[0], b[1] - a[1]], [point[0] - a[0], point[1] - a[1]]);
    let square = along[0] * along[0] + along[1] * along[1];
    // A ring ends where it starts: its chord is a point.
    let share = if square > 0.0 {
        ((along[0] * to[0] + along[1] * to[1]) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    libm::hypot(to[0] - share * along[0], to[1] - share * along[1])
}

/// Where the value of an iso-curve stands.
pub(super) struct Label {
    /// Pixel of its middle.
    pub(super) at: [f64; 2],
    /// Clockwise turn along the curve, never upside down.
    pub(super) degrees: f64,
}

/// Shortest curve that carries its value, px.
const SHORTEST: f64 = 46.0;

impl Label {
    /// At a share of the length of a curve that is long enough.
    pub(super) fn along(pixels: &[[f64; 2]], share: f64) -> Option<Self> {
        let length = |a: [f64; 2], b: [f64; 2]| libm::hypot(b[0] - a[0], b[1] - a[1]);
        let total: f64 = pixels.windows(2).map(|w| length(w[0], w[1])).sum();
        if total < SHORTEST {
            return None;
        }
        let mut walked = 0.0;
        for (index, pair) in pixels.windows(2).enumerate() {
            walked += length(pair[0], pair[1]);
            if walked >= share * total {
                // The direction over a few points: a single one may turn back at a corner.
                let from = pixels[index.saturating_sub(2)];
                let to = pixels[(index + 3).min(pixels.len() - 1)];
                let degrees = libm::atan2(to[1] - from[1], to[0] - from[0]).to_degrees();
                let degrees = match degrees {
                    d if d > 90.0 => d - 180.0,
                    d if d <= -90.0 => d + 180.0,
                    d => d,
                };
                let at = pair[1];
                return Some(Label { at, degrees });
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_unseen_points_are_left_out() {
        let line: Vec<[f64; 2]> = (0..=100)
            .map(|k| [f64::from(k), 0.05 * f64::from(k % 2)])
            .collect();
        assert_eq!(simplified(&line), [[0.0, 0.0], [100.0, 0.0]]);
        let corner = [[0.0, 0.0], [5.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 0.0]];
        assert_eq!(
            simplified(&corner),
            [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 0.0]]
        );
        assert!(simplified(&[]).is_empty());
    }

    /// Rounding does not add up along a path.
    #[test]
    fn steps_are_between_rounded_points() {
        let zigzag: Vec<[f64; 2]> = (0..5).map(|k| [1.04 * f64::from(k), f64::from(k % 2)]).collect();
        assert_eq!(data(&zigzag, false), "M0 0l1 1l1.1 -1l1 1l1.1 -1");
        assert_eq!(
            data(&[[1.0, 2.0], [1.0, 3.0], [4.0, 3.04], [1.0, 2.0]], true),
            "M1 2l0 1l3 0l-3 -1Z"
        );
        assert_eq!(data(&[], true), "");
    }

    #[test]
    fn labels_are_never_upside_down() {
        let leftwards: Vec<[f64; 2]> = (0..20).map(|k| [-5.0 * f64::from(k), 0.0]).collect();
        let label = Label::along(&leftwards, 0.5).unwrap();
        assert_eq!(label.degrees, 0.0);
        assert!(Label::along(&leftwards[..5], 0.5).is_none());
    }
}
