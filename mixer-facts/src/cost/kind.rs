//! How a mixer desaturates, which decides what it costs.

use serde::Serialize;

use mixer_compiler::Compiled;

/// How a mixer brings a request within the attainable set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum DesaturationKind {
    /// Vertical axes and up to four units: a few cases, each solved at once.
    ClosedForm,
    /// Any other layout: an interior point method of a fixed number of iterations.
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
            DesaturationKind::General => "by a fixed number of iterations",
        }
    }
}
