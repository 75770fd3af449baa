//! The checked airframe: a model of which every value is known to make sense.

mod allocation;
mod basis;
mod check;
mod inverse;
mod layout;
mod name;
mod pair;
mod power;
mod rotor_alone;
mod throttle;
mod uncertainty;
mod unit;
mod vehicle;
mod voltage;

use std::ops::Range;

use toml::Spanned;

pub use self::allocation::{Airmode, Allocation, Axis};
pub use self::basis::Basis;
pub use self::inverse::{Inverse, Method};
pub use self::pair::{Pair, Spin};
pub use self::power::Power;
pub use self::rotor_alone::RotorAlone;
pub use self::throttle::Throttle;
pub use self::uncertainty::Uncertainty;
pub use self::unit::Unit;
pub use self::vehicle::{GRAVITY, Vehicle};
pub use self::voltage::{Voltage, VoltageLaw};
use crate::diagnostic::source::Source;
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::spec::{self, Places, Spec};

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
    /// Supply voltage; `None` where thrust and torque do not depend on it.
    pub voltage: Option<Voltage>,
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
        let airframe = Spec::read(source, &mut faults).and_then(|spec| check(spec, &mut faults));
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
        self.voltage.as_ref().map_or(0.0, |voltage| voltage.reference_v)
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
    pub(crate) fn power_bias_share(&self) -> f64 {
        let spins = self.units.iter().map(|unit| unit.spin_sign(self.pair.upper_spin));
        let mean = spins.sum::<f64>() / self.units.len() as f64;
        1.0 - mean * mean
    }

    /// Whether the file itself has a key like `unit[3].channels`.
    pub(crate) fn states(&self, key: &str) -> bool {
        self.places.contains_key(key)
    }

    /// Place of a key like `unit[3].channels` in the file, or of the nearest table or array around
    /// it that the file has; else of the name.
    pub fn place(&self, key: &str) -> Option<Range<usize>> {
        let mut key = key;
        loop {
            if let Some(place) = self.places.get(key) {
                return Some(place.clone());
            }
            match key.rfind(['.', '[']) {
                Some(parent) => key = &key[..parent],
                None => return self.places.get("name").cloned(),
            }
        }
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

fn check(spec: Spec, faults: &mut Vec<Diagnostic>) -> Option<Airframe> {
    let name = spec.name.as_ref().and_then(|field| name::check(field, faults));
    let throttle = spec
        .throttle
        .as_ref()
        .and_then(|table| throttle::check(table, faults));
    let pair = spec
        .pair
        .as_ref()
        .and_then(|table| pair::check(table, throttle.as_ref(), faults));
    let voltage = spec.voltage.as_ref().map(|table| voltage::check(table, faults));
    let units = units(&spec, faults).and_then(|units| unit::check(&units, faults));
    let inverse = spec
        .inverse
        .as_ref()
        .map_or(Some(Inverse::default()), |table| inverse::check(table, faults));
    let allocation = spec
        .allocation
        .as_ref()
        .map_or(Some(Allocation::default()), |table| {
            allocation::check(table, faults)
        });

    let vehicle = spec.vehicle.as_ref().map(|table| vehicle::check(table, faults));

    let units = units?;
    let mut places = spec.places;
    if let Some(layout) = &spec.layout {
        // Later stages know units alone; what they find in one is to be pointed at in the layout.
        let of_units = (0..units.len()).map(|k| (format!("unit[{k}]"), layout.place.clone()));
        places.extend(of_units.chain([("unit".to_string(), layout.place.clone())]));
    }
    Some(Airframe {
        name: name?,
        description: spec.description.map(Spanned::into_inner).unwrap_or_default(),
        throttle: throttle?,
        pair: pair?,
        voltage: match voltage {
            Some(voltage) => Some(voltage?),
            None => None,
        },
        units,
        inverse: inverse?,
        allocation: allocation?,
        vehicle: match vehicle {
            Some(vehicle) => Some(vehicle?),
            None => None,
        },
        first_angle_deg: spec
            .layout
            .and_then(|layout| layout.first_angle_deg)
            .map(Spanned::into_inner),
        places,
    })
}

/// The units as written, from `[[unit]]` or from `[layout]`.
fn units(spec: &Spec, faults: &mut Vec<Diagnostic>) -> Option<Vec<spec::Unit>> {
    let written = spec.places.get("unit");
    let Some(layout) = &spec.layout else {
        if let Some(place) = written
            && spec.units.is_empty()
            && !faults.iter().any(|fault| fault.key.starts_with("unit"))
        {
            faults.push(
                Diagnostic::new(
                    Code::WrongLength,
                    "unit",
                    place.clone(),
                    "the airframe has 0 units",
                )
                .label("empty")
                .help("add a `[[unit]]` for each pair of rotors"),
            );
        }
        return (!spec.units.is_empty()).then(|| spec.units.clone());
    };
    if written.is_some() {
        faults.push(
            Diagnostic::new(
                Code::Conflict,
                "layout",
                layout.place.clone(),
                format!("the file has `[layout]` and {} `[[unit]]`", spec.units.len()),
            )
            .label("second description of the units")
            .help("keep one: `[layout]` for a regular frame, else `[[unit]]`"),
        );
        return None;
    }
    let bench_spin = spec.pair.as_ref().and_then(|pair| pair.upper_spin.as_ref());
    let bench_spin = bench_spin.and_then(|spin| Spin::WORDS.iter().find(|(word, _)| word == spin.get_ref()));
    layout::expand(layout, bench_spin.map(|&(_, spin)| spin), faults)
}
