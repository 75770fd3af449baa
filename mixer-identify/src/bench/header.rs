//! Which column holds what: from the header line, or by hand.
//!
//! A name is normalised first ([`units::spelled`]); its unit is the last group in brackets, or a
//! suffix of the plain format (`thrust_n`). Then a column is known by a word of its name (`ESC` or
//! `PWM`, `thrust`, `torque`, `voltage`) and its rotor by another (`Left`, `A`, `upper`, or a
//! prefix such as `Powertrain 1 - `, which users edit, so that the first prefix to appear is the
//! first rotor). The first rotor is taken as the upper one unless names say otherwise.

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
    /// The unit, where nothing but the cells tells it.
    pub in_cells: Option<String>,
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
    /// Electrical power.
    pub power: Split<Option<Column>>,
    /// Speed.
    pub speed: Split<Option<Column>>,
    /// Coefficients of thrust and of power, C_T and C_P.
    pub coefficients: [Split<Option<Column>>; 2],
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
    /// Diameter, m, of the propeller of columns C_T and C_P.
    pub diameter_m: Option<f64>,
    /// Density, kg/m3, of the air in which they are to hold.
    pub density_kg_m3: Option<f64>,
    /// Exchange the two rotors that the header suggests.
    pub swap: bool,
    /// The options that a message offers.
    pub offers: Offers,
}

/// The options by which the user of a command can name columns and units of a file.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Offers {
    /// `--column upper=`, `lower=` and so on.
    #[default]
    Pair,
    /// `--column throttle=` and so on.
    OneRotor,
    /// None: the header has to say it.
    Header,
}

impl Offers {
    /// The role's name.
    fn role(self, role: &str) -> &str {
        match (self, role) {
            (Offers::OneRotor | Offers::Header, "upper") => "throttle",
            _ => role,
        }
    }

    /// How a column is named.
    fn column(self, role: &str, header: &str) -> String {
        let role = self.role(role);
        match self {
            Offers::Header => format!("a column named {role}"),
            _ => format!("--column {role}={header}"),
        }
    }

    /// How a unit is named.
    fn unit(self, role: &str) -> String {
        match self {
            Offers::Header => "a unit in the header".to_owned(),
            _ => format!("a unit in the header, or --unit {}=UNIT", self.role(role)),
        }
    }
}

/// All that a header lacks: what, and what would mend it.
#[derive(Default)]
struct Lacks {
    all: Vec<(String, String)>,
    /// What columns are of that cannot be read, so that they are not missing.
    doubtful: Vec<Quantity>,
}

impl Lacks {
    fn add(&mut self, what: impl Into<String>, mend: impl Into<String>) {
        self.all.push((what.into(), mend.into()));
    }

    fn doubt(&mut self, quantity: Quantity, (what, mend): (String, String)) {
        self.doubtful.push(quantity);
        self.add(what, mend);
    }

