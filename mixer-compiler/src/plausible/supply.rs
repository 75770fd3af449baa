//! Rules on `[voltage]` and `[air]`.

use super::rule::{Facts, KindFacts, Rule};
use crate::airframe::{APART, Correction, Law, TYPICAL_EXPONENT};
use crate::diagnostic::{Code, number, rounded};

/// What a pack of lithium cells loses of its voltage from full to empty, as a share.
const PACK_FALLS: f64 = 0.2;

/// Highest voltage of one cell, V.
const ONE_CELL_V: f64 = 4.5;

/// Thrust of a unit that one cell does not drive, N.
const ONE_CELL_THRUST_N: f64 = 5.0;

/// Factors that packs and air give: 0.6 to 1.4 from empty to full, 0.6 to 1.1 from mountain to coast.
const FACTORS: [f64; 2] = [0.35, 2.0];

/// What brings the rows of a bench to one voltage.
const TO_ONE: &str = "run identify again with --voltage-exponent 1.75 --cells N, which brings the rows to one voltage and \
                      writes [voltage]";

/// The voltage of the bench, the power of the voltage that each law follows over its range, and what
/// it leaves of thrust or torque at the ends. A vehicle without `[voltage]` has a pack that is not
/// known; without `[vehicle]` it may be a pair on a stand.
pub(super) fn voltage(facts: &Facts<'_>) -> Vec<Rule> {
    let Some(voltage) = &facts.airframe.voltage else {
        let help = match facts
            .kinds
            .iter()
            .find_map(|kind| kind.view.of.measured().bench_v)
        {
            Some(_) => TO_ONE,
            None => {
                "add [voltage] with reference_v (the bench's), range_v (the pack's), thrust_exponent and torque_exponent \
                 (1.75 is typical)"
            }
        };
        let lost = 100.0 * (1.0 - libm::pow(1.0 - PACK_FALLS, TYPICAL_EXPONENT));
        return vec![
            Rule::holds(Code::NoVoltage, "vehicle.mass_kg", facts.airframe.vehicle.is_none()).says(
                format!(
                    "no [voltage]: thrust is taken to be the same at any voltage, but a pack that falls by {:.0} % loses \
                     {lost:.0} % of it",
                    100.0 * PACK_FALLS
                ),
                "flies at one voltage",
                help,
            ),
        ];
    };
    let reference = number(voltage.reference);
    let thrust = facts.scale[0];
    let is_one_cell = voltage.reference <= ONE_CELL_V && thrust >= ONE_CELL_THRUST_N;
    let mut rules = vec![
        Rule::holds(Code::SingleCell, "voltage.reference", !is_one_cell).says(
            format!(
                "{} N a unit at {reference} V, the voltage of one cell",
                rounded(thrust)
            ),
            "expected the pack's voltage",
            "multiply reference_v, range_v and the voltages of points by the number of cells in series",
        ),
    ];
    let kinds = facts.kinds.iter().map(|kind| kind.view.of.measured());
    for (law, [low, high]) in kinds.filter_map(|of| Some((&of.own_laws[0], of.bench_v?))) {
        let held = law.as_ref().unwrap_or(voltage).reference;
        let near = [(1.0 - APART) * high, (1.0 + APART) * low];
        rules.push(
            Rule::within(Code::SagTwice, "voltage.reference", held, near).says(
                format!(
                    "the bench had {} to {} V, which are in the pair as they were: with a reference of {} V [voltage] \
                     counts the sag twice, or takes the pair for that of another voltage",
                    number(low),
                    number(high),
                    number(held)
                ),
                "beside rows at their own voltages",
                TO_ONE,
            ),
        );
    }
    rules.extend(laws(voltage, &VOLTAGE));
    rules
}

/// The same of the air: the power of the density that each law follows, and what it leaves.
pub(super) fn air(facts: &Facts<'_>) -> Vec<Rule> {
    let air = facts.airframe.air.as_ref();
    air.map(|air| laws(air, &AIR)).unwrap_or_default()
}

