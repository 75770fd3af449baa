//! The checked airframe: a model of which every value is known to make sense.

mod allocation;
mod basis;
mod correction;
mod inverse;
mod layout;
mod limits;
mod name;
mod pair;
mod power;
mod rotor_alone;
mod throttle;
mod uncertainty;
mod unit;
mod vehicle;

use std::ops::Range;

use toml::de::DeTable;

pub use self::allocation::{Airmode, Allocation, Axis};
pub use self::basis::Basis;
pub(crate) use self::basis::{POWERS, value_of_terms};
pub use self::correction::{Correction, Law, TYPICAL_EXPONENT};
pub use self::inverse::{Inverse, Method};
pub use self::name::of_file as name_of_file;
pub use self::pair::{Pair, Spin};
pub use self::power::Power;
pub use self::rotor_alone::RotorAlone;
pub use self::throttle::Throttle;
pub use self::uncertainty::Uncertainty;
pub use self::unit::Unit;
pub use self::vehicle::{GRAVITY, Vehicle};
use crate::diagnostic::source::Source;
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::spec::keys::{Kind, Shape, keys};
use crate::spec::{self, Fields, Places, Spanned};

keys! { FILE = "":
    NAME "name" = "\"my-x8\"", Kind::Name,
        "Name of the airframe; becomes the Rust module and type.".required();
    DESCRIPTION "description" = "\"X8 with 15 inch propellers\"", Kind::Text,
        "Free text.";
    THROTTLE "throttle" = "", Kind::Table(&throttle::TABLE),
        "The range of every rotor's throttle.".required();
    PAIR "pair" = "", Kind::Table(&pair::TABLE),
        "Total thrust and torque of one unit at the reference voltage, from the bench.".required();
    VOLTAGE "voltage" = "", Kind::Table(&correction::VOLTAGE_TABLE),
        "How thrust and torque follow the battery's voltage; without it they do not.";
    AIR "air" = "", Kind::Table(&correction::AIR_TABLE),
        "How thrust and torque follow the air's density; without it they do not.";
    LAYOUT "layout" = "", Kind::Table(&layout::TABLE),
        "A regular frame, instead of [[unit]].";
    UNIT "unit" = "", Kind::Tables(&unit::TABLE),
        "One for each pair of rotors.";
    INVERSE "inverse" = "", Kind::Table(&inverse::TABLE),
        "How truly, and how, the pair's map is inverted.";
    ALLOCATION "allocation" = "", Kind::Table(&allocation::TABLE),
        "Which axes are served, and what gives way when not all can be had.";
    VEHICLE "vehicle" = "", Kind::Table(&vehicle::TABLE),
        "The vehicle, for what `check` and the report say of hover.";
}

/// The keys of the airframe file, version 1.
pub const KEYS: &Shape = &FILE;

/// An airframe whose values are checked, in SI units. Made by [`Airframe::read`] alone, so that the
/// ranges stated on the fields hold.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Airframe {
    /// Lower-case letters and digits in parts joined by `-` or `_`, from a letter on; at most 64.
    pub name: String,
    /// Free text; empty where the file has none.
    pub description: String,
    /// Range of every throttle.
    pub throttle: Throttle,
    /// Model of one pair at the reference voltage.
    pub pair: Pair,
    /// Correction for the battery's voltage, V; `None` where thrust and torque do not depend on it.
    pub voltage: Option<Correction>,
    /// Correction for the air's density, kg/m3; `None` where they do not depend on it.
    pub air: Option<Correction>,
    /// The units in the order of the file: 1 to 32, no two in one place, their channels 0 to 2n - 1
    /// each once.
    pub units: Vec<Unit>,
    /// How to invert the pair's map.
    pub inverse: Inverse,
    /// Controlled axes and priorities.
    pub allocation: Allocation,
    /// The vehicle; `None` where the file does not have it.
    pub vehicle: Option<Vehicle>,
    /// `layout.first_angle_deg` as written, which the units no longer tell.
    pub(crate) first_angle_deg: Option<f64>,
    places: Places,
}

