//! What the vehicle is: frame, axes, thrust and authority.

use itertools::join;
use mixer_compiler::Compiled;
use mixer_compiler::airframe::Airframe;
use mixer_compiler::hover::HoverAt;

use super::list::{List, or_nothing};
use crate::checklist;

/// Share of the largest bare thrust at which the authority of any vehicle is looked at.
const SHARE: f64 = 0.4;

/// Units in a line of the frame.
const UNITS_A_LINE: usize = 3;

/// Name, rotors, frame, served axes and the condition of M.
pub(super) fn gives(list: &mut List, compiled: &Compiled) {
    let (airframe, m) = (&compiled.airframe, &compiled.effectiveness);
    let axes: Vec<&str> = airframe.allocation.axes.iter().map(|axis| axis.name()).collect();
    let description = Some(&airframe.description).filter(|text| !text.is_empty());
    let words = or_nothing(description, |text| format!(": {text}"));
    list.say("airframe", &airframe.name, "", words)
        .json("name", &airframe.name)
        .in_verdict();
    rotors(list, airframe);
    let frame = checklist::frame(airframe);
    let lines = frame.chunks(UNITS_A_LINE).map(|units| units.join("; "));
    list.say("frame", "", "", join(lines, &format!(";\n{:20}", "")))
        .json("frame", frame.join("; "))
        .in_verdict();
    list.say("served axes", axes.join(", "), "", "")
        .json("axes", &axes)
        .in_verdict();
    let words = format!("; rank {} of {} served axes", m.rank, axes.len());
    list.say("condition of M", format!("{:.4}", m.condition), "", words)
        .json("rank", m.rank)
        .json("condition", m.condition);
}

/// Rotors, units and arms.
fn rotors(list: &mut List, airframe: &Airframe) {
    let units = airframe.units.iter();
    let arms = units.map(|unit| libm::hypot(unit.position_m[0], unit.position_m[1]));
    let arms = [arms.clone().fold(f64::MAX, f64::min), arms.fold(0.0, f64::max)];
    let of_arms = match arms.map(|arm| format!("{arm:.3}")) {
        [_, longest] if longest == "0.000" => String::new(),
        [shortest, longest] if shortest == longest => format!(", arms of {longest} m"),
        [shortest, longest] => format!(", arms of {shortest} to {longest} m"),
    };
    let units = airframe.units.len();
    let single = airframe.single_units();
    let pairs = match units - single {
        1 => " in 1 coaxial unit".to_owned(),
        pairs => format!(" in {pairs} coaxial units"),
    };
    let words = match single {
        0 => pairs + &of_arms,
        _ if single == units => format!(", all single{of_arms}"),
        _ => format!("{pairs} and {single} single ones{of_arms}"),
    };
    list.say("rotors", airframe.rotors(), "", words)
        .json("units", units)
        .json("rotors", airframe.rotors())
        .json("arms_m", arms)
        .in_verdict();
}

/// Thrust without torque, and what is left of torque beside a share of it.
pub(super) fn thrust(list: &mut List, compiled: &Compiled) {
    let airframe = &compiled.airframe;
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
