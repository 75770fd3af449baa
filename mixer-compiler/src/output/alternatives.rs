//! Every evaluator for one airframe, with what it costs and what it misses: why the choice fell as
//! it did.
//!
//! This fits and proves all of them, which takes seconds without optimisation. It is for reports;
//! [`compile`] stops at the first that is proven.
//!
//! [`compile`]: crate::compile

use serde::Serialize;

use crate::airframe::Method;
use crate::compiled::Compiled;
use crate::inverse::evaluator::Evaluator;
use crate::inverse::fit::Inversion;
use crate::output::cost;
use crate::proof::residual::Residual;
use crate::proof::{self, CorrectionBounds};
use crate::tables::{InverseTable, Part, UnitMap};

/// One evaluator as it would be emitted.
#[derive(Clone, Debug, Serialize)]
pub struct Alternative {
    /// The name as in `inverse.method`.
    pub evaluator: String,
    /// The name with its parameters, for people.
    pub description: String,
    /// Instructions per unit on a Cortex-M4F: [`Evaluator::instructions`].
    pub instructions: Option<u32>,
    /// About the cycles per unit on a Cortex-M4F: [`Evaluator::cost`].
    pub cost: Option<u32>,
    /// About the instructions of a whole mix of this airframe: [`cost::delivered`].
    pub delivered: Option<u32>,
    /// Bytes of its own constants: coordinates and coefficients, without the forward map.
    pub bytes: usize,
    /// Proven bounds at every voltage, `[N, N m]`; infinite where nothing could be proven.
    pub proven: [f64; 2],
    /// Largest residuals observed at the reference voltage, `[N, N m]`.
    pub observed: [f64; 2],
    /// True where the file's tolerance is proven.
    pub holds: bool,
    /// True for the one that the compiler chose.
    pub chosen: bool,
}

impl Alternative {
    /// Whether it was chosen or would do, in a word or two.
    pub fn verdict(&self) -> &'static str {
        match (self.chosen, self.holds) {
            (true, _) => "chosen",
            (false, true) => "would do",
            (false, false) => "",
        }
    }
}

impl Compiled {
    /// All evaluators that `method = "auto"` tries, in its order: by cost.
    pub fn front(&self) -> Vec<Alternative> {
        let pair = &self.pair;
        let correction = CorrectionBounds::new(&self.airframe, self.tables.voltage.as_ref());
        let basis = self.airframe.pair.basis;
        let tolerance = correction.tolerance_at_reference(&self.airframe);
        let mut inversion = Inversion::new(pair, tolerance, true);
        let alternative = |evaluator: Evaluator| {
            let inverse = InverseTable::new(&inversion.fit(evaluator).0);
            let map = UnitMap::new(&self.airframe, inverse);
            let mut observed = Residual::over_set(pair, &map);
            let certificate = proof::prove(&self.airframe, pair, &map, &correction, &mut observed, true);
            Alternative {
                evaluator: evaluator.name().to_owned(),
                description: evaluator.description(),
                instructions: evaluator.instructions(basis),
                cost: evaluator.cost(basis),
                delivered: cost::delivered(self, evaluator),
                bytes: map.inverse.bytes(),
                proven: certificate.stated,
                observed: observed.efforts,
                holds: certificate.holds(),
                chosen: evaluator == self.evaluator,
            }
        };
        Evaluator::candidates(&Method::Auto)
            .into_iter()
            .map(alternative)
            .collect()
    }
}
