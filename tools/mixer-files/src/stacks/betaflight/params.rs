//! Betaflight's settings, as lines of its CLI.

use mixer_compiler::Compiled;
use mixer_compiler::airframe::Airmode;
use mixer_facts::hover;

use super::frames::TABLES;
use crate::params::parameter::{Parameters, Value, curve};
use crate::params::writer::Back::{Stays, ToldByImport, Written};
use crate::params::writer::{Options, Read, Writer};

/// See [`Writer`].
pub(crate) const WRITER: Writer = Writer {
    geometry: |compiled, _, all| geometry(compiled, all),
    settings,
    own,
    pulses,
    pulse_names: "min_command and max_throttle, which DShot does not use,",
    frame: ["", "save\n"],
    line: |parameter| match parameter.value {
        Value::Line => parameter.name.clone(),
        value => format!("set {} = {value}", parameter.name),
    },
    unit: ("A PID sum of 1000, or full stick,", Compiled::betaflight_scale),
    read: READ,
};

/// What becomes of the parameters that `import` reads, words of Betaflight's and INAV's command line.
#[rustfmt::skip]
const READ: &[Read] = &[
    (Written, &["mixer", "mmix", "yaw_motors_reversed", "feature 3D"]),
    (ToldByImport, &["mixer_profile", "platform_type", "motor_direction_inverted", "yaw_motor_direction", "yaw_direction"]),
    (Stays, &["motor_output_reordering"]),
];

/// `MAX_SUPPORTED_MOTORS` of Betaflight's boards.
const MOST_MOTORS: usize = 8;

/// Factors that differ by less are one.
const SAME_FACTOR: f64 = 0.05;

/// Most of `motor_idle`, of the range of the throttle.
const MOST_IDLE: f64 = 0.2;

/// `mixer`, and where no table of Betaflight has these factors, `mmix`.
fn geometry(compiled: &Compiled, all: &mut Parameters) -> Result<(), String> {
    let own = compiled.betaflight_factors();
    if own.len() > MOST_MOTORS {
        return Err(format!(
            "{} rotors: Betaflight has {MOST_MOTORS} motors",
            own.len()
        ));
    }
    let known = TABLES.iter().find(|(_, motors)| {
        let pairs = motors.iter().flatten().zip(own.iter().flatten());
        motors.len() == own.len() && pairs.clone().all(|(a, b)| (a - b).abs() < SAME_FACTOR)
    });
    if let Some((name, _)) = known {
        all.because("Betaflight's frame: channel 0 of the airframe is motor 1.")
            .line(format!("mixer {name}"));
    } else {
        custom(&own, all);
    }
    all.because("Yaw of `mixer` and `mmix` is by the motors' real directions, which the airframe has.")
        .line("set yaw_motors_reversed = OFF");
    all.because("No rotor turns backwards.").line("feature -3D");
    Ok(())
}

/// `mmix` of these factors.
fn custom(own: &[[f64; 3]], all: &mut Parameters) {
    let mut reason = all.because(
        "Throttle, roll, pitch and yaw of each motor by the airframe's geometry: channel 0 is motor 1, `mmix 0`.",
    );
    reason.line("mixer CUSTOM").line("mmix reset");
    for (motor, [roll, pitch, yaw]) in own.iter().enumerate() {
        let [roll, pitch, yaw] = [roll, pitch, yaw].map(|factor| factor + 0.0);
        reason.line(format!("mmix {motor} 1.000 {roll:.3} {pitch:.3} {yaw:.3}"));
    }
}

/// Where this mixer puts out the throttles.
fn settings(compiled: &Compiled, _: &Options, all: &mut Parameters) {
    all.because("The mixer inverts the rotors' curve.")
        .whole("thrust_linear", 0);
    all.because("The mixer follows the battery's voltage.")
        .whole("vbat_sag_compensation", 0);
    idle(
        compiled,
        all,
        "Idle of crash flip and launch control, in 0.01 %; in flight it is throttle.min of the file.",
    );
    all.because("The largest throttle is the mixer's, throttle.max.")
        .whole("motor_output_limit", 100);
    all.because("A rotor that is held at a speed of its own is none of the model's.")
        .whole("dyn_idle_min_rpm", 0)
        .line("set rpm_limit = OFF");
    match compiled.airframe.allocation.airmode {
        Airmode::Disabled => all.note(
            "the airmode is \"disabled\", which gives no roll and pitch at throttle 0; Betaflight's AIRMODE counts on them: \
             `airmode = \"roll-pitch\"` in the airframe file",
        ),
        _ => {
            all.because("The airframe's airmode raises the thrust for roll, pitch and the yaw reserve; without the feature their PID sums are halved at throttle 0.")
                .line("feature AIRMODE");
        }
    }
    let missing = hover::yaw_reserve(compiled).filter(|_| compiled.airframe.allocation.yaw_reserve_nm <= 0.0);
    if let Some(reserve) = missing {
        all.note(format!(
            "yaw_reserve_nm is 0, so there is no yaw at throttle 0; pilots of Betaflight's AIRMODE count on it: \
             `yaw_reserve_nm = {reserve:.2}` in the airframe file is a fifth of hover's"
        ));
    }
    hover_throttle(compiled, all);
    all.note(
        "PID gains that were tuned with these factors stay, and those tuned with an `mmix` whose factors of an axis reach over another \
         range than 2 are multiplied by that range over 2: a PID sum asks for the torque that the factors give in hover at the reference \
         voltage (`[vehicle] mass_kg` says where that is). Settings of profiles are those of the active one",
    );
}

/// Where Betaflight's own mixer puts out the throttles.
fn own(compiled: &Compiled, _: &Options, all: &mut Parameters) {
    let curve = (100.0 * curve(compiled, true)).round() as i32;
    all.because("Fitted to the thrust of all rotors at one throttle, in percent as MOT_THST_EXPO.")
        .whole("thrust_linear", curve);
    if compiled.airframe.throttle.min > MOST_IDLE {
        all.note(format!(
            "throttle.min is {:?}, and Betaflight's motor_idle {MOST_IDLE} at most: its own mixer idles below the airframe's range",
            compiled.airframe.throttle.min
        ));
    }
    idle(compiled, all, "Idle of the airframe, throttle.min, in 0.01 %.");
    let [min, max] = compiled.airframe.throttle.range();
    all.because("The largest throttle is throttle.max.").whole(
        "motor_output_limit",
        (100.0 * (max - min) / (1.0 - min)).round() as i32,
    );
    hover_throttle(compiled, all);
}

/// Pulse widths of throttle 0 and 1, microseconds; DShot has none.
fn pulses(_: &Compiled, [low, high]: [f64; 2], all: &mut Parameters) {
    all.because("Pulse widths of throttle 0 and 1 on the bench; DShot does not use them.")
        .whole("min_command", low as i32)
        .whole("max_throttle", high as i32);
}

fn idle(compiled: &Compiled, all: &mut Parameters, why: &str) {
    let idle = (1e4 * compiled.airframe.throttle.min.min(MOST_IDLE)).round() as i32;
    all.because(why).whole("motor_idle", idle);
}

/// Betaflight's hover for altitude hold and rescue; its throttle 1 is throttle.max of all rotors.
fn hover_throttle(compiled: &Compiled, all: &mut Parameters) {
    let [min, max] = compiled.airframe.throttle.range();
    let hover = compiled.equal_hover_throttle();
    let hover = hover.map(|throttle| (1000.0 + 1000.0 * (throttle - min) / (max - min)).round());
    let why = "The throttle of hover at the reference voltage.";
    all.hover("ap_hover_throttle", hover, why);
}
