//! Factors that put the axes on one scale.

use crate::airframe::{Airframe, Axis};
use crate::model::effectiveness::Effectiveness;
use crate::model::scales;

/// Units over authority per axis at the reference voltage, rounded; 0 on axes that are not served.
pub(super) fn rows(airframe: &Airframe, effectiveness: &Effectiveness) -> [f32; 4] {
    let scales = scales(airframe, [1.0; 2]);
    Axis::ALL.map(|axis| {
        if airframe.allocation.controls(axis) {
            (airframe.units.len() as f64 / effectiveness.largest(axis as usize, &scales)) as f32
        } else {
            0.0
        }
    })
}
