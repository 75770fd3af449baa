//! Betaflight's settings, as lines of its CLI.

use mixer_compiler::Compiled;
use mixer_compiler::airframe::Airmode;
use mixer_facts::hover;

use super::frames::TABLES;
use crate::params::parameter::{OwnCurve, Parameters, STEADIEST, Value, gains_note};
use crate::params::writer::Back::{Stays, ToldByImport, Written};
use crate::params::writer::{Betaflight, Options, Read, Writer};

/// See [`Writer`].
pub(crate) const WRITER: Writer = Writer {
    geometry,
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
fn geometry(compiled: &Compiled, options: &Options, all: &mut Parameters) -> Result<(), String> {
    let versions = Betaflight::ALL
        .iter()
        .map(|(version, word, _)| match *version == options.betaflight {
            true => format!("{word} (written)"),
            false => (*word).to_owned(),
        });
    all.note(format!(
        "idle, hover and the curve of thrust_linear have other names and forms from version to version: {}, each with what follows it",
        itertools::join(versions, ", ")
    ));
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
fn settings(compiled: &Compiled, options: &Options, all: &mut Parameters) {
    all.because("The mixer inverts the rotors' curve.")
        .whole("thrust_linear", 0);
    all.because("The mixer follows the battery's voltage.")
        .whole("vbat_sag_compensation", 0);
    let [min, max] = compiled.airframe.throttle.range();
    all.because(
        "Idle of crash flip and launch control, in 0.01 %; in flight it is throttle.min of the file.",
    )
    .whole(
        options.betaflight.idle(),
        (1e4 * min.min(MOST_IDLE)).round() as i32,
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
    hover_throttle(compiled, options, [min, max], all);
    // A PID sum asks for the torque that the factors give in hover over the airframe's range: see `Compiled::betaflight_scale`.
    let unit = compiled.slope_in_hover().map(|slope| (max - min) * slope);
    let fitted = own_curve(compiled, options);
    let stock = OwnCurve {
        range: [DEFAULT_IDLE, 1.0],
        ..fitted
    };
    let slopes = [(stock, 0.0), (fitted, fitted.steadiest(compiled))];
    let slopes = slopes.map(|(curve, factor)| Some(curve.slope_in_hover(compiled, factor)? / unit?));
    all.note(gains_note(
        "PID gains",
        "thrust_linear 0 and Betaflight's idle",
        slopes,
    ));
    all.note(
        "PID gains that were tuned with an `mmix` whose factors of an axis reach over another range than 2 are multiplied by that range \
         over 2, too. Settings of profiles are those of the active one",
    );
}

/// Where Betaflight's own mixer puts out the throttles.
fn own(compiled: &Compiled, options: &Options, all: &mut Parameters) {
    let curve = own_curve(compiled, options);
    all.because(STEADIEST).whole(
        "thrust_linear",
        (100.0 * curve.steadiest(compiled)).round() as i32,
    );
    let [idle, max] = curve.range;
    all.because("Betaflight's default, or throttle.min of the airframe where that is less, in 0.01 %: alone a rotor has no idle of the pair's.")
        .whole(options.betaflight.idle(), (1e4 * idle).round() as i32);
    all.because("The largest throttle is throttle.max.").whole(
        "motor_output_limit",
        (100.0 * (max - idle) / (1.0 - idle)).round() as i32,
    );
    hover_throttle(compiled, options, curve.range, all);
}

/// `DEFAULT_IDLE` of motors that are not brushed (`src/main/pg/motor.c`: 550).
const DEFAULT_IDLE: f64 = 0.055;

/// The curve of Betaflight's own mixer above its own idle (`pidApplyThrustLinearization`, `pidCompensateThrustLinearization`).
fn own_curve(compiled: &Compiled, options: &Options) -> OwnCurve {
    let [min, max] = compiled.airframe.throttle.range();
    let curve = OwnCurve::parabola([min.min(DEFAULT_IDLE), max]);
    match options.betaflight {
        Betaflight::V4_5 | Betaflight::V2025_12 => OwnCurve {
            output: |e, share| share * (1.0 + e * (1.0 - share) * (1.0 - share)),
            share: |e, t| t / (1.0 + (e - 0.5 * e * e) * (1.0 - t) * (1.0 - t)),
            ..curve
        },
        Betaflight::V2026_6 => OwnCurve {
            output: |e, share| share * (1.0 + e * (1.0 - share) * (1.0 + e * (1.0 - 2.0 * share))),
            ..curve
        },
    }
}

/// Pulse widths of throttle 0 and 1, microseconds; DShot has none.
fn pulses(_: &Compiled, [low, high]: [f64; 2], all: &mut Parameters) {
    all.because("Pulse widths of throttle 0 and 1 on the bench; DShot does not use them.")
        .whole("min_command", low as i32)
        .whole("max_throttle", high as i32);
}

/// Betaflight's hover for altitude hold and rescue: its throttle over a range.
fn hover_throttle(compiled: &Compiled, options: &Options, [least, most]: [f64; 2], all: &mut Parameters) {
    let hover = compiled.equal_hover_throttle();
    let hover = hover.map(|throttle| (1000.0 + 1000.0 * (throttle - least) / (most - least)).round());
    let why = "The throttle of hover at the reference voltage.";
    all.hover(options.betaflight.hover(), hover, why);
}
