//! What there is to say of a compiled airframe, once.

use std::fmt;

use mixer_compiler::Compiled;
use mixer_compiler::airframe::{Kind, Uncertainty};
use mixer_compiler::atmosphere::TOP_M;
use mixer_compiler::diagnostic::rounded_up;
use mixer_compiler::dynamics::UNPROVEN;
use mixer_compiler::flywheel::Flywheel;
use mixer_compiler::hover::HoverAt;
use mixer_compiler::model::PairMap;
use mixer_compiler::power::LevelPower;
use serde::Serialize;
use serde_json::{Value, json};

use crate::air::{Air, AtAltitude, LEAST_THRUST_OVER_WEIGHT};
use crate::checklist;
use crate::cost::Cost;
use crate::hover::Hover;

/// Share of the largest bare thrust at which the authority of any vehicle is looked at.
const SHARE: f64 = 0.4;

/// Units in a line of the frame.
const UNITS_A_LINE: usize = 3;

/// Border points per edge of the throttle box at which the largest efforts are looked for.
const SAMPLES: usize = 64;

/// Something to say of a compiled airframe: a number with its unit and the words to it.
#[derive(Clone, Debug)]
pub struct Fact {
    /// What it is of. No other fact of the airframe has this name.
    pub name: &'static str,
    /// The number or the word, short enough to stand beside those of other airframes; empty where
    /// there is none.
    pub value: String,
    /// The value's unit; empty where it has none.
    pub unit: &'static str,
    /// What else there is to say, to be read on after the unit.
    pub words: String,
    /// Keys and values of `cargo mixer check --json`.
    pub json: Vec<(&'static str, Value)>,
    /// Whether it is part of the verdict: what an engineer asks first.
    pub in_verdict: bool,
}

/// Facts in the order in which they are said.
struct List(Vec<Fact>);

impl List {
    fn say(
        &mut self,
        name: &'static str,
        value: impl ToString,
        unit: &'static str,
        words: impl Into<String>,
    ) -> &mut Fact {
        let at = self.0.len();
        let (value, words) = (value.to_string(), words.into());
        let (json, in_verdict) = (Vec::new(), false);
        self.0.push(Fact {
            name,
            value,
            unit,
            words,
            json,
            in_verdict,
        });
        &mut self.0[at]
    }

    fn count(&mut self, name: &'static str, count: Option<u32>, words: String) -> &mut Fact {
        match count {
            Some(count) => self.say(name, count, INSTRUCTIONS, words),
            None => self.say(name, "", INSTRUCTIONS, "not counted"),
        }
    }
}

impl Fact {
    /// For the verdict, if `so`.
    fn in_verdict_if(&mut self, so: bool) -> &mut Self {
        self.in_verdict = so;
        self
    }

    /// For the verdict.
    fn in_verdict(&mut self) -> &mut Self {
        self.in_verdict_if(true)
    }

    fn json(&mut self, key: &'static str, value: impl Serialize) -> &mut Self {
        // Numbers, words and lists have a value.
        self.json
            .push((key, serde_json::to_value(value).unwrap_or_default()));
        self
    }

    /// Whether it is a count of what the target executes.
    pub fn is_cost(&self) -> bool {
        self.unit == INSTRUCTIONS
    }

    /// All but the name.
    pub fn text(&self) -> String {
        match (self.value.as_str(), self.unit) {
            ("", _) | (_, "") => format!("{}{}", self.value, self.words),
            (value, unit) => format!("{value} {unit}{}", self.words),
        }
    }
}

/// A line of `check`.
impl fmt::Display for Fact {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.text() {
            // Its keys of JSON hold without a pair, too.
            text if text.is_empty() => Ok(()),
            text => writeln!(f, "{:<18}  {}", self.name, text.trim_start()),
        }
    }
}

