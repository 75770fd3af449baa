//! The battery's voltage and the air's density.

use itertools::join;
use mixer_compiler::Compiled;
use mixer_compiler::atmosphere::TOP_M;

use super::list::List;
use crate::air::{Air, AtAltitude, LEAST_THRUST_OVER_WEIGHT};

/// The battery's voltage.
pub(super) fn voltage(list: &mut List, compiled: &Compiled) {
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
pub(super) fn air(list: &mut List, compiled: &Compiled) {
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
    let each = |value: &dyn Fn(&AtAltitude) -> String| join(air.altitudes.iter().map(value), ", ");
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
