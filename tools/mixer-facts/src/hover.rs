//! The vehicle in hover, and a yaw reserve to begin with.

use mixer_compiler::Compiled;
use mixer_compiler::airframe::Axis;
use mixer_compiler::hover::HoverAt;
use serde::Serialize;

/// The vehicle in hover.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Hover {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Weight, N.
    pub weight_n: f64,
    /// Largest bare thrust over weight at the reference voltage.
    pub thrust_over_weight: f64,
    /// At the lowest and at the reference voltage; one without a voltage where it has no effect.
    pub at: Vec<HoverAt>,
}

impl Hover {
    /// The hover of a compiled airframe; `None` where the file has no mass.
    pub fn new(compiled: &Compiled) -> Option<Hover> {
        let mass_kg = compiled.airframe.vehicle.as_ref()?.mass_kg;
        let weight_n = compiled.airframe.weight_n()?;
        let volts = match &compiled.airframe.voltage {
            None => vec![None],
            Some(voltage) => {
                let mut volts = vec![voltage.range[0], voltage.reference];
                volts.dedup();
                volts.into_iter().map(Some).collect()
            }
        };
        let at = volts.into_iter();
        Some(Hover {
            mass_kg,
            weight_n,
            thrust_over_weight: f64::from(compiled.thrust_range_n[1]) / weight_n,
            at: at.map(|volts| HoverAt::new(compiled, weight_n, volts)).collect(),
        })
    }
}

/// Share of the yaw in hover that [`yaw_reserve`] keeps.
const KEPT_YAW: f64 = 0.2;

/// A yaw reserve to begin with, N m: a fifth of the yaw that is left in hover either way, at the
/// reference voltage. Hover is the weight, without a mass half of the largest bare thrust. `None` where nothing is left or yaw is not served.
pub fn yaw_reserve(compiled: &Compiled) -> Option<f64> {
    let airframe = &compiled.airframe;
    let half_n = 0.5 * f64::from(compiled.thrust_range_n[1]);
    let weight_n = airframe.weight_n().unwrap_or(half_n);
    let reference_v = airframe.voltage.as_ref().map(|voltage| voltage.reference);
    let hover = HoverAt::new(compiled, weight_n, reference_v);
    let mut margins = hover.margins.iter();
    let yaw = margins.find(|margin| margin.axis == Axis::Yaw.name())?;
    let [least, most] = yaw.torque_nm;
    let reserve = KEPT_YAW * most.min(-least);
    (reserve > 0.0).then_some(reserve)
}
