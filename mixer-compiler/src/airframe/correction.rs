//! The corrections of thrust and torque for the battery's voltage and for the air's density, and what
//! makes their tables sound.

mod law;

pub use self::law::{Correction, Law};
use crate::diagnostic::{Code, Diagnostic, any_of, number, rounded};
use crate::quantity::{self, Quantity};
use crate::spec::keys::{self, Key, ValueKind, keys};
use crate::spec::{Fields, Point, Spanned};

/// How far k may be from 1 at the reference: points are written to three or four digits.
const REFERENCE_TOLERANCE: f64 = 1e-3;

/// Power of the voltage that thrust follows where nothing else is known: the median of 104 motors that
/// were measured at two voltages.
pub const TYPICAL_EXPONENT: f64 = 1.75;

/// Steepest power of the voltage that is taken for a law. Thrust follows about V^1.75; V^3 would be
/// power.
const LARGEST_OF_VOLTAGE: f64 = 4.0;

/// Steepest power of the density that is taken for a law. A controller that holds a speed has 1.
const LARGEST_OF_DENSITY: f64 = 1.5;

/// Least distance of two values over the higher one, of the range's ends and of neighbouring
/// points: in single precision their difference is then true to a thousandth.
const LEAST_STEP: f64 = 1e-4;

/// Least k over the range. The mixer divides by k; below this a rotor hardly turns.
const LEAST_FACTOR: f64 = 1e-3;

/// Largest k over the range: ten times the voltage by the square. No pack does that, and larger
/// ones overflow.
const LARGEST_FACTOR: f64 = 100.0;

const OF_VOLTAGE: ValueKind = ValueKind::Number(keys::Range::Within([0.0, LARGEST_OF_VOLTAGE]));
const VOLTAGE_LABEL: &str = "not a motor's exponent";
const VOLTAGE_HELP: &str = "thrust and torque follow about the power 1.75 of the voltage";
const OF_DENSITY: ValueKind = ValueKind::Number(keys::Range::Within([0.0, LARGEST_OF_DENSITY]));
const DENSITY_LABEL: &str = "not a rotor's exponent";
const DENSITY_HELP: &str =
    "it is the exponent of the voltage less 1, about 0.75, or 1 with speed controllers that hold a speed";

keys! { VOLTAGE_TABLE = "[voltage]":
    REFERENCE_V "reference_v" = "14.8", ValueKind::Number(keys::Range::Positive),
        "Voltage of the bench, V.".required();
    RANGE_V "range_v" = "[12.8, 16.8]", ValueKind::Numbers([2, 2]),
        "Lowest and highest voltage in flight, V; outside it is clamped and flagged.".required();
    THRUST_EXPONENT "thrust_exponent" = "1.75", OF_VOLTAGE,
        "Thrust is multiplied by (V / reference)^exponent.".refusing(VOLTAGE_LABEL, VOLTAGE_HELP);
    THRUST_POINTS "thrust_points" = "[[12.8, 0.78], [14.8, 1.0], [16.8, 1.25]]", ValueKind::Points,
        "Thrust is multiplied by a factor between these points [V, factor].";
    TORQUE_EXPONENT "torque_exponent" = "1.75", OF_VOLTAGE,
        "Torque is multiplied by (V / reference)^exponent.".refusing(VOLTAGE_LABEL, VOLTAGE_HELP);
    TORQUE_POINTS "torque_points" = "[[12.8, 0.78], [14.8, 1.0], [16.8, 1.25]]", ValueKind::Points,
        "Torque is multiplied by a factor between these points [V, factor].";
}

keys! { AIR_TABLE = "[air]":
    REFERENCE_DENSITY "reference_density_kg_m3" = "1.204", ValueKind::Number(keys::Range::Positive),
        "Density of the bench's air, kg/m3: pressure in Pa / (287.05 x temperature in K).".required();
    RANGE_DENSITY "range_kg_m3" = "[0.75, 1.4]", ValueKind::Numbers([2, 2]),
        "Least and largest density in flight, kg/m3; outside it is clamped and flagged.".required();
    THRUST_OF_DENSITY "thrust_exponent" = "0.75", OF_DENSITY,
        "Thrust is multiplied by (density / reference)^exponent; that of [voltage] less 1 without it, 1 with speed controllers that hold a speed."
        .refusing(DENSITY_LABEL, DENSITY_HELP);
    TORQUE_OF_DENSITY "torque_exponent" = "0.75", OF_DENSITY,
        "Torque is multiplied by (density / reference)^exponent; likewise."
        .refusing(DENSITY_LABEL, DENSITY_HELP);
}

/// A measured quantity: its keys of reference and range, and the words of its diagnostics.
struct Measured {
    reference: &'static Key,
    range: &'static Key,
    of: Quantity,
    /// Advice for a range that cannot be.
    ends: &'static str,
}

