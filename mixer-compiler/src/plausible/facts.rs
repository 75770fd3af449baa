//! The facts about an airframe that the rules read.

use crate::airframe::Airframe;
use crate::model::PairMap;
use crate::model::effectiveness::Effectiveness;

/// An airframe and what was found out about it.
pub(super) struct Facts<'a> {
    pub(super) airframe: &'a Airframe,
    /// `None` where the airframe is refused.
    pub(super) effectiveness: Option<&'a Effectiveness>,
    pub(super) map: &'a PairMap,
    /// Largest thrust (N) and largest absolute torque (N m) of one unit at the reference voltage.
    pub(super) scale: [f64; 2],
    /// Least and largest bare thrust at the reference voltage, N; `None` where the airframe is
    /// refused.
    pub(super) thrust_range_n: Option<[f64; 2]>,
}
