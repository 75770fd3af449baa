//! Writing files.

use std::fmt::Display;
use std::fs::{self, File, Metadata};
use std::io::{self, Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use sha2::{Digest as _, Sha256};

/// Most links that are followed to a file, as by the kernel.
const MOST_LINKS: usize = 40;

/// Writes the whole file or none of it: a temporary file beside it, flushed to the disk, takes its
/// name and its permissions. A link stays a link, one to no file yet gets its file. A file with
/// several names keeps them: it is written to in place, once the temporary file has shown that
/// there is room. What is no regular file, as a device or a pipe, is written to and stays what it
/// is.
///
/// # Errors
/// What cannot be written, by its path, and why.
pub fn write(path: &Path, text: &str) -> Result<(), String> {
    let fault = |reason: &dyn Display| format!("{}: {reason}", path.display());
    // By the path as given: `/dev/stdout` leads to a pipe that has no path of its own.
    let found = fs::metadata(path).ok();
    match &found {
        Some(found) if found.is_dir() => return Err(fault(&"is a folder; name a file in it")),
        Some(found) if !found.is_file() => {
            let written = File::options().write(true).open(path);
            return written
                .and_then(|mut file| file.write_all(text.as_bytes()))
                .map_err(|error| fault(&error));
        }
        _ => {}
    }
    let replaced = target(path).map_err(|error| fault(&error))?;
    let (Some(folder), Some(_)) = (replaced.parent(), replaced.file_name()) else {
        return Err(fault(&"names no file"));
    };
    if !folder.as_os_str().is_empty() && !folder.is_dir() {
        return Err(fault(&format_args!("there is no folder {}", folder.display())));
    }
    place(folder, &replaced, text, found.as_ref()).map_err(|error| fault(&error))
}

/// [`write`], and says so: what every command does with its output.
///
/// # Errors
/// As [`write`].
pub(crate) fn save(path: &Path, text: &str) -> Result<(), String> {
    write(path, text)?;
    crate::print_note(format_args!("wrote {}", path.display()));
    Ok(())
}

/// Refuses an output that is one of the inputs, which is bad usage, or that is there already:
/// before anything is computed.
///
/// # Errors
/// The exit status; what is wrong is told.
pub(crate) fn writable<'a>(
    output: &Path,
    force: bool,
    inputs: impl IntoIterator<Item = &'a Path>,
) -> Result<(), ExitCode> {
    let same = |input: &Path| match (input.canonicalize(), output.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => input == output,
    };
    if inputs.into_iter().any(same) {
        crate::print_error(format_args!(
            "{} is an input and would be overwritten",
            output.display()
        ));
        return Err(ExitCode::from(crate::BAD_USAGE));
    }
    not_there(output, force).map_err(crate::print_error)
}

/// The digest of a file's bytes in hexadecimal, as `sha256sum` prints it.
pub(crate) fn sha256(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Largest bench file that is read, MB. A device without an end would fill the memory.
const LARGEST_MB: u64 = 64;

/// Largest airframe or parameter file, MB. They have kilobytes; read, they take forty times their
/// size.
const LARGEST_SMALL_MB: u64 = 1;

/// The bytes of a whole file.
///
/// # Errors
/// A file that cannot be read, or is above 64 MB.
pub fn bytes(path: &Path) -> io::Result<Vec<u8>> {
    up_to(path, LARGEST_MB)
}

fn up_to(path: &Path, most_mb: u64) -> io::Result<Vec<u8>> {
    let most = most_mb << 20;
    let mut bytes = Vec::new();
    File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        return Err(io::Error::other(format!(
            "it is above {most_mb} MB; name a smaller file"
        )));
    }
    Ok(bytes)
}

/// The bytes of an airframe or parameter file.
///
/// # Errors
/// A file that cannot be read, or is above 1 MB; the message names it.
pub fn read_small(path: &Path) -> Result<Vec<u8>, String> {
    up_to(path, LARGEST_SMALL_MB).map_err(|error| format!("{}: {error}", path.display()))
}

