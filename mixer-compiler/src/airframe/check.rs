//! Checks that several tables of the file share.

use toml::Spanned;

use crate::diagnostic::{Code, Diagnostic, any_of, nearest, quoted};

/// Largest coefficient, N or N m: far beyond any rotor, far within single precision.
pub(super) const LARGEST_EFFORT: f64 = 1e6;

/// The meaning of one of the words that a key takes.
pub(super) fn word<T: Copy>(
    field: &Spanned<String>,
    key: &str,
    words: &[(&'static str, T)],
    faults: &mut Vec<Diagnostic>,
) -> Option<T> {
    let written = field.get_ref();
    let found = words
        .iter()
        .find(|(word, _)| word == written)
        .map(|&(_, meaning)| meaning);
    if found.is_none() {
        let names = || words.iter().map(|&(word, _)| word);
        let label = match nearest(written, names()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "unknown word".to_string(),
        };
        faults.push(
            Diagnostic::new(
                Code::UnknownWord,
                key,
                field.span(),
                format!("`{key}` cannot be {}", quoted(written)),
            )
            .label(label)
            .help(format!("write {}", any_of(names()))),
        );
    }
    found
}
