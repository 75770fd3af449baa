//! The rule on the vehicle's weight.

use super::facts::Facts;
use crate::diagnostic::{Code, Diagnostic, number, rounded};

/// Share of the largest bare thrust above which hover leaves too little for control.
const HIGH: f64 = 0.8;

/// Too heavy to hover at the lowest voltage, or so light that it rises at idle at the highest, or
/// with little thrust left at the reference voltage.
pub(super) fn hover(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    let airframe = facts.airframe;
    let (Some(vehicle), Some(weight), Some([floor, ceiling])) =
        (&airframe.vehicle, airframe.weight_n(), facts.thrust_range_n)
    else {
        return;
    };
    let at = |volts: Option<f64>, thrust: f64| match (&airframe.voltage, volts) {
        (Some(voltage), Some(volts)) => {
            let thrust = voltage.thrust_factor(volts) * thrust;
            (format!(" at {} V", number(volts)), thrust)
        }
        _ => (String::new(), thrust),
    };
    let range = airframe.voltage.as_ref().map(|voltage| voltage.range_v);
    let reference = airframe.voltage.as_ref().map(|voltage| voltage.reference_v);
    let (at_lowest, ceiling_at_lowest) = at(range.map(|[low, _]| low), ceiling);
    let (at_highest, floor_at_highest) = at(range.map(|[_, high]| high), floor);
    let (at_reference, _) = at(reference, ceiling);
    let weighs = format!("{} kg weigh {} N", number(vehicle.mass_kg), rounded(weight));
    let (code, message, label, help) = if weight > ceiling_at_lowest {
        (
            Code::TooHeavy,
            format!(
                "{weighs}, the largest thrust{at_lowest} is {} N",
                rounded(ceiling_at_lowest)
            ),
            "too heavy to hover",
            "check the mass and the units of thrust_n",
        )
    } else if weight < floor_at_highest {
        (
            Code::FloatsAtIdle,
            format!(
                "{weighs}, the least thrust{at_highest} is {} N",
                rounded(floor_at_highest)
            ),
            "rises at idle",
            "check the mass and the units of thrust_n, or lower throttle.min",
        )
    } else if weight > HIGH * ceiling {
        (
            Code::HoversHigh,
            format!(
                "{weighs}, {:.0} % of the largest thrust{at_reference}, {} N",
                100.0 * weight / ceiling,
                rounded(ceiling)
            ),
            "little is left",
            "roll, pitch and yaw come out of what hover leaves; frames hover at 30 to 60 %",
        )
    } else {
        return;
    };
    found.push(airframe.diagnostic(code, "vehicle.mass_kg", message, label, help));
}