/// [`read_small`] for text.
///
/// # Errors
/// As [`read_small`]; what is not UTF-8.
pub fn read_text(path: &Path) -> Result<String, String> {
    String::from_utf8(read_small(path)?).map_err(|_| format!("{}: is not UTF-8 text", path.display()))
}

/// Refuses a file that is there already, unless `force` is given. A device or a pipe has nothing to
/// lose.
///
/// # Errors
/// A regular file of that name.
pub fn not_there(path: &Path, force: bool) -> Result<(), String> {
    match fs::metadata(path) {
        Ok(found) if found.is_file() && !force => Err(format!(
            "{} is there already: --force overwrites it",
            path.display()
        )),
        _ => Ok(()),
    }
}

fn place(folder: &Path, replaced: &Path, text: &str, found: Option<&Metadata>) -> io::Result<()> {
    let here = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    let mut temporary = tempfile::Builder::new();
    // A new file's permissions are those that the user's mask leaves, as without this detour.
    let permissions = found.map_or_else(new_file, |found| Some(found.permissions()));
    if let Some(permissions) = permissions {
        temporary.permissions(permissions);
    }
    // A name of its own: with the file's in it, it could be longer than names may be.
    let mut temporary = temporary.prefix(".cargo-mixer.").tempfile_in(here)?;
    temporary.write_all(text.as_bytes())?;
    temporary.as_file().sync_all()?;
    if !found.is_some_and(has_other_names) {
        temporary.persist(replaced)?;
        return Ok(());
    }
    let mut file = File::options().write(true).truncate(true).open(replaced)?;
    file.write_all(text.as_bytes())?;
    file.sync_all()
}

#[cfg(unix)]
fn new_file() -> Option<fs::Permissions> {
    Some(std::os::unix::fs::PermissionsExt::from_mode(0o666))
}

#[cfg(not(unix))]
fn new_file() -> Option<fs::Permissions> {
    None
}

#[cfg(unix)]
fn has_other_names(found: &Metadata) -> bool {
    std::os::unix::fs::MetadataExt::nlink(found) > 1
}

#[cfg(not(unix))]
fn has_other_names(_: &Metadata) -> bool {
    false
}

/// The file behind links, whether it is there or not.
fn target(path: &Path) -> io::Result<PathBuf> {
    if let Ok(file) = path.canonicalize() {
        return Ok(file);
    }
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&path) {
            // Relative to the link's folder; an absolute one replaces it.
            Ok(next) => path = path.parent().unwrap_or(Path::new("")).join(next),
            Err(_) => return Ok(path),
        }
    }
    Err(io::Error::other("a circle of links"))
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
    fn what_a_file_is_stays() {
        use std::os::unix::fs::{MetadataExt as _, PermissionsExt as _, symlink};

        let folder = folder("stays");
        let [secret, other, dangling, circle] =
            ["secret.csv", "other.csv", "dangling.csv", "circle.csv"].map(|name| folder.join(name));
        fs::write(&secret, "before").unwrap();
        fs::set_permissions(&secret, fs::Permissions::from_mode(0o600)).unwrap();
        write(&secret, "after").unwrap();
        assert_eq!(fs::metadata(&secret).unwrap().mode() & 0o777, 0o600);

        fs::hard_link(&secret, &other).unwrap();
        write(&secret, "again").unwrap();
        assert_eq!(fs::read_to_string(&other).unwrap(), "again");
        assert_eq!(fs::metadata(&other).unwrap().nlink(), 2);

        symlink("made.csv", &dangling).unwrap();
        write(&dangling, "made").unwrap();
        assert!(fs::symlink_metadata(&dangling).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(folder.join("made.csv")).unwrap(), "made");

        symlink("circle.csv", &circle).unwrap();
        let refused = write(&circle, "").unwrap_err();
        assert!(refused.ends_with("a circle of links"), "{refused}");

        let long = folder.join("a".repeat(255));
        write(&long, "long").unwrap();
        assert_eq!(fs::read_to_string(&long).unwrap(), "long");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 6);
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
