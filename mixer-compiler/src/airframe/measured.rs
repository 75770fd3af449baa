//! How a kind of unit was measured.

use super::correction::{self, Correction};
use super::uncertainty::{self, Uncertainty};
use crate::spec::Fields;
use crate::spec::keys::Key;

/// How a pair or a single rotor was measured.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Measured {
    /// Error of the model; `None` where the file has no `[pair.uncertainty]`, `[rotor.uncertainty]`.
    pub uncertainty: Option<Uncertainty>,
    /// Least and greatest voltage of the bench's rows, V, where they were not brought to one.
    pub bench_v: Option<[f64; 2]>,
    /// Laws of the voltage and of the air by which it was brought from its own bench's references to the frame's; `None`
    /// where its bench had these.
    pub own_laws: [Option<Correction>; 2],
}

/// The keys are those of the fields, of the table of the kind.
pub(super) fn read(
    table: &mut Fields<'_, '_>,
    [uncertainty, bench_v, voltage, air]: [&'static Key; 4],
) -> Measured {
    Measured {
        uncertainty: table.table(uncertainty, uncertainty::read).flatten(),
        bench_v: table.array(bench_v),
        own_laws: correction::read(table, [voltage, air]),
    }
}
