//! Which column holds what: from the header line, or by hand.
//!
//! A name is normalised first ([`units::normalised`]); its unit is the last group in brackets, or a
//! suffix of the plain format (`thrust_n`). Then a column is known by a word of its name (`ESC` or
//! `PWM`, `thrust`, `torque`, `voltage`) and its rotor by another (`Left`, `A`, `upper`, or a
//! prefix such as `Powertrain 1 - `, which users edit, so that the first prefix to appear is the
//! first rotor). The first rotor is taken as the upper one unless names say otherwise.

use std::ops::{Index, IndexMut};

use self::name::{Name, distinct_prefixes};
use crate::bench::sheet::Heading;
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
    /// What it measures, as its unit has it: a throttle may be a speed.
    pub quantity: Quantity,
    /// How to reach SI.
    pub scale: Scale,
    /// The unit, where there is one.
    pub unit: Option<String>,
    /// Whether nothing but the cells tells the unit.
    pub in_cells: bool,
}

impl Column {
    /// Whether a number with this text behind it can stand in the column.
    pub fn holds(&self, unit: &str) -> bool {
        let scale = |unit: &str| units::scale(self.quantity, unit);
        match unit {
            "" => !self.in_cells,
            unit => scale(unit).is_some() && self.unit.as_deref().and_then(scale) == scale(unit),
        }
    }
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

/// The columns that are read, by what they measure; `--column ROLE=HEADER` names them by [`ROLES`].
///
/// A voltage of the whole is the upper rotor's, the lower one has one where it has a supply of its own;
/// the command of the only rotor is the upper one's.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Columns {
    by_quantity: [Split<Option<Column>>; Quantity::Density as usize + 1],
    /// The format that the header was recognised as, for the report.
    pub format: String,
    /// Whether names, rather than an assumption, say which rotor is the upper one.
    pub sides_named: bool,
    /// Whether the user says it, of both rotors.
    pub sides_by_hand: bool,
    /// Columns in two units that are one if they agree in every row, and what is said where they do not.
    pub(crate) twins: Vec<([Column; 2], Lack)>,
}

impl Index<Quantity> for Columns {
    type Output = Split<Option<Column>>;

    fn index(&self, quantity: Quantity) -> &Self::Output {
        &self.by_quantity[quantity as usize]
    }
}

impl IndexMut<Quantity> for Columns {
    fn index_mut(&mut self, quantity: Quantity) -> &mut Self::Output {
        &mut self.by_quantity[quantity as usize]
    }
}

/// Columns and units given by hand, and what else is known of them.
#[derive(Debug, Clone, Default)]
pub struct ByHand {
    /// (role, header name or `#` and the column's number from 1).
    pub columns: Vec<(String, String)>,
    /// (role, unit), for headers without one.
    pub units: Vec<(String, String)>,
    /// Speed at full throttle, revolutions per minute, of controllers that hold a speed: columns of
    /// speeds stand for throttles.
    pub full_rpm: Option<f64>,
    /// Exchange the two rotors that the header suggests.
    pub swap: bool,
    /// Whether speeds serve without thrust.
    pub speed_serves: bool,
}

/// How a column is named.
fn named(role: &str, header: &str) -> String {
    format!("--column {role}={header}")
}

/// What a value above 1 in a throttle column without a unit needs.
pub const ABOVE_ONE: &str = "is above 1: give --pwm-range 1000,2000 if it is a pulse width, --unit upper=% --unit lower=% if it is in per cent";

/// What a header lacks, and what would mend it.
type Lack = (String, String);

/// Roles for `--column`, with what they measure and of which rotor.
pub const ROLES: [(&str, Quantity, Option<usize>); 22] = [
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
    ("power", Quantity::Power, None),
    ("upper_power", Quantity::Power, Some(0)),
    ("lower_power", Quantity::Power, Some(1)),
    ("upper_speed", Quantity::Speed, Some(0)),
    ("lower_speed", Quantity::Speed, Some(1)),
    ("time", Quantity::Time, None),
    ("temperature", Quantity::Temperature, None),
    ("pressure", Quantity::Pressure, None),
    ("density", Quantity::Density, None),
];

