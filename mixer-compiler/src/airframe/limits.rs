//! Limits that several tables of the file share.

use crate::diagnostic::{Code, Diagnostic, number};
use crate::spec::Fields;
use crate::spec::Numbers;
use crate::spec::keys::Key;

/// Largest coefficient, N, N m or W: far beyond any rotor, far within single precision.
pub(super) const LARGEST_EFFORT: f64 = 1e6;

/// The coefficients of a key, as many as `what` has `terms`; `help` says which these are.
pub(super) fn coefficients(
    table: &mut Fields<'_, '_>,
    key: &'static Key,
    (what, terms): (&str, usize),
    help: impl FnOnce(usize) -> String,
) -> Option<Vec<f64>> {
    let field = table.read::<Numbers>(key)?;
    let (path, found) = (table.key_path(key.name), field.get_ref().len());
    if found != terms {
        let message = format!("`{path}` has {found} coefficients, {what} takes {terms}");
        let label = format!("expected {terms} numbers");
        return table.refuse(key, Code::WrongLength, message, label, help(found));
    }
    let before = table.faults.len();
    for written in field
        .get_ref()
        .iter()
        .filter(|c| c.get_ref().abs() > LARGEST_EFFORT)
    {
        let [beyond, largest] = [*written.get_ref(), LARGEST_EFFORT].map(number);
        let message = format!("a coefficient of {beyond} in `{path}` is beyond {largest}");
        let fault = Diagnostic::new(Code::OutOfRange, path.as_str(), written.span(), message);
        table.faults.push(
            fault
                .label("no rotor has that")
                .help("the throttles of the polynomial run from 0 to 1, not in microseconds"),
        );
    }
    let coefficients = field.get_ref().iter().map(|c| *c.get_ref()).collect();
    (table.faults.len() == before).then_some(coefficients)
}
