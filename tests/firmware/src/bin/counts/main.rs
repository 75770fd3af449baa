//! Counts the instructions of one mixer, request by request.
//!
//! Which one: see `src/subject`. Prints a line per set of requests: how many, the sum, the median
//! and the worst of their instructions, the deepest stack, and the request that cost most (roll,
//! pitch, yaw, thrust, voltage as f32 bits). The sets are `attainable` and `saturated`, drawn by
//! the host (`mixer_setpoints::Requests`), and `searched`: what a random search for the most
//! expensive requests tries. Only one airframe is linked, as in a user's image: what is inlined
//! depends on who else calls it.
#![no_std]
#![no_main]

#[cfg(airframe)]
mod measurement;
#[cfg(airframe)]
mod search;
#[cfg(airframe)]
#[path = "../../subject/mod.rs"]
mod subject;

use cortex_m_rt::entry;

include!(concat!(env!("OUT_DIR"), "/requests.rs"));

#[entry]
fn main() -> ! {
    #[cfg(airframe)]
    let passed = measurement::run();
    #[cfg(not(airframe))]
    let passed = probe::no_airframe();
    probe::exit(passed)
}
