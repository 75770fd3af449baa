//! Which column holds what: from the header line, or by hand.
//!
//! A name is normalised first ([`units::spelled`]); its unit is the last group in brackets, or a
//! suffix of the plain format (`thrust_n`). Then a column is known by a word of its name (`ESC` or
//! `PWM`, `thrust`, `torque`, `voltage`) and its rotor by another (`Left`, `A`, `upper`, or a
//! prefix such as `Powertrain 1 - `, which users edit, so that the first prefix to appear is the
//! first rotor). The first rotor is taken as the upper one unless names say otherwise.

use self::name::{Name, distinct_prefixes};
use crate::bench::units::{self, Quantity, Scale};
use crate::refusal::Refusal;

mod name;

/// A column that is read.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Position in the row, from 0.
    pub index: usize,
    /// Name as in the file.
    pub name: String,
    /// How to reach SI.
    pub scale: Scale,
}

/// A quantity of the whole and of the upper and the lower rotor.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Split<T> {
    /// Of both rotors together.
    pub whole: T,
    /// Of the upper and of the lower one.
    pub rotors: [T; 2],
}

impl<T> Split<Option<T>> {
    /// Whether there is any.
    pub fn any(&self) -> bool {
        self.whole.is_some() || self.rotors.iter().any(Option::is_some)
    }

    /// Whether there is the whole, or both rotors.
    pub fn complete(&self) -> bool {
        self.whole.is_some() || self.rotors.iter().all(Option::is_some)
    }
}

/// The columns that are read; `--column ROLE=HEADER` names them by [`ROLES`].
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Columns {
    /// Commands of the upper rotor, or of the only one, and of the lower rotor.
    pub throttle: Split<Option<Column>>,
    /// Thrust.
    pub thrust: Split<Option<Column>>,
    /// Torque.
    pub torque: Split<Option<Column>>,
    /// Supply voltage of the whole or of the upper rotor, and of the lower one where it has a supply
    /// of its own.
    pub voltage: Split<Option<Column>>,
    /// Supply current.
    pub current: Split<Option<Column>>,
    /// Time.
    pub time: Split<Option<Column>>,
    /// Temperature of the air.
    pub temperature: Split<Option<Column>>,
    /// Its pressure.
    pub pressure: Split<Option<Column>>,
    /// Its density.
    pub density: Split<Option<Column>>,
    /// The format that the header was recognised as, for the report.
    pub format: String,
    /// Whether names, rather than an assumption, say which rotor is the upper one.
    pub sides_named: bool,
}

/// Columns and units given by hand.
#[derive(Debug, Clone, Default)]
pub struct ByHand {
    /// (role, header name or `#` and the column's number from 1).
    pub columns: Vec<(String, String)>,
    /// (role, unit), for headers without one.
    pub units: Vec<(String, String)>,
    /// Speed at full throttle, revolutions per minute: throttle columns hold speeds.
    pub full_rpm: Option<f64>,
    /// Exchange the two rotors that the header suggests.
    pub swap: bool,
}

/// Roles for `--column`, with what they measure and of which rotor.
pub const ROLES: [(&str, Quantity, Option<usize>); 17] = [
    ("upper", Quantity::Throttle, Some(0)),
    ("lower", Quantity::Throttle, Some(1)),
    ("thrust", Quantity::Thrust, None),
    ("torque", Quantity::Torque, None),
    ("upper_thrust", Quantity::Thrust, Some(0)),
    ("lower_thrust", Quantity::Thrust, Some(1)),
    ("upper_torque", Quantity::Torque, Some(0)),
    ("lower_torque", Quantity::Torque, Some(1)),
    ("voltage", Quantity::Voltage, Some(0)),
    ("lower_voltage", Quantity::Voltage, Some(1)),
    ("current", Quantity::Current, None),
    ("upper_current", Quantity::Current, Some(0)),
    ("lower_current", Quantity::Current, Some(1)),
    ("time", Quantity::Time, None),
    ("temperature", Quantity::Temperature, None),
    ("pressure", Quantity::Pressure, None),
    ("density", Quantity::Density, None),
];

