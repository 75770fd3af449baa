//! What a mix costs on a Cortex-M4F.
//!
//! The inverse map is counted on its own, evaluator by evaluator
//! ([`mixer_compiler::evaluator::Evaluator::instructions`]). What a mix takes that delivers its request is estimated
//! (`cost/typical.rs`); any request takes at most what the code does at most (`cost/bound.rs`).

mod bound;
mod typical;

use serde::Serialize;

use mixer_compiler::Compiled;

/// What counts are of.
pub const TARGET: &str = "Cortex-M4F, counted in QEMU";

/// What one airframe costs: instructions, and cycles where they are known.
#[derive(Clone, Debug, Serialize)]
pub struct Cost {
    /// [`TARGET`].
    pub target: &'static str,
    /// The inverse map of one unit, counted; `None` for an evaluator that has not been.
    pub inverse_instructions: Option<u32>,
    /// The inverse map of one unit, with the cycles that divisions and roots take longer.
    pub inverse_cycles: Option<u32>,
    /// The inverse map of all units that are pairs.
    pub inverses_instructions: Option<u32>,
    /// The inverse map of all units that are pairs.
    pub inverses_cycles: Option<u32>,
    /// The whole mix of a request that least norm delivers, estimated.
    pub delivered_instructions: Option<u32>,
    /// Largest error of this estimate over counted frames, as a share.
    pub delivered_error: Option<f64>,
    /// The mean of mixes of attainable requests, estimated; `None` where it depends on the frame
    /// too much.
    pub attainable_instructions: Option<u32>,
    /// Largest error of this estimate over counted frames, as a share.
    pub attainable_error: Option<f64>,
    /// How the mixer desaturates: `closed-form`, or `general`, an interior point method.
    pub desaturation: &'static str,
    /// The most that any request takes, by what the code does at most; `None` where no bound is
    /// stated.
    pub bound_instructions: Option<u32>,
    /// The same while rotors are out, however many.
    pub bound_with_rotors_out_instructions: Option<u32>,
    /// Bytes of the inverse map's own constants.
    pub inverse_bytes: usize,
    /// Bytes of all tables.
    pub table_bytes: usize,
}

impl Cost {
    /// The cost of a compiled airframe.
    pub fn new(compiled: &Compiled) -> Self {
        let pairs = compiled.airframe.pair_units();
        let delivered = typical::delivered(compiled);
        let attainable = typical::attainable(compiled);
        let all = |one: Option<u32>| one.map(|one| one * pairs as u32);
        let inverse = compiled.inverse();
        let inverse_instructions = inverse.and_then(|(evaluator, basis)| evaluator.instructions(basis));
        let inverse_cycles = inverse.and_then(|(evaluator, basis)| evaluator.cost(basis));
        Cost {
            target: TARGET,
            inverse_instructions,
            inverse_cycles,
            inverses_instructions: all(inverse_instructions),
            inverses_cycles: all(inverse_cycles),
            delivered_instructions: delivered.map(|estimate| estimate.instructions),
            delivered_error: delivered.map(|estimate| estimate.error),
            attainable_instructions: attainable.map(|estimate| estimate.instructions),
            attainable_error: attainable.map(|estimate| estimate.error),
            desaturation: match compiled.tables.closed_form {
                Some(_) => "closed-form",
                None => "general",
            },
            bound_instructions: bound::bound(compiled),
            bound_with_rotors_out_instructions: bound::with_rotors_out(compiled),
            inverse_bytes: compiled.tables.inverse_bytes(),
            table_bytes: compiled.tables.bytes(),
        }
    }

    /// How the mixer desaturates, for people.
    pub fn desaturates(&self) -> &'static str {
        match self.desaturation {
            "closed-form" => "in closed form",
            _ => "by a fixed number of iterations",
        }
    }
}
