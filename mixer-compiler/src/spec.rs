//! The airframe file as written: every field with its place, none of it judged yet.
//!
//! The structures mirror the file, version 1. A field is `None` where the file does not have it,
//! and also where its value was of a wrong shape, which is then among the faults. Whether numbers
//! make sense is for [`crate::airframe`] to say.

mod fields;
pub mod keys;
mod syntax;
mod value;

use std::ops::Range;

pub(crate) use toml::Spanned;

use self::fields::Fields;
pub(crate) use self::syntax::Places;
use crate::diagnostic::source::Source;
use crate::diagnostic::{Code, Diagnostic};

/// Three numbers, each with its place.
pub(crate) type Triple = [Spanned<f64>; 3];

/// A voltage and its factor.
pub(crate) type Point = Spanned<[Spanned<f64>; 2]>;

/// The output channels of the upper and of the lower rotor.
pub(crate) type Channels = [Spanned<usize>; 2];

/// The whole file.
#[derive(Clone, Debug)]
pub(crate) struct Spec {
    /// `name`
    pub(crate) name: Option<Spanned<String>>,
    /// `description`
    pub(crate) description: Option<Spanned<String>>,
    /// `[throttle]`
    pub(crate) throttle: Option<Throttle>,
    /// `[pair]`
    pub(crate) pair: Option<Pair>,
    /// `[voltage]`
    pub(crate) voltage: Option<Voltage>,
    /// `[layout]`
    pub(crate) layout: Option<Layout>,
    /// `[[unit]]`
    pub(crate) units: Vec<Unit>,
    /// `[inverse]`
    pub(crate) inverse: Option<Inverse>,
    /// `[allocation]`
    pub(crate) allocation: Option<Allocation>,
    /// `[vehicle]`
    pub(crate) vehicle: Option<Vehicle>,
    /// Where every key is.
    pub(crate) places: Places,
}

/// `[throttle]`
#[derive(Clone, Debug)]
pub(crate) struct Throttle {
    /// `min`
    pub(crate) min: Option<Spanned<f64>>,
    /// `max`
    pub(crate) max: Option<Spanned<f64>>,
}

/// `[pair]`
#[derive(Clone, Debug)]
pub(crate) struct Pair {
    /// `basis`
    pub(crate) basis: Option<Spanned<String>>,
    /// `thrust_n`
    pub(crate) thrust_n: Option<Spanned<Vec<Spanned<f64>>>>,
    /// `torque_nm`
    pub(crate) torque_nm: Option<Spanned<Vec<Spanned<f64>>>>,
    /// `upper_spin`
    pub(crate) upper_spin: Option<Spanned<String>>,
    /// `[pair.lower_out]`
    pub(crate) lower_out: Option<RotorAlone>,
    /// `[pair.upper_out]`
    pub(crate) upper_out: Option<RotorAlone>,
    /// `[pair.power]`
    pub(crate) power: Option<Power>,
    /// `[pair.uncertainty]`
    pub(crate) uncertainty: Option<Uncertainty>,
}

/// `[pair.uncertainty]`
#[derive(Clone, Debug)]
pub(crate) struct Uncertainty {
    /// `thrust_percent`
    pub(crate) thrust_percent: Option<Spanned<f64>>,
    /// `torque_percent`
    pub(crate) torque_percent: Option<Spanned<f64>>,
}

/// `[pair.power]`
#[derive(Clone, Debug)]
pub(crate) struct Power {
    /// `power_w`
    pub(crate) power_w: Option<Spanned<Vec<Spanned<f64>>>>,
}

/// `[pair.lower_out]` or `[pair.upper_out]`
#[derive(Clone, Debug)]
pub(crate) struct RotorAlone {
    /// `thrust_n`
    pub(crate) thrust_n: Option<Spanned<Triple>>,
    /// `torque_nm`
    pub(crate) torque_nm: Option<Spanned<Triple>>,
}

/// `[voltage]`
#[derive(Clone, Debug)]
pub(crate) struct Voltage {
    /// Place of the header.
    pub(crate) place: Range<usize>,
    /// `reference_v`
    pub(crate) reference_v: Option<Spanned<f64>>,
    /// `range_v`
    pub(crate) range_v: Option<Spanned<[Spanned<f64>; 2]>>,
    /// `thrust_exponent`, `thrust_polynomial`, `thrust_points`
    pub(crate) thrust: VoltageLaw,
    /// `torque_exponent`, `torque_polynomial`, `torque_points`
    pub(crate) torque: VoltageLaw,
}

