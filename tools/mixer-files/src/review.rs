//! A flight log of PX4 or ArduPilot over the model of a compiled airframe: whether the model is true of
//! the vehicle.
//!
//! ```text
//! bytes of a log -> topics and parameters        log.rs; ../stacks/{px4/ulog,ardupilot/dataflash}.rs
//!   -> a flight, in one form for both stacks     flight.rs; ../stacks/*/log.rs
//!   -> one of this vehicle, or refused           read.rs
//!   -> instants in the air, and the model's wrench at the logged throttles    rows.rs
//!   -> what that says of the model               compare.rs: thrust.rs, rotors.rs, saturated.rs; result.rs
//!   -> what deserves a look                      warnings.rs
//!   -> text; the airframe file with the scale    text.rs, scaled.rs
//! ```
//!
//! Nothing here reads or writes files.

mod compare;
pub(crate) mod flight;
pub(crate) mod log;
pub(crate) mod read;
mod result;
mod rotors;
mod rows;
mod saturated;
mod scaled;
mod text;
mod thrust;
mod warnings;

pub use crate::review::flight::Flight;
pub use crate::review::log::Series;
pub use crate::review::result::{Options, Review};
pub use crate::review::scaled::scaled;
