//! Rules on `[voltage]`.

use super::facts::Facts;
use crate::airframe::{Voltage, VoltageLaw};
use crate::diagnostic::{Code, Diagnostic, number, rounded};

/// What a pack of lithium cells loses of its voltage from full to empty, as a share.
const PACK_FALLS: f64 = 0.2;

/// Exponent of thrust over voltage: the median of benches.
const TYPICAL: f64 = 1.75;

/// A vehicle whose pack is not known. Without `[vehicle]` it may be a pair on a stand.
pub(super) fn missing(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    if facts.airframe.voltage.is_some() || facts.airframe.vehicle.is_none() {
        return;
    }
    found.push(facts.airframe.diagnostic(
        Code::NoVoltage,
        "vehicle.mass_kg",
        format!(
            "no [voltage]: thrust is taken to be the same at any voltage, but a pack that falls by {:.0} % loses {:.0} % of it",
            100.0 * PACK_FALLS,
            100.0 * (1.0 - libm::pow(1.0 - PACK_FALLS, TYPICAL))
        ),
        "flies at one voltage",
        "add [voltage] with reference_v (the bench's), range_v (the pack's), thrust_exponent and torque_exponent (1.75 is typical)",
    ));
}

/// Highest voltage of one cell, V.
const ONE_CELL_V: f64 = 4.5;

/// Thrust of a unit that one cell does not drive, N.
const ONE_CELL_THRUST_N: f64 = 5.0;

/// The voltage of a cell in place of the pack's.
pub(super) fn single_cell(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    let Some(voltage) = &facts.airframe.voltage else {
        return;
    };
    if voltage.reference_v > ONE_CELL_V || facts.scale[0] < ONE_CELL_THRUST_N {
        return;
    }
    found.push(facts.airframe.diagnostic(
        Code::SingleCell,
        "voltage.reference_v",
        format!(
            "{} N a unit at {} V, the voltage of one cell",
            rounded(facts.scale[0]),
            number(voltage.reference_v)
        ),
        "expected the pack's voltage",
        "multiply reference_v, range_v and the voltages of points by the number of cells in series",
    ));
}

/// Powers of the voltage that propellers follow: 1 to 2.5, and what a narrow range leaves
/// uncertain.
const EXPONENTS: [f64; 2] = [0.8, 2.7];

/// The power of the voltage that a law follows over its range.
pub(super) fn exponents(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    let Some(voltage) = &facts.airframe.voltage else {
        return;
    };
    let [low, high] = voltage.range_v;
    for (name, law) in laws(voltage) {
        let factor = |volts| law.factor(volts, voltage.reference_v);
        let exponent = libm::log(factor(high) / factor(low)) / libm::log(high / low);
        if (EXPONENTS[0]..=EXPONENTS[1]).contains(&exponent) {
            continue;
        }
        found.push(facts.airframe.diagnostic(
            Code::VoltageExponent,
            &key(name, law),
            format!(
                "{name} follows the power {} of the voltage from {} V to {} V",
                rounded(exponent),
                number(low),
                number(high)
            ),
            "expected about 1 to 2.5",
            "benches give 1.75 at the median; without measurements at two voltages take that",
        ));
    }
}

/// Factors that packs give: 0.6 to 1.4 from empty to full.
const FACTORS: [f64; 2] = [0.35, 2.0];

/// What a law leaves of thrust or torque at the ends of its range.
pub(super) fn factors(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    let Some(voltage) = &facts.airframe.voltage else {
        return;
    };
    for (name, law) in laws(voltage) {
        let far = voltage
            .range_v
            .map(|volts| (volts, law.factor(volts, voltage.reference_v)))
            .into_iter()
            .find(|(_, k)| !(FACTORS[0]..=FACTORS[1]).contains(k));
        let Some((volts, k)) = far else { continue };
        found.push(facts.airframe.diagnostic(
            Code::VoltageFactor,
            &key(name, law),
            format!(
                "at {} V {name} is {} of what it is at the reference of {} V",
                number(volts),
                rounded(k),
                number(voltage.reference_v)
            ),
            format!("expected {} to {}", FACTORS[0], FACTORS[1]),
            "check range_v and reference_v: a pack goes from about 0.85 to 1.15 of its nominal voltage",
        ));
    }
}

fn laws(voltage: &Voltage) -> [(&'static str, &VoltageLaw); 2] {
    [("thrust", &voltage.thrust), ("torque", &voltage.torque)]
}

fn key(name: &str, law: &VoltageLaw) -> String {
    let form = match law {
        VoltageLaw::Exponent(_) => "exponent",
        VoltageLaw::Points(_) => "points",
    };
    format!("voltage.{name}_{form}")
}
