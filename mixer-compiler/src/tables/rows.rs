//! Factors that put the axes of the general path on one scale.

use crate::airframe::{Airframe, Axis};
use crate::model::PairMap;
use crate::model::effectiveness::Effectiveness;

/// Units over authority per axis at the reference voltage, roll and pitch alike, rounded; 0 on axes
/// that are not served.
pub(super) fn rows(airframe: &Airframe, effectiveness: &Effectiveness, pair: &PairMap) -> [f32; 4] {
    let scale = pair.scale();
    let authority: [f64; 4] = std::array::from_fn(|axis| {
        if airframe.allocation.controls(Axis::ALL[axis]) {
            effectiveness.largest(axis, scale)
        } else {
            0.0
        }
    });
    let level = authority[0].max(authority[1]);
    std::array::from_fn(|axis| {
        let size = if axis < 2 { level } else { authority[axis] };
        if authority[axis] > 0.0 {
            (airframe.units.len() as f64 / size) as f32
        } else {
            0.0
        }
    })
}
