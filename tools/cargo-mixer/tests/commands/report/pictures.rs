//! The pictures of `docs/` are those that the command draws today.

use std::collections::BTreeSet;
use std::fs;

use mixer_files::report::pictures;
use roxmltree::Document;

use super::{airframes, root};

#[test]
fn the_documents_pictures_are_current() {
    let airframes = airframes();
    let x8 = airframes
        .iter()
        .find(|compiled| compiled.airframe.name == "isae-x8")
        .unwrap();
    let drawn = pictures::pictures(x8);
    let mut stale = Vec::new();
    for (name, text) in &drawn {
        if name.ends_with(".svg") {
            Document::parse(text).unwrap_or_else(|error| panic!("{name}: {error}"));
            assert!(text.len() < 80_000, "{name} has {} bytes", text.len());
        }
        if fs::read_to_string(root().join("docs").join(name)).ok().as_ref() != Some(text) {
            stale.push(name.clone());
        }
    }
    assert!(stale.is_empty(), "{stale:?} are stale; run `cargo pictures`");
    let names: BTreeSet<String> = fs::read_dir(root().join("docs"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .filter(|name| {
            airframes
                .iter()
                .any(|c| name.starts_with(&format!("{}-", c.airframe.name)))
        })
        .collect();
    let orphans: Vec<&String> = names.iter().filter(|name| !drawn.contains_key(*name)).collect();
    assert!(orphans.is_empty(), "nothing draws {orphans:?}");
}
