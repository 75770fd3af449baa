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
    let health = if object.health { "_with_health" } else { "" };
    let names = match object {
        Object { dynamic: false, .. } => ["mix", "mix_in"].as_slice(),
        Object { health: false, .. } => &["mix_dynamic", "follow"],
        _ => &["mix_dynamic"],
    };
    names
        .iter()
        .map(|name| format!("{module}_{name}{health}"))
        .collect()
}

/// A crate that exports these functions alone.
pub(crate) fn rust(airframe: &Airframe, object: Object) -> String {
    let Airframe { compiled, module, .. } = airframe;
    let (parameter, argument, with_health, of_health) = match object.health {
        true => (
            "failed: u64, ",
            "failed, ",
            "_with_health",
            ", mixer_rt::Health::from_bits(failed)",
        ),
        false => ("", "", "", ""),
    };
    let functions = functions(module, object);
    let [mix, second] = [0, 1].map(|k| functions.get(k).map_or("", String::as_str));
    let generated = compiled.rust();
    let entries = match object.dynamic {
        true => {
            let follow = match object.health {
                true => "",
                false => FOLLOW,
            };
            DYNAMIC
                .replace("WITH_HEALTH", with_health)
                .replace("OF_HEALTH", of_health)
                + follow
        }
        false => STEADY
            .replace("ARGUMENT", argument)
            .replace(
                "CALL",
                &format!("airframe::mix{with_health}(&setpoint, conditions{of_health})"),
            )
            .replace(
                "DENSITY",
                &format!("{:?}", compiled.airframe.reference_density() as f32),
            ),
    };
    let entries = entries
        .replace("PARAMETER", parameter)
        .replace("FIRST", mix)
        .replace("SECOND", second);
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

/// Gives the status of a mix, and what it gives to `out`.
#[inline(always)]
unsafe fn write(mix: Result<mixer_rt::Mix<{{ airframe::CHANNELS }}>, mixer_rt::SetpointError>, out: *mut Mix) -> c_int {{
    match mix {{
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

{entries}"
    )
}

/// Both jump to a third, so that the mixer is there once.
const STEADY: &str = "/// # Safety
/// `setpoint` and `out` point to their types.
#[unsafe(no_mangle)]
pub unsafe extern \"C\" fn FIRST(setpoint: *const Wrench, voltage_v: f32, PARAMETERout: *mut Mix) -> c_int {
    unsafe { mix(setpoint, voltage_v, DENSITY, ARGUMENTout) }
}

/// # Safety
/// `setpoint`, `conditions` and `out` point to their types.
#[unsafe(no_mangle)]
pub unsafe extern \"C\" fn SECOND(setpoint: *const Wrench, conditions: *const Conditions, PARAMETERout: *mut Mix) -> c_int {
    let Conditions { voltage_v, density_kg_m3 } = unsafe { conditions.read() };
    unsafe { mix(setpoint, voltage_v, density_kg_m3, ARGUMENTout) }
}

#[inline(never)]
unsafe extern \"C\" fn mix(setpoint: *const Wrench, voltage_v: f32, density_kg_m3: f32, PARAMETERout: *mut Mix) -> c_int {
    let Wrench { roll_nm, pitch_nm, yaw_nm, thrust_n } = unsafe { setpoint.read() };
    let setpoint = mixer_rt::Wrench { roll_nm, pitch_nm, yaw_nm, thrust_n };
    let conditions = mixer_rt::Conditions::at_voltage(voltage_v).in_air(density_kg_m3);
    unsafe { write(CALL, out) }
}
";

const DYNAMIC: &str = "/// # Safety
/// All pointers are to their types.
#[unsafe(no_mangle)]
pub unsafe extern \"C\" fn FIRST(state: *mut airframe::State, setpoint: *const Wrench, conditions: *const Conditions, PARAMETERheld_s: f32, out: *mut Mix) -> c_int {
    let Wrench { roll_nm, pitch_nm, yaw_nm, thrust_n } = unsafe { setpoint.read() };
    let setpoint = mixer_rt::Wrench { roll_nm, pitch_nm, yaw_nm, thrust_n };
    let Conditions { voltage_v, density_kg_m3 } = unsafe { conditions.read() };
    let conditions = mixer_rt::Conditions::at_voltage(voltage_v).in_air(density_kg_m3);
    unsafe { write(airframe::mix_dynamicWITH_HEALTH(&mut *state, &setpoint, conditionsOF_HEALTH, held_s), out) }
}
";

const FOLLOW: &str = "
/// # Safety
/// Both pointers are to their types.
#[unsafe(no_mangle)]
pub unsafe extern \"C\" fn SECOND(state: *mut airframe::State, given: *const [f32; airframe::CHANNELS], held_s: f32) {
    unsafe { airframe::follow(&mut *state, &*given, held_s) }
}
";

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
