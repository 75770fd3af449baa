//! Factors that put the axes on one scale.

use crate::airframe::{Airframe, Axis};
use crate::model::PairMap;
use crate::model::effectiveness::Effectiveness;

/// Units over authority per axis at the reference voltage, rounded; 0 on axes that are not served.
pub(super) fn rows(airframe: &Airframe, effectiveness: &Effectiveness, pair: &PairMap) -> [f32; 4] {
    let scale = pair.scale();
    Axis::ALL.map(|axis| {
        if airframe.allocation.controls(axis) {
            (airframe.units.len() as f64 / effectiveness.largest(axis as usize, scale)) as f32
        } else {
            0.0
        }
    })
}