impl Columns {
    fn of(&mut self, quantity: Quantity) -> &mut Split<Option<Column>> {
        match quantity {
            Quantity::Throttle => &mut self.throttle,
            Quantity::Thrust => &mut self.thrust,
            Quantity::Torque => &mut self.torque,
            Quantity::Voltage => &mut self.voltage,
            Quantity::Current => &mut self.current,
            Quantity::Time => &mut self.time,
            Quantity::Temperature => &mut self.temperature,
            Quantity::Pressure => &mut self.pressure,
            Quantity::Density => &mut self.density,
        }
    }

    /// The place of a quantity's column.
    fn slot(&mut self, quantity: Quantity, side: Option<usize>) -> &mut Option<Column> {
        let Split { whole, rotors } = self.of(quantity);
        match (side, rotors) {
            (None, _) => whole,
            (Some(0), [upper, _]) => upper,
            (_, [_, lower]) => lower,
        }
    }

    /// Reads the header line of `file`. `headers` are the decoded names.
    pub fn find(file: &str, headers: &[String], by_hand: &ByHand) -> Result<Self, Refusal> {
        let names: Vec<Name> = headers.iter().map(|h| Name::new(h)).collect();
        let mut columns = Columns {
            format: format_name(headers, &names),
            ..Columns::default()
        };
        columns.by_name(file, &names, by_hand)?;
        if by_hand.swap {
            use Quantity::{Current, Throttle, Thrust, Torque};
            for quantity in [Throttle, Thrust, Torque, Current] {
                columns.of(quantity).rotors.swap(0, 1);
            }
            if columns.voltage.complete() {
                columns.voltage.rotors.swap(0, 1);
            }
        }
        for (role, wanted) in &by_hand.columns {
            let Some(&(_, quantity, side)) = ROLES.iter().find(|(r, ..)| r == role) else {
                return Err(unknown_role(role));
            };
            let index = position(headers, wanted).ok_or_else(|| {
                Refusal::of(
                    file,
                    format!("no column {wanted:?} for the role {role}"),
                    format!("one of: {}", headers.join(", ")),
                )
            })?;
            let column = scaled(file, index, &names[index], quantity, role, by_hand)?;
            // A column of one rotor given by hand stands above the whole's.
            if side.is_some() {
                columns.of(quantity).whole = None;
            }
            *columns.slot(quantity, side) = Some(column);
            columns.sides_named |= matches!(role.as_str(), "upper" | "lower");
        }
        columns.sides_named |= by_hand.swap;
        Ok(columns)
    }

    /// Why there is no electrical power, where columns are missing for it.
    pub fn no_power(&self) -> Option<String> {
        let of_one = |named: &Column, other: &str| {
            format!(
                "the current of one rotor only ({:?}): --column {other}_current=HEADER names the other's",
                named.name
            )
        };
        match (&self.voltage.rotors[0], &self.current.whole, &self.current.rotors) {
            (Some(_), Some(_), _) | (Some(_), _, [Some(_), Some(_)]) => None,
            (_, None, [Some(upper), None]) => Some(of_one(upper, "lower")),
            (_, None, [None, Some(lower)]) => Some(of_one(lower, "upper")),
            (_, None, [None, None]) => Some("no file has the current of both rotors".into()),
            (None, _, _) => Some("no file has the supply voltage beside the current".into()),
        }
    }

