//! Numbers as people and spreadsheets write them: `1,234.5`, `1 234`, `0,07`, `40 %`, `22.2V`.
//!
//! A comma or a point with three digits behind it and one to three before it, as `1,234`, says 1.234
//! or 1234. Every other form has one meaning and proves the decimal mark of its column, else of its
//! file: one program wrote it.

/// A cell taken apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cell<'a> {
    /// Digits, marks and exponent.
    pub number: &'a str,
    /// What stands behind them.
    pub unit: &'a str,
}

/// Whether a cell holds nothing but dashes and the like.
pub fn is_blank(cell: &str) -> bool {
    !cell.contains(|c: char| c.is_alphanumeric() || matches!(c, '#' | '%'))
}

/// Whether a cell holds no value: nothing, dashes, what spreadsheets and programs write for it
/// (`#DIV/0!`, `#NV`, `n/a`, `NaN`).
pub fn is_missing(cell: &str) -> bool {
    const WORDS: [&str; 6] = ["nan", "na", "n/a", "null", "none", "nil"];
    let cell = cell.trim();
    cell.starts_with('#') || is_blank(cell) || WORDS.iter().any(|word| cell.eq_ignore_ascii_case(word))
}

impl Cell<'_> {
    /// The number at the beginning of a cell, and the rest.
    pub fn of(cell: &str) -> Option<Cell<'_>> {
        let cell = cell.trim();
        // Nearly all are no more than a number.
        if cell.parse().is_ok_and(f64::is_finite) {
            return Some(Cell {
                number: cell,
                unit: "",
            });
        }
        let bytes = cell.as_bytes();
        let digit = |at: usize| bytes.get(at).is_some_and(u8::is_ascii_digit);
        let mut at = usize::from(cell.starts_with(['+', '-']));
        let begin = at;
        while let Some(byte) = bytes.get(at) {
            let after_digit = at > begin && digit(at - 1);
            match byte {
                b'0'..=b'9' => at += 1,
                b',' | b'.' if after_digit || digit(at + 1) => at += 1,
                b' ' | b'\'' if after_digit && (1..4).all(|k| digit(at + k)) && !digit(at + 4) => at += 4,
                _ => break,
            }
        }
        if !cell[begin..at].contains(|c: char| c.is_ascii_digit()) {
            return None;
        }
        if bytes.get(at).is_some_and(|byte| matches!(byte, b'e' | b'E')) {
            let sign = usize::from(matches!(bytes.get(at + 1), Some(b'+' | b'-')));
            if digit(at + 1 + sign) {
                at += 1 + sign;
                while digit(at) {
                    at += 1;
                }
            }
        }
        let (number, unit) = cell.split_at(at);
        let unit = unit.trim_start();
        Some(Cell { number, unit })
    }

    /// Whether it is a number, maybe with a unit; no date, time or name.
    pub fn is_number(&self) -> bool {
        !self.unit.contains(|c: char| c.is_ascii_digit())
    }

    /// The value of the number by this decimal mark; before it, a mark stands before every three digits
    /// or nowhere.
    pub fn value(&self, decimal: char) -> Option<f64> {
        // Nearly all are written this way.
        if decimal == '.'
            && let Ok(value) = self.number.parse()
        {
            return Some(value);
        }
        let (mantissa, exponent) = self
            .number
            .split_at(self.number.find(['e', 'E']).unwrap_or(self.number.len()));
        let (whole, part) = mantissa.split_once(decimal).unwrap_or((mantissa, ""));
        let sign = if whole.starts_with('-') { "-" } else { "" };
        let whole = whole.trim_start_matches(['+', '-']);
        let mark = whole
            .find(|c: char| !c.is_ascii_digit())
            .map(|at| &whole[at..=at]);
        let groups: Vec<&str> = mark.map_or(vec![whole], |mark| whole.split(mark).collect());
        let grouped = groups.len() == 1
            || exponent.is_empty()
                && !whole.starts_with('0')
                && groups[0].len() <= 3
                && groups[1..].iter().all(|group| group.len() == 3);
        if !grouped {
            return None;
        }
        format!("{sign}{}.{part}{exponent}", groups.concat()).parse().ok()
    }
}

/// How the numbers of a column, or of a file, are written.
#[derive(Debug, Clone, Default)]
pub struct Style {
    /// Numbers that have a value by a decimal point alone, and by a decimal comma alone.
    proofs: [usize; 2],
    /// Line and text of the first number that has a value by each.
    open: Option<(u64, String)>,
    /// Whether such numbers have a point, and a comma.
    open_marks: [bool; 2],
    /// Whole numbers without marks: of one or two digits, of three, of more.
    plain: [usize; 3],
}

const MARKS: [char; 2] = ['.', ','];