impl Columns {
    /// All of them.
    pub fn all(&self) -> impl Iterator<Item = &Column> {
        let splits = self.by_quantity.iter();
        splits
            .flat_map(|split| split.rotors.iter().chain([&split.whole]))
            .flatten()
    }

    /// The column of a role.
    pub(crate) fn of_role(&self, role: &str) -> Option<&Column> {
        let (_, quantity, side) = ROLES.iter().find(|(known, ..)| *known == role)?;
        let Split { whole, rotors } = &self[*quantity];
        side.map_or(whole, |side| &rotors[side]).as_ref()
    }

    /// The place of a quantity's column.
    fn slot(&mut self, quantity: Quantity, side: Option<usize>) -> &mut Option<Column> {
        let Split { whole, rotors } = &mut self[quantity];
        side.map_or(whole, |side| &mut rotors[side])
    }

    /// Reads the header at `place`, the file with its line.
    ///
    /// # Errors
    /// All that is missing of the columns that every use needs, and of their units.
    pub fn find(place: &str, headings: &[Heading], by_hand: &ByHand) -> Result<Self, Refusal> {
        let headers: Vec<String> = headings.iter().map(|heading| heading.name.clone()).collect();
        let names: Vec<Name> = headers.iter().map(|h| Name::new(h)).collect();
        let mut columns = Columns {
            format: format_name(&headers, &names),
            ..Columns::default()
        };
        let mut lacks = Vec::new();
        columns.by_name(headings, &names, by_hand, &mut lacks);
        if by_hand.swap {
            let one_supply = !columns[Quantity::Voltage].complete();
            for (quantity, split) in columns.by_quantity.iter_mut().enumerate() {
                if quantity != Quantity::Voltage as usize || !one_supply {
                    split.rotors.swap(0, 1);
                }
            }
        }
        for (role, wanted) in &by_hand.columns {
            let Some(&(_, quantity, side)) = ROLES.iter().find(|(r, ..)| r == role) else {
                return Err(unknown_role(role));
            };
            let index = match positions(&headers, wanted)[..] {
                [index] => index,
                [] => {
                    return Err(Refusal::of(
                        place,
                        format!("no column {wanted:?} for the role {role}"),
                        format!("one of: {}", headers.join(", ")),
                    ));
                }
                ref several => {
                    return Err(Refusal::of(
                        place,
                        format!("{} columns are named {wanted:?}", several.len()),
                        by_number(role, several),
                    ));
                }
            };
            // A column of one rotor given by hand stands above the whole's.
            if side.is_some() {
                columns[quantity].whole = None;
            }
            let (column, lack) = scaled(index, &headings[index], &names[index], quantity, role, by_hand);
            *columns.slot(quantity, side) = Some(column);
            lacks.extend(lack);
        }
        let is_given = |wanted: &str| by_hand.columns.iter().any(|(role, _)| role == wanted);
        columns.sides_by_hand = is_given("upper") && is_given("lower")
            || by_hand.full_rpm.is_some() && is_given("upper_speed") && is_given("lower_speed");
        let says_side = |(role, _): &(String, String)| role.starts_with("upper") || role.starts_with("lower");
        columns.sides_named |= by_hand.columns.iter().any(says_side) || by_hand.swap;
        columns.by_speed(&names, by_hand);
        columns.require(by_hand, &mut lacks);
        match lacks.is_empty() {
            true => Ok(columns),
            false => Err(Columns::refusal(place, &headers, lacks)),
        }
    }

    /// The refusal of a header at `place` that lacks this.
    pub(crate) fn refusal(place: &str, headers: &[impl AsRef<str>], lacks: Vec<Lack>) -> Refusal {
        let (what, mut mends): (Vec<String>, Vec<String>) = lacks.into_iter().unzip();
        mends.dedup();
        let headers = headers.iter().map(AsRef::as_ref);
        let reason = format!(
            "{}; the columns are {}",
            what.join("; "),
            itertools::join(headers, ", ")
        );
        Refusal::of(place, reason, mends.join("; "))
    }

