//! An airframe file that a command writes.

use std::path::Path;
use std::process::ExitCode;

use mixer_compiler::Source;

use crate::Refusal;

/// Writes an airframe file that compiles; one that does not is refused with its faults, and nothing
/// is written.
pub(crate) fn write(path: &Path, text: &str) -> ExitCode {
    let source = Source::new(path.display().to_string(), text);
    match mixer_compiler::compile(&source) {
        Err(faults) => return Refusal::Faulty(faults).report(),
        Ok(compiled) if !compiled.warnings.is_empty() => crate::show(&compiled.warnings),
        Ok(_) => {}
    }
    match crate::file::write(path, text) {
        Ok(()) => {
            crate::print_note(format_args!("wrote {}", path.display()));
            let schema = path.with_file_name("airframe.schema.json");
            if !schema.exists() {
                crate::print_note(format_args!(
                    "your editor completes and checks it with its schema beside it: cargo mixer schema -o {}",
                    schema.display()
                ));
            }
            ExitCode::SUCCESS
        }
        Err(message) => crate::print_error(message),
    }
}
