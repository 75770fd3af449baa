//! Tables of what the airframe costs on the target.

use maud::Markup;
use mixer_facts::cost::Cost;

use crate::number::fixed;
use crate::rows::facts_table;

/// Where an evaluator has not been counted.
const NOT_COUNTED: &str = "not counted";

/// The chosen evaluator and the whole mix.
pub fn facts(cost: &Cost) -> Markup {
    let inverse = |instructions: Option<u32>, cycles: Option<u32>| match (instructions, cycles) {
        (Some(instructions), Some(cycles)) => format!("{instructions} instructions, {cycles} cycles"),
        _ => NOT_COUNTED.to_owned(),
    };
    let delivered = match (cost.delivered_instructions, cost.delivered_error) {
        (Some(delivered), Some(error)) => format!(
            "about {delivered} instructions; the estimate is off by {} % at most on counted frames",
            fixed(100.0 * error, 0)
        ),
        _ => NOT_COUNTED.to_owned(),
    };
    let mut facts = vec![
        (
            "Inverse map of one unit",
            inverse(cost.inverse_instructions, cost.inverse_cycles),
        ),
        (
            "Inverse map of all units",
            inverse(cost.inverses_instructions, cost.inverses_cycles),
        ),
        ("Request that least norm delivers", delivered),
    ];
    if let (Some(attainable), Some(error)) = (cost.attainable_instructions, cost.attainable_error) {
        let error = fixed(100.0 * error, 0);
        facts.push((
            "Mean of attainable requests",
            format!("about {attainable} instructions; off by {error} % at most"),
        ));
    }
    if let Some(bound) = cost.bound_instructions {
        facts.push((
            "Any request",
            format!("at most {bound} instructions, the sum of what the code does at most"),
        ));
    }
    if let Some(bound) = cost.bound_with_rotors_out_instructions {
        facts.push((
            "Any request with rotors out",
            format!("at most {bound} instructions, however many are out"),
        ));
    }
    facts.push((
        "Constants",
        format!(
            "{} bytes of the inverse map, {} bytes in all",
            cost.inverse_bytes, cost.table_bytes
        ),
    ));
    facts_table(&facts)
}
