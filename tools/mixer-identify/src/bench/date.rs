//! The date of a measurement, from the file's name.

/// `YYYY-MM-DD` for the first date in a name such as `data2021_08_17_23_41.csv`,
/// `Log_2019-11-05_171350.csv` or `20210817_map.csv`.
pub fn date_in(name: &str) -> Option<String> {
    let bytes = name.as_bytes();
    let number = |range: std::ops::Range<usize>| -> Option<u32> {
        let digits = name.get(range)?;
        let are_digits = digits.bytes().all(|byte| byte.is_ascii_digit());
        digits.parse().ok().filter(|_| are_digits)
    };
    (0..bytes.len()).find_map(|at| {
        if at > 0 && bytes[at - 1].is_ascii_digit() {
            return None;
        }
        let year = number(at..at + 4).filter(|y| (1990..2100).contains(y))?;
        let step = usize::from(matches!(bytes.get(at + 4), Some(b'_' | b'-' | b'.')));
        let month = number(at + 4 + step..at + 6 + step).filter(|m| (1..=12).contains(m))?;
        let mark = bytes.get(at + 6 + step);
        if step == 1 && mark != bytes.get(at + 4) {
            return None;
        }
        let day =
            number(at + 6 + 2 * step..at + 8 + 2 * step).filter(|d| (1..=days(year, month)).contains(d))?;
        let followed = bytes.get(at + 8 + 2 * step).is_some_and(u8::is_ascii_digit);
        (!followed).then(|| format!("{year:04}-{month:02}-{day:02}"))
    })
}

/// Days of a month.
fn days(year: u32, month: u32) -> u32 {
    let is_leap = year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    match month {
        2 if is_leap => 29,
        2 => 28,
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}

#[cfg(test)]
mod tests {
    use super::date_in;

    #[test]
    fn dates_in_names() {
        let of = |name| date_in(name).unwrap_or_default();
        assert_eq!(of("data2021_08_17_23_41_12_16p2in.csv"), "2021-08-17");
        assert_eq!(of("Log_2019-11-05_171350.csv"), "2019-11-05");
        assert_eq!(of("20210817_map.csv"), "2021-08-17");
        assert_eq!(of("2024-02-29.csv"), "2024-02-29");
        for name in [
            "a1_11.csv",
            "map_2300kv_8045.csv",
            "2021-13-05.csv",
            "2021-02-29.csv",
            "2021-04-31.csv",
            "serial20210817123.csv",
            "",
        ] {
            assert_eq!(of(name), "", "{name}");
        }
    }
}
