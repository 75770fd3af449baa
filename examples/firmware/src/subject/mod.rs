//! The mixer that an image measures: one airframe's, `--cfg airframe --cfg airframe="<name>"`, or what flight stacks do
//! with that airframe, in addition `--cfg baseline --cfg baseline="conventional"`, `"sequential"` or `"wls"`.

#[cfg(not(baseline))]
mod coaxial;
#[cfg(any(baseline = "conventional", baseline = "sequential"))]
mod isolated;
#[cfg(baseline = "wls")]
mod wls;

#[cfg(not(baseline))]
pub(crate) use coaxial::*;
#[cfg(any(baseline = "conventional", baseline = "sequential"))]
pub(crate) use isolated::*;
#[cfg(baseline = "wls")]
pub(crate) use wls::*;

include!(concat!(env!("OUT_DIR"), "/subject.rs"));
