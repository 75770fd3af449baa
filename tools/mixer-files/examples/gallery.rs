//! Draws the pictures of `docs/`: `cargo gallery`.

use std::error::Error;
use std::fs;
use std::path::Path;

use mixer_compiler::{Compiled, Source};
use mixer_files::report::gallery;

fn main() -> Result<(), Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let docs = root.join("docs");
    fs::create_dir_all(&docs)?;
    for (name, text) in pictures(&root)? {
        fs::write(docs.join(name), text)?;
    }
    Ok(())
}

/// The gallery of all of `airframes/` and the figures of the paper's X8.
fn pictures(root: &Path) -> Result<gallery::Files, Box<dyn Error>> {
    let mut paths = Vec::new();
    for entry in fs::read_dir(root.join("airframes"))? {
        paths.push(entry?.path());
    }
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    paths.sort();
    let airframes = paths
        .iter()
        .map(|path| compiled(path))
        .collect::<Result<Vec<_>, _>>()?;
    let mut files = gallery::gallery(&airframes);
    if let Some(x8) = airframes
        .iter()
        .find(|compiled| compiled.airframe.name == "isae-x8")
    {
        files.append(&mut gallery::figures(x8));
    }
    Ok(files)
}

fn compiled(path: &Path) -> Result<Compiled, Box<dyn Error>> {
    let source = Source::new(path.display().to_string(), fs::read_to_string(path)?);
    mixer_compiler::compile(&source).map_err(|faults| faults.to_string().into())
}
