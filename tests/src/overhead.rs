//! The compiler's model of what a mix costs, fitted to `tests/counts.csv`.
//!
//! `mixer-compiler/src/output/cost/counted.rs` is written by `cargo xtask counts --fit`, and with
//! the counts themselves by `--bless`. It follows from them and from the evaluators' counts alone.

use std::fs;
use std::path::PathBuf;

use mixer_compiler::Compiled;
use mixer_compiler::cost::{Cost, Counted, DesaturationKind, Overhead};
use nalgebra::{DMatrix, DVector};

use crate::counts::Row;
use crate::frames::counted;
use crate::{frames, golden, root};

/// A counted mixer with what its cost is modelled by.
#[derive(Clone, Debug)]
pub struct Sample {
    /// As in [`Row::subject`].
    pub airframe: String,
    /// How it desaturates.
    pub kind: DesaturationKind,
    /// Number of units.
    pub units: usize,
    /// All thrust axes are vertical: then least norm delivers most wrenches that random throttles
    /// give.
    pub vertical: bool,
    /// With a voltage correction.
    pub voltage: bool,
    /// Instructions of its evaluator, one unit.
    pub inverse: u32,
    /// The most instructions of any request, where the compiler states a bound.
    pub bound: Option<u32>,
    /// What was counted.
    pub row: Row,
}

/// What is modelled of a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Requests that least norm delivers: the median over attainable ones stands for them.
    Delivered,
    /// The mean over attainable requests.
    Attainable,
}

impl Sample {
    /// The quantities that there is a model of.
    pub fn quantities(&self) -> &'static [Quantity] {
        match self.kind {
            DesaturationKind::ClosedForm => &[Quantity::Delivered, Quantity::Attainable],
            DesaturationKind::General if self.vertical => &[Quantity::Delivered],
            DesaturationKind::General => &[],
        }
    }

    /// What was counted, instructions.
    pub fn counted(&self, quantity: Quantity) -> f64 {
        match quantity {
            Quantity::Delivered => self.row.get("attainable_median") as f64,
            Quantity::Attainable => self.row.mean("attainable"),
        }
    }

    /// Which of the overheads the model takes.
    pub fn overhead(&self, counted: &Counted, quantity: Quantity) -> Overhead {
        match quantity {
            Quantity::Delivered => counted.delivered(self.kind),
            Quantity::Attainable => counted.closed_form_mean,
        }
    }

    /// What the model says over what was counted, less one.
    pub fn error(&self, counted: &Counted, quantity: Quantity) -> f64 {
        let overhead = self.overhead(counted, quantity);
        let modelled = counted.mix(overhead, self.units, self.inverse, self.voltage);
        modelled / self.counted(quantity) - 1.0
    }

    /// Factors of the model's parameters: per mix and per unit of each overhead, per voltage.
    fn factors(&self, quantity: Quantity) -> [f64; PARAMETERS] {
        let mut factors = [0.0; PARAMETERS];
        let overhead = match (self.kind, quantity) {
            (DesaturationKind::ClosedForm, Quantity::Delivered) => CLOSED_FORM,
            (DesaturationKind::ClosedForm, Quantity::Attainable) => CLOSED_FORM_MEAN,
            (DesaturationKind::General, _) => GENERAL,
        };
        factors[overhead] = 1.0;
        factors[overhead + 1] = self.units as f64;
        factors[PER_VOLTAGE] = f64::from(u8::from(self.voltage));
        factors
    }
}

/// Places of the parameters, an overhead's per mix and then per unit.
const CLOSED_FORM: usize = 0;
const CLOSED_FORM_MEAN: usize = 2;
const GENERAL: usize = 4;
const PER_VOLTAGE: usize = 6;
const PARAMETERS: usize = 7;

/// The coaxial mixers among counted rows, compiled.
///
/// # Errors
/// An airframe that is not there, is refused, or has an evaluator that has not been counted.
pub fn samples(rows: &[Row]) -> Result<Vec<Sample>, String> {
    let mut measured = counted::all();
    let airframes = crate::airframes().map_err(|error| format!("airframes/: {error}"))?;
    measured.extend(airframes.iter().filter_map(|name| {
        let text = std::fs::read_to_string(root().join(format!("airframes/{name}.toml"))).ok()?;
        counted::y6(name, &text)
    }));
    let coaxial = rows.iter().filter(|row| row.subject.mixer == "coaxial");
    coaxial
        .map(|row| {
            let name = &row.subject.airframe;
            let compiled = match measured.iter().find(|(known, _)| known == name) {
                Some((_, text)) => frames::compile_text(text)?,
                None => golden::compile(name)?,
            };
            sample(&compiled, row).ok_or_else(|| format!("{name}: its evaluator has not been counted"))
        })
        .collect()
}

