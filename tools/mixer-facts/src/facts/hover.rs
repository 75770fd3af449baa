//! The vehicle in hover, with all its rotors and with one out.

use itertools::join;
use mixer_compiler::Compiled;
use mixer_compiler::flywheel::Flywheel;
use mixer_compiler::hover::HoverAt;

use super::list::{List, one_or_list, or_nothing, whose};
use crate::hover::Hover;

/// Mass, thrust over weight, throttles and what torque is left.
pub(super) fn hover(list: &mut List, compiled: &Compiled) {
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
    inertia(list, compiled, &flywheels);
    let over_weight = format!("{:.2}", hover.thrust_over_weight);
    list.say("thrust over weight", over_weight, "", " at most")
        .in_verdict();
    for (at, name) in hover.at.iter().rev().zip(["hover", "hover, lowest V"]) {
        at_voltage(list, name, at);
    }
    if let Some(at) = hover.at.last().filter(|at| !at.rotor_out.is_empty()) {
        rotor_out(list, compiled, at);
    }
}

/// The rotors of each kind as flywheels.
fn inertia(list: &mut List, compiled: &Compiled, flywheels: &[Option<Flywheel>]) {
    let of_rotors = compiled.airframe.views().zip(flywheels).filter_map(|(view, rotor)| {
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
    let words = join(of_rotors, "; ");
    if !words.is_empty() {
        list.say("rotors' inertia", "", "", words).in_verdict();
    }
}

/// Throttles at one voltage, and the torques that are left there.
fn at_voltage(list: &mut List, name: &'static str, at: &HoverAt) {
    let volts = or_nothing(at.voltage_v, |volts| format!(" at {volts:?} V"));
    if at.layers.is_empty() {
        let words = format!("the weight is not carried{volts}");
        list.say(name, "", "", words).in_verdict();
        return;
    }
    let left = at.margins.iter().map(|margin| {
        let [least, largest] = margin.torque_nm;
        let band = or_nothing(margin.band_nm, |band| format!(" +- {band:.3}"));
        format!("{} {least:.3} to {largest:.3}{band}", margin.axis)
    });
    let left = Some(join(left, ", ")).filter(|left| !left.is_empty());
    let left = or_nothing(left, |left| format!("; left (N m): {left}"));
    let band = or_nothing(at.throttle_band.as_ref(), |[least, most]| {
        let ends = least.iter().zip(most).zip(&at.layers);
        let ends = ends.map(|((least, most), of)| {
            let name = if at.layers.len() > 1 { of.layer } else { "" };
            format!("{least:.3} to {most:.3} {name}").trim_end().to_owned()
        });
        format!("; by the model's uncertainty {}", join(ends, ", "))
    });
    let throttle = at.layers.iter().map(|of| layer(of.throttle, of.outputs));
    let names: Vec<&str> = at.layers.iter().map(|of| of.layer).collect();
    let of_layers = match names.as_slice() {
        [_] => String::new(),
        names => format!(" of {} rotors", names.join(", ")),
    };
    let words = format!(" throttle{of_layers}{volts}{left}{band}");
    list.say(name, join(throttle, ", "), "", words).in_verdict();
}

/// Least and greatest throttle of a layer with their outputs; one number where they are alike.
fn layer([least, greatest]: [f64; 2], [lowest, highest]: [usize; 2]) -> String {
    match [least, greatest].map(|throttle| format!("{throttle:.3}")) {
        [low, high] if low == high => low,
        [low, high] => format!("{low} (output {lowest}) to {high} (output {highest})"),
    }
}

/// The yaw that is left with the worst upper and the worst lower rotor out.
fn rotor_out(list: &mut List, compiled: &Compiled, at: &HoverAt) {
    let each = at.rotor_out.iter().map(|out| {
        let yaw = out.yaw_nm.map_or("no level flight".to_owned(), |[least, most]| {
            format!("yaw {least:.3} to {most:.3} N m")
        });
        let article = if out.layer == "upper" { "an" } else { "a" };
        let outputs = match out.not_level.as_slice() {
            [] | [_] => format!("output {}", out.output),
            several => {
                let several = several.iter().map(usize::to_string);
                format!("any of outputs {}", join(several, ", "))
            }
        };
        format!("{yaw} with {article} {} rotor out ({outputs})", out.layer)
    });
    let reserve = compiled.airframe.allocation.yaw_reserve_nm;
    let words = format!("{}; yaw reserve {reserve} N m", join(each, ", "));
    list.say("hover, rotor out", "", "", words).in_verdict();
}
