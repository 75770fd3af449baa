//! Runtime of compiled coaxial multirotor mixers.
//!
//! A coaxial push-pull multirotor has `n` units of two stacked, contra-rotating rotors. The lower
//! rotor works in the wake of the upper one, so a unit's thrust and torque are polynomials of
//! *both* throttles (Chebbi et al. 2020, eq. (1)). This crate evaluates what `mixer-compiler` has
//! tabulated from an airframe file. Firmware calls the `mix` of the module that
//! `mixer_macros::airframe!` or `mixer_compiler::build_script` makes of that file, which calls
//! `tables::mix`. What firmware handles is documented here. What the generated module needs is in
//! `tables`, which is hidden: it changes with the compiler, and generated code asserts its format.
//!
//! ```
//! use mixer_rt::{SetpointError, Wrench};
//!
//! // The module that `mixer_macros::airframe!("airframes/isae-x8.toml");` makes.
//! # include!(concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/golden/isae-x8.rs"));
//! fn main() -> Result<(), SetpointError> {
//!     let setpoint = Wrench { roll_nm: 0.5, thrust_n: 31.4, ..Wrench::default() };
//!     let mix = isae_x8::mix(&setpoint, 14.8)?; // at 14.8 V
//!     assert!(mix.throttle.iter().all(|throttle| (0.1..=1.0).contains(throttle)));
//!     assert!((mix.achieved.roll_nm - 0.5).abs() < 0.001);
//!     assert!(!mix.saturation.any_axis());
//!     Ok(())
//! }
//! ```
//!
//! ```text
//! setpoint u = [roll, pitch, yaw, thrust]                                           wrench.rs
//!   -> factors of voltage and density                                                    conditions.rs
//!   -> throttles                   of least norm, else of the request cut by priority   allocate.rs
//!        of every unit                 inverse of (f, Q)(u, l)                              pair/inverse.rs
//!   -> achieved wrench             M (k_f f(u, l), k_Q Q(u, l))                          mix.rs
//!   -> throttles of rotors under way                                                     dynamic.rs
//! ```
//!
//! No heap, no dependencies, no panic path, no `unsafe` but for the hardware square root. All
//! arithmetic is plain IEEE 754 single precision (`+ - * /` and a correctly rounded square root),
//! so the bits are the same on every target.
//!
//! Conventions: body frame FRD (x forward, y right, z down), SI units, clockwise yaw seen from
//! above positive, thrust positive upwards; throttles inside `[min, max]` within `[0, 1]`.
#![no_std]

mod allocate;
mod arithmetic;
#[cfg(feature = "serde")]
mod array;
mod conditions;
mod dynamic;
mod health;
mod layout;
mod mix;
mod pair;
mod saturation;
#[doc(hidden)]
pub mod tables;
mod wrench;

pub(crate) use arithmetic::{clamp, divided, divisor, larger, quotient, rolled, smaller, sqrt};
pub use conditions::Conditions;
pub use dynamic::RotorState;
pub use health::Health;
pub use mix::{Airframe, Mix, Outputs};
pub use saturation::{Direction, Saturation};
pub use wrench::{Axis, SetpointError, Wrench};

/// Hands the path and the text of each file of this crate to `of`, for `cargo mixer library`, which compiles it for
/// another target.
#[doc(hidden)]
#[cfg(feature = "sources")]
pub fn sources(of: &mut dyn FnMut(&'static str, &'static [u8])) {
    type Folder = include_dir::Dir<'static>;
    static SOURCES: Folder = include_dir::include_dir!("$CARGO_MANIFEST_DIR/src");
    fn visit(folder: &'static Folder, of: &mut dyn FnMut(&'static str, &'static [u8])) {
        for file in folder.files() {
            of(file.path().to_str().unwrap_or_default(), file.contents());
        }
        folder.dirs().for_each(|folder| visit(folder, of));
    }
    visit(&SOURCES, of);
}