/// The three forms of a voltage law.
#[derive(Clone, Debug)]
pub(crate) struct VoltageLaw {
    /// The forms that the file has, also those of a wrong shape.
    pub(crate) present: Vec<(&'static str, Range<usize>)>,
    /// `.._exponent`
    pub(crate) exponent: Option<Spanned<f64>>,
    /// `.._polynomial`
    pub(crate) polynomial: Option<Spanned<Vec<Spanned<f64>>>>,
    /// `.._points`
    pub(crate) points: Option<Spanned<Vec<Point>>>,
}

/// `[layout]`
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    /// Place of the header.
    pub(crate) place: Range<usize>,
    /// `arm_m`
    pub(crate) arm_m: Option<Spanned<f64>>,
    /// `units`
    pub(crate) units: Option<Spanned<usize>>,
    /// `first_angle_deg`
    pub(crate) first_angle_deg: Option<Spanned<f64>>,
    /// `first_spin`
    pub(crate) first_spin: Option<Spanned<String>>,
    /// `spins`
    pub(crate) spins: Option<Spanned<Vec<Spanned<String>>>>,
    /// `channels`
    pub(crate) channels: Option<Spanned<Vec<Spanned<Channels>>>>,
}

/// `[[unit]]`
#[derive(Clone, Debug)]
pub(crate) struct Unit {
    /// Path, like `unit[3]`.
    pub(crate) path: String,
    /// Place of the header.
    pub(crate) place: Range<usize>,
    /// `position_m`
    pub(crate) position_m: Option<Spanned<Triple>>,
    /// `upper_spin`
    pub(crate) upper_spin: Option<Spanned<String>>,
    /// `channels`
    pub(crate) channels: Option<Spanned<Channels>>,
    /// `axis`
    pub(crate) axis: Option<Spanned<Triple>>,
}

/// `[inverse]`
#[derive(Clone, Debug)]
pub(crate) struct Inverse {
    /// `thrust_tolerance_n`
    pub(crate) thrust_tolerance_n: Option<Spanned<f64>>,
    /// `torque_tolerance_nm`
    pub(crate) torque_tolerance_nm: Option<Spanned<f64>>,
    /// `method`
    pub(crate) method: Option<Spanned<String>>,
    /// `degree`
    pub(crate) degree: Option<Spanned<usize>>,
}

/// `[allocation]`
#[derive(Clone, Debug)]
pub(crate) struct Allocation {
    /// `airmode`
    pub(crate) airmode: Option<Spanned<String>>,
    /// `axes`
    pub(crate) axes: Option<Spanned<Vec<Spanned<String>>>>,
    /// `yaw_reserve_nm`
    pub(crate) yaw_reserve_nm: Option<Spanned<f64>>,
    /// `power_bias_nm_per_n`
    pub(crate) power_bias_nm_per_n: Option<Spanned<f64>>,
}

/// `[vehicle]`
#[derive(Clone, Debug)]
pub(crate) struct Vehicle {
    /// `mass_kg`
    pub(crate) mass_kg: Option<Spanned<f64>>,
    /// `inertia_kg_m2`
    pub(crate) inertia_kg_m2: Option<Spanned<Triple>>,
}

impl Spec {
    /// Reads the file and notes all faults of its shape: syntax, unknown and missing keys, wrong
    /// types and lengths, numbers that are not finite. `None` where the text is not TOML or empty,
    /// so that nothing more can be said of it.
    pub(crate) fn read(source: &Source, faults: &mut Vec<Diagnostic>) -> Option<Spec> {
        let table = syntax::parse(source, faults)?;
        let places = syntax::places(&table);
        let top = places.get("name").cloned().unwrap_or(0..0);
        if table.is_empty() {
            faults.push(
                Diagnostic::new(Code::MissingKey, "name", top, "the file is empty")
                    .label("expected an airframe")
                    .help("an airframe has a `name`, `[throttle]`, `[pair]`, and a `[[unit]]` for each pair of rotors"),
            );
            return None;
        }
        let mut file = Fields::new(&table, keys::FILE, String::new(), top, faults);
        file.require();
        if file.key_place("unit").is_none() && file.key_place("layout").is_none() {
            let fault = Diagnostic::new(Code::MissingKey, "unit", file.place(), "the airframe has 0 units")
                .label("this airframe has no `[[unit]]`")
                .help("add a `[[unit]]` for each pair of rotors, or a `[layout]` for a regular frame");
            file.report(fault);
        }
        Some(Spec {
            name: file.read("name"),
            description: file.read("description"),
            throttle: file.table("throttle", keys::THROTTLE, Throttle::read),
            pair: file.table("pair", keys::PAIR, Pair::read),
            voltage: file.table("voltage", keys::VOLTAGE, Voltage::read),
            layout: file.table("layout", keys::LAYOUT, Layout::read),
            units: file.tables("unit", keys::UNIT, Unit::read),
            inverse: file.table("inverse", keys::INVERSE, Inverse::read),
            allocation: file.table("allocation", keys::ALLOCATION, Allocation::read),
            vehicle: file.table("vehicle", keys::VEHICLE, Vehicle::read),
            places,
        })
    }
}