    /// Speeds that stand for throttles.
    fn by_speed(&mut self, names: &[Name], by_hand: &ByHand) {
        use Quantity::{Speed, Throttle};
        let speeds = &self[Speed].rotors;
        let commanded = |rotor: usize| self[Throttle].rotors[rotor].is_some();
        let all = speeds.iter().any(Option::is_some)
            && (0..2).all(|rotor| speeds[rotor].is_some() || !commanded(rotor))
            && !by_hand.columns.iter().any(|(role, _)| role == "upper");
        if let Some(full) = by_hand.full_rpm.filter(|_| all) {
            let throttles = speeds
                .clone()
                .map(|column| column.map(|column| of_full(column, full)));
            self[Throttle].rotors = throttles;
            self.sides_named |= names.iter().any(Name::says_upper_or_lower);
        }
    }

    /// What every use needs.
    fn require(&self, by_hand: &ByHand, lacks: &mut Vec<Lack>) {
        if let [None, lower] = &self[Quantity::Throttle].rotors {
            let mut mend = match lower {
                None => "--column upper=HEADER and --column lower=HEADER, or --column throttle=HEADER of one rotor".to_owned(),
                Some(_) => named("upper", "HEADER"),
            };
            let speed = self[Quantity::Speed].rotors.iter().flatten().next();
            if let Some(speed) = speed.filter(|_| by_hand.full_rpm.is_none()) {
                let held = format!("where the speed controllers hold the speeds {:?}", speed.name);
                mend += &format!("; or --rpm-at-full RPM, the speed at full throttle, {held}");
            }
            let of_upper = lower.as_ref().map_or("", |_| " of the upper rotor");
            lacks.push((format!("no throttle column{of_upper}"), mend));
        }
        let serves = self[Quantity::Thrust].any() || by_hand.speed_serves && self[Quantity::Speed].any();
        if !serves {
            lacks.push(("no thrust column".to_owned(), named("thrust", "HEADER")));
        }
    }

    /// Why there is no electrical power, where columns are missing for it.
    pub fn no_power(&self) -> Option<String> {
        let current = &self[Quantity::Current];
        let known = self[Quantity::Voltage].rotors[0].is_some() && current.complete();
        let one = current.rotors.iter().position(Option::is_some);
        match one.filter(|_| !current.complete()) {
            _ if known || self[Quantity::Power].complete() => None,
            Some(one) => Some(format!(
                "the current of one rotor only: --column {}_current=HEADER names the other's",
                ["lower", "upper"][one]
            )),
            None => Some("no file has the supply voltage and the current of both rotors".into()),
        }
    }

    /// Takes the columns whose names say what they measure, but for roles that are given by hand.
    fn by_name(&mut self, headings: &[Heading], names: &[Name], by_hand: &ByHand, lacks: &mut Vec<Lack>) {
        use Quantity::{Throttle, Thrust, Torque, Voltage};
        let prefixes = distinct_prefixes(names);
        for (index, quantity, side) in places(headings, names, &prefixes) {
            let name = &names[index];
            let role = ROLES.iter().find(|(_, of, at)| (*of, *at) == (quantity, side));
            let Some(&(role, ..)) = role else { continue };
            if by_hand.columns.iter().any(|(r, _)| r == role) {
                continue;
            }
            // Power and air are by-products: what is doubtful there refuses no map.
            let aside = !matches!(quantity, Throttle | Thrust | Torque | Voltage) || role == "lower_voltage";
            let (column, lack) = scaled(index, &headings[index], name, quantity, role, by_hand);
            let slot = self.slot(quantity, side);
            match slot {
                None if aside && lack.is_some() => (),
                None => {
                    *slot = Some(column);
                    lacks.extend(lack);
                    self.sides_named |= quantity == Throttle && name.says_upper_or_lower();
                }
                Some(_) if aside => (),
                Some(first) => {
                    let both = [first.clone(), column];
                    let is_known = lack.is_none();
                    self.twice(
                        role,
                        both,
                        is_known,
                        name.side(&prefixes).is_some(),
                        headings,
                        lacks,
                    );
                }
            }
        }
        if self.format == NEWDEXTERITY {
            self.sides_named = true; // on this platform the left rotor is the upper one
        }
    }