    fn refused(self, place: &str, among: &str) -> Result<(), Refusal> {
        if self.all.is_empty() {
            return Ok(());
        }
        let (what, mut mends): (Vec<String>, Vec<String>) = self.all.into_iter().unzip();
        let is_missing = |what: &&String| what.starts_with("no ");
        let (missing, wrong): (Vec<&String>, Vec<&String>) = what.iter().partition(is_missing);
        let joined = |of: Vec<&String>, between| of.into_iter().cloned().collect::<Vec<_>>().join(between);
        let reason = match (joined(wrong, "; "), joined(missing, ", ")) {
            (wrong, missing) if missing.is_empty() => wrong,
            (wrong, missing) if wrong.is_empty() => format!("{missing} among: {among}"),
            (wrong, missing) => format!("{wrong}; {missing} among: {among}"),
        };
        mends.dedup();
        Err(Refusal::of(place, reason, mends.join("; ")))
    }
}

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
        let [ct, cp] = &self.coefficients;
        let of = [
            &self.throttle,
            &self.thrust,
            &self.torque,
            &self.voltage,
            &self.current,
            &self.power,
            &self.speed,
            ct,
            cp,
        ];
        let of_air = [&self.temperature, &self.pressure, &self.density];
        let columns = of
            .into_iter()
            .chain(of_air)
            .flat_map(|split| split.rotors.iter().chain([&split.whole]));
        columns.flatten()
    }

    fn of(&mut self, quantity: Quantity) -> &mut Split<Option<Column>> {
        match quantity {
            Quantity::Throttle => &mut self.throttle,
            Quantity::Thrust => &mut self.thrust,
            Quantity::Torque => &mut self.torque,
            Quantity::Voltage => &mut self.voltage,
            Quantity::Current => &mut self.current,
            Quantity::Power => &mut self.power,
            Quantity::Speed => &mut self.speed,
            Quantity::ThrustCoefficient => &mut self.coefficients[0],
            Quantity::PowerCoefficient => &mut self.coefficients[1],
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
        let mut lacks = Lacks::default();
        columns.by_name(headings, &names, by_hand, &mut lacks);
        if by_hand.swap {
            use Quantity::{Current, Power, Speed, Throttle, Thrust, Torque};
            for quantity in [Throttle, Thrust, Torque, Current, Power, Speed] {
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
            let index = position(&headers, wanted).ok_or_else(|| {
                let role = by_hand.offers.role(role);
                Refusal::of(
                    place,
                    format!("no column {wanted:?} for the role {role}"),
                    format!("one of: {}", headers.join(", ")),
                )
            })?;
            // A column of one rotor given by hand stands above the whole's.
            if side.is_some() {
                columns.of(quantity).whole = None;
            }
            match scaled(index, &headings[index], &names[index], quantity, role, by_hand) {
                Ok(column) => *columns.slot(quantity, side) = Some(column),
                Err(lack) => lacks.doubt(quantity, lack),
            }
            columns.sides_named |= matches!(role.as_str(), "upper" | "lower");
        }
        columns.sides_named |= by_hand.swap;
        columns.by_speed(place, &names, by_hand, &mut lacks)?;
        columns.require(by_hand, &mut lacks);
        lacks.refused(place, &headers.join(", "))?;
        Ok(columns)
    }

    /// Speeds that stand for throttles, and what coefficients give at them.
    fn by_speed(
        &mut self,
        place: &str,
        names: &[Name],
        by_hand: &ByHand,
        lacks: &mut Lacks,
    ) -> Result<(), Refusal> {
        let given = |rotor: &str| by_hand.columns.iter().any(|(role, _)| role == rotor);
        let sides = [0, 1].map(|side| self.throttle.rotors[side].is_some());
        let speeds = [0, 1].map(|side| self.speed.rotors[side].is_some());
        let all = (0..2).all(|side| speeds[side] || !sides[side]);
        if let Some(full) = by_hand
            .full_rpm
            .filter(|_| speeds != [false; 2] && all && !given("upper"))
        {
            self.throttle.rotors = self
                .speed
                .rotors
                .clone()
                .map(|column| column.map(|column| of_full(column, full)));
            self.sides_named |= names.iter().any(Name::says_upper_or_lower);
        }
        let [Some(thrust), power] = self.coefficients.each_ref().map(|of| of.whole.clone()) else {
            return Ok(());
        };
        if self.thrust.any() {
            return Ok(());
        }
        if names.iter().any(|name| name.text == "j") {
            return Err(Refusal::of(
                place,
                "CT and CP over the advance ratio J: a propeller in forward flight",
                "the static table of the same propeller, RPM CT CP, of a file named .._static_..",
            ));
        }
        let Some(diameter) = by_hand.diameter_m else {
            lacks.add(
                "the diameter is missing, without which CT and CP give no thrust",
                "--diameter METRE",
            );
            return Ok(());
        };
        if speeds[0] {
            // T = C_T rho n^2 D^4, Q = C_P rho n^2 D^5 / (2 pi), n in revolutions per second.
            let density = by_hand.density_kg_m3.unwrap_or(STANDARD_DENSITY);
            let squared = diameter * diameter;
            let force = density * squared * squared / 3600.0;
            let moment = force * diameter / std::f64::consts::TAU;
            let of = |column: Column, factor| Column {
                scale: Scale::OfSpeed(factor),
                ..column
            };
            self.thrust.whole = Some(of(thrust, force));
            self.torque.whole = power.map(|power| of(power, moment));
        }
        Ok(())
    }

    /// What every use needs.
    fn require(&self, by_hand: &ByHand, lacks: &mut Lacks) {
        let offers = by_hand.offers;
        let one_rotor = offers != Offers::Pair;
        let doubtful = |quantity| lacks.doubtful.contains(&quantity);
        let [throttle, thrust, torque] =
            [Quantity::Throttle, Quantity::Thrust, Quantity::Torque].map(doubtful);
        match self.throttle.rotors.each_ref() {
            _ if throttle => {}
            [None, _] if self.speed.any() && by_hand.full_rpm.is_none() => {
                let speed = self.speed.rotors.iter().flatten().next();
                let speed = speed.map_or("", |column| column.name.as_str());
                let column = offers.column("upper", "HEADER");
                let full = "--rpm-at-full RPM, the speed at full throttle";
                lacks.add(
                    "no throttle column",
                    format!("{column}; or {full}, where the speed controllers hold the speeds {speed:?}"),
                );
            }
            [None, None] if one_rotor => lacks.add("no throttle column", offers.column("upper", "HEADER")),
            [None, None] => lacks.add(
                "no throttle column",
                "--column upper=HEADER and --column lower=HEADER",
            ),
            [None, Some(_)] => lacks.add(
                "no throttle column of the upper rotor",
                offers.column("upper", "HEADER"),
            ),
            _ => {}
        }
        if !thrust && !self.thrust.any() && self.coefficients[0].whole.is_none() {
            lacks.add("no thrust column", offers.column("thrust", "HEADER"));
        }
        // Of a pair it is asked for later, where nothing else is missing.
        let torque = torque || self.torque.any() || self.coefficients[1].whole.is_some();
        if !torque && !lacks.all.is_empty() && by_hand.diameter_m.is_none() {
            let otherwise = if one_rotor { " (or --diameter METRE)" } else { "" };
            lacks.add(
                "no torque column",
                format!("{}{otherwise}", offers.column("torque", "HEADER")),
            );
        }
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
            _ if self.power.complete() => None,
            (_, None, [Some(upper), None]) => Some(of_one(upper, "lower")),
            (_, None, [None, Some(lower)]) => Some(of_one(lower, "upper")),
            (_, None, [None, None]) => Some("no file has the current of both rotors".into()),
            (None, _, _) => Some("no file has the supply voltage beside the current".into()),
        }
    }

    fn by_name(&mut self, headings: &[Heading], names: &[Name], by_hand: &ByHand, lacks: &mut Lacks) {
        let prefixes = distinct_prefixes(names);
        for (index, (name, heading)) in names.iter().zip(headings).enumerate() {
            let Some(quantity) = name.quantity() else { continue };
            use Quantity::{
                Density, PowerCoefficient, Pressure, Speed, Temperature, Throttle, ThrustCoefficient, Time,
                Voltage,
            };
            let side = match (quantity, name.side(&prefixes)) {
                (Time | Temperature | Pressure | Density | ThrustCoefficient | PowerCoefficient, _) => None,
                (Throttle | Voltage | Speed, None) => Some(0),
                (_, side) => side,
            };
            let role = ROLES.iter().find(|(_, of, at)| (*of, *at) == (quantity, side));
            let role = role.map_or("coefficient", |(role, ..)| *role);
            if by_hand.columns.iter().any(|(r, _)| r == role) {
                continue;
            }
            // Power and air are by-products: what is doubtful there refuses no map. Time is only used
            // to keep rows in order.
            let aside = !matches!(
                quantity,
                Throttle | Quantity::Thrust | Quantity::Torque | Voltage | Time
            ) || role == "lower_voltage";
            let slot = self.slot(quantity, side);
            if let Some(first) = slot {
                // Two columns for one role: guessing would be silent. Told of the first two.
                if !aside && quantity != Time && !lacks.doubtful.contains(&quantity) {
                    let (first, raw, role) = (&first.name, &name.raw, by_hand.offers.role(role));
                    let mend = match by_hand.offers {
                        Offers::Header => format!("one column of the {role}"),
                        _ => format!("the right one by hand: --column {role}={raw:?}"),
                    };
                    let what = format!("the columns {first:?} and {raw:?} both look like the {role}");
                    lacks.doubt(quantity, (what, mend));
                }
                continue;
            }
            match scaled(index, heading, name, quantity, role, by_hand) {
                Ok(column) => *slot = Some(column),
                Err(lack) if !aside => lacks.doubt(quantity, lack),
                Err(_) => continue,
            }
            self.sides_named |= quantity == Throttle && name.says_upper_or_lower();
        }
        if self.format == NEWDEXTERITY {
            self.sides_named = true; // on this platform the left rotor is the upper one
        }
    }
}

