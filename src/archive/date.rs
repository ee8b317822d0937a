//! The time of an archive: told from outside, never read from a clock.

use super::ArchiveError;

/// Seconds since 1970, if any were told.
pub(super) type Moment = Option<u32>;

/// `SOURCE_DATE_EPOCH` (reproducible-builds.org), if it is set.
pub(super) fn told() -> Result<Moment, ArchiveError> {
    match std::env::var("SOURCE_DATE_EPOCH") {
        Ok(text) => match text.parse() {
            Ok(seconds) => Ok(Some(seconds)),
            Err(_) => Err(ArchiveError::Epoch(text)),
        },
        Err(std::env::VarError::NotPresent) => Ok(None),
        Err(std::env::VarError::NotUnicode(text)) => {
            Err(ArchiveError::Epoch(text.to_string_lossy().into_owned()))
        }
    }
}

/// The day in which a second lies, as `YYYY-MM-DD`, in UTC.
///
/// Years that begin in March have the leap day at their end: E. G. Richards, *Mapping Time* (1998), chapter 25.
pub(super) fn day(seconds: u32) -> String {
    /// Days from 1 March of year 0 to 1 January 1970.
    const TO_1970: u32 = 719_468;
    /// Days of 400 years.
    const ERA: u32 = 146_097;
    let days = seconds / 86_400 + TO_1970;
    let (era, day) = (days / ERA, days % ERA);
    let year = (day - day / 1460 + day / 36_524 - day / (ERA - 1)) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    // From March: 153 days every five months.
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let (month, next) = if month < 10 {
        (month + 3, 0)
    } else {
        (month - 9, 1)
    };
    format!("{:04}-{month:02}-{day:02}", 400 * era + year + next)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_of_the_calendar() {
        // As `date -u -d @N +%F` has them.
        for (seconds, wanted) in [
            (0, "1970-01-01"),
            (86_399, "1970-01-01"),
            (86_400, "1970-01-02"),
            (68_169_600, "1972-02-29"),
            (951_782_400, "2000-02-29"),
            (951_868_800, "2000-03-01"),
            (1_700_000_000, "2023-11-14"),
            (1_735_689_599, "2024-12-31"),
            (4_107_542_399, "2100-02-28"),
            (4_107_542_400, "2100-03-01"),
            (u32::MAX, "2106-02-07"),
        ] {
            assert_eq!(day(seconds), wanted, "{seconds}");
        }
    }
}