    /// Two columns for one role: guessing would be silent. In two units they may be one, which the rows tell.
    fn twice(
        &mut self,
        role: &str,
        columns: [Column; 2],
        is_known: bool,
        says_side: bool,
        headings: &[Heading],
        lacks: &mut Vec<Lack>,
    ) {
        let [first, second] = columns.each_ref().map(|column| &column.name);
        let both = format!("both look like the {role}");
        // Of several the first two are told.
        if lacks.iter().any(|(what, _)| what.ends_with(&both)) {
            return;
        }
        let mend = match columns[1].quantity {
            // Of names that say no side the one that is told of may be either rotor's.
            Quantity::Throttle if !says_side => format!(
                "{} of one rotor; of two --column upper=HEADER and --column lower=HEADER",
                named("throttle", &format!("{second:?}"))
            ),
            _ if first == second => {
                let same = (0..headings.len()).filter(|&k| headings[k].name == *second);
                by_number(role, &same.collect::<Vec<_>>())
            }
            _ => named(role, &format!("{second:?}")),
        };
        let lack = (format!("the columns {first:?} and {second:?} {both}"), mend);
        let scales = columns
            .each_ref()
            .map(|column| column.unit.is_some().then_some(column.scale));
        match is_known && scales[0] != scales[1] && !scales.contains(&None) {
            true => self.twins.push((columns, lack)),
            false => lacks.push(lack),
        }
    }
}

/// Index, quantity and rotor of the columns whose names say them.
fn places(headings: &[Heading], names: &[Name], prefixes: &[&str]) -> Vec<(usize, Quantity, Option<usize>)> {
    use Quantity::{Current, Power, Speed, Throttle, Thrust, Torque, Voltage};
    let place = |(index, name): (usize, &Name)| {
        let quantity = name.quantity()?;
        let side = match (quantity, name.side(prefixes)) {
            (Throttle | Voltage | Speed, None) => Some(0),
            (Throttle | Thrust | Torque | Voltage | Current | Power | Speed, side) => side,
            _ => None,
        };
        Some((index, quantity, side))
    };
    let mut places: Vec<_> = names.iter().enumerate().filter_map(place).collect();
    let is_thrust = |at: &(usize, Quantity, _)| at.1 == Thrust && !names[at.0].is_force();
    if places.iter().any(is_thrust) {
        places.retain(|at| at.1 != Thrust || is_thrust(at));
    }
    // Beside a column of the quantity one in a unit of something else, as the load cell's millivolts, is another's.
    let is_other = |&(index, quantity, _): &(usize, Quantity, Option<usize>)| {
        let unit = names[index].unit.as_ref().or(headings[index].below.as_ref());
        unit.is_some_and(|unit| units::scale(quantity, unit).is_none())
    };
    let is_rival = |one: &(usize, Quantity, Option<usize>)| {
        let mut same = places.iter().filter(|two| (two.1, two.2) == (one.1, one.2));
        !is_other(one) || same.all(is_other)
    };
    places.iter().copied().filter(is_rival).collect()
}

/// A speed as a throttle: its share of the speed at full throttle.
fn of_full(column: Column, full_rpm: f64) -> Column {
    let Scale::Factor(to_rpm) = column.scale else {
        return column;
    };
    Column {
        scale: Scale::Speed(to_rpm / full_rpm),
        ..column
    }
}

/// The number of cells of a line that name what is measured, by name or by hand.
pub fn known(cells: &[String], by_hand: &ByHand) -> usize {
    let by_name = cells.iter().filter(|cell| Name::new(cell).quantity().is_some());
    let wanted = by_hand.columns.iter().map(|(_, wanted)| wanted);
    let found = wanted.filter(|wanted| !wanted.starts_with('#') && !positions(cells, wanted).is_empty());
    by_name.count() + found.count()
}

/// Whether a text is a unit of what a column with this name measures.
pub fn is_unit(name: &str, unit: &str) -> bool {
    let quantity = Name::new(name).quantity();
    quantity.is_some_and(|quantity| units::scale(quantity, unit).is_some())
}

/// The refusal of a role that does not exist.
pub fn unknown_role(role: &str) -> Refusal {
    let roles = ROLES.iter().map(|(r, ..)| *r);
    Refusal::general(
        format!("unknown role {role:?}"),
        format!("one of: {}", itertools::join(roles, ", ")),
    )
}

const NEWDEXTERITY: &str = "coaxial map (newdexterity)";

