//! What evaluators of the inverse map cost on the target, counted by the `evaluators` image of
//! `tests/firmware`.

use crate::firmware::{Toolchain, Variant};

/// Name of an evaluator, a polynomial's with its degree, and instructions per unit with a
/// biquadratic, a cubic and a quartic pair.
pub type Count = (String, [u32; 3]);

/// Counts all evaluators, in the image's order.
///
/// # Errors
/// As [`Toolchain::run`], or if the image prints something else.
pub fn counted(toolchain: &Toolchain) -> Result<Vec<Count>, String> {
    let text = toolchain.run("evaluators", &Variant::default())?;
    let mut counts: Vec<Count> = Vec::new();
    for line in text.lines() {
        let fault = || format!("not a count: {line}");
        let cells: Vec<&str> = line.split_whitespace().collect();
        let [name, basis, count] = cells[..] else {
            return Err(fault());
        };
        let bases = ["biquadratic", "cubic", "quartic"];
        let index = bases.iter().position(|known| *known == basis).ok_or_else(fault)?;
        if index == 0 {
            counts.push((name.to_owned(), [0; 3]));
        }
        let last = counts
            .last_mut()
            .filter(|last| last.0 == name)
            .ok_or_else(fault)?;
        last.1[index] = count.parse().map_err(|_| fault())?;
    }
    Ok(counts)
}
