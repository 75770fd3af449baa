//! Draws the pictures of `docs/`: `cargo pictures`.

use std::error::Error;
use std::fs;
use std::path::Path;

use mixer_compiler::Source;
use mixer_files::report::pictures;

fn main() -> Result<(), Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let path = root.join("airframes/isae-x8.toml");
    let source = Source::new(path.display().to_string(), fs::read_to_string(&path)?);
    let compiled = mixer_compiler::compile(&source).map_err(|faults| faults.to_string())?;
    for (name, text) in pictures::pictures(&compiled) {
        fs::write(root.join("docs").join(name), text)?;
    }
    Ok(())
}
