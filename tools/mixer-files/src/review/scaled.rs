//! An airframe file with the scale of a flight in it.

use crate::review::result::Review;
use toml_edit::{Array, DocumentMut, Item, Value};

/// Tables of the pair that have thrusts.
const TABLES: [&[&str]; 3] = [&["pair"], &["pair", "lower_out"], &["pair", "upper_out"]];

/// Before the half of a coefficient's interval, in the comments that `identify` writes.
const HALF: &str = "+- ";

/// The text of an airframe file with every coefficient of the thrust over the scale of a review, their intervals in
/// comments, and a comment that says so and names the log. All else stays as it is: the torque, too, of which a log does
/// not tell. Where the parts of the log have no one scale ([`Review::undecided`]) it is their median.
///
/// # Errors
/// A text that is not TOML, or has no `pair.thrust_n`.
pub fn scaled(text: &str, review: &Review, log: &str) -> Result<String, String> {
    let scale = review.thrust.median;
    let [low, high] = review.thrust.interval;
    let comment = format!(
        "Thrust over {scale:.4} ({low:.3} to {high:.3}), the model's over that measured in flight at {} kg:\ncargo mixer review {log}",
        review.mass_kg
    );
    let mut document: DocumentMut = text.parse().map_err(|error| format!("{error}"))?;
    let mut is_scaled = false;
    for path in TABLES {
        let mut item = Some(document.as_item_mut());
        for key in path {
            item = item.and_then(|item| item.get_mut(key));
        }
        let Some(table) = item.and_then(Item::as_table_like_mut) else {
            continue;
        };
        let Some(thrusts) = table.get_mut("thrust_n").and_then(Item::as_array_mut) else {
            continue;
        };
        thrusts.iter_mut().for_each(|thrust| divide(thrust, scale));
        let behind = thrusts.trailing().as_str().map(|text| intervals(text, scale));
        thrusts.set_trailing(behind.unwrap_or_default());
        if path.len() == 1 {
            tell(thrusts, &comment);
            is_scaled = true;
        }
    }
    match is_scaled {
        true => Ok(document.to_string()),
        false => Err("the file has no `pair.thrust_n`".to_owned()),
    }
}

/// Divides a number, to ten digits, and leaves what stands around it.
fn divide(value: &mut Value, scale: f64) {
    let number = value
        .as_float()
        .or_else(|| value.as_integer().map(|whole| whole as f64));
    if let Some(number) = number {
        let mut decor = value.decor().clone();
        let before = decor
            .prefix()
            .and_then(|text| text.as_str())
            .map(|text| intervals(text, scale));
        decor.set_prefix(before.unwrap_or_default());
        // A number in decimal notation reads back.
        *value = format!("{:.9e}", number / scale)
            .parse()
            .map_or(0.0, |x: f64| x)
            .into();
        *value.decor_mut() = decor;
    }
}

/// Comments with the halves of intervals over the scale.
fn intervals(text: &str, scale: f64) -> String {
    let mut pieces = text.split(HALF);
    let first = pieces.next().unwrap_or_default().to_owned();
    pieces.fold(first, |before, piece| {
        let end = piece.find(char::is_whitespace).unwrap_or(piece.len());
        let (number, rest) = piece.split_at(end);
        let number = number
            .parse()
            .map_or(number.to_owned(), |half: f64| format!("{:.3e}", half / scale));
        before + HALF + &number + rest
    })
}

/// Puts a comment behind the array.
fn tell(thrusts: &mut Array, comment: &str) {
    let before = thrusts
        .decor()
        .suffix()
        .and_then(|suffix| suffix.as_str())
        .unwrap_or_default()
        .to_owned();
    let lines = comment.lines().map(|line| format!("\n# {line}"));
    thrusts
        .decor_mut()
        .set_suffix(format!("{before}{}", lines.collect::<String>()));
}