    fn by_name(&mut self, file: &str, names: &[Name], by_hand: &ByHand) -> Result<(), Refusal> {
        let prefixes = distinct_prefixes(names);
        for (index, name) in names.iter().enumerate() {
            let Some(quantity) = name.quantity() else { continue };
            let side = match (quantity, name.side(&prefixes)) {
                (Quantity::Time | Quantity::Temperature | Quantity::Pressure | Quantity::Density, _) => None,
                (Quantity::Throttle | Quantity::Voltage, None) => Some(0),
                (_, side) => side,
            };
            let role = ROLES.iter().find(|(_, of, at)| (*of, *at) == (quantity, side));
            let Some(&(role, ..)) = role else { continue };
            if by_hand.columns.iter().any(|(r, _)| r == role) {
                continue;
            }
            // Power and air are by-products: what is doubtful there refuses no map.
            use Quantity::{Current, Density, Pressure, Temperature};
            let aside =
                matches!(quantity, Current | Temperature | Pressure | Density) || role == "lower_voltage";
            let slot = self.slot(quantity, side);
            if let Some(first) = slot {
                // Two columns for one role: guessing would be silent. Time is only used to keep
                // rows in order.
                if aside || quantity == Quantity::Time {
                    continue;
                }
                return Err(Refusal::of(
                    file,
                    format!(
                        "the columns {:?} and {:?} both look like the {role}",
                        first.name, name.raw
                    ),
                    format!("the right one by hand: --column {role}={:?}", name.raw),
                ));
            }
            match scaled(file, index, name, quantity, role, by_hand) {
                Err(_) if aside => {}
                column => *slot = Some(column?),
            }
            self.sides_named |= quantity == Quantity::Throttle && name.says_upper_or_lower();
        }
        if self.format == NEWDEXTERITY {
            self.sides_named = true; // on this platform the left rotor is the upper one
        }
        Ok(())
    }
}

/// The refusal of a role that does not exist.
pub fn unknown_role(role: &str) -> Refusal {
    let roles: Vec<&str> = ROLES.iter().map(|(r, ..)| *r).collect();
    Refusal::general(
        format!("unknown role {role:?}"),
        format!("one of: {}", roles.join(", ")),
    )
}

const NEWDEXTERITY: &str = "coaxial map (newdexterity)";

fn format_name(headers: &[String], names: &[Name]) -> String {
    let has = |text: &str| names.iter().any(|n| n.text == text);
    let any = |text: &str| headers.iter().any(|h| units::spelled(h).contains(text));
    if has("pwm left") && has("pwm right") {
        NEWDEXTERITY
    } else if any("torque mz") || any("force fz") {
        "Tyto Flight Stand"
    } else if has("esc a") && has("esc b") {
        "RCbenchmark 1780"
    } else if any("esc signal") {
        "RCbenchmark 1520/1580"
    } else if has("upper") && has("lower") {
        "plain"
    } else {
        "columns by name"
    }
    .to_string()
}

fn position(headers: &[String], wanted: &str) -> Option<usize> {
    if let Some(number) = wanted.strip_prefix('#').and_then(|n| n.parse::<usize>().ok()) {
        return number.checked_sub(1).filter(|&i| i < headers.len());
    }
    let exact = headers.iter().position(|h| h.trim() == wanted.trim());
    let spelled = units::spelled(wanted);
    exact
        .or_else(|| headers.iter().position(|h| units::spelled(h) == spelled))
        .or_else(|| headers.iter().position(|h| Name::new(h).text == spelled))
}

fn scaled(
    file: &str,
    index: usize,
    name: &Name,
    quantity: Quantity,
    role: &str,
    by_hand: &ByHand,
) -> Result<Column, Refusal> {
    let given = by_hand.units.iter().find(|(r, _)| r == role);
    let unit = given.map(|(_, unit)| unit.clone()).or_else(|| name.unit.clone());
    let scale = match (&unit, quantity) {
        (_, Quantity::Throttle) if by_hand.full_rpm.is_some() => {
            by_hand.full_rpm.map(|full| Scale::Factor(1.0 / full))
        }
        (Some(unit), _) => units::scale(quantity, unit),
        (None, Quantity::Throttle) if name.words().any(|w| w == "pwm" || w == "esc") => {
            Some(Scale::Pulse(1.0))
        }
        (None, Quantity::Throttle | Quantity::Time) => Some(Scale::Factor(1.0)),
        (None, _) => None,
    };
    let scale = scale.ok_or_else(|| {
        let (raw, known) = (&name.raw, units::known(quantity));
        let reason = match &unit {
            Some(unit) => format!("the unit {unit:?} of the column {raw:?} is unknown for the {role}"),
            None => format!("the column {raw:?} has no unit"),
        };
        let needed = format!("a unit in the header, or --unit {role}=UNIT with one of: {known}");
        Refusal::of(format!("{file}:1"), reason, needed)
    })?;
    Ok(Column {
        index,
        name: name.raw.clone(),
        scale,
    })
}

#[cfg(test)]
mod tests;
