//! The compiler's statements of cost beside what was counted.

use mixer_compiler::Compiled;
use mixer_facts::cost::Cost;

use crate::counts::Row;
use crate::frames::counted;
use crate::{frames, golden, root};

/// A counted mixer with what the compiler says of it.
#[derive(Clone, Debug)]
pub struct Sample {
    /// The counted row.
    pub row: Row,
    /// The compiler's statement of cost.
    pub cost: Cost,
    /// All thrust axes are vertical: then least norm delivers most wrenches that random throttles
    /// give.
    vertical: bool,
}

impl Sample {
    /// The compiler's estimates: their names, what was counted, what is estimated, and the largest
    /// error that is stated, as a share.
    pub fn estimates(&self) -> Vec<(&'static str, f64, u32, f64)> {
        let Cost {
            delivered_instructions,
            delivered_error,
            attainable_instructions,
            attainable_error,
            ..
        } = self.cost;
        let delivered = delivered_instructions
            .zip(delivered_error)
            .filter(|_| self.vertical);
        let attainable = attainable_instructions.zip(attainable_error);
        let median = self.row.get("attainable_median") as f64;
        [
            ("delivered", median, delivered),
            ("attainable", self.row.mean("attainable"), attainable),
        ]
        .into_iter()
        .filter_map(|(name, counted, stated)| {
            stated.map(|(estimate, error)| (name, counted, estimate, error))
        })
        .collect()
    }

    /// The bound that the compiler states for the rotors of this row.
    pub fn bound(&self) -> Option<u32> {
        if self.row.subject.rotors_out() > 0 {
            self.cost.bound_with_rotors_out_instructions
        } else {
            self.cost.bound_instructions
        }
    }
}

/// The coaxial mixers among counted rows, with all rotors and with rotors out, compiled.
///
/// # Errors
/// An airframe that is not there or is refused.
pub fn samples(rows: &[Row]) -> Result<Vec<Sample>, String> {
    let mut measured = counted::all();
    let airframes = crate::airframes().map_err(|error| format!("airframes/: {error}"))?;
    measured.extend(airframes.iter().filter_map(|name| {
        let text = std::fs::read_to_string(root().join(format!("airframes/{name}.toml"))).ok()?;
        counted::y6(name, &text)
    }));
    let ours = rows.iter().filter(|row| row.subject.is_ours());
    ours.map(|row| {
        let name = &row.subject.airframe;
        let compiled = match measured.iter().find(|(known, _)| known == name) {
            Some((_, text)) => frames::compile_text(text)?,
            None => golden::compile(name)?,
        };
        Ok(sample(&compiled, row))
    })
    .collect()
}

fn sample(compiled: &Compiled, row: &Row) -> Sample {
    Sample {
        row: row.clone(),
        cost: Cost::new(compiled),
        vertical: compiled.effectiveness.is_vertical(),
    }
}
