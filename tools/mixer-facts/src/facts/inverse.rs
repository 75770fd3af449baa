//! The inverse map: what is proven of it, its tables, and what a mix costs.

use mixer_compiler::Compiled;
use mixer_compiler::diagnostic::rounded_up;
use serde_json::json;

use super::list::{INSTRUCTIONS, List, or_nothing};
use crate::cost::Cost;

/// The evaluator of the inverse map, and what is proven of its errors.
pub(super) fn proven(list: &mut List, compiled: &Compiled) {
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
}

/// The closed form of desaturation, and the bytes of all tables.
pub(super) fn tables(list: &mut List, compiled: &Compiled) {
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

/// What a mix costs on the target.
pub(super) fn costs(list: &mut List, compiled: &Compiled) {
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
