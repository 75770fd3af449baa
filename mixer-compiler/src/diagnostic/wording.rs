//! Words and numbers as a user would write them, and what the user may have meant.

/// The candidate nearest to `word`: within a third of its letters in edits, case and separators
/// aside, or else one that continues it (`arm` for `arm_m`). `None` where nothing is near.
pub(crate) fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // Distances cost the product of the lengths; no key is nearly this long.
    if word.len() > 64 {
        return None;
    }
    let word = plain(word);
    let allowed = (word.chars().count() / 3).max(1);
    candidates
        .into_iter()
        .filter_map(|candidate| {
            let other = plain(candidate);
            let distance = strsim::osa_distance(&word, &other);
            let continued = word.len() >= 3 && other.starts_with(&word);
            (distance <= allowed || continued).then_some((distance.min(allowed + 1), candidate))
        })
        // The first of equals, so that the order of the candidates decides.
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, candidate)| candidate)
}

/// Lower case, `-` for the separators that people mix up.
fn plain(word: &str) -> String {
    word.chars()
        .map(|c| {
            if matches!(c, '_' | ' ') {
                '-'
            } else {
                c.to_ascii_lowercase()
            }
        })
        .collect()
}

/// True for a character that shows as itself and in its place: no control character, no mark that
/// reorders text (CVE-2021-42574), no separator of lines or paragraphs, no byte order mark.
pub fn is_plain(c: char) -> bool {
    !c.is_control()
        && !matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{feff}')
}

/// Text of others, such as the name of a file, on one line of a terminal: characters that are not
/// [plain](is_plain) are escaped.
pub fn printable(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        if is_plain(c) {
            shown.push(c);
        } else {
            shown.extend(c.escape_default());
        }
    }
    shown
}

/// [`printable`] text, of which the ends of lines and tabs stay: names of files and comments of
/// other files are in it.
pub fn printable_lines(text: &str) -> String {
    let is_kept = |c| matches!(c, '\n' | '\t');
    let parts = text.split_inclusive(is_kept).map(|part| {
        let plain = part.trim_end_matches(is_kept);
        printable(plain) + &part[plain.len()..]
    });
    parts.collect()
}

/// The text, of which at most `longest` characters are left.
pub fn cut_to(text: String, longest: usize) -> String {
    match text.char_indices().nth(longest) {
        Some((end, _)) => format!("{} ..", &text[..end]),
        None => text,
    }
}

/// Units that stay with their number, and the `m` of N m with its N.
const UNITS: [&str; 10] = ["%", "N", "m", "V", "W", "A", "g", "kg", "mm", "degrees"];

/// The words of a text, a number and its unit as one.
fn words(text: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let bare = word.trim_end_matches([',', ';', '.', ':', ')']);
        match words.last_mut() {
            Some(last)
                if UNITS.contains(&bare) && last.ends_with(|c: char| c.is_ascii_digit() || c == 'N') =>
            {
                last.push(' ');
                last.push_str(word);
            }
            _ => words.push(word.to_owned()),
        }
    }
    words
}

/// Breaks text at blanks into lines of at most `width` characters. A unit stays with its number.
pub fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in words(text) {
        let line = lines.len() - 1;
        if !lines[line].is_empty() && lines[line].chars().count() + 1 + word.chars().count() > width {
            lines.push(word);
        } else {
            if !lines[line].is_empty() {
                lines[line].push(' ');
            }
            lines[line].push_str(&word);
        }
    }
    lines
}

/// [`wrapped`], with `mark` before the first line and blanks before the others.
pub fn hanging(mark: &str, text: &str, width: usize) -> impl ExactSizeIterator<Item = String> {
    let lines = wrapped(text, width).into_iter().enumerate();
    lines.map(move |(k, line)| if k == 0 { mark } else { "  " }.to_owned() + &line)
}

/// [`hanging`] as comments of TOML, each ended.
pub fn commented(mark: &str, text: &str, width: usize) -> String {
    hanging(mark, text, width)
        .map(|line| format!("# {line}\n"))
        .collect()
}

/// Text of the user's between backticks, on one line and of bounded length.
pub(crate) fn quoted(text: &str) -> String {
    const LONGEST: usize = 48;
    let mut shown: String = text.chars().take(LONGEST).flat_map(char::escape_debug).collect();
    if text.chars().nth(LONGEST).is_some() {
        shown.push_str("..");
    }
    format!("`{shown}`")
}