fn sample(compiled: &Compiled, row: &Row) -> Option<Sample> {
    let units = compiled.airframe.units.len();
    let one = compiled.evaluator.instructions(compiled.airframe.pair.basis)?;
    Some(Sample {
        airframe: row.subject.airframe.clone(),
        kind: DesaturationKind::of(compiled),
        units,
        vertical: compiled
            .airframe
            .units
            .iter()
            .all(|unit| unit.axis == [0.0, 0.0, -1.0]),
        voltage: compiled.airframe.voltage.is_some(),
        inverse: one,
        bound: Cost::new(compiled).bound_instructions,
        row: row.clone(),
    })
}

/// Least squares of the relative errors.
///
/// # Errors
/// Too few kinds of frames for the model's parameters.
pub fn fit(samples: &[Sample]) -> Result<Counted, String> {
    let known: Vec<(&Sample, Quantity)> = samples
        .iter()
        .flat_map(|sample| {
            sample
                .quantities()
                .iter()
                .map(move |&quantity| (sample, quantity))
        })
        .collect();
    let matrix = DMatrix::from_fn(known.len(), PARAMETERS, |row, column| {
        let (sample, quantity) = known[row];
        sample.factors(quantity)[column] / sample.counted(quantity)
    });
    let beside = known.iter().map(|(sample, quantity)| {
        let inverses = sample.units as f64 * f64::from(sample.inverse);
        1.0 - inverses / sample.counted(*quantity)
    });
    let beside = DVector::from_iterator(known.len(), beside);
    let svd = matrix.svd(true, true);
    if svd.rank(1e-9) < PARAMETERS {
        return Err("the counted frames do not tell the overheads apart".into());
    }
    let found = svd.solve(&beside, 1e-9)?;
    // Tenths of an instruction are more than enough.
    let tenths = |index: usize| (10.0 * found[index]).round() / 10.0;
    let overhead = |first: usize| Overhead {
        per_mix: tenths(first),
        per_unit: tenths(first + 1),
        error: 0.0,
    };
    let mut counted = Counted {
        per_voltage: tenths(PER_VOLTAGE),
        closed_form: overhead(CLOSED_FORM),
        closed_form_mean: overhead(CLOSED_FORM_MEAN),
        general: overhead(GENERAL),
    };
    let error = |kinds: &[DesaturationKind], of: Quantity| {
        let errors = known
            .iter()
            .filter(|(sample, quantity)| kinds.contains(&sample.kind) && *quantity == of)
            .map(|(sample, quantity)| sample.error(&counted, *quantity).abs());
        // Thousandths, rounded up.
        (1e3 * errors.fold(0.0, f64::max)).ceil() / 1e3
    };
    let errors = [
        error(&[DesaturationKind::ClosedForm], Quantity::Delivered),
        error(&[DesaturationKind::ClosedForm], Quantity::Attainable),
        error(&[DesaturationKind::General], Quantity::Delivered),
    ];
    counted.closed_form.error = errors[0];
    counted.closed_form_mean.error = errors[1];
    counted.general.error = errors[2];
    Ok(counted)
}

/// The file that holds the fit.
pub fn file() -> PathBuf {
    root().join("mixer-compiler/src/output/cost/counted.rs")
}

/// Writes [`file()`].
///
/// # Errors
/// It cannot be written.
pub fn write(compiler: &str, counted: &Counted) -> Result<(), String> {
    let path = file();
    fs::write(&path, text(compiler, counted)).map_err(|error| format!("{}: {error}", path.display()))
}

/// The content of [`file()`].
pub fn text(compiler: &str, counted: &Counted) -> String {
    let overhead = |Overhead {
                        per_mix,
                        per_unit,
                        error,
                    }: Overhead| {
        format!(
            "Overhead {{\n        per_mix: {per_mix:?},\n        per_unit: {per_unit:?},\n        error: {error:?},\n    }}"
        )
    };
    let text = format!(
        "//! @generated by `cargo xtask counts --fit` from `tests/counts.csv`; do not edit.\n\n\
         use super::overhead::{{Counted, Overhead}};\n\n\
         /// Firmware built by {compiler}.\n\
         pub const COUNTED: Counted = Counted {{\n    per_voltage: {:?},\n    closed_form: {},\n    closed_form_mean: {},\n    general: {},\n}};\n",
        counted.per_voltage,
        overhead(counted.closed_form),
        overhead(counted.closed_form_mean),
        overhead(counted.general)
    );
    text
}
