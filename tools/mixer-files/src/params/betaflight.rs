//! Betaflight's settings, as lines of its CLI.

use mixer_compiler::Compiled;
use mixer_compiler::airframe::Airmode;

use crate::import::betaflight::TABLES;
use crate::params::parameter::{Parameters, curve};

/// `MAX_SUPPORTED_MOTORS` of Betaflight's boards.
const MOST_MOTORS: usize = 8;

/// Factors that differ by less are one.
const SAME_FACTOR: f64 = 0.05;

/// Most of `motor_idle`, of the range of the throttle.
const MOST_IDLE: f64 = 0.2;

/// `mixer`, and where no table of Betaflight has these factors, `mmix`.
pub(crate) fn geometry(compiled: &Compiled, all: &mut Parameters) -> Result<(), String> {
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
        return Ok(());
    }
    let mut reason = all.because(
        "Throttle, roll, pitch and yaw of each motor by the airframe's geometry: channel 0 is motor 1, `mmix 0`.",
    );
    reason.line("mixer CUSTOM").line("mmix reset");
    for (motor, [roll, pitch, yaw]) in own.iter().enumerate() {
        let [roll, pitch, yaw] = [roll, pitch, yaw].map(|factor| factor + 0.0);
        reason.line(format!("mmix {motor} 1.000 {roll:.3} {pitch:.3} {yaw:.3}"));
    }
    Ok(())
}

/// Where this mixer puts out the throttles.
pub(crate) fn settings(compiled: &Compiled, all: &mut Parameters) {
    all.because("The mixer inverts the rotors' curve.")
        .whole("thrust_linear", 0);
    all.because("The mixer follows the battery's voltage.")
        .whole("vbat_sag_compensation", 0);
    idle(compiled, all);
    all.because("The largest throttle is the mixer's, throttle.max.")
        .whole("motor_output_limit", 100);
    all.because("A rotor of a pair that is held at a speed of its own is none of the map's.")
        .whole("dyn_idle_min_rpm", 0)
        .line("set rpm_limit = OFF")
        .line("feature -3D");
    match compiled.airframe.allocation.airmode {
        Airmode::Disabled => all.note(
            "the airmode is \"disabled\", which gives no roll and pitch at throttle 0; Betaflight's AIRMODE counts on them: \
             `airmode = \"roll-pitch\"` in the airframe file",
        ),
        _ => {
            all.because("The airframe's airmode raises the thrust for roll and pitch; without the feature their PID sums are halved at throttle 0.")
                .line("feature AIRMODE");
        }
    }
    hover(compiled, 1.0, all);
    all.note(
        "PID gains of Betaflight's own mixer stay: a PID sum asks for the torque that its factors give in hover at the reference \
         voltage (`[vehicle] mass_kg` says where that is). Settings of profiles are those of the active one",
    );
}

/// Where Betaflight's own mixer puts out the throttles.
pub(crate) fn own(compiled: &Compiled, all: &mut Parameters) {
    let curve = (100.0 * curve(compiled, true)).round() as i32;
    all.because("Fitted to the thrust of the pair with both rotors alike, in percent as MOT_THST_EXPO.")
        .whole("thrust_linear", curve);
    idle(compiled, all);
    let [min, max] = compiled.pair.range();
    all.because("The largest throttle is throttle.max.").whole(
        "motor_output_limit",
        (100.0 * (max - min) / (1.0 - min)).round() as i32,
    );
    hover(compiled, max, all);
}

/// Pulse widths of throttle 0 and 1, microseconds; DShot has none.
pub(crate) fn pulses([low, high]: [f64; 2], all: &mut Parameters) {
    all.because("Pulse widths of throttle 0 and 1 on the bench; DShot does not use them.")
        .whole("min_command", low as i32)
        .whole("max_throttle", high as i32);
}

fn idle(compiled: &Compiled, all: &mut Parameters) {
    let throttle = &compiled.airframe.throttle;
    if throttle.min > MOST_IDLE {
        all.note(format!(
            "throttle.min is {:?}: Betaflight's motor_idle is {MOST_IDLE} at most, and the mixer does not arm with another than the airframe's",
            throttle.min
        ));
    }
    let idle = (1e4 * throttle.min.min(MOST_IDLE)).round() as i32;
    all.because("Idle of the airframe, throttle.min, in 0.01 %.")
        .whole("motor_idle", idle);
}

/// Betaflight's hover for altitude hold and rescue; its throttle 1 is a rotor's throttle `full`.
fn hover(compiled: &Compiled, full: f64, all: &mut Parameters) {
    let min = compiled.airframe.throttle.min;
    let hover = compiled.equal_hover_throttle();
    let hover = hover.map(|throttle| (1000.0 + 1000.0 * (throttle - min) / (full - min)).round());
    let why = "The throttle of hover at the reference voltage.";
    all.hover("ap_hover_throttle", hover, why);
}
