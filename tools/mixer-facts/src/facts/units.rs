//! The units' maps, how their rotors follow, what a rotor out leaves, and power.

use mixer_compiler::Compiled;
use mixer_compiler::airframe::{Kind, Uncertainty};
use mixer_compiler::dynamics::UNPROVEN;
use mixer_compiler::model::PairMap;
use mixer_compiler::power::LevelPower;
use serde_json::{Value, json};

use super::list::{List, one_or_list, or_nothing, whose};

/// Border points per edge of the throttle box at which the largest efforts are looked for.
const SAMPLES: usize = 64;

/// Basis, origin and uncertainty of the units' maps, their extent and their least determinant.
pub(super) fn model(list: &mut List, compiled: &Compiled) {
    let airframe = &compiled.airframe;
    let kinds: Vec<Kind<'_>> = airframe.views().map(|view| view.of).collect();
    origin(list, compiled, &kinds);
    for (name, unit, k, decimals) in [("thrust of a unit", "N", 0, 3), ("torque of a unit", "N m", 1, 4)] {
        let extent = kinds.iter().map(|kind| {
            let map = PairMap::of_kind(*kind, &airframe.throttle);
            let values = map.border(SAMPLES).into_iter().map(|at| map.efforts(at)[k]);
            let widen = |[low, high]: [f64; 2], x: f64| [low.min(x), high.max(x)];
            let [low, high] = values.fold([f64::INFINITY, f64::NEG_INFINITY], widen);
            let value = format!("{low:.decimals$} to {high:.decimals$}");
            (*kind, value, String::new())
        });
        list.say_of_each(name, unit, kinds.len(), extent);
    }
    let least = compiled.of_pairs.iter();
    let least: Vec<f64> = least.map(|of| of.injectivity.least_determinant).collect();
    let pairs = airframe.pairs.iter().zip(&compiled.of_pairs).zip(&least);
    let det_j = pairs.map(|((pair, of), least)| {
        let words = format!(" at least: proven invertible, with idles from {}", of.least_idle);
        (Kind::Pair(pair), format!("{least:.4e}"), words)
    });
    list.say_of_each("det J", "N N m", kinds.len(), det_j)
        .json("least_det_j", one_or_list(&least));
}

/// What the maps are, whose, and how uncertain.
fn origin(list: &mut List, compiled: &Compiled, kinds: &[Kind<'_>]) {
    let airframe = &compiled.airframe;
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
    let name = match airframe.single_rotors.is_empty() {
        true => "pair",
        false => "units",
    };
    list.say_of_each(name, "", kinds.len(), told)
        .in_verdict_if(uncertainty.iter().any(Option::is_some) || borrowed.iter().any(Option::is_some))
        .json("borrowed_from", one_or_list(&borrowed))
        .json("uncertainty", one_or_list(&uncertainty));
}

/// How rotors follow, for `mix_dynamic`.
pub(super) fn dynamics(list: &mut List, compiled: &Compiled) {
    let of_kinds = compiled.dynamics.as_deref().unwrap_or_default();
    let each = compiled.airframe.views().zip(of_kinds).map(|(view, of)| {
        let origin = match of.is_estimated {
            true => "0.7 of an estimate; measure it for `mix_dynamic` (docs/bench.md)",
            false => "as the file says",
        };
        let (throttle, shift) = (of.throttle, of.shift_per_square);
        let words = format!(
            " at throttle {throttle:.2}, {origin}; where a rotor is d of throttle off, `mix_dynamic` shifts by {shift:.1} d^2 at most"
        );
        (view.of, format!("{:.3}", of.lag_s), words)
    });
    match of_kinds.len() {
        0 => list.say("rotors' lag", "", "", UNPROVEN),
        kinds => list.say_of_each("rotors' lag", "s", kinds, each),
    }
    .json("dynamics", one_or_list(of_kinds))
    .in_verdict();
}

/// Where the map of a rotor comes from whose partner is out.
pub(super) fn rotor_out(list: &mut List, compiled: &Compiled) {
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
}

/// Electrical power in level flight, and what least power costs where a rotor stops.
pub(super) fn power(list: &mut List, compiled: &Compiled) {
    let airframe = &compiled.airframe;
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
