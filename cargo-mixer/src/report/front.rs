//! The evaluators that the compiler chooses from, with what each would miss on this airframe: why the chosen one.

use mixer_compiler::airframe::Method;
use mixer_compiler::evaluator::Evaluator;
use mixer_compiler::inversion::Inversion;
use mixer_compiler::residual::Residual;
use mixer_compiler::tables::{InverseTable, MixerTables};

use super::study::Study;

/// One evaluator on this airframe.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// In words.
    pub description: String,
    /// Bytes of all tables with it.
    pub table_bytes: usize,
    /// Largest error over the attainable set at the reference voltage, N and N m, as observed.
    pub error: [f64; 2],
    /// Whether that is within the file's tolerance at every voltage.
    pub within: bool,
    /// Whether it is the one that is emitted.
    pub chosen: bool,
}

/// All evaluators by ascending cost on the target.
pub fn front(study: &Study<'_>) -> Vec<Candidate> {
    let tables = &study.compiled.tables;
    let tolerance = tables.tolerance.efforts.map(f64::from);
    let mut inversion = Inversion::new(&study.pair, tolerance);
    let mut evaluators = Evaluator::candidates(&Method::Auto);
    if !evaluators.contains(&study.compiled.evaluator) {
        evaluators.push(study.compiled.evaluator);
    }
    evaluators
        .into_iter()
        .map(|evaluator| {
            let chosen = evaluator == study.compiled.evaluator;
            let inverse = if chosen {
                tables.inverse.clone()
            } else {
                InverseTable::new(&inversion.fit(evaluator).0)
            };
            let with = MixerTables {
                inverse,
                ..tables.clone()
            };
            let residual = Residual::over_set(&study.pair, &with);
            Candidate {
                description: evaluator.description(),
                table_bytes: with.bytes(),
                error: residual.efforts,
                within: residual.within(tolerance),
                chosen,
            }
        })
        .collect()
}
