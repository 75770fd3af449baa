//! The supply voltage: its laws, and the checks of what the file says of them.

mod check;
mod largest;
mod law;
mod least;

pub(super) use self::check::{TABLE, read};
pub use self::law::{Voltage, VoltageLaw};
