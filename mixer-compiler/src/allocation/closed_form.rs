//! The table of `mixer-rt`'s closed form of desaturation, for up to four units with vertical axes.

mod border;
mod outline;

use mixer_rt::{
    Axis,
    tables::{Airmode, ClosedForm, ClosedFormUnit, Facets, Steep},
};
use nalgebra::Vector3;

use crate::airframe::Airframe;
use crate::model::PairMap;
use crate::model::effectiveness::Effectiveness;
use crate::tables::ClosedFormTable;

/// Of sums of a few f32 products.
const ROUNDING: f32 = 1e-6;

/// Yaw that counts as none, as a share of the units' largest torques.
const YAW_ROUNDING: f64 = 1e-5;

/// A unit whose thrust changes by less than this share of the largest along the null space has no
/// part in it.
const NO_PART: f64 = 1e-5;

/// Shares of all thrust per share of all roll and pitch from which a facet is steep: the ratio of their costs in the
/// interior point method.
const STEEP: f64 = 20.0;

/// The thrusts of the units in what is served of roll, pitch and thrust.
struct Layout {
    /// Roll, pitch (N m) and thrust (N) per N of each unit, 0 where not served.
    columns: Vec<Vector3<f64>>,
    /// The axes, of roll and pitch, that are not served.
    free: Vec<Vector3<f64>>,
}

impl Layout {
    /// # Errors
    /// Why the layout or the priorities allow no closed form.
    fn new(airframe: &Airframe, effectiveness: &Effectiveness) -> Result<Layout, &'static str> {
        let (n, matrix) = (airframe.units.len(), &effectiveness.matrix);
        let served = [Axis::Roll, Axis::Pitch].map(|axis| airframe.allocation.controls(axis));
        let axes = [Vector3::x(), Vector3::y()].into_iter().zip(served);
        let free: Vec<_> = axes.filter(|(_, served)| !served).map(|(axis, _)| axis).collect();
        if airframe.is_unlike() {
            return Err("units are of several kinds, or single rotors");
        }
        if !effectiveness.is_vertical() {
            return Err("thrust axes are tilted");
        }
        // Else the null space of the thrusts has more dimensions than one.
        if !(3..=4).contains(&(n + free.len())) {
            return Err(
                "it takes three or four units, one less for each of roll and pitch that is not served",
            );
        }
        if airframe.allocation.airmode == Airmode::RollPitchYaw {
            return Err("yaw comes before thrust");
        }
        if !airframe.allocation.controls(Axis::Yaw) {
            return Err("yaw is not served");
        }
        let lever = |axis: usize, unit: usize| if served[axis] { matrix[(axis, unit)] } else { 0.0 };
        let column = |unit| Vector3::new(lever(0, unit), lever(1, unit), matrix[(3, unit)]);
        let columns = (0..n).map(column).collect();
        Ok(Layout { columns, free })
    }
}

/// The table, and the share of the area of a unit's attainable set that its border loses.
///
/// # Errors
/// Why there is no closed form, in words.
pub(crate) fn table(
    airframe: &Airframe,
    effectiveness: &Effectiveness,
    maps: &[PairMap],
) -> Result<(ClosedFormTable, f64), &'static str> {
    let Layout { columns, free } = Layout::new(airframe, effectiveness)?;
    let pair = &maps[0];
    let [low, high] = pair.range();
    let ends = [pair.efforts([low, low]), pair.efforts([high, high])];
    // f32 rounding, inwards.
    let thrust_n = [(ends[0][0] as f32).next_up(), (ends[1][0] as f32).next_down()];
    let (border, cells, lost) =
        border::border(pair).ok_or("sides of the attainable set would leave out much of it")?;
    let (slopes, walls) = facets(&columns, &free, thrust_n.map(f64::from));
    let n = airframe.units.len();
    let mut table = ClosedFormTable {
        numbers: ClosedForm {
            units: &[],
            complete: free.is_empty(),
            thrust_n,
            border,
            slopes: &[],
            walls: &[],
            steep: &[],
            torque_share: 1.0 / n as f32,
            thrust_floor_n: 0.0,
            thrust_middle_n: 0.0,
            yaw_rounding_nm: (YAW_ROUNDING * n as f64 * pair.scale()[1]) as f32,
        },
        units: units(airframe, effectiveness, &null_vector(&columns, &free), thrust_n),
        cells,
        steep: steep(&slopes, &columns, thrust_n),
        slopes,
        walls,
    };
    let [floor, ceiling] = level_range(&table.view()).ok_or("no thrust leaves yaw at zero")?;
    // At least what the facets allow without roll and pitch, with rounding.
    let least_level = table
        .slopes
        .iter()
        .map(|facets| facets.bounds[0])
        .fold(floor, f32::max);
    table.numbers.thrust_floor_n = least_level * (1.0 + ROUNDING);
    table.numbers.thrust_middle_n = 0.5 * (floor + ceiling);
    Ok((table, lost))
}

