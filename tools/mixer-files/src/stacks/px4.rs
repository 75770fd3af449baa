//! PX4 Autopilot.

pub(crate) mod import;
pub(crate) mod log;
pub(crate) mod params;
mod ulog;
