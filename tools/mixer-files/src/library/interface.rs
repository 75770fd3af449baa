//! The Rust of the C interface: the mixer at the bench's air density and in air of a measured one, around the
//! generated module.

use crate::library::airframe::Airframe;

/// What an object of a library serves: rotors that are out, rotors that are under way.
#[derive(Clone, Copy)]
pub(crate) struct Object {
    pub(crate) health: bool,
    pub(crate) dynamic: bool,
}

/// Names of its C functions: at the bench's density, and under conditions; or of rotors under way.
pub(crate) fn functions(module: &str, object: Object) -> Vec<String> {
    let names: &[&str] = match (object.dynamic, object.health) {
        (false, false) => &["mix", "mix_in"],
        (false, true) => &["mix_with_health", "mix_in_with_health"],
        (true, false) => &["mix_dynamic", "follow"],
        (true, true) => &["mix_dynamic_with_health"],
    };
    names.iter().map(|name| format!("{module}_{name}")).collect()
}

/// A crate that exports these functions alone. Those that mix jump to one, so that the mixer is there once.
pub(crate) fn rust(airframe: &Airframe, object: Object) -> String {
    let Airframe { compiled, module, .. } = airframe;
    let Object { health, dynamic } = object;
    let words = |is: bool, words: [&'static str; 4]| if is { words } else { [""; 4] };
    let with_failed = [
        "failed: u64, ",
        "failed, ",
        "_with_health",
        ", mixer_rt::Health::from_bits(failed)",
    ];
    let [failed, mask, with_health, of_health] = words(health, with_failed);
    let with_state = [
        "state: *mut airframe::State, ",
        "state, ",
        "held_s: f32, ",
        "held_s, ",
    ];
    let [before, state, held, held_s] = words(dynamic, with_state);
    let (parameter, argument) = (format!("{failed}{held}"), format!("{mask}{held_s}"));
    let mix_in = format!(
        "{module}_mix_{}{with_health}",
        if dynamic { "dynamic" } else { "in" }
    );
    let call = match dynamic {
        true => format!(
            "airframe::mix_dynamic{with_health}(unsafe {{ &mut *state }}, &setpoint, conditions{of_health}, held_s)"
        ),
        false => format!("airframe::mix{with_health}(&setpoint, conditions{of_health})"),
    };
    let density = compiled.airframe.reference_density() as f32;
    let generated = compiled.rust();
    let first = match object {
        Object { dynamic: false, .. } => format!("{EXPORTED} fn {module}_mix{with_health}(setpoint: *const Wrench, voltage_v: f32, {parameter}out: *mut Mix) -> c_int {{
    unsafe {{ mix(setpoint, voltage_v, {density:?}, {argument}out) }}
}}"),
        Object { health: false, .. } => format!("{EXPORTED} fn {module}_follow(state: *mut airframe::State, given: *const [f32; airframe::CHANNELS], held_s: f32) {{
    unsafe {{ airframe::follow(&mut *state, &*given, held_s) }}
}}"),
        _ => String::new(),
    };
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
/// The pointers are to their types.
{first}

/// # Safety
/// `setpoint`, `conditions` and `out` point to their types.
{EXPORTED} fn {mix_in}({before}setpoint: *const Wrench, conditions: *const Conditions, {parameter}out: *mut Mix) -> c_int {{
    let Conditions {{ voltage_v, density_kg_m3 }} = unsafe {{ conditions.read() }};
    unsafe {{ mix({state}setpoint, voltage_v, density_kg_m3, {argument}out) }}
}}

#[inline(never)]
unsafe extern \"C\" fn mix({before}setpoint: *const Wrench, voltage_v: f32, density_kg_m3: f32, {parameter}out: *mut Mix) -> c_int {{
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

const EXPORTED: &str = "#[unsafe(no_mangle)]
pub unsafe extern \"C\"";

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
