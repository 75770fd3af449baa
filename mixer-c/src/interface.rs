//! The Rust of the C interface: one function around the generated module.

use crate::airframe::Airframe;

/// Name of the C function.
pub(crate) fn function(module: &str, health: bool) -> String {
    if health {
        format!("{module}_mix_with_health")
    } else {
        format!("{module}_mix")
    }
}

/// A crate that exports this function alone.
pub(crate) fn rust(airframe: &Airframe, health: bool) -> String {
    let Airframe { compiled, module, .. } = airframe;
    let function = function(module, health);
    let (parameter, call) = if health {
        (
            "failed: u64, ",
            "airframe::mix_with_health(&setpoint, voltage_v, health(failed))",
        )
    } else {
        ("", "airframe::mix(&setpoint, voltage_v)")
    };
    let generated = compiled.rust();
    let health = if health { HEALTH } else { "" };
    format!(
        "{HEAD}mod generated {{
{generated}
}}
use generated::{module} as airframe;

#[repr(C)]
pub struct Mix {{
    throttle: [f32; airframe::CHANNELS],
    achieved: Wrench,
    saturation: u32,
}}
{health}
/// # Safety
/// `setpoint` and `out` point to their types.
#[unsafe(no_mangle)]
pub unsafe extern \"C\" fn {function}(setpoint: *const Wrench, voltage_v: f32, {parameter}out: *mut Mix) -> c_int {{
    let Wrench {{ roll_nm, pitch_nm, yaw_nm, thrust_n }} = unsafe {{ setpoint.read() }};
    let setpoint = mixer_rt::Wrench {{ roll_nm, pitch_nm, yaw_nm, thrust_n }};
    match {call} {{
        Ok(mix) => {{
            let mixer_rt::Wrench {{ roll_nm, pitch_nm, yaw_nm, thrust_n }} = mix.achieved;
            let achieved = Wrench {{ roll_nm, pitch_nm, yaw_nm, thrust_n }};
            let saturation = u32::from(mix.saturation.bits());
            unsafe {{
                let throttle = (&raw mut (*out).throttle).cast::<f32>();
                for (channel, value) in mix.throttle.iter().enumerate() {{
                    // Volatile: a copy of many words would be a call of memcpy.
                    throttle.add(channel).write_volatile(*value);
                }}
                (*out).achieved = achieved;
                (*out).saturation = saturation;
            }}
            0
        }}
        Err(SetpointError::NonFinite(axis)) => 1 + axis as c_int,
        Err(SetpointError::NonFiniteVoltage) => 5,
    }}
}}
"
    )
}

const HEAD: &str = "#![no_std]
use core::ffi::c_int;
use mixer_rt::SetpointError;

unsafe extern \"C\" {
    fn the_mixer_can_panic() -> !;
}

/// A panic that can be reached leaves that name undefined, and the object is refused.
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    unsafe { the_mixer_can_panic() }
}

#[repr(C)]
pub struct Wrench {
    roll_nm: f32,
    pitch_nm: f32,
    yaw_nm: f32,
    thrust_n: f32,
}

";

const HEALTH: &str = "
fn health(mut failed: u64) -> mixer_rt::Health {
    let mut health = mixer_rt::Health::GOOD;
    while failed != 0 {
        health = health.with_failed(failed.trailing_zeros() as u8);
        failed &= failed - 1;
    }
    health
}
";
