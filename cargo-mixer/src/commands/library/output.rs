//! The files of a library: all of them, or none.

use std::fmt::Display;
use std::fs;
use std::path::Path;

/// A file of the library.
#[derive(Debug)]
pub(super) struct File {
    /// Its name in the folder.
    pub(super) name: String,
    /// What it holds.
    pub(super) bytes: Vec<u8>,
}

impl File {
    pub(super) fn text(name: impl Into<String>, text: String) -> Self {
        File {
            name: name.into(),
            bytes: text.into_bytes(),
        }
    }
}

fn fault(path: &Path, reason: impl Display) -> String {
    format!("{}: {reason}", path.display())
}

/// Whether `folder` can be one: before anything is compiled.
pub(super) fn check(folder: &Path) -> Result<(), String> {
    if folder.is_dir() {
        return Ok(());
    }
    if folder.exists() {
        return Err(fault(folder, "is a file; name a folder"));
    }
    match folder.parent() {
        None => Err(fault(folder, "names no folder")),
        Some(parent) if parent.as_os_str().is_empty() || parent.is_dir() => Ok(()),
        Some(parent) => Err(fault(
            folder,
            format_args!("there is no folder {}", parent.display()),
        )),
    }
}

/// Writes all files into a folder beside their places, then gives them their names.
pub(super) fn write(folder: &Path, files: &[File], force: bool) -> Result<(), String> {
    for file in files {
        let place = folder.join(&file.name);
        if fs::read(&place).is_ok_and(|held| held != file.bytes) {
            crate::file::not_there(&place, force)?;
        }
    }
    let made = !folder.exists();
    if made {
        fs::create_dir(folder).map_err(|error| fault(folder, format_args!("cannot be made: {error}")))?;
    }
    let staging = folder.join(format!(".cargo-mixer-{}", std::process::id()));
    let written = stage(&staging, files).and_then(|()| publish(&staging, folder, files));
    let _ = fs::remove_dir_all(&staging);
    if made && written.is_err() {
        let _ = fs::remove_dir(folder);
    }
    written
}

fn stage(staging: &Path, files: &[File]) -> Result<(), String> {
    fs::create_dir(staging).map_err(|error| {
        let folder = staging.parent().unwrap_or(staging);
        fault(folder, format_args!("nothing can be written there: {error}"))
    })?;
    for file in files {
        let path = staging.join(&file.name);
        fs::write(&path, &file.bytes).map_err(|error| fault(&path, error))?;
    }
    Ok(())
}

fn publish(staging: &Path, folder: &Path, files: &[File]) -> Result<(), String> {
    // A folder in a file's place is what could stop half of them.
    let places = files.iter().map(|file| folder.join(&file.name));
    if let Some(place) = places.into_iter().find(|place| place.is_dir()) {
        return Err(fault(&place, "is a folder"));
    }
    for file in files {
        let place = folder.join(&file.name);
        fs::rename(staging.join(&file.name), &place).map_err(|error| fault(&place, error))?;
        crate::print_note(format_args!("wrote {}", place.display()));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_files_or_none() {
        let folder = std::env::temp_dir().join(format!("cargo-mixer-output-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        let files = [File::text("a.h", "a".into()), File::text("b.h", "b".into())];
        write(&folder, &files, false).unwrap();
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 2);

        fs::remove_file(folder.join("b.h")).unwrap();
        fs::create_dir(folder.join("b.h")).unwrap();
        let other = [File::text("a.h", "other".into()), File::text("b.h", "b".into())];
        let refused = write(&folder, &other, false).unwrap_err();
        assert!(refused.ends_with("--force overwrites it"), "{refused}");
        assert!(
            write(&folder, &other, true)
                .unwrap_err()
                .ends_with("b.h: is a folder")
        );
        assert_eq!(fs::read_to_string(folder.join("a.h")).unwrap(), "a");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 2);

        assert!(check(&folder.join("a.h")).is_err());
        assert!(check(&folder.join("none/none")).is_err());
        fs::remove_dir_all(folder).unwrap();
    }
}