/// The laws of a kind against those of the frame, which all units follow in flight.
pub(super) fn own_laws(facts: &KindFacts<'_>) -> Vec<Rule> {
    let frame = [(&facts.view.voltage, &VOLTAGE), (&facts.view.air, &AIR)];
    let laws = facts.view.of.measured().own_laws.iter().zip(frame);
    let rule = |(own, (frame, limits)): (&Option<Correction>, (&Option<Correction>, &Limits))| {
        let (own, frame, Limits { table, unit, .. }) = (own.as_ref()?, frame.as_ref()?, limits);
        let off = |x| {
            100.0 * (own.thrust_factor(x) / own.thrust_factor(frame.reference) / frame.thrust_factor(x) - 1.0)
        };
        let ([low, high], [from, to]) = (frame.range.map(off), frame.range.map(number));
        let most = low.abs().max(high.abs());
        Some(Rule::at_most(Code::UnlikeLaw, format!("pair.{table}"), most, 100.0 * APART).says(
            format!(
                "thrust by its own law is {low:+.1} % at {from} {unit} and {high:+.1} % at {to} {unit} off that by the frame's \
                 `[{table}]`, which all follow"
            ),
            "another law",
            "identify each kind with the same exponents, or narrow the frame's range",
        ))
    };
    laws.filter_map(rule).collect()
}

/// Words and limits of the laws over one measured quantity.
struct Limits {
    table: &'static str,
    name: &'static str,
    unit: &'static str,
    /// Powers that propellers follow, and what is expected in words.
    exponents: [f64; 2],
    expected: &'static str,
    typical: &'static str,
    /// Advice where a factor is far from 1.
    check: &'static str,
}

const VOLTAGE: Limits = Limits {
    table: "voltage",
    name: "voltage",
    unit: "V",
    exponents: [0.8, 2.7],
    expected: "expected about 1 to 2.5",
    typical: "benches give 1.75 at the median; without measurements at two voltages take that",
    check: "check range_v and reference_v: a pack goes from about 0.85 to 1.15 of its nominal voltage",
};

const AIR: Limits = Limits {
    table: "air",
    name: "density",
    unit: "kg/m3",
    exponents: [0.4, 1.05],
    expected: "expected about 0.6 to 0.85, or 1",
    typical: "it is the voltage's exponent less 1, about 0.75; 1 with speed controllers that hold a speed",
    check: "check range_kg_m3 and reference_density_kg_m3: air has 0.9 at 3,000 m and 1.2 at sea level",
};

fn laws(correction: &Correction, limits: &Limits) -> Vec<Rule> {
    let ([low, high], reference) = (correction.range, number(correction.reference));
    let Limits {
        table,
        name: of,
        unit,
        ..
    } = limits;
    let exponents = correction.exponents();
    let laws = [("thrust", &correction.thrust), ("torque", &correction.torque)];
    let rules = laws
        .into_iter()
        .zip(exponents)
        .flat_map(|((name, law), exponent)| {
            let key = match law {
                Law::Exponent(_) => format!("{table}.{name}_exponent"),
                Law::Points(_) => format!("{table}.{name}_points"),
            };
            let factor = |x| law.factor(x, correction.reference);
            let [from, to] = correction.range.map(number);
            let power = Rule::within(Code::ConditionExponent, &key, exponent, limits.exponents).says(
                format!(
                    "{name} follows the power {} of the {of} from {from} {unit} to {to} {unit}",
                    rounded(exponent)
                ),
                limits.expected,
                limits.typical,
            );
            let is_far = |x: &f64| !(FACTORS[0]..=FACTORS[1]).contains(&factor(*x));
            let far = [low, high].into_iter().find(is_far).map(|x| {
                Rule::within(Code::ConditionFactor, &key, factor(x), FACTORS).says(
                    format!(
                        "at {} {unit} {name} is {} of what it is at the reference of {reference} {unit}",
                        number(x),
                        rounded(factor(x))
                    ),
                    format!("expected {} to {}", FACTORS[0], FACTORS[1]),
                    limits.check,
                )
            });
            std::iter::once(power).chain(far)
        });
    rules.collect()
}