/// The least and the largest thrust in all (N) without roll and pitch, z as near zero as can be,
/// that can leave yaw at zero.
fn level_range(table: &ClosedForm<'_>) -> Option<[f32; 2]> {
    const STEPS: usize = 4000;
    let [idle, full] = table.thrust_n;
    let is_level = |thrust_n: f32| {
        let least_norm = |unit: &ClosedFormUnit| unit.allocation[2] * thrust_n;
        let (mut low, mut high) = (-f32::MAX, f32::MAX);
        for unit in table.units.iter().filter(|unit| unit.null != 0.0) {
            let [from, to] = unit.ends.map(|end| (end - least_norm(unit)) * unit.per_null);
            (low, high) = (low.max(from), high.min(to));
        }
        let z = if low <= high { 0.0f32.clamp(low, high) } else { 0.0 };
        let mut yaw = [0.0, 0.0];
        for unit in table.units {
            let f = least_norm(unit) + z * unit.null;
            if f < idle - ROUNDING * full || f > full + ROUNDING * full {
                return false;
            }
            let [middle, half] = table.border.torques(f.clamp(idle, full));
            yaw = [
                yaw[0] + unit.spin * middle - half,
                yaw[1] + unit.spin * middle + half,
            ];
        }
        yaw[0] <= table.yaw_rounding_nm && yaw[1] >= -table.yaw_rounding_nm
    };
    let n = table.units.len() as f32;
    let at = |k: usize| n * (idle + (full - idle) * k as f32 / STEPS as f32);
    let floor = (0..=STEPS).map(at).find(|&thrust_n| is_level(thrust_n))?;
    let ceiling = (0..=STEPS).rev().map(at).find(|&thrust_n| is_level(thrust_n))?;
    Some([floor, ceiling])
}

/// Shares of C and C+, rounded.
fn units(
    airframe: &Airframe,
    effectiveness: &Effectiveness,
    null: &[f64],
    [least, most]: [f32; 2],
) -> Vec<ClosedFormUnit> {
    let n = airframe.units.len();
    let Effectiveness {
        matrix,
        pseudo_inverse,
        ..
    } = effectiveness;
    let units = airframe.units.iter().zip(null).enumerate();
    units
        .map(|(i, (unit, &null))| ClosedFormUnit {
            allocation: [0, 1, 3].map(|axis| pseudo_inverse[(i, axis)] as f32),
            arms: [0, 1].map(|axis| matrix[(axis, i)] as f32),
            spin: matrix[(2, n + i)] as f32,
            null: null as f32,
            per_null: if null == 0.0 { 0.0 } else { (1.0 / null) as f32 },
            ends: if null < 0.0 { [most, least] } else { [least, most] },
            channels: unit.channel_table(),
        })
        .collect()
}

