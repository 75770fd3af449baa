//! The range of bare thrust: what all units attain together with least-norm efforts and no torque asked.
//!
//! Desaturation starts from a thrust in the middle of it, where roll and pitch have the most room.

use mixer_rt::{AttainableSet, Desaturation};

use crate::airframe::Airframe;
use crate::diagnostic::{Code, Diagnostic};
use crate::tables::MixerTables;
use crate::voltage::factors_over_range;

/// Thrusts tried between zero and the sum of all units.
const STEPS: usize = 256;

/// Limits of the bare thrust `[floor, anchor, ceiling]`, N at the reference voltage, that hold at every voltage.
///
/// # Errors
/// A layout that cannot hover: no thrust without torque is attainable at all voltages.
pub(crate) fn limits(airframe: &Airframe, tables: &MixerTables) -> Result<[f32; 3], Vec<Diagnostic>> {
    let set = AttainableSet {
        vertices: &tables.attainable,
    };
    let factors = factors_over_range(airframe);
    let largest = tables
        .attainable
        .iter()
        .fold(0.0f32, |f, vertex| f.max(vertex[0]));
    let total = largest * tables.units.len() as f32 * 1.05;
    let works = |thrust: f32| {
        factors
            .iter()
            .all(|&k| bare(tables, thrust, k).all(|efforts| inside(&set, efforts)))
    };
    let tried: Vec<f32> = (1..=STEPS).map(|k| total * k as f32 / STEPS as f32).collect();
    let attained: Vec<f32> = tried.into_iter().filter(|&thrust| works(thrust)).collect();
    let Some((&first, &last)) = attained.first().zip(attained.last()) else {
        return Err(vec![airframe.diagnostic(
            Code::Hover,
            "unit",
            format!("no thrust up to {total:.1} N is attainable without roll, pitch or yaw"),
            "",
            "check positions, spins and thrust axes: the units must balance each other, each with a torque near zero",
        )]);
    };
    let step = total / STEPS as f32;
    let floor = refine(first, first - step, &works);
    let ceiling = refine(last, last + step, &works);
    let anchor = attained
        .iter()
        .map(|&thrust| (thrust, room(airframe, tables, &set, thrust)))
        .fold(
            (first, -1.0),
            |best, candidate| if candidate.1 > best.1 { candidate } else { best },
        )
        .0;
    Ok([floor, anchor.clamp(floor, ceiling), ceiling])
}

/// The desaturation entry of the tables.
pub(crate) fn desaturation(airframe: &Airframe, [floor, anchor, ceiling]: [f32; 3]) -> Desaturation {
    Desaturation {
        airmode: airframe.allocation.airmode,
        thrust_floor_n: floor,
        thrust_anchor_n: anchor,
        thrust_ceiling_n: ceiling,
        yaw_reserve_nm: airframe.allocation.yaw_reserve_nm as f32,
    }
}

/// The efforts of every unit at the reference voltage for a bare thrust k_f `thrust` at correction `[k_f, k_Q]`.
fn bare(tables: &MixerTables, thrust: f32, [k_f, k_q]: [f64; 2]) -> impl Iterator<Item = [f32; 2]> {
    let ratio = (k_f / k_q) as f32;
    tables.units.iter().map(move |unit| {
        [
            unit.allocation[0][3] * thrust,
            unit.allocation[1][3] * thrust * ratio,
        ]
    })
}

/// True where the polygon contains the point: it lies to the left of the edges an odd number of times.
fn inside(set: &AttainableSet<'_>, [f, q]: [f32; 2]) -> bool {
    let ends = set.vertices.iter();
    let starts = set
        .vertices
        .iter()
        .cycle()
        .skip(set.vertices.len().saturating_sub(1));
    ends.zip(starts).fold(false, |inside, (end, start)| {
        let crosses = (start[1] > q) != (end[1] > q)
            && f < start[0] + (q - start[1]) / (end[1] - start[1]) * (end[0] - start[0]);
        inside != crosses
    })
}

/// Bisects between a thrust that works and one that may not.
fn refine(works_at: f32, fails_at: f32, works: &dyn Fn(f32) -> bool) -> f32 {
    let (mut good, mut bad) = (works_at, fails_at);
    for _ in 0..20 {
        let middle = 0.5 * (good + bad);
        if works(middle) {
            good = middle;
        } else {
            bad = middle;
        }
    }
    good
}

/// The least share of full authority in any direction of the served torques from a bare thrust, where full
/// authority is what one unit's full thrust would give.
fn room(airframe: &Airframe, tables: &MixerTables, set: &AttainableSet<'_>, thrust: f32) -> f32 {
    let served = airframe
        .allocation
        .axes
        .iter()
        .map(|&axis| axis as usize)
        .filter(|&axis| axis < 3);
    let mut least = f32::INFINITY;
    for axis in served {
        let size = tables.units.iter().fold(0.0f32, |size, unit| {
            size.max(unit.allocation[0][axis].abs())
                .max(unit.allocation[1][axis].abs())
        });
        for sign in [-1.0, 1.0] {
            for (unit, from) in tables.units.iter().zip(bare(tables, thrust, [1.0, 1.0])) {
                let scale = sign * 100.0 / size;
                let step = [unit.allocation[0][axis] * scale, unit.allocation[1][axis] * scale];
                least = least.min(set.clip(from, step));
            }
        }
    }
    least
}