/// All facts of an airframe: what it gives, what flying it leaves, how true it is, what it costs.
pub fn facts(compiled: &Compiled) -> Vec<Fact> {
    let mut list = List(Vec::new());
    gives(&mut list, compiled);
    hover(&mut list, compiled);
    dynamics(&mut list, compiled);
    power(&mut list, compiled);
    model(&mut list, compiled);
    voltage(&mut list, compiled);
    air(&mut list, compiled);
    inverse(&mut list, compiled);
    costs(&mut list, compiled);
    let warnings = mixer_compiler::lint(compiled).faults().len();
    list.say("warnings", warnings, "", "").in_verdict();
    list.0
}

/// `text`, where there is a value to say it of.
fn or_nothing<T>(value: Option<T>, text: impl FnOnce(T) -> String) -> String {
    value.map_or_else(String::new, text)
}

/// What it is, its thrust and its authority.
fn gives(list: &mut List, compiled: &Compiled) {
    let (airframe, m) = (&compiled.airframe, &compiled.effectiveness);
    let units = airframe.units.len();
    let axes: Vec<&str> = airframe.allocation.axes.iter().map(|axis| axis.name()).collect();
    let description = Some(&airframe.description).filter(|text| !text.is_empty());
    let words = or_nothing(description, |text| format!(": {text}"));
    list.say("airframe", &airframe.name, "", words)
        .json("name", &airframe.name)
        .in_verdict();
    let arms = airframe
        .units
        .iter()
        .map(|unit| libm::hypot(unit.position_m[0], unit.position_m[1]));
    let arms = [arms.clone().fold(f64::MAX, f64::min), arms.fold(0.0, f64::max)];
    let told = match arms.map(|arm| format!("{arm:.3}")) {
        [_, longest] if longest == "0.000" => String::new(),
        [shortest, longest] if shortest == longest => format!(", arms of {longest} m"),
        [shortest, longest] => format!(", arms of {shortest} to {longest} m"),
    };
    let single = airframe.single_units();
    let pairs = match units - single {
        1 => " in 1 coaxial unit".to_owned(),
        pairs => format!(" in {pairs} coaxial units"),
    };
    let words = match single {
        0 => pairs + &told,
        _ if single == units => format!(", all single{told}"),
        _ => format!("{pairs} and {single} single ones{told}"),
    };
    list.say("rotors", airframe.rotors(), "", words)
        .json("units", units)
        .json("rotors", airframe.rotors())
        .json("arms_m", arms)
        .in_verdict();
    let frame = checklist::frame(airframe);
    let lines: Vec<String> = frame.chunks(UNITS_A_LINE).map(|units| units.join("; ")).collect();
    list.say("frame", "", "", lines.join(&format!(";\n{:20}", "")))
        .json("frame", frame.join("; "))
        .in_verdict();
    list.say("served axes", axes.join(", "), "", "")
        .json("axes", &axes)
        .in_verdict();
    let words = format!("; rank {} of {} served axes", m.rank, axes.len());
    list.say("condition of M", format!("{:.4}", m.condition), "", words)
        .json("rank", m.rank)
        .json("condition", m.condition);

    let [floor, ceiling] = compiled.thrust_range_n.map(f64::from);
    let reference_v = airframe.voltage.as_ref().map(|voltage| voltage.reference);
    let at = or_nothing(reference_v, |volts| format!(" at {volts} V"));
    let words = format!(" without torque{at}");
    list.say("bare thrust", format!("{floor:.1} to {ceiling:.1}"), "N", words)
        .json("thrust_range_n", [floor, ceiling])
        .in_verdict();
    let throttle = format!("{:?} to {:?}", airframe.throttle.min, airframe.throttle.max);
    let share = 100.0 * floor / ceiling;
    let needs_most = airframe.pairs.iter().zip(&compiled.of_pairs);
    let needs_most = needs_most.max_by(|(_, a), (_, b)| a.least_idle.total_cmp(&b.least_idle));
    let needed = or_nothing(needs_most, |(pair, of)| {
        let whose = match airframe.pairs.len() {
            1 => String::new(),
            _ => format!(" of pair \"{}\"", pair.name),
        };
        let needed = (1e3 * of.least_idle).ceil() / 1e3;
        format!(", the map{whose} needs {needed:.3} at least")
    });
    let words = format!("; idle gives {share:.1} % of the largest thrust{needed}");
    list.say("throttle", throttle, "", words)
        .json("min_idle", needs_most.map(|(_, of)| of.least_idle))
        .in_verdict();

    for margin in HoverAt::new(compiled, SHARE * ceiling, reference_v).margins {
        let name = match margin.axis {
            "roll" => "roll authority",
            "pitch" => "pitch authority",
            _ => "yaw authority",
        };
        let [least, largest] = margin.torque_nm;
        let words = format!(" beside {:.0} % of the largest thrust", 100.0 * SHARE);
        list.say(name, format!("{least:.3} to {largest:.3}"), "N m", words);
    }
}

