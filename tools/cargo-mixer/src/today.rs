//! The day on which the program runs.

use std::env;
use std::time::{SystemTime, UNIX_EPOCH};

/// Today as `YYYY-MM-DD`. `SOURCE_DATE_EPOCH`, seconds since 1970, stands for now
/// (reproducible-builds.org).
pub(crate) fn today() -> Option<String> {
    let stated = env::var("SOURCE_DATE_EPOCH").ok();
    let stated = stated.and_then(|text| text.parse().ok());
    let seconds = stated.or_else(|| {
        let passed = SystemTime::now().duration_since(UNIX_EPOCH);
        passed.ok().map(|passed| passed.as_secs())
    });
    seconds.map(date)
}

/// The date (UTC) of seconds since 1970. Days are counted from 1 March of year 0, so that leap days
/// end their years; 400 years have 146,097 days.
fn date(seconds: u64) -> String {
    let days = seconds / 86_400 + 719_468;
    let (cycle, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1_460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    // Months from March on have 153 days in five.
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    let year = 400 * cycle + year + u64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02}")
}

#[cfg(test)]
mod tests {
    use super::date;

    /// By GNU date.
    #[test]
    fn dates_are_those_of_the_calendar() {
        let days = [
            (0, "1970-01-01"),
            (951_782_399, "2000-02-28"),
            (951_782_400, "2000-02-29"),
            (951_868_800, "2000-03-01"),
            (1_735_689_599, "2024-12-31"),
            (1_795_392_000, "2026-11-23"),
            (4_107_542_400, "2100-03-01"),
        ];
        for (seconds, day) in days {
            assert_eq!(date(seconds), day);
        }
    }
}
