//! Origin of a report page: the hash of the airframe file and the day.

/// Date and hash; pages of equal files and no date are equal.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Origin {
    /// SHA-256 of the airframe file in hexadecimal, as `sha256sum` prints it.
    pub sha256: Option<String>,
    /// `YYYY-MM-DD`.
    pub date: Option<String>,
}