/// Density of the standard atmosphere at sea level, kg/m3, for coefficients without another.
pub const STANDARD_DENSITY: f64 = 1.225;

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
    let wanted = by_hand
        .columns
        .iter()
        .filter(|(_, wanted)| !wanted.starts_with('#'));
    by_name.count()
        + wanted
            .filter(|(_, wanted)| position(cells, wanted).is_some())
            .count()
}

/// Whether a text is a unit of what a column with this name measures.
pub fn is_unit(name: &str, unit: &str) -> bool {
    let quantity = Name::new(name).quantity();
    quantity.is_some_and(|quantity| units::scale(quantity, unit).is_some())
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

/// The column of a role, or what its unit lacks and what mends it.
fn scaled(
    index: usize,
    heading: &Heading,
    name: &Name,
    quantity: Quantity,
    role: &str,
    by_hand: &ByHand,
) -> Result<Column, (String, String)> {
    let raw = &name.raw;
    let full_rpm = by_hand
        .full_rpm
        .filter(|_| quantity == Quantity::Throttle && !name.is_throttle());
    let quantity = if full_rpm.is_some() {
        Quantity::Speed
    } else {
        quantity
    };
    let by_hand_unit = by_hand
        .units
        .iter()
        .find(|(r, _)| r == role)
        .map(|(_, unit)| unit);
    let in_cells = heading
        .in_cells
        .as_ref()
        .filter(|unit| units::scale(quantity, unit).is_some());
    let mut told = [name.unit.as_ref(), heading.below.as_ref(), in_cells]
        .into_iter()
        .flatten();
    let in_header = name.unit.is_some() || heading.below.is_some() || by_hand_unit.is_some();
    let unit = by_hand_unit.or(told.next());
    let scale = match (unit, quantity) {
        (Some(unit), _) => units::scale(quantity, unit),
        (None, Quantity::Throttle) if name.words().any(|w| w == "pwm" || w == "esc") => {
            Some(Scale::Pulse(1.0))
        }
        (None, Quantity::Throttle | Quantity::Time | Quantity::Speed) => Some(Scale::Factor(1.0)),
        (None, Quantity::ThrustCoefficient | Quantity::PowerCoefficient) => Some(Scale::Factor(1.0)),
        (None, _) => None,
    };
    let (shown, known) = (by_hand.offers.role(role), units::known(quantity));
    let needed = || format!("{} with one of: {known}", by_hand.offers.unit(role));
    let Some(scale) = scale else {
        return Err(match unit {
            Some(unit) => (
                format!("the unit {unit:?} of the column {raw:?} is unknown for the {shown}"),
                needed(),
            ),
            None => (format!("the column {raw:?} has no unit"), needed()),
        });
    };
    if let Some(other) =
        told.find(|other| by_hand_unit.is_none() && units::scale(quantity, other) != Some(scale))
    {
        let unit = unit.map_or("", String::as_str);
        return Err((
            format!("the column {raw:?} is in {unit:?} by its name and in {other:?} below it"),
            needed(),
        ));
    }
    Ok(Column {
        index,
        name: raw.clone(),
        quantity,
        scale: match (scale, full_rpm) {
            (Scale::Factor(to_rpm), Some(full)) => Scale::Speed(to_rpm / full),
            (scale, _) => scale,
        },
        in_cells: in_cells.filter(|_| !in_header).cloned(),
    })
}

#[cfg(test)]
mod tests;
