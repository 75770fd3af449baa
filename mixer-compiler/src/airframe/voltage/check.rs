//! What makes a voltage table sound.

use std::ops::Range;

use super::largest::{Supply, not_too_large};
use super::law::{Voltage, VoltageLaw};
use super::least::{LEAST_FACTOR, below_least};
use crate::diagnostic::{Code, Diagnostic, any_of, number, rounded};
use crate::spec::keys::{self, Key, Kind, keys};
use crate::spec::{Fields, Numbers, Point, Spanned};

/// How far k may be from 1 at the reference voltage: coefficients and points are written to three
/// or four digits.
const REFERENCE_TOLERANCE: f64 = 1e-3;

/// Steepest power that is taken for a law. Thrust follows about V^1.75; V^3 would be power.
const LARGEST_EXPONENT: f64 = 4.0;

/// Highest degree of a polynomial law. Bench data support 1 or 2.
const HIGHEST_LAW_DEGREE: usize = 8;

/// Below this, nothing turns.
const LEAST_V: f64 = 0.1;

/// Least distance of two voltages over the higher one, of the range's ends and of neighbouring
/// points: in single precision their difference is then true to a thousandth.
const LEAST_STEP: f64 = 1e-4;

/// Above this, millivolts were meant.
const LARGEST_V: f64 = 1000.0;

const EXPONENT: Kind = Kind::Number(keys::Range::Within([0.0, LARGEST_EXPONENT]));
const EXPONENT_LABEL: &str = "not a motor's exponent";
const EXPONENT_HELP: &str = "thrust and torque follow about the power 1.75 of the voltage";

const COEFFICIENTS: Kind = Kind::Numbers([1, HIGHEST_LAW_DEGREE + 1]);

keys! { TABLE = "[voltage]":
    REFERENCE_V "reference_v" = "14.8", Kind::Number(keys::Range::Positive),
        "Voltage of the bench, V.".required();
    RANGE_V "range_v" = "[12.8, 16.8]", Kind::Numbers([2, 2]),
        "Lowest and highest voltage in flight, V; outside it is clamped and flagged.".required();
    THRUST_EXPONENT "thrust_exponent" = "1.75", EXPONENT,
        "Thrust is multiplied by (V / reference)^exponent.".refusing(EXPONENT_LABEL, EXPONENT_HELP);
    THRUST_POLYNOMIAL "thrust_polynomial" = "[-0.7, 1.7]", COEFFICIENTS,
        "Thrust is multiplied by c0 + c1 x + .., x = V / reference.";
    THRUST_POINTS "thrust_points" = "[[12.8, 0.78], [14.8, 1.0], [16.8, 1.25]]", Kind::Points,
        "Thrust is multiplied by a factor between these points [V, factor].";
    TORQUE_EXPONENT "torque_exponent" = "1.75", EXPONENT,
        "Torque is multiplied by (V / reference)^exponent.".refusing(EXPONENT_LABEL, EXPONENT_HELP);
    TORQUE_POLYNOMIAL "torque_polynomial" = "[-0.7, 1.7]", COEFFICIENTS,
        "Torque is multiplied by c0 + c1 x + .., x = V / reference.";
    TORQUE_POINTS "torque_points" = "[[12.8, 0.78], [14.8, 1.0], [16.8, 1.25]]", Kind::Points,
        "Torque is multiplied by a factor between these points [V, factor].";
}

