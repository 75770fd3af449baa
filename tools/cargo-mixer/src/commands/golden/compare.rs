//! Differences between golden outputs and those of today: the first difference of every file, and
//! by how much.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The faults of each file, one line each, beginning with its name: differing, missing,
/// orphans.
///
/// # Errors
/// The folder cannot be read.
pub fn differences(folder: &Path, outputs: &BTreeMap<String, String>) -> Result<Vec<String>, String> {
    let mut found = Vec::new();
    for (file, content) in outputs {
        match fs::read_to_string(folder.join(file)) {
            Ok(held) if held == *content => {}
            Ok(held) => found.push(format!("{file}:{}", first_difference(&held, content))),
            Err(error) => found.push(format!("{file}: {error}")),
        }
    }
    let orphans = orphans(folder, outputs)?.into_iter();
    found.extend(orphans.map(|file| format!("{file}: belongs to none of these airframes")));
    Ok(found)
}

/// Files of the folder that are not among the outputs; hidden ones are not looked at.
///
/// # Errors
/// The folder cannot be read.
pub fn orphans(folder: &Path, outputs: &BTreeMap<String, String>) -> Result<Vec<String>, String> {
    let unreadable = |error: std::io::Error| format!("{}: {error}", folder.display());
    let mut orphans = Vec::new();
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        let file = entry.map_err(unreadable)?.file_name();
        let file = file.to_string_lossy().into_owned();
        if !outputs.contains_key(&file) && !file.starts_with('.') {
            orphans.push(file);
        }
    }
    orphans.sort();
    Ok(orphans)
}

/// `LINE: was .., is ..`, of a table with its column and the difference of the numbers.
pub fn first_difference(held: &str, now: &str) -> String {
    let lines = held.lines().zip(now.lines()).enumerate();
    let differing = lines.clone().find(|(_, (held, now))| held != now);
    let count = lines.filter(|(_, (held, now))| held != now).count();
    let Some((index, (was, is))) = differing else {
        let [was, is] = [held, now].map(|text| text.lines().count());
        return format!("{}: had {was} lines, has {is}", was.min(is) + 1);
    };
    let others = match count {
        1 => String::new(),
        count => format!("; {count} lines differ"),
    };
    let columns = now.lines().next().unwrap_or_default().split(',');
    let cells = columns.zip(was.split(',').zip(is.split(',')));
    let cell = cells
        .filter_map(|(column, (was, is))| Some((column, number(was)?, number(is)?)))
        .find(|(_, was, is)| was.to_bits() != is.to_bits());
    match cell {
        Some((column, was, is)) => format!(
            "{}: {column} was {was:?}, is {is:?}, by {:+.2e}{others}",
            index + 1,
            f64::from(is) - f64::from(was)
        ),
        None => format!("{}: was `{was}`, is `{is}`{others}", index + 1),
    }
}

/// A float of a table: the hexadecimal digits of its bits. A count is no float.
fn number(cell: &str) -> Option<f32> {
    let bits = u32::from_str_radix(cell.strip_prefix("0x")?, 16).ok()?;
    Some(f32::from_bits(bits))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_difference_is_named() {
        let table = |throttle: f32, bits: u16| {
            format!(
                "roll_nm,throttle_0,saturation\n0x00000000,0x{:08x},{bits}\n",
                throttle.to_bits()
            )
        };
        assert_eq!(
            first_difference(&table(0.5, 0), &table(0.625, 4)),
            "2: throttle_0 was 0.5, is 0.625, by +1.25e-1"
        );
        assert_eq!(
            first_difference(&table(0.5, 0), &table(0.5, 4)),
            "2: was `0x00000000,0x3f000000,0`, is `0x00000000,0x3f000000,4`"
        );
        assert_eq!(
            first_difference("a\nb\nc\n", "a\nx\ny\n"),
            "2: was `b`, is `x`; 2 lines differ"
        );
        assert_eq!(first_difference("a\nb\n", "a\n"), "2: had 2 lines, has 1");
    }
}
