//! The mixer of `cargo mixer library`, called as a C program calls it. The tests make the library,
//! link it, and give its function this name.

use core::mem::MaybeUninit;

use mixer_rt::{Health, Wrench};

use super::airframe;

/// Throttles, and whether no axis is saturated; or the status.
pub(crate) type Mixed = Result<([f32; airframe::CHANNELS], bool), i32>;

/// `mixer_wrench_t`.
#[repr(C)]
struct Setpoint {
    roll_nm: f32,
    pitch_nm: f32,
    yaw_nm: f32,
    thrust_n: f32,
}

/// `M_mix_t`.
#[repr(C)]
struct Output {
    throttle: [f32; airframe::CHANNELS],
    achieved: Setpoint,
    saturation: u32,
}

unsafe extern "C" {
    fn c_interface_mix(setpoint: *const Setpoint, voltage_v: f32, output: *mut Output) -> i32;
}

/// It has no state.
pub(crate) fn prepare() {}

#[inline(always)]
pub(crate) fn mix(setpoint: &Wrench, voltage_v: f32, _: Health) -> Mixed {
    let &Wrench {
        roll_nm,
        pitch_nm,
        yaw_nm,
        thrust_n,
    } = setpoint;
    let setpoint = Setpoint {
        roll_nm,
        pitch_nm,
        yaw_nm,
        thrust_n,
    };
    let mut output = MaybeUninit::<Output>::uninit();
    // SAFETY: both pointers are to what the header says; the output is written where the status is
    // 0.
    unsafe {
        match c_interface_mix(&setpoint, voltage_v, output.as_mut_ptr()) {
            0 => {
                let output = output.assume_init_ref();
                Ok((output.throttle, output.saturation == 0))
            }
            status => Err(status),
        }
    }
}