impl Vehicle {
    fn read(fields: &mut Fields<'_, '_>) -> Self {
        fields.require();
        Self {
            mass_kg: fields.read("mass_kg"),
            inertia_kg_m2: fields.read("inertia_kg_m2"),
        }
    }
}

impl Throttle {
    fn read(fields: &mut Fields<'_, '_>) -> Self {
        fields.require();
        Self {
            min: fields.read("min"),
            max: fields.read("max"),
        }
    }
}

impl Pair {
    fn read(fields: &mut Fields<'_, '_>) -> Self {
        fields.require();
        Self {
            basis: fields.read("basis"),
            thrust_n: fields.read("thrust_n"),
            torque_nm: fields.read("torque_nm"),
            upper_spin: fields.read("upper_spin"),
            lower_out: fields.table("lower_out", keys::LOWER_OUT, RotorAlone::read),
            upper_out: fields.table("upper_out", keys::UPPER_OUT, RotorAlone::read),
            power: fields.table("power", keys::POWER, Power::read),
            uncertainty: fields.table("uncertainty", keys::UNCERTAINTY, Uncertainty::read),
        }
    }
}

impl Uncertainty {
    fn read(fields: &mut Fields<'_, '_>) -> Self {
        fields.require();
        Self {
            thrust_percent: fields.read("thrust_percent"),
            torque_percent: fields.read("torque_percent"),
        }
    }
}

impl Power {
    fn read(fields: &mut Fields<'_, '_>) -> Self {
        fields.require();
        Self {
            power_w: fields.read("power_w"),
        }
    }
}

impl RotorAlone {
    fn read(fields: &mut Fields<'_, '_>) -> Self {
        fields.require();
        Self {
            thrust_n: fields.read("thrust_n"),
            torque_nm: fields.read("torque_nm"),
        }
    }
}

impl Voltage {
    fn read(fields: &mut Fields<'_, '_>) -> Self {
        fields.require();
        Self {
            place: fields.place(),
            reference_v: fields.read("reference_v"),
            range_v: fields.read("range_v"),
            thrust: VoltageLaw::read(fields, ["thrust_exponent", "thrust_polynomial", "thrust_points"]),
            torque: VoltageLaw::read(fields, ["torque_exponent", "torque_polynomial", "torque_points"]),
        }
    }
}

impl VoltageLaw {
    fn read(fields: &mut Fields<'_, '_>, names: [&'static str; 3]) -> Self {
        let [exponent, polynomial, points] = names;
        Self {
            present: names
                .into_iter()
                .filter_map(|name| Some((name, fields.key_place(name)?)))
                .collect(),
            exponent: fields.read(exponent),
            polynomial: fields.read(polynomial),
            points: fields.read(points),
        }
    }
}

impl Layout {
    fn read(fields: &mut Fields<'_, '_>) -> Self {
        fields.require();
        Self {
            place: fields.place(),
            arm_m: fields.read("arm_m"),
            units: fields.read("units"),
            first_angle_deg: fields.read("first_angle_deg"),
            first_spin: fields.read("first_spin"),
            spins: fields.read("spins"),
            channels: fields.read("channels"),
        }
    }
}

impl Unit {
    fn read(fields: &mut Fields<'_, '_>) -> Self {
        fields.require();
        Self {
            path: fields.path().to_string(),
            place: fields.place(),
            position_m: fields.read("position_m"),
            upper_spin: fields.read("upper_spin"),
            channels: fields.read("channels"),
            axis: fields.read("axis"),
        }
    }
}

impl Inverse {
    fn read(fields: &mut Fields<'_, '_>) -> Self {
        Self {
            thrust_tolerance_n: fields.read("thrust_tolerance_n"),
            torque_tolerance_nm: fields.read("torque_tolerance_nm"),
            method: fields.read("method"),
            degree: fields.read("degree"),
        }
    }
}

impl Allocation {
    fn read(fields: &mut Fields<'_, '_>) -> Self {
        Self {
            airmode: fields.read("airmode"),
            axes: fields.read("axes"),
            yaw_reserve_nm: fields.read("yaw_reserve_nm"),
            power_bias_nm_per_n: fields.read("power_bias_nm_per_n"),
        }
    }
}
