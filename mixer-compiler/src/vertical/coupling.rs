//! What priorities that couple thrust and yaw need beside the table of [`super::table`].

use mixer_rt::Coupling;

use crate::tables::VerticalTable;

/// Segments of `floors_n`.
const SEGMENTS: usize = 16;

/// Steps of a search for the largest value of a concave function, each of which leaves two thirds of the range.
const STEPS: usize = 40;

/// Share of the largest yaw that is held to be attainable in f32.
const SURE: f64 = 0.999;

/// The table's `Coupling`, for units of the largest efforts `[f, Q]` (N, N m).
pub(super) fn coupling(table: &VerticalTable, scale: [f64; 2]) -> Coupling {
    let levels = table.slopes.iter().map(|facets| facets.bounds.map(f64::from));
    let range = levels.fold([0.0, f64::INFINITY], |[low, high], [least, most]| {
        [f64::max(low, least), f64::min(high, most)]
    });
    let floor = f64::from(table.thrust_floor_n).max(range[0]);
    let (mut most_yaw_nm, mut floors_n) = ([0.0; 2], [[0.0; SEGMENTS + 1]; 2]);
    for (index, direction) in [1.0, -1.0].into_iter().enumerate() {
        let reach = |thrust: f64| reach(table, direction, thrust);
        let (top, yaw) = largest(reach, [floor, range[1]]);
        let most = SURE * yaw.max(0.0);
        most_yaw_nm[index] = most as f32;
        for (knot, floor_n) in floors_n[index].iter_mut().enumerate() {
            let wanted = most * knot as f64 / SEGMENTS as f64;
            let (mut low, mut high) = (floor, top);
            if reach(low) >= wanted {
                high = low;
            }
            for _ in 0..STEPS {
                let middle = 0.5 * (low + high);
                if reach(middle) < wanted {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            *floor_n = high as f32;
        }
    }
    Coupling {
        scale: (scale[0] / scale[1]) as f32,
        most_yaw_nm,
        floors_n,
    }
}

/// The furthest yaw in `direction` without roll and pitch at a thrust.
fn reach(table: &VerticalTable, direction: f64, thrust: f64) -> f64 {
    let [least, most] = table.thrust_n.map(f64::from);
    let level = |share: f32| f64::from(share) * thrust;
    let mut range = [f64::NEG_INFINITY, f64::INFINITY];
    for unit in table.units.iter().filter(|unit| unit.null != 0.0) {
        let ends = unit
            .ends
            .map(|end| (f64::from(end) - level(unit.allocation[2])) * f64::from(unit.per_null));
        range = [range[0].max(ends[0]), range[1].min(ends[1])];
    }
    let yaw = |z: f64| {
        let yaws = table.units.iter().map(|unit| {
            let turns = direction * f64::from(unit.spin) > 0.0;
            let side = &table.border.sides[usize::from(!turns)];
            let f = level(unit.allocation[2]) + z * f64::from(unit.null);
            side.torque(f.clamp(least, most))
        });
        yaws.sum()
    };
    if range[0].is_finite() {
        largest(yaw, range).1
    } else {
        yaw(0.0)
    }
}

/// Where a concave function is largest within a range, and its value there.
fn largest(of: impl Fn(f64) -> f64, [mut low, mut high]: [f64; 2]) -> (f64, f64) {
    for _ in 0..STEPS {
        let third = (high - low) / 3.0;
        let (a, b) = (low + third, high - third);
        if of(a) < of(b) {
            low = a;
        } else {
            high = b;
        }
    }
    let middle = 0.5 * (low + high);
    (middle, of(middle))
}
