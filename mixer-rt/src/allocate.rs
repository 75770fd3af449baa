//! From a wrench to throttles.
//!
//! **The throttles nearest those of least norm among those that cut the request least, by priority:**
//!
//! ```text
//! 1. roll and pitch, jointly scaled       their direction stays
//! 2. yaw up to the reserve
//! 3. thrust, nearest the request          airmode `roll-pitch-yaw`: after 4
//! 4. the rest of yaw                      with rotors out: yaw, nearest the request
//! ```
//!
//! With all rotors no torque is reversed or exceeded. With rotors out yaw may be, where roll, pitch or thrust need it: a rotor
//! alone in its unit turns the vehicle one way.
//!
//! With airmode `disabled` no priority raises the thrust above the request, or above what level flight
//! needs. Costs say so: where units differ, thrust may rise by a share of its authority where that frees five times the share
//! of roll and pitch.
//!
//! Where least norm gives the request, that is the answer; what cannot be given has two methods:
//!
//! ```text
//! all rotors     least norm, eq. (8)                                  allocate/least_norm.rs
//!                up to four vertical pairs alike: in closed form      allocate/closed_form.rs
//!                else an interior point method on the throttles       allocate/interior.rs
//! rotors out     nearest the whole frame's least norm                 allocate/rotors_alone.rs
//!                else the interior point method
//! ```
//!
//! A single rotor is a pair whose partner is out: least norm of frames that have one is that with rotors out.

pub(crate) mod closed_form;
mod frame;
pub(crate) mod interior;
pub(crate) mod least_norm;
pub(crate) mod power_bias;
pub(crate) mod priorities;
mod request;
mod rotors_alone;
mod system;
pub(crate) mod unit;
mod unknown;

use core::hint::black_box;

use crate::layout::Tables;
use crate::pair::Kinds;
use crate::pair::rotors::Rotors;
use closed_form::AllocationMethod;
use frame::Frame;
use unit::UnitState;

/// Writes throttles that serve `wrench` (`[roll, pitch, yaw, thrust]`, bounded) into the units' states,
/// which hold the rotors that turn. `factors` is `[k_f, k_Q]`. `is_whole` tells that all rotors turn. True
/// where these are the throttles of least norm, with all rotors.
#[inline(never)]
pub(crate) fn allocate<K: Kinds, S: AllocationMethod, const VERTICAL: bool>(
    tables: &Tables<'_, K, S>,
    wrench: &[f32; 4],
    factors: [f32; 2],
    units: &mut [UnitState],
    is_whole: bool,
) -> bool {
    // With the tables or the number of units known the compiler would write every loop over them out.
    let (tables, units) = black_box((tables, units));
    let frame = Frame::<_, _, VERTICAL>::new(tables, factors);
    if frame.serve(wrench, units, is_whole) {
        return is_whole;
    }
    if !frame.cut(wrench, units, is_whole) {
        frame.guard(wrench, units, is_whole);
    }
    false
}

/// Whether least norm serves a wrench with all rotors; `units` then have the throttles. For the compiler.
pub fn least_norm<K: Kinds, S: AllocationMethod>(
    tables: &Tables<'_, K, S>,
    wrench: &[f32; 4],
    factors: [f32; 2],
    units: &mut [UnitState],
) -> bool {
    for (index, unit) in units.iter_mut().enumerate() {
        unit.rotors = Rotors::all(tables.is_single(index));
    }
    Frame::<_, _, false>::new(tables, factors).serve(wrench, units, true)
}
