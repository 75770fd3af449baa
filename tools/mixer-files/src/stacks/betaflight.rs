//! Betaflight, and INAV where its files are the same.

mod frames;
pub(crate) mod import;
pub(crate) mod params;
