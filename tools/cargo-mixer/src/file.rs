//! Files: read whole, and written whole or not at all.

use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use mixer_compiler::Source;
use mixer_facts::input::{read_small, up_to};
use tempfile::NamedTempFile;

/// Largest bench file that is read, MB. A device without an end would fill the memory.
const LARGEST_MB: u64 = 64;

/// Largest flight log, MB: an hour at PX4's high rates.
const LARGEST_LOG_MB: u64 = 1024;

/// The bytes of a whole file.
///
/// # Errors
/// A file that cannot be read, or is above 64 MB.
pub fn bytes(path: &Path) -> io::Result<Vec<u8>> {
    up_to(path, LARGEST_MB)
}

/// The bytes of a flight log.
///
/// # Errors
/// A file that cannot be read, or is above 1 GB; the message names it.
pub(crate) fn read_log(path: &Path) -> Result<Vec<u8>, String> {
    up_to(path, LARGEST_LOG_MB).map_err(|error| format!("{}: {error}", path.display()))
}

/// An airframe or parameter file: UTF-8, or UTF-16 with its byte-order mark.
///
/// # Errors
/// As [`read_small`]; bytes that are neither, with the place of the first.
pub fn source(path: &Path) -> Result<Source, String> {
    let name = path.display().to_string();
    Source::from_bytes(name, read_small(path)?).map_err(|faults| faults.refusal())
}

/// Refuses a file that is there already, unless `force` is given. A device or a pipe has nothing to
/// lose.
///
/// # Errors
/// A regular file of that name.
fn not_there(path: &Path, force: bool) -> Result<(), String> {
    match fs::metadata(path) {
        Ok(found) if found.is_file() && !force => Err(format!(
            "{} is there already: --force overwrites it",
            path.display()
        )),
        _ => Ok(()),
    }
}

/// Refuses an output that is one of the inputs or `-`, which is bad usage, or that is there already:
/// before anything is computed.
///
/// # Errors
/// The exit status; what is wrong is told.
pub(crate) fn writable(
    output: &Path,
    force: bool,
    inputs: impl IntoIterator<Item = impl AsRef<Path>>,
) -> Result<(), ExitCode> {
    let same = |input: &Path| match (input.canonicalize(), output.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => input == output,
    };
    if inputs.into_iter().any(|input| same(input.as_ref())) {
        return Err(crate::bad_usage(format_args!(
            "{} is an input and would be overwritten",
            output.display()
        )));
    }
    if output == Path::new("-") {
        let message = "- is no file: without -o the answer goes to standard output where there is one, ./- is a file of that name";
        return Err(crate::bad_usage(message));
    }
    not_there(output, force).map_err(crate::print_error)
}

/// Refuses a path that can be no folder to write into: before anything is computed.
pub(crate) fn check_folder(folder: &Path) -> Result<(), String> {
    let parent = folder.parent().filter(|parent| !parent.as_os_str().is_empty());
    match parent {
        _ if folder.is_dir() => Ok(()),
        _ if folder.exists() => Err(format!("{}: is a file; name a folder", folder.display())),
        Some(parent) if !parent.is_dir() => Err(no_folder(folder, parent)),
        _ => Ok(()),
    }
}

fn no_folder(path: &Path, folder: &Path) -> String {
    format!("{}: there is no folder {}", path.display(), folder.display())
}

/// Writes a file and says so: what every command does with its output.
///
/// # Errors
/// The path that cannot be written, and why.
pub(crate) fn save(path: &Path, text: &str) -> Result<(), String> {
    stage(path, text.as_bytes())?.publish()
}

/// Writes files by their names into a folder, which is made where there is none: all of them, or
/// none. Those that hold the same already are left alone.
///
/// # Errors
/// A file that is there with other contents, unless `force` is given; what cannot be written.
pub(crate) fn save_all<'a>(
    folder: &Path,
    files: impl Iterator<Item = (&'a str, &'a [u8])>,
    force: bool,
) -> Result<(), String> {
    let places = files.map(|(name, bytes)| (folder.join(name), bytes));
    let changed = places.filter(|(path, bytes)| fs::read(path).ok().as_deref() != Some(*bytes));
    let changed: Vec<(PathBuf, &[u8])> = changed.collect();
    if changed.is_empty() {
        crate::print_note(format_args!("{}: nothing has changed", folder.display()));
    }
    for (path, _) in &changed {
        not_there(path, force)?;
    }
    fs::create_dir_all(folder).map_err(|error| format!("{}: cannot be made: {error}", folder.display()))?;
    let staged = changed.iter().map(|(path, bytes)| stage(path, bytes));
    for file in staged.collect::<Result<Vec<_>, _>>()? {
        file.publish()?;
    }
    Ok(())
}

/// A file whose bytes are on the disk beside its place.
#[derive(Debug)]
struct Staged {
    /// `None` for what is no regular file, as a device or a pipe: it has been written to.
    temporary: Option<NamedTempFile>,
    /// Behind a link, if the path as given is one.
    place: PathBuf,
    path: PathBuf,
}