/// The facets of the zonotope of all thrusts, slopes and walls: every two units span a pair of
/// them, or one unit and the `free` axis, or both of these where the airframe serves neither roll
/// nor pitch.
fn facets(
    columns: &[Vector3<f64>],
    free: &[Vector3<f64>],
    [least, most]: [f64; 2],
) -> (Vec<Facets>, Vec<Facets>) {
    let (mut slopes, mut walls): (Vec<Facets>, Vec<Facets>) = (Vec::new(), Vec::new());
    let (first, second) = match free {
        [] => (columns, columns),
        [_] => (columns, free),
        [first, ..] => (std::slice::from_ref(first), &free[1..]),
    };
    for (i, first) in first.iter().enumerate() {
        let later = if free.is_empty() { i + 1 } else { 0 };
        for second in &second[later..] {
            let mut normal = first.cross(second);
            let level = normal[2].abs() < 1e-9 * normal.amax();
            normal /= if level { normal.norm() } else { normal[2] };
            if level {
                normal[2] = 0.0;
            }
            if !normal.amax().is_finite() {
                continue; // the same direction twice
            }
            let mut bounds = [0.0; 2];
            for column in columns {
                let along = normal.dot(column);
                bounds[0] += (along * least).min(along * most);
                bounds[1] += (along * least).max(along * most);
            }
            let facet = Facets {
                normal: [normal[0] as f32, normal[1] as f32],
                bounds: bounds.map(|x| x as f32),
            };
            let facets = if level { &mut walls } else { &mut slopes };
            if !facets.contains(&facet) {
                facets.push(facet);
            }
        }
    }
    (slopes, walls)
}

/// The steep ones among `slopes`, with their ranges of thrust: on a facet every unit is at the bound that the normal leads
/// to, but for those that span it.
fn steep(slopes: &[Facets], columns: &[Vector3<f64>], thrust_n: [f32; 2]) -> Vec<Steep> {
    let all = columns
        .iter()
        .fold(Vector3::zeros(), |all, column| all + column.abs());
    let is_steep = |facets: &&Facets| {
        let [roll, pitch] = [0, 1].map(|axis| f64::from(facets.normal[axis]) * all[axis] / all[2]);
        libm::hypot(roll, pitch) > STEEP
    };
    let range = |facets: &Facets, side: usize| {
        let [roll, pitch] = facets.normal.map(f64::from);
        let end = |k: usize| -> f32 {
            let thrust = |column: &Vector3<f64>| {
                let parts = [roll * column[0], pitch * column[1], column[2]];
                let along: f64 = parts.iter().sum();
                let is_spanning = along.abs() < 1e-5 * parts.iter().map(|part| part.abs()).sum::<f64>();
                let of_side = if along > 0.0 { side } else { 1 - side };
                column[2] as f32 * thrust_n[if is_spanning { k } else { of_side }]
            };
            columns.iter().map(thrust).sum()
        };
        // Level flight is not beyond the facet.
        let [low, high] = facets.bounds;
        [0, 1].map(|k| end(k).clamp(low, high))
    };
    let steep = slopes.iter().filter(is_steep);
    steep
        .map(|facets| Steep {
            facets: *facets,
            thrusts_n: [0, 1].map(|side| range(facets, side)),
        })
        .collect()
}

/// Thrusts that give no roll, pitch and thrust but along the `free` axes, the largest being 1;
/// zeros where there are none.
fn null_vector(columns: &[Vector3<f64>], free: &[Vector3<f64>]) -> Vec<f64> {
    let [a, b, c, d] = &[columns, free].concat()[..] else {
        return vec![0.0; columns.len()];
    };
    let minor = |x: &Vector3<f64>, y: &Vector3<f64>, z: &Vector3<f64>| x.cross(y).dot(z);
    let null = [minor(b, c, d), -minor(a, c, d), minor(a, b, d), -minor(a, b, c)];
    let null = &null[..columns.len()];
    let largest = null.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    null.iter()
        .map(|x| x / largest)
        .map(|x| if x.abs() < NO_PART { 0.0 } else { x })
        .collect()
}
