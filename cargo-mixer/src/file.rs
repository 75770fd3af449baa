//! Writing files.

use std::fmt::Display;
use std::fs::{self, File};
use std::io::Write as _;
use std::path::Path;

/// Writes the whole file or none of it: a temporary file beside it, flushed to the disk, takes its name. A link to a
/// file stays a link. What is no regular file, as a device or a pipe, is written to and stays what it is.
///
/// # Errors
/// What cannot be written, by its path, and why.
pub fn write(path: &Path, text: &str) -> Result<(), String> {
    let fault = |reason: &dyn Display| format!("{}: {reason}", path.display());
    let replaced = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    match fs::metadata(path) {
        Ok(found) if found.is_dir() => return Err(fault(&"is a folder; name a file in it")),
        Ok(found) if !found.is_file() => {
            let written = File::options().write(true).open(path);
            return written
                .and_then(|mut file| file.write_all(text.as_bytes()))
                .map_err(|error| fault(&error));
        }
        _ => {}
    }
    let (Some(folder), Some(name)) = (replaced.parent(), replaced.file_name()) else {
        return Err(fault(&"names no file"));
    };
    if !folder.as_os_str().is_empty() && !folder.is_dir() {
        return Err(fault(&format_args!("there is no folder {}", folder.display())));
    }
    let temporary = folder.join(format!(".{}.{}", name.to_string_lossy(), std::process::id()));
    let written = File::create(&temporary).and_then(|mut file| {
        file.write_all(text.as_bytes())?;
        file.sync_all()
    });
    let done = written.and_then(|()| fs::rename(&temporary, &replaced));
    if done.is_err() {
        let _ = fs::remove_file(&temporary);
    }
    done.map_err(|error| fault(&error))
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;

    /// A folder of this test's own, empty.
    fn folder(test: &str) -> PathBuf {
        let path = std::env::temp_dir().join(format!("cargo-mixer-{test}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        path
    }

    #[test]
    fn replaces_a_file_and_leaves_no_other() {
        let folder = folder("replaces");
        let file = folder.join("a.csv");
        for text in ["first", "second"] {
            write(&file, text).unwrap();
            assert_eq!(fs::read_to_string(&file).unwrap(), text);
        }
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn folders_are_named() {
        let folder = folder("folders");
        assert!(
            write(&folder, "")
                .unwrap_err()
                .ends_with("is a folder; name a file in it")
        );
        let missing = folder.join("none");
        let refused = write(&missing.join("a.csv"), "").unwrap_err();
        assert!(
            refused.ends_with(&format!("there is no folder {}", missing.display())),
            "{refused}"
        );
        assert!(write(Path::new(""), "").is_err());
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
        fs::remove_dir_all(folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn links_and_pipes_stay_what_they_are() {
        use std::io::Read as _;
        use std::os::unix::fs::{FileTypeExt as _, symlink};

        let folder = folder("links");
        let [file, link, pipe] = ["a.csv", "link.csv", "pipe"].map(|name| folder.join(name));
        fs::write(&file, "before").unwrap();
        symlink("a.csv", &link).unwrap();
        write(&link, "after").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&file).unwrap(), "after");

        let made = std::process::Command::new("mkfifo").arg(&pipe).status().unwrap();
        assert!(made.success());
        // Open at both ends, so that no one waits.
        let mut ends = File::options().read(true).write(true).open(&pipe).unwrap();
        write(&pipe, "after").unwrap();
        assert!(fs::metadata(&pipe).unwrap().file_type().is_fifo());
        let mut read = [0; 5];
        ends.read_exact(&mut read).unwrap();
        assert_eq!(&read, b"after");
        fs::remove_dir_all(folder).unwrap();
    }
}
