//! ArduPilot's Copter.

mod dataflash;
pub(crate) mod frames;
pub(crate) mod import;
pub(crate) mod log;
pub(crate) mod params;