/// `` `a`, `b` or `c` ``.
pub(crate) fn any_of<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    let words: Vec<String> = words.into_iter().map(|word| format!("`{word}`")).collect();
    match words.split_last() {
        None => String::new(),
        Some((only, [])) => only.clone(),
        Some((last, others)) => format!("{} or {last}", others.join(", ")),
    }
}

/// A number as the file may have it: no `.0`, an exponent only where zeros would have to be
/// counted.
pub(crate) fn number(x: f64) -> String {
    if x != 0.0 && !(1e-4..1e7).contains(&x.abs()) {
        format!("{x:e}")
    } else {
        format!("{x}")
    }
}

/// A computed number to four significant digits.
pub fn rounded(x: f64) -> String {
    number(format!("{x:.3e}").parse().unwrap_or(x))
}

/// A bound to three significant digits, rounded up, in the shortest form that a file can hold.
pub fn rounded_up(x: f64) -> String {
    if x <= 0.0 || !x.is_finite() {
        return format!("{x:?}");
    }
    let mut text = format!("{x:.2e}");
    if text.parse::<f64>().is_ok_and(|rounded| rounded < x) {
        let unit = text
            .split_once('e')
            .and_then(|(_, exponent)| format!("0.01e{exponent}").parse::<f64>().ok());
        text = format!("{:.2e}", x + unit.unwrap_or(0.0));
    }
    text.parse::<f64>().map_or(text, |rounded| format!("{rounded:?}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_finds_typing_errors_and_nothing_else() {
        let words = [
            "arm_m",
            "units",
            "first_angle_deg",
            "first_spin",
            "spins",
            "channels",
        ];
        assert_eq!(nearest("unit", words), Some("units"));
        assert_eq!(nearest("arm", words), Some("arm_m"));
        assert_eq!(nearest("chanels", words), Some("channels"));
        assert_eq!(nearest("first-angle", words), Some("first_angle_deg"));
        assert_eq!(
            nearest("bilinear-newtown", ["bilinear", "bilinear-newton"]),
            Some("bilinear-newton")
        );
        assert_eq!(nearest("maximum_rpm", ["min", "max"]), None);
        assert_eq!(nearest("mass_kg", words), None);
        assert_eq!(nearest("", words), None);
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!(number(318.0), "318");
        assert_eq!(number(1e-4), "0.0001");
        assert_eq!(number(1e300), "1e300");
        assert_eq!(rounded(0.123_456_789), "0.1235");
        assert_eq!(rounded(-0.0), "-0");
        assert_eq!(rounded(f64::NAN), "NaN");
    }

    #[test]
    fn what_does_not_print_is_escaped() {
        assert_eq!(printable("é 飛 \\\t\n"), "é 飛 \\\\t\\n");
        let all =
            "\0\r\u{1b}\u{7f}\u{9b}\u{61c}\u{200e}\u{2028}\u{2029}\u{202a}\u{202e}\u{2066}\u{2069}\u{feff}";
        assert!(!all.chars().any(is_plain));
        assert!(printable(all).is_ascii() && !printable(all).contains(|c: char| c.is_control()));
        assert_eq!(printable("a\rb\u{202e}"), "a\\rb\\u{202e}");
    }

    #[test]
    fn quoted_is_one_short_line() {
        assert_eq!(quoted("a\nb"), "`a\\nb`");
        assert!(quoted(&"é".repeat(1000)).chars().count() <= 52);
    }

    #[test]
    fn bounds_are_rounded_up() {
        assert_eq!(rounded_up(0.003_211), "0.00322");
        assert_eq!(rounded_up(0.009_999), "0.01");
        assert_eq!(rounded_up(3.6e-5), "3.6e-5");
        assert_eq!(rounded_up(1234.5), "1240.0");
    }

    #[test]
    fn a_unit_stays_with_its_number() {
        let lines = wrapped("thrust of 12.5 N, 0.2 N m at 3 % or more", 12);
        assert_eq!(lines, ["thrust of", "12.5 N,", "0.2 N m at", "3 % or more"]);
    }
}
