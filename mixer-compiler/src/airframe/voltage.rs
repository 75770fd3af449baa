//! The supply voltage, and what makes a voltage table sound.

mod law;

pub use self::law::{Voltage, VoltageLaw};
use crate::diagnostic::{Code, Diagnostic, any_of, number, rounded};
use crate::spec::keys::{self, Key, Kind, keys};
use crate::spec::{Fields, Point, Spanned};

/// How far k may be from 1 at the reference voltage: points are written to three or four digits.
const REFERENCE_TOLERANCE: f64 = 1e-3;

/// Steepest power that is taken for a law. Thrust follows about V^1.75; V^3 would be power.
const LARGEST_EXPONENT: f64 = 4.0;

/// Below this, nothing turns.
const LEAST_V: f64 = 0.1;

/// Least distance of two voltages over the higher one, of the range's ends and of neighbouring
/// points: in single precision their difference is then true to a thousandth.
const LEAST_STEP: f64 = 1e-4;

/// Above this, millivolts were meant.
const LARGEST_V: f64 = 1000.0;

/// Least k over the range. The mixer divides by k; below this a rotor hardly turns.
const LEAST_FACTOR: f64 = 1e-3;

/// Largest k over the range: ten times the voltage by the square. No pack does that, and larger
/// ones overflow.
const LARGEST_FACTOR: f64 = 100.0;

const EXPONENT: Kind = Kind::Number(keys::Range::Within([0.0, LARGEST_EXPONENT]));
const EXPONENT_LABEL: &str = "not a motor's exponent";
const EXPONENT_HELP: &str = "thrust and torque follow about the power 1.75 of the voltage";

keys! { TABLE = "[voltage]":
    REFERENCE_V "reference_v" = "14.8", Kind::Number(keys::Range::Positive),
        "Voltage of the bench, V.".required();
    RANGE_V "range_v" = "[12.8, 16.8]", Kind::Numbers([2, 2]),
        "Lowest and highest voltage in flight, V; outside it is clamped and flagged.".required();
    THRUST_EXPONENT "thrust_exponent" = "1.75", EXPONENT,
        "Thrust is multiplied by (V / reference)^exponent.".refusing(EXPONENT_LABEL, EXPONENT_HELP);
    THRUST_POINTS "thrust_points" = "[[12.8, 0.78], [14.8, 1.0], [16.8, 1.25]]", Kind::Points,
        "Thrust is multiplied by a factor between these points [V, factor].";
    TORQUE_EXPONENT "torque_exponent" = "1.75", EXPONENT,
        "Torque is multiplied by (V / reference)^exponent.".refusing(EXPONENT_LABEL, EXPONENT_HELP);
    TORQUE_POINTS "torque_points" = "[[12.8, 0.78], [14.8, 1.0], [16.8, 1.25]]", Kind::Points,
        "Torque is multiplied by a factor between these points [V, factor].";
}

/// Reference and range once they are sound.
#[derive(Clone, Copy)]
struct Supply {
    reference_v: f64,
    range_v: [f64; 2],
}

pub(super) fn read(table: &mut Fields<'_, '_>) -> Option<Voltage> {
    let supply = supply(table);
    let thrust = law(table, "thrust", [&THRUST_EXPONENT, &THRUST_POINTS], supply);
    let torque = law(table, "torque", [&TORQUE_EXPONENT, &TORQUE_POINTS], supply);
    let Supply { reference_v, range_v } = supply?;
    Some(Voltage {
        reference_v,
        range_v,
        thrust: thrust?,
        torque: torque?,
    })
}