/// The exponent, the polynomial and the points of a law.
type Forms = [&'static Key; 3];

const THRUST: Forms = [&THRUST_EXPONENT, &THRUST_POLYNOMIAL, &THRUST_POINTS];
const TORQUE: Forms = [&TORQUE_EXPONENT, &TORQUE_POLYNOMIAL, &TORQUE_POINTS];

pub(in crate::airframe) fn read(table: &mut Fields<'_, '_>) -> Option<Voltage> {
    let supply = supply(table);
    let thrust = law(table, "thrust", THRUST, supply);
    let torque = law(table, "torque", TORQUE, supply);
    let supply = supply?;
    Some(Voltage {
        reference_v: supply.reference_v,
        range_v: supply.range_v,
        thrust: thrust?,
        torque: torque?,
    })
}

fn supply(table: &mut Fields<'_, '_>) -> Option<Supply> {
    let reference = table.read::<f64>(&REFERENCE_V);
    let range = table.read::<[Spanned<f64>; 2]>(&RANGE_V)?;
    let [low, high] = range.get_ref().each_ref().map(|volts| *volts.get_ref());
    let [low_v, high_v] = [low, high].map(number);
    const PACK: &str = "write the pack's voltage under load when empty, then when full";
    if low < LEAST_V || low >= high {
        let message =
            format!("the voltage range from {low_v} V to {high_v} V is empty or goes below {LEAST_V} V");
        return table.refuse(
            &RANGE_V,
            Code::VoltageRange,
            message,
            "expected [lowest, highest]",
            PACK,
        );
    }
    if high - low < LEAST_STEP * high {
        let [wide, least] = [high - low, LEAST_STEP * high].map(|volts| rounded(volts * 1000.0));
        let message = format!("the voltage range up to {high_v} V is {wide} mV wide");
        let label = format!("expected {least} mV at least");
        let help = format!("{PACK}, or leave `[voltage]` out");
        return table.refuse(&RANGE_V, Code::VoltageRange, message, label, help);
    }
    if high > LARGEST_V {
        let message = format!("a voltage of {high_v} V is beyond {LARGEST_V} V");
        let help = format!("if millivolts were meant, write {} V", number(high / 1000.0));
        return table.refuse(&RANGE_V, Code::VoltageRange, message, "expected volts", help);
    }
    let reference_v = *reference?.get_ref();
    if !(low..=high).contains(&reference_v) {
        let message = format!(
            "the reference of {} V is outside the range from {low_v} V to {high_v} V",
            number(reference_v)
        );
        let label = format!("not in [{low_v}, {high_v}]");
        let help =
            "the reference is the voltage at which the bench model holds; widen `range_v` to contain it";
        return table.refuse(&REFERENCE_V, Code::VoltageRange, message, label, help);
    }
    Some(Supply {
        reference_v,
        range_v: [low, high],
    })
}

fn law(
    table: &mut Fields<'_, '_>,
    quantity: &str,
    forms: Forms,
    supply: Option<Supply>,
) -> Option<VoltageLaw> {
    let written: Vec<_> = forms
        .into_iter()
        .filter_map(|key| Some((key, table.key_place(key)?)))
        .collect();
    match written.as_slice() {
        [] => {
            let [exponent, polynomial, points] = forms.map(|key| key.name);
            let message = format!("`[voltage]` says nothing of the {quantity}");
            table.refuse(
                forms[0],
                Code::MissingKey,
                message,
                format!("no `{exponent}`, `{polynomial}` or `{points}`"),
                format!("where only one voltage was measured, `{exponent} = 1.75` is typical"),
            )
        }
        [(key, _)] => {
            let path = &table.key_path(key.name);
            match forms.iter().position(|form| form.name == key.name)? {
                0 => exponent(table, key, supply),
                1 => polynomial(path, &table.read(key)?, supply?, table.faults),
                _ => points(path, &table.read(key)?, supply?, table.faults),
            }
        }
        [(first, _), others @ ..] => {
            // Faults of their shape are told all the same.
            let [exponent, polynomial, points] = forms;
            table.read::<f64>(exponent);
            table.read::<Numbers>(polynomial);
            table.read::<Vec<Point>>(points);
            let names = || written.iter().map(|(key, _)| key.name);
            for (other, place) in others {
                let message = format!(
                    "`{}` and `{}` are two laws for the {quantity}",
                    other.name, first.name
                );
                let path = table.key_path(other.name);
                table.faults.push(
                    Diagnostic::new(Code::Conflict, path, place.clone(), message)
                        .label("second law")
                        .help(format!("keep one: {}", any_of(names()))),
                );
            }
            None
        }
    }
}

fn exponent(table: &mut Fields<'_, '_>, key: &'static Key, supply: Option<Supply>) -> Option<VoltageLaw> {
    let law = VoltageLaw::Exponent(table.number(key)?);
    let (supply, path, place) = (supply?, &table.key_path(key.name), table.value_place(key));
    let low = supply.range_v[0];
    let k = law.factor(low, supply.reference_v);
    if k < LEAST_FACTOR {
        let fault = too_small(path, place, k, low);
        table.faults.push(fault.help("raise the lower end of `range_v`"));
        return None;
    }
    not_too_large(path, place, &law, supply, table.faults)?;
    Some(law)
}

fn polynomial(
    key: &str,
    field: &Spanned<Numbers>,
    supply: Supply,
    faults: &mut Vec<Diagnostic>,
) -> Option<VoltageLaw> {
    let coefficients: Vec<f64> = field.get_ref().iter().map(|c| *c.get_ref()).collect();
    if !(1..=HIGHEST_LAW_DEGREE + 1).contains(&coefficients.len()) {
        faults.push(
            Diagnostic::new(
                Code::WrongLength,
                key,
                field.span(),
                format!(
                    "`{key}` has {} coefficients, not 1 to {}",
                    coefficients.len(),
                    HIGHEST_LAW_DEGREE + 1
                ),
            )
            .label("c0, c1, .. in V/Vref")
            .help("two or three are enough for a measured pack"),
        );
        return None;
    }
    let range = supply.range_v.map(|volts| volts / supply.reference_v);
    if let Some((x, k)) = below_least(&coefficients, range) {
        faults.push(
            too_small(key, field.span(), k, x * supply.reference_v)
                .help("the coefficients multiply 1, V/Vref, (V/Vref)^2, .., not volts"),
        );
        return None;
    }
    let law = VoltageLaw::Polynomial(coefficients);
    one_at_reference(key, field.span(), &law, "coefficient", supply, faults)?;
    not_too_large(key, field.span(), &law, supply, faults)?;
    Some(law)
}

fn points(
    key: &str,
    field: &Spanned<Vec<Point>>,
    supply: Supply,
    faults: &mut Vec<Diagnostic>,
) -> Option<VoltageLaw> {
    let before = faults.len();
    let points: Vec<[f64; 2]> = field
        .get_ref()
        .iter()
        .map(|point| point.get_ref().each_ref().map(|x| *x.get_ref()))
        .collect();
    let mut previous = None;
    for (&[volts, k], written) in points.iter().zip(field.get_ref()) {
        point(key, written.span(), previous, [volts, k], faults);
        previous = Some(volts);
    }
    if faults.len() == before {
        faults.extend(uncovered(key, field.span(), &points, supply.range_v));
    }
    if faults.len() > before {
        return None;
    }
    let law = VoltageLaw::Points(points);
    one_at_reference(key, field.span(), &law, "factor", supply, faults)?;
    not_too_large(key, field.span(), &law, supply, faults)?;
    Some(law)
}

/// Judges one point by its factor and by the voltage of the point before it.
fn point(
    key: &str,
    place: Range<usize>,
    previous: Option<f64>,
    [volts, k]: [f64; 2],
    faults: &mut Vec<Diagnostic>,
) {
    let fault = |message: String| Diagnostic::new(Code::VoltagePoints, key, place.clone(), message);
    if let Some(previous) = previous
        && volts - previous < LEAST_STEP * volts
    {
        if volts > previous {
            faults.push(
                fault(format!(
                    "{} V and {} V are {} mV apart",
                    number(previous),
                    number(volts),
                    rounded((volts - previous) * 1000.0)
                ))
                .label(format!(
                    "expected {} mV at least",
                    rounded(LEAST_STEP * volts * 1000.0)
                ))
                .help("keep one of the two: between them the law would be a jump"),
            );
            return;
        }
        let (volts, previous) = (number(volts), number(previous));
        faults.push(
            fault(format!("{volts} V does not come after {previous} V"))
                .label("expected ascending voltages")
                .help("sort the points by voltage and keep one at each"),
        );
    }
    if k < LEAST_FACTOR {
        faults.push(
            too_small(key, place, k, volts)
                .help("a point is [volts, factor], the factor relative to the reference voltage"),
        );
    }
}

/// The fault of ascending points that do not cover the range.
fn uncovered(
    key: &str,
    place: Range<usize>,
    points: &[[f64; 2]],
    [low, high]: [f64; 2],
) -> Option<Diagnostic> {
    let reach = match points.first().zip(points.last()) {
        Some((first, last)) if first[0] <= low && high <= last[0] => return None,
        Some((first, last)) => format!("reaches from {} V to {} V", number(first[0]), number(last[0])),
        None => "is empty".to_string(),
    };
    let message = format!(
        "`{key}` {reach}, `range_v` from {} V to {} V",
        number(low),
        number(high)
    );
    let fault = Diagnostic::new(Code::VoltagePoints, key, place, message);
    Some(
        fault
            .label("does not cover `range_v`")
            .help("add measured points at both ends, or narrow `range_v`"),
    )
}

fn too_small(key: &str, place: Range<usize>, k: f64, volts: f64) -> Diagnostic {
    let (k, volts) = (rounded(k), rounded(volts));
    Diagnostic::new(
        Code::VoltageNotPositive,
        key,
        place,
        format!("`{key}` falls to {k} at {volts} V"),
    )
    .label(format!("must stay above {LEAST_FACTOR} over `range_v`"))
}

fn one_at_reference(
    key: &str,
    place: Range<usize>,
    law: &VoltageLaw,
    parts: &str,
    supply: Supply,
    faults: &mut Vec<Diagnostic>,
) -> Option<()> {
    let k = law.factor(supply.reference_v, supply.reference_v);
    if (k - 1.0).abs() <= REFERENCE_TOLERANCE {
        return Some(());
    }
    let (k, volts) = (rounded(k), number(supply.reference_v));
    faults.push(
        Diagnostic::new(
            Code::VoltageNotOne,
            key,
            place,
            format!("`{key}` is {k} at the reference of {volts} V"),
        )
        .label("must be 1 there, within 0.001")
        .help(format!(
            "divide every {parts} by {k}, or set `reference_v` to the voltage of the bench model"
        )),
    );
    None
}
