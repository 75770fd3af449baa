//! The rules on the vehicle's weight.

use super::rule::{Facts, Rule};
use crate::atmosphere::altitude_of;
use crate::diagnostic::{Code, number, rounded};
use crate::flywheel::Flywheel;

/// Share of the largest bare thrust above which hover leaves too little for control.
const HIGH: f64 = 0.8;

/// Thrust over weight above which no vehicle is built: racing quadrotors have up to 14.
const LIFTS: f64 = 20.0;

/// How far the inertia of a rotor may be from the one that is estimated: the estimate is within a factor of two, a wrong unit is
/// off by a hundred and more.
const INERTIA_OFF: f64 = 10.0;

/// An inertia of a rotor that is in another unit, or of something else.
pub(super) fn rotor_inertia(facts: &Facts<'_>) -> Vec<Rule> {
    let vehicle = facts.airframe.vehicle.as_ref();
    let stated = vehicle.and_then(|vehicle| Some((vehicle.rotor_inertia_kg_m2?, vehicle.mass_kg)));
    let Some((stated, mass_kg)) = stated else {
        return Vec::new();
    };
    let rule = |usual: Flywheel| {
        let usual = usual.inertia_kg_m2;
        Rule::within(
            Code::RotorInertia,
            "vehicle.rotor_inertia_kg_m2",
            stated,
            [usual / INERTIA_OFF, usual * INERTIA_OFF],
        )
        .says(
            format!(
                "an inertia of {} kg m2, where a rotor of this thrust has about {usual:.0e}",
                number(stated)
            ),
            "not a rotor of this thrust",
            "kg m2 of one rotor with its motor's bell about its axis: 1 kg m2 is 1e7 g cm2; leave the key out where it is not known",
        )
        .unless_explained(&[Code::PairUnits, Code::TooLight, Code::RotorInertia])
    };
    let usual = Flywheel::of_mass(facts.airframe, mass_kg, None).into_iter();
    usual.flatten().map(rule).collect()
}

/// Too heavy to hover at the lowest voltage, or so light that it rises at idle at the highest, or
/// with little thrust left at the reference voltage, in the thinnest air that it is to fly in.
pub(super) fn hover(facts: &Facts<'_>) -> Vec<Rule> {
    const KEY: &str = "vehicle.mass_kg";
    let (Some(vehicle), Some(weight), Some([floor, ceiling])) = (
        &facts.airframe.vehicle,
        facts.airframe.weight_n(),
        facts.thrust_range_n,
    ) else {
        return Vec::new();
    };
    // Words for the lowest, the highest and the reference voltage, and a thrust at each.
    let [lowest, highest, reference] = match &facts.airframe.voltage {
        None => [const { String::new() }; 3].map(|none| (none, 1.0)),
        Some(voltage) => [voltage.range[0], voltage.range[1], voltage.reference]
            .map(|volts| (format!(" at {} V", number(volts)), voltage.thrust_factor(volts))),
    };
    let (most, least) = (lowest.1 * ceiling, highest.1 * floor);
    let (thin, in_air, from) = match &facts.airframe.air {
        None => (1.0, String::new(), String::new()),
        Some(air) => {
            let sigma = libm::pow(weight / (HIGH * ceiling), 1.0 / air.exponents()[0]);
            let from = match 10.0 * (0.1 * altitude_of(sigma * air.reference)).round() {
                altitude if altitude > 0.0 => format!("; {:.0} % from {altitude} m up", 100.0 * HIGH),
                _ => String::new(),
            };
            let thinnest = air.range[0];
            (
                air.thrust_factor(thinnest),
                format!(" in air of {} kg/m3", number(thinnest)),
                from,
            )
        }
    };
    let left = thin * ceiling;
    let weighs = format!("{} kg weigh {} N", number(vehicle.mass_kg), rounded(weight));
    vec![
        Rule::at_most(Code::TooHeavy, KEY, weight, most).says(
            format!("{weighs}, the largest thrust{} is {} N", lowest.0, rounded(most)),
            "too heavy to hover",
            "check the mass and the units of thrust_n",
        ),
        Rule::at_most(Code::FloatsAtIdle, KEY, least, weight)
            .says(
                format!("{weighs}, the least thrust{} is {} N", highest.0, rounded(least)),
                "rises at idle",
                "check the mass and the units of thrust_n, or lower throttle.min",
            )
            .unless_explained(&[Code::TooHeavy]),
        Rule::at_most(Code::HoversHigh, KEY, weight, HIGH * left)
            .says(
                format!(
                    "{weighs}, {:.0} % of the largest thrust{}{in_air}, {} N{from}",
                    100.0 * weight / left,
                    reference.0,
                    rounded(left)
                ),
                "little is left",
                "roll, pitch and yaw come out of what hover leaves; frames hover at 30 to 60 %",
            )
            .unless_explained(&[Code::TooHeavy, Code::FloatsAtIdle]),
        Rule::at_most(Code::TooLight, KEY, ceiling / weight, LIFTS)
            .says(
                format!(
                    "{weighs}, the largest thrust{} is {} N, {:.0} times as much",
                    reference.0,
                    rounded(ceiling),
                    ceiling / weight
                ),
                "too light",
                "check the mass, in kg with battery and payload, and the units of thrust_n",
            )
            .unless_explained(&[Code::PairUnits, Code::FloatsAtIdle]),
    ]
}
