//! The model of what a mix takes beside the evaluators.

use serde::Serialize;

use crate::compiled::Compiled;

/// How a mixer brings a request within the attainable set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum DesaturationKind {
    /// Vertical axes and up to four units: a few cases, each solved at once.
    ClosedForm,
    /// Any other layout: a dual simplex method of bounded work.
    General,
}

impl DesaturationKind {
    /// The kind of a compiled airframe.
    pub fn of(compiled: &Compiled) -> DesaturationKind {
        match &compiled.tables.closed_form {
            Some(_) => DesaturationKind::ClosedForm,
            None => DesaturationKind::General,
        }
    }

    /// For people, after "desaturates".
    pub fn description(self) -> &'static str {
        match self {
            DesaturationKind::ClosedForm => "in closed form",
            DesaturationKind::General => "by a bounded simplex method",
        }
    }
}

/// Overheads of all mixers beside the evaluators, from one set of counts.
#[derive(Clone, Debug, PartialEq)]
pub struct Counted {
    /// Instructions more with a voltage correction.
    pub per_voltage: f64,
    /// Requests that least norm delivers, of mixers that desaturate in closed form.
    pub closed_form: Overhead,
    /// The mean over attainable requests of the same mixers, some of which least norm does not
    /// deliver.
    pub closed_form_mean: Overhead,
    /// Requests that least norm delivers, of all other mixers.
    pub general: Overhead,
}

/// Instructions beside the evaluators'.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overhead {
    /// Per mix: checks, voltage, allocation.
    pub per_mix: f64,
    /// Per unit: allocation, channels, the achieved wrench.
    pub per_unit: f64,
    /// Largest error of the model over the frames that it is fitted to, as a share of their counts.
    pub error: f64,
}

impl Counted {
    /// The overhead of requests that least norm delivers.
    pub fn delivered(&self, kind: DesaturationKind) -> Overhead {
        match kind {
            DesaturationKind::ClosedForm => self.closed_form,
            DesaturationKind::General => self.general,
        }
    }

    /// The overhead of the mean over attainable requests, where there is a model of it.
    pub fn attainable(&self, kind: DesaturationKind) -> Option<Overhead> {
        (kind == DesaturationKind::ClosedForm).then_some(self.closed_form_mean)
    }

    /// Instructions of a mix with as many `units`, whose evaluator takes `one` instructions for
    /// each.
    pub fn mix(&self, overhead: Overhead, units: usize, one: u32, voltage: bool) -> f64 {
        let voltage = if voltage { self.per_voltage } else { 0.0 };
        overhead.per_mix + units as f64 * (overhead.per_unit + f64::from(one)) + voltage
    }
}