impl Airframe {
    /// Reads and checks an airframe file, version 1.
    ///
    /// # Errors
    ///
    /// All faults of the file at once: of its shape and of its values. Only text that is not TOML is
    /// refused for that alone.
    pub fn read(source: &Source) -> Result<Airframe, Diagnostics> {
        let mut faults = Vec::new();
        let table = spec::parse(source, &mut faults);
        let airframe = table.and_then(|table| read(&table, &mut faults));
        match airframe {
            Some(airframe) if faults.is_empty() => Ok(airframe),
            _ => Err(Diagnostics::new(source.clone(), faults)),
        }
    }

    /// The name as a Rust module: `isae_x8`.
    pub fn module_name(&self) -> String {
        name::module(&self.name)
    }

    /// The name as a Rust type: `IsaeX8`.
    pub fn type_name(&self) -> String {
        name::type_(&self.name)
    }

    /// The module and the type by which code refers to the airframe of a file that is refused:
    /// after the file's `name` where that can be read and used, else after the file itself.
    pub fn names_if_refused(source: &Source) -> [String; 2] {
        name::if_refused(source)
    }

    /// Number of rotors, twice that of the units.
    pub fn rotors(&self) -> usize {
        2 * self.units.len()
    }

    /// The reference voltage, V; 0 without `[voltage]`, as mixers then ignore it.
    pub fn reference_v(&self) -> f64 {
        self.voltage.as_ref().map_or(0.0, |voltage| voltage.reference)
    }

    /// `[k_f, k_Q]` at a voltage, V, and the bench's density; 1 at any without `[voltage]`.
    pub fn voltage_factors(&self, volts: f64) -> [f64; 2] {
        self.voltage
            .as_ref()
            .map_or([1.0; 2], |voltage| voltage.factors(volts))
    }

    /// `[k_f, k_Q]` at a voltage, V, and a density, kg/m3; 1 of either without its table.
    pub fn factors(&self, volts: f64, density: f64) -> [f64; 2] {
        let air = self.air.as_ref().map_or([1.0; 2], |air| air.factors(density));
        let voltage = self.voltage_factors(volts);
        [0, 1].map(|k| voltage[k] * air[k])
    }

    /// The bench's density, kg/m3; 0 without `[air]`, as mixers then ignore it.
    pub fn reference_density(&self) -> f64 {
        self.air.as_ref().map_or(0.0, |air| air.reference)
    }

    /// Voltages (V) and densities (kg/m3), `[volts, density]`: the ends of both ranges and the references, each
    /// with each; 0 for what the file has no table of.
    pub(crate) fn conditions(&self) -> Vec<[f64; 2]> {
        let values = |correction: &Option<Correction>| match correction {
            Some(Correction {
                reference,
                range: [low, high],
                ..
            }) => vec![*low, *reference, *high],
            None => vec![0.0],
        };
        let densities = values(&self.air);
        let with = |volts: f64| densities.iter().map(move |density| [volts, *density]);
        values(&self.voltage).into_iter().flat_map(with).collect()
    }

    /// The vehicle's weight, N; `None` without `[vehicle]`.
    pub fn weight_n(&self) -> Option<f64> {
        self.vehicle.as_ref().map(|vehicle| GRAVITY * vehicle.mass_kg)
    }

    /// Electrical power of all rotors at the reference voltage, W, with a throttle per channel;
    /// `None` where the file has no `[pair.power]`, or a channel has no throttle.
    pub fn power_w(&self, throttle: &[f64]) -> Option<f64> {
        let map = self.pair.power.as_ref()?;
        let of_unit = |unit: &Unit| {
            let [u, l] =
                [unit.upper_channel, unit.lower_channel].map(|channel| throttle.get(channel).copied());
            Some(map.at([u?, l?]))
        };
        self.units.iter().map(of_unit).sum()
    }

    /// The share of a pair's saving by `power_bias_nm_per_n` that is left in hover, as torques must
    /// cancel: 1 - (sum s / n)^2 with the spins s of n units.
    pub fn power_bias_share(&self) -> f64 {
        let spins = self.units.iter().map(|unit| unit.spin_sign(self.pair.upper_spin));
        let mean = spins.sum::<f64>() / self.units.len() as f64;
        1.0 - mean * mean
    }

    /// Whether the file itself has a key like `unit[3].channels`.
    pub fn states(&self, key: &str) -> bool {
        self.places.contains_key(key)
    }

    /// Place of a key like `unit[3].channels` in the file, or of the nearest table or array around
    /// it that the file has; else of the name.
    pub fn place(&self, key: &str) -> Option<Range<usize>> {
        spec::place_in(&self.places, key)
    }