fn supply(table: &mut Fields<'_, '_>) -> Option<Supply> {
    let reference = table.read::<f64>(&REFERENCE_V);
    let [low, high]: [f64; 2] = table.array(&RANGE_V)?;
    let [low_v, high_v] = [low, high].map(number);
    const PACK: &str = "write the pack's voltage under load when empty, then when full";
    let mut refuse = |message, label: String, help: String| {
        table.refuse::<Supply>(&RANGE_V, Code::VoltageRange, message, label, help)
    };
    if low < LEAST_V || low >= high {
        let message =
            format!("the voltage range from {low_v} V to {high_v} V is empty or goes below {LEAST_V} V");
        return refuse(message, "expected [lowest, highest]".to_owned(), PACK.to_owned());
    }
    if high - low < LEAST_STEP * high {
        let [wide, least] = [high - low, LEAST_STEP * high].map(|volts| rounded(volts * 1000.0));
        let message = format!("the voltage range up to {high_v} V is {wide} mV wide");
        let help = format!("{PACK}, or leave `[voltage]` out");
        return refuse(message, format!("expected {least} mV at least"), help);
    }
    if high > LARGEST_V {
        let message = format!("a voltage of {high_v} V is beyond {LARGEST_V} V");
        let help = format!("if millivolts were meant, write {} V", number(high / 1000.0));
        return refuse(message, "expected volts".to_owned(), help);
    }
    let reference_v = *reference?.get_ref();
    if !(low..=high).contains(&reference_v) {
        let volts = number(reference_v);
        let message = format!("the reference of {volts} V is outside the range from {low_v} V to {high_v} V");
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

/// The law of a quantity, by its exponent or by its points.
fn law(
    table: &mut Fields<'_, '_>,
    quantity: &str,
    [exponent, points]: [&'static Key; 2],
    supply: Option<Supply>,
) -> Option<VoltageLaw> {
    let (of_exponent, of_points) = (exponent.name, points.name);
    match (table.key_place(exponent), table.key_place(points)) {
        (None, None) => {
            let message = format!("`[voltage]` says nothing of the {quantity}");
            let label = format!("no `{of_exponent}` or `{of_points}`");
            let help = format!("where only one voltage was measured, `{of_exponent} = 1.75` is typical");
            table.refuse(exponent, Code::MissingKey, message, label, help)
        }
        (Some(_), None) => {
            let law = VoltageLaw::Exponent(table.number(exponent)?);
            check_size(table, exponent, &law, supply?).then_some(law)
        }
        (None, Some(_)) => {
            let field = table.read(points)?;
            let law = VoltageLaw::Points(check_points(table, points, &field, supply?)?);
            check_size(table, points, &law, supply?).then_some(law)
        }
        (Some(_), Some(place)) => {
            // Faults of their shape are told all the same.
            table.read::<f64>(exponent);
            table.read::<Vec<Point>>(points);
            let message = format!("`{of_points}` and `{of_exponent}` are two laws for the {quantity}");
            let path = table.key_path(of_points);
            let help = format!("keep one: {}", any_of([of_exponent, of_points]));
            let fault = Diagnostic::new(Code::Conflict, path, place, message);
            table.faults.push(fault.label("second law").help(help));
            None
        }
    }
}

/// Whether a law is 1 at the reference and leaves factors over the range that can be computed with.
fn check_size(table: &mut Fields<'_, '_>, key: &'static Key, law: &VoltageLaw, supply: Supply) -> bool {
    let path = table.key_path(key.name);
    let factor = |volts: f64| (law.factor(volts, supply.reference_v), volts);
    let (volts, mend) = match law {
        VoltageLaw::Exponent(_) => (supply.range_v.to_vec(), "raise the lower end of `range_v`"),
        VoltageLaw::Points(points) => (
            points.iter().map(|point| point[0]).collect(),
            "a point is [volts, factor], the factor relative to the reference voltage",
        ),
    };
    let factors = || volts.iter().map(|volts| factor(*volts));
    let of_reference = factor(supply.reference_v).0;
    let (least, least_v) = factors().fold((f64::INFINITY, 0.0), |a, b| if b.0 < a.0 { b } else { a });
    let (most, most_v) = factors().fold((0.0, 0.0), |a, b| if b.0 > a.0 { b } else { a });
    let (code, message, label, help) = if least < LEAST_FACTOR {
        let message = format!("`{path}` falls to {} at {} V", rounded(least), rounded(least_v));
        let label = format!("must stay above {LEAST_FACTOR} over `range_v`");
        (Code::VoltageNotPositive, message, label, mend.to_owned())
    } else if (of_reference - 1.0).abs() > REFERENCE_TOLERANCE {
        let (k, volts) = (rounded(of_reference), number(supply.reference_v));
        let message = format!("`{path}` is {k} at the reference of {volts} V");
        let label = "must be 1 there, within 0.001".to_owned();
        let help =
            format!("divide every factor by {k}, or set `reference_v` to the voltage of the bench model");
        (Code::VoltageNotOne, message, label, help)
    } else if most > LARGEST_FACTOR {
        let message = format!("`{path}` rises to {} at {} V", rounded(most), rounded(most_v));
        let label = format!("must stay below {LARGEST_FACTOR} over `range_v`");
        let help = "the law is a factor, 1 at the reference voltage, not a thrust or a torque".to_owned();
        (Code::VoltageTooLarge, message, label, help)
    } else {
        return true;
    };
    table.refuse::<()>(key, code, message, label, help).is_some()
}

/// Points whose voltages ascend over the whole range.
fn check_points(
    table: &mut Fields<'_, '_>,
    key: &'static Key,
    field: &Spanned<Vec<Point>>,
    supply: Supply,
) -> Option<Vec<[f64; 2]>> {
    let path = table.key_path(key.name);
    let before = table.faults.len();
    let values = |point: &Point| point.get_ref().each_ref().map(|x| *x.get_ref());
    let points: Vec<[f64; 2]> = field.get_ref().iter().map(values).collect();
    for (pair, written) in points.windows(2).zip(field.get_ref().iter().skip(1)) {
        let [from, to] = [pair[0][0], pair[1][0]];
        let least = LEAST_STEP * to.abs();
        if to - from >= least {
            continue;
        }
        let message = format!("{} V does not come after {} V", number(to), number(from));
        let label = format!("expected at least {} mV above it", rounded(least * 1000.0));
        let fault = Diagnostic::new(Code::VoltagePoints, path.as_str(), written.span(), message);
        let help = "sort the points by voltage and keep one at each";
        table.faults.push(fault.label(label).help(help));
    }
    let [low, high] = supply.range_v.map(number);
    let reach = match (points.first(), points.last()) {
        (Some([first, _]), Some([last, _])) => {
            let [low, high] = supply.range_v;
            let covers = *first <= low && high <= *last;
            (!covers).then(|| format!("reaches from {} V to {} V", number(*first), number(*last)))
        }
        _ => Some("is empty".to_owned()),
    };
    if let (Some(reach), true) = (reach, table.faults.len() == before) {
        let message = format!("`{path}` {reach}, `range_v` from {low} V to {high} V");
        let help = "add measured points at both ends, or narrow `range_v`";
        table.refuse::<()>(
            key,
            Code::VoltagePoints,
            message,
            "does not cover `range_v`",
            help,
        );
    }
    (table.faults.len() == before).then_some(points)
}
