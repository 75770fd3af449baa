//! The mixer that an image measures: one airframe's, `--cfg airframe --cfg airframe="<name>"`, or
//! what flight stacks do with that airframe, in addition `--cfg baseline --cfg
//! baseline="conventional"`, `"sequential"` or `"wls"`, or its library for C, `"c-interface"`, or the mixer with rotors under way, `"dynamic"`. With
//! `--cfg rotors_out="1"` or `"2"` the airframe's mixer is asked with so many rotors out.

#[cfg(baseline = "c-interface")]
mod c_interface;
#[cfg(not(baseline))]
mod coaxial;
#[cfg(baseline = "dynamic")]
mod dynamic;
#[cfg(any(baseline = "conventional", baseline = "sequential"))]
mod isolated;
#[cfg(baseline = "wls")]
mod wls;

#[cfg(baseline = "c-interface")]
pub(crate) use c_interface::*;
#[cfg(not(baseline))]
pub(crate) use coaxial::*;
#[cfg(baseline = "dynamic")]
pub(crate) use dynamic::*;
#[cfg(any(baseline = "conventional", baseline = "sequential"))]
pub(crate) use isolated::*;
#[cfg(baseline = "wls")]
pub(crate) use wls::*;

/// Rotors that are out in every request.
pub(crate) const ROTORS_OUT: u32 = if cfg!(rotors_out = "1") {
    1
} else if cfg!(rotors_out = "2") {
    2
} else {
    0
};

include!(concat!(env!("OUT_DIR"), "/subject.rs"));