/// Least and greatest throttle of a layer with their outputs; one number where they are alike.
fn layer([least, greatest]: [f64; 2], [lowest, highest]: [usize; 2]) -> String {
    match [least, greatest].map(|throttle| format!("{throttle:.3}")) {
        [low, high] if low == high => low,
        [low, high] => format!("{low} (output {lowest}) to {high} (output {highest})"),
    }
}

/// The vehicle in hover.
fn hover(list: &mut List, compiled: &Compiled) {
    let hover = Hover::new(compiled);
    let flywheels = Flywheel::of(&compiled.airframe);
    let missing = "add [vehicle] mass_kg to see hover and its margins";
    match &hover {
        None => list.say("mass", "", "", missing),
        Some(hover) => {
            let words = format!(", a weight of {:.2} N", hover.weight_n);
            list.say("mass", hover.mass_kg, "kg", words)
        }
    }
    .json("hover", &hover)
    .json("flywheel", one_or_list(&flywheels))
    .in_verdict();
    let Some(hover) = hover else { return };
    let of_rotors = compiled.airframe.views().zip(&flywheels).filter_map(|(view, rotor)| {
        let rotor = rotor.as_ref()?;
        let source = or_nothing(rotor.estimated_diameter_m, |diameter_m| {
            format!(", estimated by the largest thrust: {diameter_m:.2} m")
        });
        let words = format!(
            "T = J w / (2 Q) of {:.2} s in hover (J {:.1e} kg m2{source}): a step of yaw begins with {:.1} times its steady torque",
            rotor.lead_s, rotor.inertia_kg_m2, rotor.first_over_steady
        );
        Some(whose(view.of, flywheels.len()) + &words)
    });
    let of_rotors: Vec<String> = of_rotors.collect();
    if !of_rotors.is_empty() {
        list.say("rotors' inertia", "", "", of_rotors.join("; "))
            .in_verdict();
    }
    let over_weight = format!("{:.2}", hover.thrust_over_weight);
    list.say("thrust over weight", over_weight, "", " at most")
        .in_verdict();
    for (at, name) in hover.at.iter().rev().zip(["hover", "hover, lowest V"]) {
        let volts = or_nothing(at.voltage_v, |volts| format!(" at {volts:?} V"));
        if at.layers.is_empty() {
            let words = format!("the weight is not carried{volts}");
            list.say(name, "", "", words).in_verdict();
            continue;
        }
        let left = at.margins.iter().map(|margin| {
            let [least, largest] = margin.torque_nm;
            let band = or_nothing(margin.band_nm, |band| format!(" +- {band:.3}"));
            format!("{} {least:.3} to {largest:.3}{band}", margin.axis)
        });
        let left: Vec<String> = left.collect();
        let left = Some(left.join(", ")).filter(|left| !left.is_empty());
        let left = or_nothing(left, |left| format!("; left (N m): {left}"));
        let band = or_nothing(at.throttle_band.as_ref(), |[least, most]| {
            let ends = least.iter().zip(most).zip(&at.layers);
            let ends = ends.map(|((least, most), of)| {
                let name = if at.layers.len() > 1 { of.layer } else { "" };
                format!("{least:.3} to {most:.3} {name}").trim_end().to_owned()
            });
            let ends: Vec<String> = ends.collect();
            format!("; by the model's uncertainty {}", ends.join(", "))
        });
        let throttles = at.layers.iter().map(|of| layer(of.throttle, of.outputs));
        let throttle = throttles.collect::<Vec<_>>().join(", ");
        let names: Vec<&str> = at.layers.iter().map(|of| of.layer).collect();
        let whose = match names.as_slice() {
            [_] => String::new(),
            names => format!(" of {} rotors", names.join(", ")),
        };
        let words = format!(" throttle{whose}{volts}{left}{band}");
        list.say(name, throttle, "", words).in_verdict();
    }
    let Some(at) = hover.at.last().filter(|at| !at.rotor_out.is_empty()) else {
        return;
    };
    let each = at.rotor_out.iter().map(|out| {
        let yaw = out.yaw_nm.map_or("no level flight".to_owned(), |[least, most]| {
            format!("yaw {least:.3} to {most:.3} N m")
        });
        let article = if out.layer == "upper" { "an" } else { "a" };
        let outputs = match out.not_level.as_slice() {
            [] | [_] => format!("output {}", out.output),
            several => {
                let several: Vec<String> = several.iter().map(usize::to_string).collect();
                format!("any of outputs {}", several.join(", "))
            }
        };
        format!("{yaw} with {article} {} rotor out ({outputs})", out.layer)
    });
    let reserve = compiled.airframe.allocation.yaw_reserve_nm;
    let words = format!(
        "{}; yaw reserve {reserve} N m",
        each.collect::<Vec<_>>().join(", ")
    );
    list.say("hover, rotor out", "", "", words).in_verdict();
}

