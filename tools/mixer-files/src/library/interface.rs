//! The Rust of the C interface: the mixer at the bench's air density and in air of a measured one, around the
//! generated module.

use crate::library::airframe::Airframe;

/// Names of the C functions: at the bench's density, and under conditions.
pub(crate) fn functions(module: &str, health: bool) -> [String; 2] {
    let health = if health { "_with_health" } else { "" };
    ["mix", "mix_in"].map(|mix| format!("{module}_{mix}{health}"))
}

/// A crate that exports these functions alone. Both jump to a third, so that the mixer is there once.
pub(crate) fn rust(airframe: &Airframe, health: bool) -> String {
    let Airframe { compiled, module, .. } = airframe;
    let [mix, mix_in] = functions(module, health);
    let (parameter, argument, call) = if health {
        (
            "failed: u64, ",
            "failed, ",
            "airframe::mix_with_health(&setpoint, conditions, mixer_rt::Health::from_bits(failed))",
        )
    } else {
        ("", "", "airframe::mix(&setpoint, conditions)")
    };
    let density = compiled.airframe.reference_density() as f32;
    let generated = compiled.rust();
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

/// # Safety
/// `setpoint` and `out` point to their types.
#[unsafe(no_mangle)]
pub unsafe extern \"C\" fn {mix}(setpoint: *const Wrench, voltage_v: f32, {parameter}out: *mut Mix) -> c_int {{
    unsafe {{ mix(setpoint, voltage_v, {density:?}, {argument}out) }}
}}

/// # Safety
/// `setpoint`, `conditions` and `out` point to their types.
#[unsafe(no_mangle)]
pub unsafe extern \"C\" fn {mix_in}(setpoint: *const Wrench, conditions: *const Conditions, {parameter}out: *mut Mix) -> c_int {{
    let Conditions {{ voltage_v, density_kg_m3 }} = unsafe {{ conditions.read() }};
    unsafe {{ mix(setpoint, voltage_v, density_kg_m3, {argument}out) }}
}}

#[inline(never)]
unsafe extern \"C\" fn mix(setpoint: *const Wrench, voltage_v: f32, density_kg_m3: f32, {parameter}out: *mut Mix) -> c_int {{
    let Wrench {{ roll_nm, pitch_nm, yaw_nm, thrust_n }} = unsafe {{ setpoint.read() }};
    let setpoint = mixer_rt::Wrench {{ roll_nm, pitch_nm, yaw_nm, thrust_n }};
    let conditions = mixer_rt::Conditions::at_voltage(voltage_v).in_air(density_kg_m3);
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
        Err(error) => error.status() as c_int,
    }}
}}
"
    )
}

const HEAD: &str = "#![no_std]
use core::ffi::c_int;

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

#[repr(C)]
pub struct Conditions {
    voltage_v: f32,
    density_kg_m3: f32,
}

";
