//! Text that may go to a terminal.

use mixer_compiler::diagnostic::printable;

/// [`printable`] text, of which the ends of lines and tabs stay: names of files and comments of
/// other files are in it.
pub fn printable_lines(text: &str) -> String {
    let is_kept = |c| matches!(c, '\n' | '\t');
    let parts = text.split_inclusive(is_kept).map(|part| {
        let plain = part.trim_end_matches(is_kept);
        printable(plain) + &part[plain.len()..]
    });
    parts.collect()
}
