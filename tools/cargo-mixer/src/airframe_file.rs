//! An airframe file that a command writes.

use std::path::Path;

use mixer_compiler::Source;

use crate::{Done, Refusal};

/// Writes an airframe file that compiles; one that does not is refused with its faults, and nothing
/// is written: they then name the file with the pair's model, if there is one.
pub(crate) fn write(path: &Path, text: &str, model: Option<&Path>) -> Done {
    let compile = |name: String| mixer_compiler::compile(&Source::new(name, text));
    match compile(path.display().to_string()) {
        Err(_) => {
            let pair = model.map_or_else(String::new, |model| {
                format!("with the pair of {}, ", model.display())
            });
            let name = format!("{} ({pair}not written)", path.display());
            // The same faults again, of the file that there is not.
            if let Err(faults) = compile(name) {
                return Err(Refusal::Faulty(faults).report());
            }
        }
        Ok(compiled) => crate::warn(&mixer_compiler::lint(&compiled)),
    }
    crate::file::save(path, text).map_err(crate::print_error)?;
    let schema = path.with_file_name("airframe.schema.json");
    if !schema.exists() {
        crate::print_note(format_args!(
            "your editor completes and checks it with its schema beside it: cargo mixer schema -o {}",
            schema.display()
        ));
    }
    Ok(())
}