fn stage(path: &Path, bytes: &[u8]) -> Result<Staged, String> {
    let fault = |error: io::Error| format!("{}: {error}", path.display());
    let found = fs::metadata(path).ok();
    if found.as_ref().is_some_and(fs::Metadata::is_dir) {
        return Err(format!("{}: is a folder; name a file in it", path.display()));
    }
    let place = path.canonicalize().unwrap_or(path.to_owned());
    let (Some(folder), Some(_)) = (place.parent(), place.file_name()) else {
        return Err(format!("{}: names no file", path.display()));
    };
    let mut staged = Staged {
        temporary: None,
        place: place.clone(),
        path: path.to_owned(),
    };
    if found.as_ref().is_some_and(|found| !found.is_file()) {
        fs::write(path, bytes).map_err(fault)?;
        return Ok(staged);
    }
    let folder = match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    };
    if !folder.is_dir() {
        return Err(no_folder(path, folder));
    }
    // A file's permissions stay; a new one's are those that the user's mask leaves.
    let mut builder = tempfile::Builder::new();
    if let Some(permissions) = found.map_or_else(new_file, |found| Some(found.permissions())) {
        builder.permissions(permissions);
    }
    let mut temporary = builder
        .prefix(".cargo-mixer.")
        .tempfile_in(folder)
        .map_err(|error| format!("{}: nothing can be written there: {error}", folder.display()))?;
    temporary.write_all(bytes).map_err(fault)?;
    temporary.as_file().sync_all().map_err(fault)?;
    staged.temporary = Some(temporary);
    Ok(staged)
}

impl Staged {
    /// Gives it its name, and says so.
    fn publish(self) -> Result<(), String> {
        let path = self.path.display();
        if let Some(temporary) = self.temporary {
            temporary
                .persist(&self.place)
                .map_err(|error| format!("{path}: {}", error.error))?;
        }
        crate::print_note(format_args!("wrote {path}"));
        Ok(())
    }
}

#[cfg(unix)]
fn new_file() -> Option<fs::Permissions> {
    Some(std::os::unix::fs::PermissionsExt::from_mode(0o666))
}

#[cfg(not(unix))]
fn new_file() -> Option<fs::Permissions> {
    None
}

#[cfg(test)]
mod tests {
    use std::fs::File;
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
            save(&file, text).unwrap();
            assert_eq!(fs::read_to_string(&file).unwrap(), text);
        }
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn folders_are_named() {
        let folder = folder("folders");
        assert!(
            save(&folder, "")
                .unwrap_err()
                .ends_with("is a folder; name a file in it")
        );
        let missing = folder.join("none");
        let refused = save(&missing.join("a.csv"), "").unwrap_err();
        assert!(
            refused.ends_with(&format!("there is no folder {}", missing.display())),
            "{refused}"
        );
        assert!(save(Path::new(""), "").is_err());
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
        fs::remove_dir_all(folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn what_a_file_is_stays() {
        use std::os::unix::fs::{MetadataExt as _, PermissionsExt as _};

        let folder = folder("stays");
        let secret = folder.join("secret.csv");
        fs::write(&secret, "before").unwrap();
        fs::set_permissions(&secret, fs::Permissions::from_mode(0o600)).unwrap();
        save(&secret, "after").unwrap();
        assert_eq!(fs::metadata(&secret).unwrap().mode() & 0o777, 0o600);

        let long = folder.join("a".repeat(255));
        save(&long, "long").unwrap();
        assert_eq!(fs::read_to_string(&long).unwrap(), "long");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 2);
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
        save(&link, "after").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&file).unwrap(), "after");

        let made = std::process::Command::new("mkfifo").arg(&pipe).status().unwrap();
        assert!(made.success());
        // Open at both ends, so that no one waits.
        let mut ends = File::options().read(true).write(true).open(&pipe).unwrap();
        save(&pipe, "after").unwrap();
        assert!(fs::metadata(&pipe).unwrap().file_type().is_fifo());
        let mut read = [0; 5];
        ends.read_exact(&mut read).unwrap();
        assert_eq!(&read, b"after");
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn all_files_or_none() {
        let folder = folder("all");
        let all = |text: &'static str, force| {
            let files = [("a.h", text), ("b.h", "b")].map(|(name, text)| (name, text.as_bytes()));
            save_all(&folder, files.into_iter(), force)
        };
        all("a", false).unwrap();
        fs::remove_file(folder.join("b.h")).unwrap();
        fs::create_dir(folder.join("b.h")).unwrap();
        let refused = all("other", false).unwrap_err();
        assert!(refused.ends_with("--force overwrites it"), "{refused}");
        let refused = all("other", true).unwrap_err();
        assert!(refused.ends_with("is a folder; name a file in it"), "{refused}");
        assert_eq!(fs::read_to_string(folder.join("a.h")).unwrap(), "a");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 2);

        assert!(check_folder(&folder.join("a.h")).is_err());
        assert!(check_folder(&folder.join("none/none")).is_err());
        fs::remove_dir_all(folder).unwrap();
    }
}
