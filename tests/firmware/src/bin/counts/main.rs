//! Counts the instructions of one mixer, request by request.
//!
//! Which one: see `src/subject`. What it does is the host's order (`order.rs`). Without one it
//! measures three sets: `attainable` and `saturated`, drawn by the host
//! (`mixer_setpoints::Requests`), and `given`, requests that come with the order. It prints a line
//! per set: how many, the sum, the median and the worst of their instructions, and the deepest
//! stack. Ordered to search, it prints the most expensive requests that it finds: their instructions,
//! and roll, pitch, yaw, thrust, voltage as f32 bits with the rotors that are out.
//!
//! Both are one image, hence the mixer has the same instructions in both. Only one airframe is
//! linked, as in a user's image: what is inlined depends on who else calls it.
#![no_std]
#![no_main]

#[cfg(airframe)]
mod measurement;
#[cfg(airframe)]
mod order;
#[cfg(airframe)]
mod request;
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