const VOLTAGE: Measured = Measured {
    reference: &REFERENCE_V,
    range: &RANGE_V,
    of: quantity::VOLTAGE,
    ends: "write the pack's voltage under load when empty, then when full",
};

const AIR: Measured = Measured {
    reference: &REFERENCE_DENSITY,
    range: &RANGE_DENSITY,
    of: quantity::DENSITY,
    ends: "write the density at the highest place in the warmest air, then at the lowest in the coldest: pressure in Pa / (287.05 x \
           temperature in K), about 1.2 kg/m3 at sea level",
};

/// Reference and range once they are sound, with their unit.
#[derive(Clone, Copy)]
struct Span {
    reference: f64,
    range: [f64; 2],
    unit: &'static str,
}

impl Span {
    /// The correction by the laws of thrust and of torque.
    fn correction(self, [thrust, torque]: [Option<Law>; 2]) -> Option<Correction> {
        Some(Correction {
            reference: self.reference,
            range: self.range,
            thrust: thrust?,
            torque: torque?,
        })
    }
}

/// `[voltage]` and `[air]` of these keys.
pub(super) fn read(table: &mut Fields<'_, '_>, [voltage, air]: [&'static Key; 2]) -> [Option<Correction>; 2] {
    let voltage = table.table(voltage, read_voltage);
    let of_voltage = voltage.as_ref().map(Option::as_ref);
    let air = table.table(air, |table| read_air(table, of_voltage));
    [voltage.flatten(), air.flatten()]
}

fn read_voltage(table: &mut Fields<'_, '_>) -> Option<Correction> {
    let span = span(table, &VOLTAGE);
    let thrust = law(table, "thrust", [&THRUST_EXPONENT, &THRUST_POINTS], span);
    let torque = law(table, "torque", [&TORQUE_EXPONENT, &TORQUE_POINTS], span);
    span?.correction([thrust, torque])
}

/// `[air]`, whose exponents are those of the voltage less 1 where it has none of its own: a motor with
/// its propeller gives T(V, sigma rho) = T(sigma V, rho) / sigma, so that thin air acts like a
/// lower voltage. `voltage` is the table of the file, `None` in it where it was refused.
fn read_air(table: &mut Fields<'_, '_>, voltage: Option<Option<&Correction>>) -> Option<Correction> {
    let span = span(table, &AIR);
    let of_voltage = voltage.map(|voltage| voltage.map(|voltage| voltage.exponents().map(|k| k - 1.0)));
    let keys = [("thrust", &THRUST_OF_DENSITY), ("torque", &TORQUE_OF_DENSITY)];
    let laws = [0, 1].map(|k| {
        let (quantity, key): (_, &'static Key) = keys[k];
        let exponent = match (table.key_place(key), of_voltage) {
            (Some(_), _) => table.number(key)?,
            (None, Some(exponents)) => following(table, key, exponents?[k])?,
            (None, None) => {
                let message = format!("`[air]` says nothing of the {quantity}, and there is no `[voltage]`");
                let label = format!("no `{}`", key.name);
                return table.refuse(key, Code::MissingKey, message, label, DENSITY_HELP);
            }
        };
        let law = Law::Exponent(exponent);
        check_size(table, key, &law, span?).then_some(law)
    });
    span?.correction(laws)
}

/// An exponent of the density that follows from the voltage's.
fn following(table: &mut Fields<'_, '_>, key: &'static Key, exponent: f64) -> Option<f64> {
    if (0.0..=LARGEST_OF_DENSITY).contains(&exponent) {
        return Some(exponent);
    }
    let message = format!(
        "the exponent of the voltage, {}, less 1 is no exponent of the density",
        rounded(exponent + 1.0)
    );
    let help = format!(
        "write `{}`: 1 with speed controllers that hold a speed, about 0.75 with those that make up for the voltage",
        key.name
    );
    let label = format!("no `{}` of its own", key.name);
    table.refuse(key, Code::OutOfRange, message, label, help)
}

fn span(table: &mut Fields<'_, '_>, of: &Measured) -> Option<Span> {
    let (Quantity { name, unit, .. }, ends) = (&of.of, of.ends);
    let reference = table.read::<f64>(of.reference);
    let [low, high]: [f64; 2] = table.array(of.range)?;
    let [low_x, high_x] = [low, high].map(number);
    let header = table.path().to_owned();
    let mut refuse = |message, label: String, help: String| {
        table.refuse::<Span>(of.range, Code::ConditionRange, message, label, help)
    };
    if let Some(told) = [low, high].into_iter().find_map(|x| of.of.check(x).err()) {
        let message = format!("a {name} of {told}");
        return refuse(message, format!("expected {unit}"), ends.to_owned());
    }
    if low >= high {
        let message = format!("the {name} range from {low_x} {unit} to {high_x} {unit} is empty");
        let label = "expected [lowest, highest]".to_owned();
        return refuse(message, label, ends.to_owned());
    }
    if high - low < LEAST_STEP * high {
        let [wide, least] = [high - low, LEAST_STEP * high].map(rounded);
        let message = format!("the {name} range up to {high_x} {unit} is {wide} {unit} wide");
        let help = format!("{ends}, or leave `[{header}]` out");
        return refuse(message, format!("expected {least} {unit} at least"), help);
    }
    let reference = *reference?.get_ref();
    if !(low..=high).contains(&reference) {
        let x = number(reference);
        let message = format!(
            "the reference of {x} {unit} is outside the range from {low_x} {unit} to {high_x} {unit}"
        );
        let label = format!("not in [{low_x}, {high_x}]");
        let help = format!(
            "the reference is the {name} at which the bench model holds; widen `{}` to contain it",
            of.range.name
        );
        return table.refuse(of.reference, Code::ConditionRange, message, label, help);
    }
    Some(Span {
        reference,
        range: [low, high],
        unit,
    })
}

/// The law of a quantity over the voltage, by its exponent or by its points.
fn law(
    table: &mut Fields<'_, '_>,
    quantity: &str,
    [exponent, points]: [&'static Key; 2],
    span: Option<Span>,
) -> Option<Law> {
    let (of_exponent, of_points) = (exponent.name, points.name);
    match (table.key_place(exponent), table.key_place(points)) {
        (None, None) => {
            let message = format!("`[voltage]` says nothing of the {quantity}");
            let label = format!("no `{of_exponent}` or `{of_points}`");
            let help = format!("where only one voltage was measured, `{of_exponent} = 1.75` is typical");
            table.refuse(exponent, Code::MissingKey, message, label, help)
        }
        (Some(_), None) => {
            let law = Law::Exponent(table.number(exponent)?);
            check_size(table, exponent, &law, span?).then_some(law)
        }
        (None, Some(_)) => {
            let field = table.read(points)?;
            let law = Law::Points(check_points(table, points, &field, span?)?);
            check_size(table, points, &law, span?).then_some(law)
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
fn check_size(table: &mut Fields<'_, '_>, key: &'static Key, law: &Law, span: Span) -> bool {
    let path = table.key_path(key.name);
    let unit = span.unit;
    let factor = |x: f64| (law.factor(x, span.reference), x);
    let (values, mend) = match law {
        Law::Exponent(_) => (span.range.to_vec(), "raise the lower end of the range"),
        Law::Points(points) => (
            points.iter().map(|point| point[0]).collect(),
            "a point is [volts, factor], the factor relative to the reference voltage",
        ),
    };
    let factors = || values.iter().map(|x| factor(*x));
    let of_reference = factor(span.reference).0;
    let (least, least_x) = factors().fold((f64::INFINITY, 0.0), |a, b| if b.0 < a.0 { b } else { a });
    let (most, most_x) = factors().fold((0.0, 0.0), |a, b| if b.0 > a.0 { b } else { a });
    let (code, message, label, help) = if least < LEAST_FACTOR {
        let message = format!(
            "`{path}` falls to {} at {} {unit}",
            rounded(least),
            rounded(least_x)
        );
        let label = format!("must stay above {LEAST_FACTOR} over the range");
        (Code::FactorNotPositive, message, label, mend.to_owned())
    } else if (of_reference - 1.0).abs() > REFERENCE_TOLERANCE {
        let (k, x) = (rounded(of_reference), number(span.reference));
        let message = format!("`{path}` is {k} at the reference of {x} {unit}");
        let label = "must be 1 there, within 0.001".to_owned();
        let help =
            format!("divide every factor by {k}, or set `reference_v` to the voltage of the bench model");
        (Code::FactorNotOne, message, label, help)
    } else if most > LARGEST_FACTOR {
        let message = format!(
            "`{path}` rises to {} at {} {unit}",
            rounded(most),
            rounded(most_x)
        );
        let label = format!("must stay below {LARGEST_FACTOR} over the range");
        let help = "the law is a factor, 1 at the reference voltage, not a thrust or a torque".to_owned();
        (Code::FactorTooLarge, message, label, help)
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
    span: Span,
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
    let [low, high] = span.range.map(number);
    let reach = match (points.first(), points.last()) {
        (Some([first, _]), Some([last, _])) => {
            let [low, high] = span.range;
            let covers = *first <= low && high <= *last;
            (!covers).then(|| format!("reaches from {} V to {} V", number(*first), number(*last)))
        }
        _ => Some("is empty".to_owned()),
    };
    if let (Some(reach), true) = (reach, table.faults.len() == before) {
        let message = format!("`{path}` {reach}, `range_v` from {low} V to {high} V");
        let help = "add measured points at both ends, or narrow `range_v`";
        let label = "does not cover `range_v`";
        table.refuse::<()>(key, Code::VoltagePoints, message, label, help);
    }
    (table.faults.len() == before).then_some(points)
}
