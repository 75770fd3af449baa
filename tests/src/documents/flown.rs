//! The flights of the first page, out of the tables of flights.

use super::measured;
use super::tables::markdown;
use crate::root;

/// A row: what was flown, its file, cells that tell the file's row, and the column.
type Figure = (&'static str, &'static str, &'static [&'static str], &'static str);

/// The rotors' T by the estimate is 0.39 s.
const FIGURES: [Figure; 5] = [
    (
        "yaw by 90 degrees: height error, most (m)",
        "px4-inertia.csv",
        &["0.39"],
        "height error, most, 90 degrees (m)",
    ),
    (
        "yaw by 175 degrees: height error, most (m)",
        "px4-inertia.csv",
        &["0.39"],
        "height error, most, 175 degrees (m)",
    ),
    (
        "up by 3 m: time to 90 % (s)",
        "px4-manoeuvres.csv",
        &["3 m in height"],
        "time to 90 % (s)",
    ),
    (
        "sideways by 4 m: height error, most (m)",
        "px4-manoeuvres.csv",
        &["4 m sideways"],
        "height error, most (m)",
    ),
    (
        "roll to 15 degrees: time to 90 % (s)",
        "px4-manoeuvres.csv",
        &["15 deg in roll"],
        "time to 90 % (s)",
    ),
];

/// With a rotor out, in a file whose cells are of PX4's allocator, fitted, and of this mixer.
const ROTOR_OUT: [Figure; 2] = [
    (
        "an upper rotor out, yaw by 90 degrees: roll or pitch, most (degrees)",
        "px4-rotor-out.csv",
        &["upper (output 0)"],
        "in the yaw steps: roll or pitch, most (deg)",
    ),
    (
        "an upper rotor out, yaw by 90 degrees: height error, most (m)",
        "px4-rotor-out.csv",
        &["upper (output 0)"],
        "height error, most (m)",
    ),
];

/// The cell of a figure's column in the row that holds its words and these; `None` where there is no such row.
fn cell((_, file, words, column): Figure, more: &[&str]) -> Result<Option<String>, String> {
    let path = root().join("tests/measurements/flights").join(file);
    let (header, rows) = measured(&path)?;
    let at = header.iter().position(|name| name == column);
    let at = at.ok_or_else(|| format!("{}: no column {column}", path.display()))?;
    let words = words.iter().chain(more);
    let row = rows
        .iter()
        .find(|row| words.clone().all(|word| row.iter().any(|cell| cell == *word)));
    Ok(row.and_then(|row| row.get(at)).map(str::to_owned))
}

/// What PX4's allocator, as it comes and fitted, and this mixer hold in flight.
pub(super) fn flown() -> Result<String, String> {
    const MIXERS: [&str; 3] = ["as it comes", "fitted", "this mixer"];
    const NOT_FLOWN: &str = "-";
    let mut rows = Vec::new();
    for figure in FIGURES {
        let mut row = vec![figure.0.to_owned()];
        for mixer in MIXERS {
            row.push(cell(figure, &[mixer])?.unwrap_or_else(|| NOT_FLOWN.to_owned()));
        }
        rows.push(row);
    }
    for figure in ROTOR_OUT {
        let both = cell(figure, &[])?.unwrap_or_default();
        let (fitted, this) = both
            .split_once("; ")
            .ok_or_else(|| format!("{}: `{both}` has not the cells of two mixers", figure.1))?;
        rows.push([figure.0, NOT_FLOWN, fitted, this].map(str::to_owned).to_vec());
    }
    if rows.iter().any(|row| row[2..].contains(&NOT_FLOWN.to_owned())) {
        return Err(format!("a figure of the first page was not flown: {rows:?}"));
    }
    Ok(markdown(
        &[
            "flown",
            "PX4, as it comes",
            "PX4, fitted to the pair",
            "PX4 with this mixer",
        ],
        &rows,
    ))
}