/// How rotors follow, for `mix_dynamic`.
fn dynamics(list: &mut List, compiled: &Compiled) {
    let of_kinds = compiled.dynamics.as_deref().unwrap_or_default();
    let each = compiled.airframe.views().zip(of_kinds).map(|(view, of)| {
        let origin = match of.is_estimated {
            true => {
                "0.7 of an estimate; measure it for `mix_dynamic` (docs/bench.md)"
            }
            false => "as the file says",
        };
        let (throttle, shift) = (of.throttle, of.shift_per_square);
        let words = format!(
            " at throttle {throttle:.2}, {origin}; where a rotor is d of throttle off, `mix_dynamic` shifts by {shift:.1} d^2 at most"
        );
        (view.of, format!("{:.3}", of.lag_s), words)
    });
    let each: Vec<_> = each.collect();
    match each.len() {
        0 => list.say("rotors' lag", "", "", UNPROVEN),
        kinds => list.say_of_each("rotors' lag", "s", kinds, &each),
    }
    .json("dynamics", one_or_list(of_kinds))
    .in_verdict();
}

/// A rotor out, and power in level flight.
fn power(list: &mut List, compiled: &Compiled) {
    let airframe = &compiled.airframe;
    let idle = airframe.throttle.min;
    let source = |is_declared: bool| match is_declared {
        true => (json!({ "by": "declared" }), "as declared in the file".to_owned()),
        false => (
            json!({ "by": "extrapolated", "from_throttle": idle }),
            format!("by the pair's polynomials, extrapolated from {idle:?} to 0"),
        ),
    };
    let kinds = airframe.views().count();
    let told = airframe.pair_views().map(|view| {
        let [lower, upper] = [&view.of.lower_out, &view.of.upper_out].map(|out| source(out.is_some()));
        let words = match (&lower.1, &upper.1) {
            (lower, upper) if lower == upper => format!("the other one {lower}"),
            (lower, upper) => {
                format!("of a lower one, the upper {lower}; of an upper one, the lower {upper}")
            }
        };
        let json = json!({ "lower_out": lower.0, "upper_out": upper.0 });
        (whose(Kind::Pair(view.of), kinds) + &words, json)
    });
    let (words, json): (Vec<String>, Vec<Value>) = told.unzip();
    list.say("rotor out", "", "", words.join("; "))
        .json("rotor_out", one_or_list(&json));

    let bias = airframe.allocation.power_bias_nm_per_n;
    let share = 100.0 * airframe.power_bias_share();
    let words = or_nothing(Some(bias).filter(|bias| *bias != 0.0), |_| {
        format!(" of thrust, where torques start; {share:.0} % of a pair's saving is left to this frame")
    });
    let power = LevelPower::new(compiled);
    // Where no unit is a pair there is none.
    let value = or_nothing(airframe.pairs.first(), |_| format!("{bias:?}"));
    list.say("power bias", value, "N m per N", words)
        .json("power_bias_nm_per_n", bias)
        .json("power", power);
    let Some(power) = power else {
        if airframe.single_units() > 0 && airframe.pairs.iter().any(|pair| pair.power.is_some()) {
            list.say("power", "", "", "not known: single rotors have no power map");
        }
        return;
    };
    let what = match power.is_hover {
        true => "in hover",
        false => "half of the largest bare thrust",
    };
    let without = Some(power.without_bias_w).filter(|without| *without != power.power_w);
    let saving = or_nothing(without, |without| {
        let (saving, time) = (power.saving_percent, power.flight_time_percent);
        format!(", {without:.1} W at Q = 0: saves {saving:.2} %, flight time {time:+.2} %")
    });
    let words = format!(" at {:.2} N ({what}){saving}", power.thrust_n);
    list.say("power", format!("{:.1}", power.power_w), "W", words)
        .in_verdict();
    let [upper, lower] = power.stop_percent;
    let instead = or_nothing(without, |_| {
        let [upper, lower] = power.without_bias_stop_percent;
        format!("; {lower:.0} and {upper:.0} % at Q = 0")
    });
    let words = format!(
        " of its unit's thrust lost with a lower rotor until it is left out, {upper:.0} % with an upper one{instead}"
    );
    list.say("rotor stops", format!("{lower:.0}"), "%", words)
        .in_verdict();
}