    /// A fault that a later stage found in `key`, at its place.
    pub fn diagnostic(
        &self,
        code: Code,
        key: &str,
        message: impl Into<String>,
        label: impl Into<String>,
        help: impl Into<String>,
    ) -> Diagnostic {
        Diagnostic::new(code, key, self.place(key), message)
            .label(label)
            .help(help)
    }
}

fn read(table: &DeTable<'_>, faults: &mut Vec<Diagnostic>) -> Option<Airframe> {
    let mut places = spec::places(table);
    let top = places.get("name").cloned().unwrap_or(0..0);
    if table.is_empty() {
        faults.push(
            Diagnostic::new(Code::MissingKey, "name", top, "the file is empty")
                .label("expected an airframe")
                .help("an airframe has a `name`, `[throttle]`, `[pair]`, and a `[[unit]]` for each pair of rotors"),
        );
        return None;
    }
    let mut file = Fields::of_file(table, &FILE, top, faults);
    let name = file
        .read(&NAME)
        .and_then(|field| name::check(&field, file.faults));
    let description = file.read::<String>(&DESCRIPTION);
    let throttle = file.table(&THROTTLE, throttle::read).flatten();
    let (pair, bench_spin) = file
        .table(&PAIR, |table| pair::read(table, throttle.as_ref()))
        .unwrap_or_default();
    let voltage = file.table(&VOLTAGE, correction::read_voltage);
    let of_voltage = voltage.as_ref().map(Option::as_ref);
    let air = file.table(&AIR, |table| correction::read_air(table, of_voltage));
    let layout = file.table(&LAYOUT, |table| layout::read(table, bench_spin));
    let units = file.tables(&UNIT, unit::read);
    let inverse = file.table(&INVERSE, inverse::read);
    let allocation = file.table(&ALLOCATION, allocation::read);
    let vehicle = file.table(&VEHICLE, vehicle::read);

    let written = file.key_place(&UNIT);
    let is_told = || file.faults.iter().any(|fault| fault.key.starts_with("unit"));
    if written.is_some()
        && let Some(layout) = &layout
    {
        let message = format!("the file has `[layout]` and {} `[[unit]]`", units.len());
        let fault = Diagnostic::new(Code::Conflict, "layout", layout.place.clone(), message);
        let help = "keep one: `[layout]` for a regular frame, else `[[unit]]`";
        file.faults
            .push(fault.label("second description of the units").help(help));
        return None;
    }
    if file.key_place(&LAYOUT).is_none() && units.is_empty() && !is_told() {
        let code = if written.is_some() {
            Code::WrongLength
        } else {
            Code::MissingKey
        };
        let place = written.unwrap_or(file.place());
        let help = "add a `[[unit]]` for each pair of rotors, or a `[layout]` for a regular frame";
        let fault = Diagnostic::new(code, "unit", place, "the airframe has 0 units");
        file.faults.push(fault.label("no `[[unit]]`").help(help));
        return None;
    }
    let first_angle_deg = layout.as_ref().and_then(|layout| layout.first_angle_deg);
    let units = match layout {
        None => units,
        Some(layout) => {
            let units = layout.units?;
            // Later stages know units alone; what they find in one is to be pointed at in the
            // layout.
            places.insert("unit".to_owned(), layout.place.clone());
            for k in 0..units.len() {
                places.insert(format!("unit[{k}]"), layout.place.clone());
                for index in 0..2 {
                    let written = places.get(&format!("layout.channels[{k}][{index}]")).cloned();
                    places.extend(written.map(|place| (format!("unit[{k}].channels[{index}]"), place)));
                }
            }
            units
        }
    };
    // A table that was refused left its faults, so that no default takes its place.
    Some(Airframe {
        units: unit::check(&units, &places, file.faults)?,
        name: name?,
        description: description.map(Spanned::into_inner).unwrap_or_default(),
        throttle: throttle?,
        pair: pair?,
        voltage: voltage.flatten(),
        air: air.flatten(),
        inverse: inverse.flatten().unwrap_or_default(),
        allocation: allocation.flatten().unwrap_or_default(),
        vehicle: vehicle.flatten(),
        first_angle_deg,
        places,
    })
}