fn format_name(headers: &[String], names: &[Name]) -> String {
    let has = |text: &&str| names.iter().any(|n| n.text == *text);
    let any = |text: &&str| headers.iter().any(|h| units::normalised(h).contains(*text));
    let is = |of: &[&str]| of.iter().all(has);
    match () {
        () if is(&["pwm left", "pwm right"]) => NEWDEXTERITY,
        () if ["torque mz", "force fz"].iter().any(any) => "Tyto Flight Stand",
        () if is(&["esc a", "esc b"]) => "RCbenchmark 1780",
        () if any(&"esc signal") => "RCbenchmark 1520/1580",
        () if is(&["upper", "lower"]) => "plain",
        () => "columns by name",
    }
    .to_owned()
}

/// Columns of one name by their numbers.
fn by_number(role: &str, columns: &[usize]) -> String {
    let numbers = columns
        .iter()
        .map(|column| named(role, &format!("#{}", column + 1)));
    itertools::join(numbers, " or ")
}

/// The columns that a text names: by its number, its name, its name spelled otherwise, or its name without unit.
fn positions(headers: &[String], wanted: &str) -> Vec<usize> {
    if let Some(number) = wanted.strip_prefix('#').and_then(|n| n.parse::<usize>().ok()) {
        let index = number.checked_sub(1).filter(|&i| i < headers.len());
        return index.into_iter().collect();
    }
    let spelled = units::normalised(wanted);
    let ways: [&dyn Fn(&str) -> bool; 3] = [
        &|header| header.trim() == wanted.trim(),
        &|header| units::normalised(header) == spelled,
        &|header| Name::new(header).text == spelled,
    ];
    let found = ways.into_iter().map(|is_it| {
        let all = headers.iter().enumerate();
        all.filter(|(_, header)| is_it(header))
            .map(|(k, _)| k)
            .collect::<Vec<usize>>()
    });
    found
        .into_iter()
        .find(|found| !found.is_empty())
        .unwrap_or_default()
}

/// The column of a role, and what its unit lacks.
fn scaled(
    index: usize,
    heading: &Heading,
    name: &Name,
    quantity: Quantity,
    role: &str,
    by_hand: &ByHand,
) -> (Column, Option<Lack>) {
    let held = quantity == Quantity::Throttle && !name.is_throttle();
    let full_rpm = by_hand.full_rpm.filter(|_| held);
    let quantity = full_rpm.map_or(quantity, |_| Quantity::Speed);
    let scale = |unit: &String| units::scale(quantity, unit);
    let given = by_hand
        .units
        .iter()
        .find(|(r, _)| r == role)
        .map(|(_, unit)| unit);
    let in_header = given.or(name.unit.as_ref()).or(heading.below.as_ref());
    let in_cells = heading.in_cells.as_ref().filter(|unit| scale(unit).is_some());
    let told = [in_header, heading.below.as_ref(), in_cells];
    let unit = told.into_iter().flatten().next();
    let other = told
        .into_iter()
        .flatten()
        .find(|other| scale(other) != unit.and_then(scale));
    let of_pulses = || name.words().any(|word| word == "pwm" || word == "esc");
    let without = match quantity {
        Quantity::Throttle if of_pulses() => Some(Scale::Pulse(1.0)),
        Quantity::Throttle | Quantity::Time | Quantity::Speed => Some(Scale::Factor(1.0)),
        _ => None,
    };
    let found = unit.map_or(without, scale);
    let raw = &name.raw;
    let lack = match (found, unit, other) {
        (None, Some(unit), _) => Some(format!(
            "the unit {unit:?} of the column {raw:?} is unknown for the {role}"
        )),
        (None, None, _) => Some(format!("the column {raw:?} has no unit")),
        (_, Some(unit), Some(other)) if given.is_none() => Some(format!(
            "the column {raw:?} is in {unit:?} by its name and in {other:?} below it"
        )),
        _ => None,
    };
    let mend = || {
        format!(
            "a unit in the header, or --unit {role}=UNIT, with one of: {}",
            units::known(quantity)
        )
    };
    let column = Column {
        index,
        name: raw.clone(),
        quantity,
        scale: found.unwrap_or(Scale::Factor(1.0)),
        unit: unit.cloned(),
        in_cells: in_header.is_none() && in_cells.is_some(),
    };
    let column = full_rpm.map_or_else(|| column.clone(), |full| of_full(column.clone(), full));
    (column, lack.map(|what| (what, mend())))
}

#[cfg(test)]
mod tests;
