//! The checked airframe: a model of which every value is known to make sense.

mod allocation;
mod basis;
mod correction;
mod inverse;
mod kind;
mod layout;
mod limits;
mod measured;
mod name;
mod pair;
mod power;
mod rotor_alone;
mod single_rotor;
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
pub use self::kind::Kind;
pub use self::measured::Measured;
pub use self::name::of_file as name_of_file;
pub use self::pair::{Pair, Spin};
pub use self::power::Power;
pub use self::rotor_alone::RotorAlone;
pub use self::single_rotor::SingleRotor;
pub use self::throttle::Throttle;
pub use self::uncertainty::{EXPONENT_DEVIATION, Uncertainty, by_voltage};
pub use self::unit::{Rotor, Unit};
pub use self::vehicle::{GRAVITY, Vehicle};
use crate::diagnostic::source::Source;
use crate::diagnostic::{Code, Diagnostic, Diagnostics, number};
use crate::spec::keys::{Shape, ValueKind, keys};
use crate::spec::{self, Fields, Places, Spanned};

keys! { FILE = "":
    NAME "name" = "\"my-x8\"", ValueKind::Name,
        "Name of the airframe; becomes the Rust module and type.".required();
    DESCRIPTION "description" = "\"X8 with 15 inch propellers\"", ValueKind::Text,
        "Free text.";
    THROTTLE "throttle" = "", ValueKind::Table(&throttle::TABLE),
        "The range of every rotor's throttle.".required();
    PAIR "pair" = "", ValueKind::TableOrTables(&pair::TABLE),
        "Total thrust and torque of one unit at the reference voltage, from the bench; `[[pair]]` with a name each where units differ. Left out where all units are single rotors.";
    ROTOR "rotor" = "", ValueKind::Tables(&single_rotor::TABLE),
        "One for each kind of single rotor, where units are not all pairs.";
    VOLTAGE "voltage" = "", ValueKind::Table(&correction::VOLTAGE_TABLE),
        "How thrust and torque follow the battery's voltage; without it they do not.";
    AIR "air" = "", ValueKind::Table(&correction::AIR_TABLE),
        "How thrust and torque follow the air's density; without it they do not.";
    LAYOUT "layout" = "", ValueKind::Table(&layout::TABLE),
        "A regular frame, instead of [[unit]].";
    UNIT "unit" = "", ValueKind::Tables(&unit::TABLE),
        "One for each pair of rotors, and for each single rotor.";
    INVERSE "inverse" = "", ValueKind::Table(&inverse::TABLE),
        "How truly, and how, the pair's map is inverted.";
    ALLOCATION "allocation" = "", ValueKind::Table(&allocation::TABLE),
        "Which axes are served, and what gives way when not all can be had.";
    VEHICLE "vehicle" = "", ValueKind::Table(&vehicle::TABLE),
        "The vehicle, for what `check` and the report say of hover.";
}