impl Style {
    /// Counts a number.
    pub fn add(&mut self, line: u64, cell: &Cell<'_>) {
        match MARKS.map(|mark| cell.value(mark)) {
            [Some(point), Some(comma)] if point == comma => {
                let digits = cell.number.trim_start_matches(['+', '-']);
                if digits.bytes().all(|byte| byte.is_ascii_digit()) {
                    self.plain[digits.len().clamp(2, 4) - 2] += 1;
                }
            }
            [Some(_), Some(_)] => {
                self.open_marks[usize::from(cell.number.contains(','))] = true;
                self.open.get_or_insert_with(|| (line, cell.number.to_owned()));
            }
            [point, comma] => {
                self.proofs[0] += usize::from(point.is_some());
                self.proofs[1] += usize::from(comma.is_some());
            }
        }
    }

    /// Adds the proofs of another column.
    pub fn join(&mut self, other: &Style) {
        for mark in [0, 1] {
            self.proofs[mark] += other.proofs[mark];
        }
    }

    /// The decimal mark of this column in a file of this style.
    ///
    /// # Errors
    /// Line and text of a number that may be of either mark.
    pub fn decimal(&self, file: &Style) -> Result<char, (u64, String)> {
        let of = |[points, commas]: [usize; 2]| MARKS[usize::from(commas > points)];
        if self.proofs != [0, 0] {
            return Ok(of(self.proofs));
        }
        let unproven = (file.proofs[0] > 0) == (file.proofs[1] > 0);
        match (&self.open, self.open_marks, self.plain) {
            (None, ..) => Ok(of(file.proofs)),
            _ if !unproven => Ok(of(file.proofs)),
            // Programs write a decimal point with as many digits everywhere.
            (_, [true, false], [0, 0, 0]) if file.proofs == [0, 0] => Ok('.'),
            // Who groups thousands does so everywhere, and has hundreds beside them.
            (_, [true, false], [_, 2..=usize::MAX, 0]) => Ok(','),
            (_, [false, true], [_, 2..=usize::MAX, 0]) => Ok('.'),
            (Some(open), ..) => Err(open.clone()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn style(numbers: &[&str]) -> Style {
        let mut style = Style::default();
        numbers
            .iter()
            .for_each(|number| style.add(1, &Cell { number, unit: "" }));
        style
    }

    #[test]
    fn cells_are_taken_apart() {
        for (cell, number, unit) in [
            ("-1.5e-3", "-1.5e-3", ""),
            ("40 %", "40", "%"),
            ("22.2V", "22.2", "V"),
            ("1 234.5 g", "1 234.5", "g"),
            ("1'234", "1'234", ""),
            ("12 34", "12", "34"),
            ("16x5.4", "16", "x5.4"),
            (".5", ".5", ""),
            ("5.", "5.", ""),
            ("3 e", "3", "e"),
        ] {
            assert_eq!(Cell::of(cell), Some(Cell { number, unit }), "{cell}");
        }
        for cell in ["", "-", "x1", "inf", ".", "Motor 5"] {
            assert_eq!(Cell::of(cell), None, "{cell}");
        }
    }

    #[test]
    fn marks_give_values() {
        for (number, decimal, value) in [
            ("1,234.5", '.', Some(1234.5)),
            ("1.234,5", ',', Some(1234.5)),
            ("1,234,567", '.', Some(1_234_567.0)),
            ("-1'234.5", '.', Some(-1234.5)),
            ("1 234", ',', Some(1234.0)),
            ("1.234", ',', Some(1234.0)),
            ("1,234", ',', Some(1.234)),
            ("0,5e-3", ',', Some(5e-4)),
            ("0,5", '.', None),
            ("12,34.5", '.', None),
            ("1,5,5", ',', None),
            ("1,234'567", '.', None),
        ] {
            let unit = "";
            assert_eq!(Cell { number, unit }.value(decimal), value, "{number} {decimal}");
        }
    }

    #[test]
    fn the_decimal_mark_is_that_of_the_column_else_of_the_file() {
        let points = style(&["0.5", "22.25"]);
        let commas = style(&["0,5"]);
        let none = Style::default();
        for (numbers, file, wanted) in [
            (&["1,234.5", "820"][..], &commas, Ok('.')),
            (&["1,234", "820"], &points, Ok('.')),
            (&["1.234", "820"], &commas, Ok(',')),
            (&["1.234", "2.345"], &none, Ok('.')),
            (&["1.234", "820"], &none, Err("1.234")),
            (&["1.234", "820", "905"], &none, Ok(',')),
            (&["1,234", "820", "905"], &none, Ok('.')),
            (&["1,234", "820", "1905"], &none, Err("1,234")),
            (&["1,234", "2,345"], &none, Err("1,234")),
            (&["1 234,5"], &none, Ok(',')),
            (&["820"], &commas, Ok(',')),
        ] {
            let told = style(numbers).decimal(file);
            assert_eq!(
                told.as_ref().map_err(|(_, open)| open.as_str()),
                wanted.as_ref().map_err(|open| *open)
            );
        }
        let mut both = points.clone();
        both.join(&commas);
        assert!(style(&["1.234"]).decimal(&both).is_err());
    }
}