/// Whose it is what is said of a kind, where there are several.
fn whose(kind: Kind<'_>, kinds: usize) -> String {
    match kinds {
        1 => String::new(),
        _ => format!("\"{}\" ", kind.name().1),
    }
}

/// The value of the pair; a list where units differ.
fn one_or_list<T: Serialize>(values: &[T]) -> Value {
    let json = |value: &T| serde_json::to_value(value).unwrap_or_default();
    match values {
        [one] => json(one),
        _ => values.iter().map(json).collect(),
    }
}

impl List {
    /// Says value and words of each kind.
    fn say_of_each(
        &mut self,
        name: &'static str,
        unit: &'static str,
        kinds: usize,
        each: &[(Kind<'_>, String, String)],
    ) -> &mut Fact {
        if let ([(_, value, words)], 1) = (each, kinds) {
            return self.say(name, value, unit, words.as_str());
        }
        let told = each.iter().map(|(of, value, words)| {
            let space = if unit.is_empty() { "" } else { " " };
            format!("{}{value}{space}{unit}{words}", whose(*of, kinds))
        });
        let told: Vec<String> = told.collect();
        self.say(name, "", "", told.join("; "))
    }
}

/// The units' maps.
fn model(list: &mut List, compiled: &Compiled) {
    let airframe = &compiled.airframe;
    let kinds: Vec<Kind<'_>> = airframe.views().map(|view| view.of).collect();
    let pairs = airframe.pairs.iter().zip(&compiled.of_pairs);
    let told = kinds.iter().map(|kind| {
        let of_uncertainty = or_nothing(kind.measured().uncertainty, |uncertainty| {
            format!(
                ", {}: +- {} % of the largest thrust, {} % of the largest torque (one standard deviation)",
                uncertainty.source(),
                uncertainty.thrust_percent,
                uncertainty.torque_percent
            )
        });
        let (what, borrowed) = match kind {
            Kind::Pair(pair) => (pair.basis.name(), pair.borrowed_from.as_str()),
            Kind::SingleRotor(_) => ("single rotor", ""),
        };
        let of_whom = match borrowed {
            "" => String::new(),
            borrowed => format!(", of {borrowed}, not yours"),
        };
        (*kind, what.to_owned(), of_whom + &of_uncertainty)
    });
    let told: Vec<_> = told.collect();
    let uncertainty = kinds.iter().map(|kind| {
        let json = |uncertainty: &Uncertainty| {
            json!({
                "source": uncertainty.source(),
                "thrust_percent": uncertainty.thrust_percent,
                "torque_percent": uncertainty.torque_percent,
            })
        };
        kind.measured().uncertainty.as_ref().map(json)
    });
    let uncertainty: Vec<_> = uncertainty.collect();
    let borrowed = airframe.pairs.iter().map(|pair| pair.borrowed_from.as_str());
    let borrowed: Vec<_> = borrowed
        .map(|from| Some(from).filter(|from| !from.is_empty()))
        .collect();
    let is_in_verdict = uncertainty.iter().any(Option::is_some) || borrowed.iter().any(Option::is_some);
    let name = match airframe.single_rotors.is_empty() {
        true => "pair",
        false => "units",
    };
    list.say_of_each(name, "", kinds.len(), &told)
        .in_verdict_if(is_in_verdict)
        .json("borrowed_from", one_or_list(&borrowed))
        .json("uncertainty", one_or_list(&uncertainty));
    for (name, unit, k, decimals) in [("thrust of a unit", "N", 0, 3), ("torque of a unit", "N m", 1, 4)] {
        let extent = kinds.iter().map(|kind| {
            let map = PairMap::of_kind(*kind, &airframe.throttle);
            let values = map.border(SAMPLES).into_iter().map(|at| map.efforts(at)[k]);
            let widen = |[low, high]: [f64; 2], x: f64| [low.min(x), high.max(x)];
            let [low, high] = values.fold([f64::INFINITY, f64::NEG_INFINITY], widen);
            (
                *kind,
                format!("{low:.decimals$} to {high:.decimals$}"),
                String::new(),
            )
        });
        list.say_of_each(name, unit, kinds.len(), &extent.collect::<Vec<_>>());
    }
    let det_j = pairs.map(|(pair, of)| {
        let words = format!(" at least: proven invertible, with idles from {}", of.least_idle);
        (
            Kind::Pair(pair),
            format!("{:.4e}", of.injectivity.least_determinant),
            words,
        )
    });
    let det_j: Vec<_> = det_j.collect();
    let least = compiled
        .of_pairs
        .iter()
        .map(|of| of.injectivity.least_determinant);
    list.say_of_each("det J", "N N m", kinds.len(), &det_j)
        .json("least_det_j", one_or_list(&least.collect::<Vec<_>>()));
}

/// The battery's voltage.
fn voltage(list: &mut List, compiled: &Compiled) {
    let Some(voltage) = &compiled.airframe.voltage else {
        let words = "not corrected for: no [voltage]; a pack that falls by 20 % loses 32 % of thrust";
        list.say("voltage", "", "", words).in_verdict();
        return;
    };
    let [low, high] = voltage.range;
    let [[f_low, q_low], [f_high, q_high]] = [low, high].map(|volts| voltage.factors(volts));
    let words = format!("; k_f {f_low:.4} to {f_high:.4}, k_Q {q_low:.4} to {q_high:.4} over the range");
    list.say("voltage", format!("{low} to {high}"), "V", " is corrected for")
        .in_verdict();
    list.say("reference voltage", voltage.reference, "V", words);
}

/// The air's density.
fn air(list: &mut List, compiled: &Compiled) {
    let air = Air::new(compiled);
    let with_air = air.as_ref().and_then(|air| Some((air, air.range_kg_m3?)));
    let density = match with_air {
        None => list.say(
            "air density",
            "",
            "",
            "not corrected for: no [air]; thrust falls by 20 % at 3000 m",
        ),
        Some((_, [low, high])) => {
            let range = format!("{low} to {high}");
            list.say("air density", range, "kg/m3", " is corrected for")
        }
    };
    let has_altitudes = air.as_ref().is_some_and(|air| !air.altitudes.is_empty());
    density.json("air", &air).in_verdict_if(!has_altitudes);
    if let Some((air, _)) = with_air {
        let ([thrust, torque], [of_thrust, of_torque]) = (air.exponents, air.exponents_from);
        let words = format!("; exponents {thrust} of thrust ({of_thrust}), {torque} of torque ({of_torque})");
        list.say("reference density", air.reference_density_kg_m3, "kg/m3", words);
    }
    if let Some(air) = air {
        ceiling(list, &air);
    }
}

/// How high the vehicle flies.
fn ceiling(list: &mut List, air: &Air) {
    let Some(sea) = air.altitudes.first() else {
        return;
    };
    let ceiling = match air.ceiling_m {
        Some(ceiling) => format!("{:.0}", 10.0 * (0.1 * ceiling).round()),
        None if sea.thrust_over_weight < LEAST_THRUST_OVER_WEIGHT => "below 0".to_owned(),
        None => format!("above {TOP_M}"),
    };
    let each = |value: &dyn Fn(&AtAltitude) -> String| {
        let values: Vec<String> = air.altitudes.iter().map(value).collect();
        values.join(", ")
    };
    let altitudes = each(&|at| at.altitude_m.to_string());
    let over_weight = each(&|at| format!("{:.2}", at.thrust_over_weight));
    let throttle = each(&|at| match at.hover_throttle {
        Some(throttle) => format!("{throttle:.3}"),
        None => "none".to_owned(),
    });
    let corrected = match air.range_kg_m3 {
        Some([low, high]) => format!("density is corrected for from {low} to {high} kg/m3"),
        None => "density is not corrected for: no [air]".to_owned(),
    };
    let words = format!(
        ", thrust over weight {LEAST_THRUST_OVER_WEIGHT}; at {altitudes} m it is {over_weight}, hover throttle {throttle} in the mean of all rotors; {corrected}"
    );
    list.say("ceiling", ceiling, "m", words).in_verdict();
}

/// The inverse map: what is proven of it, and its tables.
fn inverse(list: &mut List, compiled: &Compiled) {
    let (airframe, of_pairs) = (&compiled.airframe, compiled.of_all_pairs());
    let evaluator = of_pairs.as_ref().map(|of| of.evaluator);
    let (name, words) = match evaluator {
        Some(evaluator) => (evaluator.name(), format!(": {}", evaluator.description())),
        None => Default::default(),
    };
    list.say("evaluator", name, "", words)
        .json("evaluator", evaluator.map(|evaluator| evaluator.name()))
        .json(
            "evaluator_description",
            evaluator.map(|evaluator| evaluator.description()),
        );
    let every = match (&airframe.voltage, &airframe.air) {
        (Some(_), Some(_)) => " at every voltage and density",
        (Some(_), None) => " at every voltage",
        (None, Some(_)) => " at every density",
        (None, None) => "",
    };
    let allowed = airframe.inverse.tolerances();
    for (effort, (name, unit, proven_key, observed_key)) in [
        ("thrust error", "N", "proven_thrust_n", "observed_thrust_n"),
        ("torque error", "N m", "proven_torque_nm", "observed_torque_nm"),
    ]
    .into_iter()
    .enumerate()
    {
        let (stated, allowed) = (compiled.stated[effort], allowed[effort]);
        let observed = of_pairs.as_ref().map(|of| of.residual.efforts[effort]);
        let words = match observed {
            Some(observed) => {
                let seen = rounded_up(observed);
                format!(" at most of a unit, proven{every}; allowed {allowed:?}, observed {seen}")
            }
            None => format!(" at most of a unit{every}, compared in every mix; allowed {allowed:?}"),
        };
        list.say(name, rounded_up(stated), unit, words)
            .json(proven_key, stated)
            .json(observed_key, observed)
            .in_verdict();
    }
    let json = of_pairs.as_ref().map(|of| {
        json!({
            "bound": of.certificate.stated,
            "bound_at_reference": of.certificate.reference,
            "over_observed": of.certificate.over_observed(&of.residual),
            "margin": of.certificate.margin(),
            "cells": of.certificate.cells,
        })
    });
    let proof = match &of_pairs {
        None => list.say("proof", "", "", ""),
        Some(of) => {
            let (left, points) = (100.0 * of.certificate.margin(), of.residual.points);
            let words = format!("; {left:.1} % of the tolerance left, {points} efforts observed");
            list.say("proof", of.certificate.cells, "cells", words)
        }
    };
    proof
        .json("observed_points", of_pairs.as_ref().map(|of| of.residual.points))
        .json("certificate", json);
    let lost = compiled.lost_outside_border;
    let cells = compiled.tables.closed_form.as_ref();
    let cells = cells.map_or(0, |table| table.cells.len().saturating_sub(1));
    let words = match lost {
        Err(reason) => format!("on the throttles, over the whole set: no closed form, as {reason}"),
        Ok(lost) => format!(
            "in closed form between sides of {cells} cells, which leave out {:.3} % of its area; rotors out on the throttles",
            100.0 * lost
        ),
    };
    list.say("desaturation", "", "", words)
        .json("attainable_area_lost_in_closed_form", lost.ok());
    let words = or_nothing(lost.ok(), |_| {
        "; without `mix_with_health` only what the closed form reads is linked".to_owned()
    });
    list.say("tables", compiled.tables.bytes(), "bytes", words)
        .json("table_bytes", compiled.tables.bytes())
        .in_verdict();
}

/// What costs are counted in.
const INSTRUCTIONS: &str = "instructions";

/// What a mix costs on the target.
fn costs(list: &mut List, compiled: &Compiled) {
    let cost = Cost::new(compiled);
    let inverses = cost.inverses_instructions.zip(cost.inverses_cycles);
    let inverses = cost.inverse_cycles.zip(inverses);
    let cycles = or_nothing(inverses, |(one, (all, all_cycles))| {
        format!(" ({one} cycles), of all {all} ({all_cycles})")
    });
    let (bytes, target) = (cost.inverse_bytes, cost.target);
    let words = format!("{cycles}; {bytes} bytes of constants; {target}");
    let estimated =
        |error: Option<f64>| or_nothing(error, |error| format!(", estimated to {:.0} %", 100.0 * error));
    let delivered = estimated(cost.delivered_error);
    let attainable = estimated(cost.attainable_error);
    let attainable = format!(" of a Cortex-M4F over attainable requests{attainable}");
    let desaturation = cost.desaturates();
    let any = format!(" at most, desaturation {desaturation}: the sum of what the code does at most");
    let (count, words) = match cost.inverse_instructions {
        Some(count) => (count.to_string(), words),
        None if compiled.of_pairs.is_empty() => Default::default(),
        None => (String::new(), format!("not counted{words}")),
    };
    list.say("inverse of a unit", count, INSTRUCTIONS, words)
        .json("cost", &cost);
    list.count("mix by least norm", cost.delivered_instructions, delivered);
    // On the general path it depends on the frame too much.
    if let Some(mean) = cost.attainable_instructions {
        list.count("mix in the mean", Some(mean), attainable).in_verdict();
    }
    let bound = cost.bound_instructions;
    list.count("mix of any request", bound, any)
        .in_verdict_if(bound.is_some());
    let out = " at most, however many".to_owned();
    list.count("mix, rotors out", cost.bound_with_rotors_out_instructions, out);
}