/// How far voltages of benches are apart, or a reference from them, as a share, where it matters.
pub(crate) const APART: f64 = 0.01;

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
    /// Models of the pairs at the reference voltage, each that of a unit at least, all in one basis; empty where all units
    /// are single rotors.
    pub pairs: Vec<Pair>,
    /// The kinds of single rotors, each that of a unit at least.
    pub single_rotors: Vec<SingleRotor>,
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
            Some(mut airframe) if faults.is_empty() => match airframe.bring() {
                faults if faults.is_empty() => Ok(airframe),
                faults => Err(Diagnostics::new(source.clone(), faults)),
            },
            _ => Err(Diagnostics::new(source.clone(), faults)),
        }
    }

    /// Brings every kind from its own bench's references to the frame's by its own laws, and widens its uncertainty by what
    /// their exponents may be off: all kinds are taken at one voltage and in one air, or refused.
    fn bring(&mut self) -> Vec<Diagnostic> {
        let (mut faults, mut all) = (Vec::new(), Vec::new());
        for view in self.views() {
            let (mut by, mut variance) = ([1.0; 3], 0.0);
            let frame = [("voltage", "V", &self.voltage), ("air", "kg/m3", &self.air)];
            for (own, (table, unit, frame)) in view.of.measured().own_laws.iter().zip(frame) {
                let (Some(own), to) = (own, frame.as_ref().map(|frame| frame.reference)) else {
                    continue;
                };
                let [low, high] = own.range;
                if let Some(to) = to.filter(|to| (low..=high).contains(to)) {
                    let [f, q] = own.factors(to);
                    // Torque times speed; the speed is as the root of thrust over density.
                    let density = if unit == "V" { 1.0 } else { to / own.reference };
                    for (by, factor) in by.iter_mut().zip([f, q, q * (f / density).sqrt()]) {
                        *by *= factor;
                    }
                    let off = by_voltage(EXPONENT_DEVIATION, own.reference, to);
                    variance += off * off;
                    continue;
                }
                let [low, high, at] = [low, high, own.reference].map(number);
                let reference = to.map_or("no reference".to_owned(), |to| {
                    format!("a reference of {}", number(to))
                });
                faults.push(view.diagnostic(
                    Code::References,
                    &format!("pair.{table}"),
                    format!(
                        "measured at {at} {unit}, with a law from {low} to {high}; the frame's `[{table}]` has {reference}"
                    ),
                    "cannot be brought there",
                    format!(
                        "give the frame a `[{table}]` with its reference in that range, or widen it: `--cells N` of identify \
                         writes the pack's"
                    ),
                ));
            }
            all.push((by, variance));
        }
        // Without a law rows stay at the voltages of their benches.
        let rows = || {
            self.views()
                .filter_map(|view| Some((view.of.measured().bench_v?, view)))
        };
        let low = rows().map(|([_, high], _)| high).fold(f64::INFINITY, f64::min);
        let apart = rows().find(|([high, _], _)| *high > (1.0 + APART) * low);
        if let (None, Some(([high, _], view))) = (&self.voltage, apart) {
            let [low, high] = [low, high].map(number);
            faults.push(view.diagnostic(
                Code::References,
                "pair.bench_v",
                format!("measured above {high} V, another kind below {low} V, and there is no `[voltage]`"),
                "cannot be brought together",
                "identify each again with --voltage-exponent 1.75 --cells N; where each flies at its bench's voltage, remove bench_v",
            ));
        }
        let pairs = self.pairs.iter_mut().map(|pair| {
            let alone = pair.lower_out.iter_mut().chain(&mut pair.upper_out);
            let mut terms = vec![(0, &mut pair.thrust_n[..]), (1, &mut pair.torque_nm)];
            terms.extend(alone.flat_map(RotorAlone::terms));
            terms.extend(pair.power.as_mut().map(|power| (2, &mut power.power_w[..])));
            (terms, &mut pair.measured)
        });
        let rotors = self.single_rotors.iter_mut();
        let rotors = rotors.map(|rotor| (rotor.alone.terms().into(), &mut rotor.measured));
        for ((terms, measured), (by, variance)) in pairs.chain(rotors).zip(all) {
            for (k, terms) in terms {
                terms.iter_mut().for_each(|term| *term *= by[k]);
            }
            measured.uncertainty = measured.uncertainty.map(|own| own.with([variance.sqrt(); 2]));
        }
        faults
    }

    /// Takes tolerances that the file does not state down to a thousandth of the least of the units' `scales`, their largest
    /// thrusts and torques, N and N m: on small vehicles the defaults are much.
    pub(crate) fn fit_tolerances(&mut self, scales: &[[f64; 2]]) {
        const SHARE: f64 = 1e-3;
        let stated =
            ["thrust_tolerance_n", "torque_tolerance_nm"].map(|key| self.states(&format!("inverse.{key}")));
        let inverse = &mut self.inverse;
        let tolerances = [&mut inverse.thrust_tolerance_n, &mut inverse.torque_tolerance_nm];
        for (k, tolerance) in tolerances.into_iter().enumerate().filter(|(k, _)| !stated[*k]) {
            let sizes = scales.iter().map(|scale| SHARE * scale[k]);
            *tolerance = sizes.filter(|size| *size > 0.0).fold(*tolerance, f64::min);
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

    /// Number of rotors: two of each pair, and the single ones.
    pub fn rotors(&self) -> usize {
        self.units.iter().flat_map(Unit::channels).count()
    }

    /// The layers of its rotors, of `upper`, `lower` and `single` those that there are, each with its outputs.
    pub fn layers(&self) -> impl Iterator<Item = (&'static str, Vec<usize>)> + '_ {
        let of = |layer: &'static str| {
            let rotors = self.units.iter().flat_map(Unit::rotors);
            let outputs = rotors.filter(|rotor| rotor.layer == layer);
            (layer, outputs.map(|rotor| rotor.channel).collect::<Vec<_>>())
        };
        let layers = ["upper", "lower", "single"].into_iter();
        layers.map(of).filter(|(_, outputs)| !outputs.is_empty())
    }

    /// Number of units that are pairs.
    pub fn pair_units(&self) -> usize {
        self.rotors() - self.units.len()
    }

    /// Number of units that are single rotors.
    pub fn single_units(&self) -> usize {
        self.units.len() - self.pair_units()
    }

    /// Whether units differ, or are single rotors: whether the one pair is not that of all units.
    pub fn is_unlike(&self) -> bool {
        self.pairs.len() + self.single_rotors.len() > 1 || self.pairs.is_empty()
    }

    /// What a unit is.
    pub fn kind_of(&self, unit: &Unit) -> Kind<'_> {
        match self.pairs.get(unit.kind) {
            Some(pair) => Kind::Pair(pair),
            None => Kind::SingleRotor(&self.single_rotors[unit.kind - self.pairs.len()]),
        }
    }

    /// The words `, pair "front"` or `, rotor "tail"`, with what was brought to the frame's references; none where all units
    /// are alike.
    pub fn named_kind(&self, unit: &Unit) -> String {
        let kind = self.kind_of(unit);
        let laws = kind.measured().own_laws.iter().zip(["V", "kg/m3"]);
        let own = laws.filter_map(|(own, unit)| {
            Some(format!(
                ", measured at {} {unit}",
                number(own.as_ref()?.reference)
            ))
        });
        match kind.name() {
            (_, "") => String::new(),
            _ if !self.is_unlike() => String::new(),
            (word, name) => format!(", {word} \"{name}\"{}", own.collect::<String>()),
        }
    }

    /// Whose pairs they are, where they are not the airframe's own, as a line of saved files says it.
    pub fn borrowed(&self) -> Option<String> {
        let told: Vec<String> = self.pairs.iter().filter_map(Pair::borrowed).collect();
        (!told.is_empty()).then(|| told.join("; "))
    }

    /// Sign s of a unit's torque in yaw: +1 where a pair's upper rotor spins as on its bench, and where a single rotor, whose
    /// torque counts positive, spins counter-clockwise; else -1.
    pub fn spin_sign(&self, unit: &Unit) -> f64 {
        let positive = self
            .kind_of(unit)
            .pair()
            .map_or(Spin::Ccw, |pair| pair.upper_spin);
        if unit.upper_spin == positive { 1.0 } else { -1.0 }
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
    /// `None` where the file has no `[pair.power]`, a unit is a single rotor, or a channel has no throttle.
    pub fn power_w(&self, throttle: &[f64]) -> Option<f64> {
        let of_unit = |unit: &Unit| {
            let map = self.kind_of(unit).pair()?.power.as_ref()?;
            let of = |channel: usize| throttle.get(channel).copied();
            Some(map.at([of(unit.upper_channel)?, of(unit.lower_channel?)?]))
        };
        self.units.iter().map(of_unit).sum()
    }

    /// The share of a pair's saving by `power_bias_nm_per_n` that is left in hover, as torques must
    /// cancel: 1 - (sum s / n)^2 with the spins s of n units.
    pub fn power_bias_share(&self) -> f64 {
        let spins = self.units.iter().map(|unit| self.spin_sign(unit));
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
    let pairs = file.tables(&PAIR, |table| pair::read(table, throttle.as_ref()));
    let bench_spin = pairs.first().and_then(|(_, spin)| *spin);
    let pairs: Option<Vec<Pair>> = pairs.into_iter().map(|(pair, _)| pair).collect();
    let mut pairs = pairs.unwrap_or_default();
    pair::unite(&mut pairs);
    let single_rotors = file.tables(&ROTOR, |table| single_rotor::read(table, throttle.as_ref()));
    // Of a table that is there twice the rest was not read.
    let is_whole = !file.faults.iter().any(|fault| fault.code == Code::Syntax);
    let pair_names = pairs.iter().filter(|_| is_whole).map(|pair| pair.name.clone());
    let pair_names: Vec<String> = pair_names.collect();
    let single_rotors: Option<Vec<SingleRotor>> = single_rotors.into_iter().collect();
    let rotor_names = single_rotors.iter().flatten().map(|rotor| rotor.name.clone());
    let rotor_names: Vec<String> = rotor_names.collect();
    let [voltage, air] = correction::read(&mut file, [&VOLTAGE, &AIR]);
    let layout = file.table(&LAYOUT, |table| layout::read(table, bench_spin));
    let units = file.tables(&UNIT, unit::read);
    let inverse = file.table(&INVERSE, inverse::read);
    let allocation = file.table(&ALLOCATION, allocation::read);
    let vehicle = file.table(&VEHICLE, vehicle::read);

    let all_single = file.key_place(&ROTOR).is_some()
        && file.key_place(&LAYOUT).is_none()
        && units.iter().all(|unit| unit.rotor.is_some());
    if file.key_place(&PAIR).is_none() && !all_single {
        file.faults.push(file.missing(&PAIR));
    }
    let first_angle_deg = layout.as_ref().and_then(|layout| layout.first_angle_deg);
    let units = described(&mut file, units, layout, &mut places)?;
    // A table that was refused left its faults, so that no default takes its place.
    let units = unit::check(&units, [&pair_names, &rotor_names], &places, file.faults);
    let has_bias = |allocation: &Allocation| allocation.power_bias_nm_per_n != 0.0;
    if !rotor_names.is_empty() && allocation.iter().flatten().any(has_bias) {
        let key = "allocation.power_bias_nm_per_n";
        let message = "least power on a frame with single rotors".to_owned();
        let place = spec::place_in(&places, key);
        let fault = Diagnostic::new(Code::PowerBias, key, place, message);
        let help = "remove it: least power shifts torque from pair to pair, which every unit must then be";
        file.faults
            .push(fault.label("for frames of pairs alone").help(help));
    }
    Some(Airframe {
        units: units?,
        name: name?,
        description: description.map(Spanned::into_inner).unwrap_or_default(),
        throttle: throttle?,
        pairs,
        single_rotors: single_rotors?,
        voltage,
        air,
        inverse: inverse.flatten().unwrap_or_default(),
        allocation: allocation.flatten().unwrap_or_default(),
        vehicle: vehicle.flatten(),
        first_angle_deg,
        places,
    })
}

/// The units by the one description that the file has of them, `[layout]` or `[[unit]]`.
fn described(
    file: &mut Fields<'_, '_>,
    units: Vec<unit::Written>,
    layout: Option<layout::Layout>,
    places: &mut Places,
) -> Option<Vec<unit::Written>> {
    let written = file.key_place(&UNIT);
    let is_found = || file.faults.iter().any(|fault| fault.key.starts_with("unit"));
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
    if file.key_place(&LAYOUT).is_none() && units.is_empty() && !is_found() {
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
    let Some(layout) = layout else {
        return Some(units);
    };
    let units = layout.units?;
    // Later stages know units alone; what they find in one is to be pointed at in the layout.
    places.insert("unit".to_owned(), layout.place.clone());
    for k in 0..units.len() {
        places.insert(format!("unit[{k}]"), layout.place.clone());
        for index in 0..2 {
            let written = places.get(&format!("layout.channels[{k}][{index}]")).cloned();
            places.extend(written.map(|place| (format!("unit[{k}].channels[{index}]"), place)));
        }
    }
    Some(units)
}
