//! Rules on `[voltage]`.

use super::rule::{Facts, Rule};
use crate::airframe::VoltageLaw;
use crate::diagnostic::{Code, number, rounded};

/// What a pack of lithium cells loses of its voltage from full to empty, as a share.
const PACK_FALLS: f64 = 0.2;

/// Exponent of thrust over voltage: the median of benches.
const TYPICAL: f64 = 1.75;

/// Highest voltage of one cell, V.
const ONE_CELL_V: f64 = 4.5;

/// Thrust of a unit that one cell does not drive, N.
const ONE_CELL_THRUST_N: f64 = 5.0;

/// Powers of the voltage that propellers follow: 1 to 2.5, and what a narrow range leaves
/// uncertain.
const EXPONENTS: [f64; 2] = [0.8, 2.7];

/// Factors that packs give: 0.6 to 1.4 from empty to full.
const FACTORS: [f64; 2] = [0.35, 2.0];

/// The voltage of the bench, the power of the voltage that each law follows over its range, and what
/// it leaves of thrust or torque at the ends. A vehicle without `[voltage]` has a pack that is not
/// known; without `[vehicle]` it may be a pair on a stand.
pub(super) fn voltage(facts: &Facts<'_>) -> Vec<Rule> {
    let Some(voltage) = &facts.airframe.voltage else {
        let lost = 100.0 * (1.0 - libm::pow(1.0 - PACK_FALLS, TYPICAL));
        return vec![
            Rule::holds(Code::NoVoltage, "vehicle.mass_kg", facts.airframe.vehicle.is_none()).says(
                format!(
                    "no [voltage]: thrust is taken to be the same at any voltage, but a pack that falls by {:.0} % loses \
                     {lost:.0} % of it",
                    100.0 * PACK_FALLS
                ),
                "flies at one voltage",
                "add [voltage] with reference_v (the bench's), range_v (the pack's), thrust_exponent and torque_exponent \
                 (1.75 is typical)",
            ),
        ];
    };
    let ([low, high], reference) = (voltage.range_v, number(voltage.reference_v));
    let thrust = facts.scale[0];
    let is_one_cell = voltage.reference_v <= ONE_CELL_V && thrust >= ONE_CELL_THRUST_N;
    let mut rules = vec![
        Rule::holds(Code::SingleCell, "voltage.reference_v", !is_one_cell).says(
            format!(
                "{} N a unit at {reference} V, the voltage of one cell",
                rounded(thrust)
            ),
            "expected the pack's voltage",
            "multiply reference_v, range_v and the voltages of points by the number of cells in series",
        ),
    ];
    for (name, law) in [("thrust", &voltage.thrust), ("torque", &voltage.torque)] {
        let key = match law {
            VoltageLaw::Exponent(_) => format!("voltage.{name}_exponent"),
            VoltageLaw::Points(_) => format!("voltage.{name}_points"),
        };
        let factor = |volts| law.factor(volts, voltage.reference_v);
        let exponent = libm::log(factor(high) / factor(low)) / libm::log(high / low);
        let [from, to] = voltage.range_v.map(number);
        rules.push(
            Rule::within(Code::VoltageExponent, &key, exponent, EXPONENTS).says(
                format!(
                    "{name} follows the power {} of the voltage from {from} V to {to} V",
                    rounded(exponent)
                ),
                "expected about 1 to 2.5",
                "benches give 1.75 at the median; without measurements at two voltages take that",
            ),
        );
        let is_far = |volts: &f64| !(FACTORS[0]..=FACTORS[1]).contains(&factor(*volts));
        rules.extend([low, high].into_iter().find(is_far).map(|volts| {
            Rule::within(Code::VoltageFactor, &key, factor(volts), FACTORS).says(
                format!(
                    "at {} V {name} is {} of what it is at the reference of {reference} V",
                    number(volts),
                    rounded(factor(volts))
                ),
                format!("expected {} to {}", FACTORS[0], FACTORS[1]),
                "check range_v and reference_v: a pack goes from about 0.85 to 1.15 of its nominal voltage",
            )
        }));
    }
    rules
}
