//! ArduPilot's parameters.

use mixer_compiler::airframe::Airmode;
use mixer_compiler::{ARDUPILOT_MOST_SPIN_MIN as MOST_SPIN_MIN, Compiled};

use super::frames;
use crate::params::parameter::{OwnCurve, Parameters, STEADIEST, gains_note};
use crate::params::writer::Back::{Stays, ToldByImport, Written, WrittenOrNoted};
use crate::params::writer::{Options, Read, Writer};

/// See [`Writer`].
pub(crate) const WRITER: Writer = Writer {
    geometry,
    settings,
    own,
    pulses,
    pulse_names: "MOT_PWM_MIN and MOT_PWM_MAX",
    frame: ["", ""],
    line: |parameter| format!("{},{}", parameter.name, parameter.value),
    unit: ("A setpoint of 1", Compiled::ardupilot_scale),
    read: READ,
};

/// What becomes of the parameters that `import` reads.
#[rustfmt::skip]
const READ: &[Read] = &[
    (Written, &["FRAME_CLASS", "FRAME_TYPE", "MOT_SPIN_MIN", "MOT_SPIN_MAX"]),
    (WrittenOrNoted, &["MOT_PWM_MIN", "MOT_PWM_MAX", "MOT_BAT_VOLT_MAX", "MOT_BAT_VOLT_MIN"]),
    (ToldByImport, &[
        "Q_FRAME_CLASS", "Q_FRAME_TYPE", "Q_M_SPIN_MIN", "Q_M_SPIN_MAX", "Q_M_PWM_MIN", "Q_M_PWM_MAX", "Q_M_PWM_TYPE",
        "Q_M_BAT_VOLT_MAX", "Q_M_BAT_VOLT_MIN", "Q_TILT_ENABLE", "Q_TILT_MASK", "Q_TAILSIT_ENABLE",
    ]),
    (Stays, &["SERVO#_FUNCTION", "MOT_PWM_TYPE"]),
];

/// ArduPilot's own `MOT_SPIN_ARM`.
const SPIN_ARM: f64 = 0.1;

/// ArduPilot's own `MOT_SPIN_MIN` and `MOT_SPIN_MAX`, and its `MOT_THST_EXPO` (`AP_MotorsMulticopter.h`).
const DEFAULT_SPIN: [f64; 2] = [0.15, 0.95];
const DEFAULT_EXPO: f64 = 0.65;

/// Range of `MOT_THST_HOVER` in ArduPilot.
const HOVER_RANGE: [f64; 2] = [0.125, 0.6875];

/// ArduPilot has no monitor by default, and no voltage without one.
const MONITOR: &str = "BATT_MONITOR is your board's; 0 measures no voltage, the simulator has 4";

/// Why the battery's range is not written.
const NO_VOLTAGE: &str =
    "MOT_BAT_VOLT_MAX and MOT_BAT_VOLT_MIN stay as they are: the airframe has no [voltage]";

/// ArduPilot's density goes by the ground's temperature.
const GROUND_TEMPERATURE: &str = "BARO_GND_TEMP, the air's temperature, is set before every take-off, as ArduPilot forgets it at \
                                  power-off: without it the density goes by the barometer chip's, and 20 K more are 5 % too much thrust";

/// ArduPilot's parameters where this mixer puts out the throttles.
fn settings(compiled: &Compiled, _: &Options, all: &mut Parameters) {
    let airframe = &compiled.airframe;
    all.because("The mixer inverts the rotors' curve; all else that reads this is linear then.")
        .real("MOT_THST_EXPO", 0.0);
    spin(idle(compiled, all), airframe.throttle.max, all);
    if airframe.voltage.is_some() {
        all.because("The mixer follows the battery's voltage.")
            .real("MOT_BAT_VOLT_MAX", 0.0)
            .real("MOT_BAT_VOLT_MIN", 0.0);
        all.note(MONITOR);
    } else {
        all.note(NO_VOLTAGE);
    }
    all.because("Rotors would slew apart from one another.")
        .real("MOT_SLEW_UP_TIME", 0.0)
        .real("MOT_SLEW_DN_TIME", 0.0);
    if airframe.air.is_some() {
        all.note(GROUND_TEMPERATURE);
    }
    let full_n = f64::from(compiled.ardupilot_scale().thrust_n);
    let hover = airframe.weight_n().map(|weight| weight / full_n);
    let at = airframe
        .voltage
        .as_ref()
        .map_or_else(String::new, |voltage| format!(" and {:?} V", voltage.range[1]));
    let why = format!("Weight over the thrust of all rotors at full throttle{at}.");
    hover_throttle(hover, &why, all);
    all.note(gains(compiled));
    if airframe.allocation.airmode == Airmode::Disabled {
        all.note(
            "the airmode is \"disabled\", which gives no roll and pitch at throttle 0; ArduPilot counts on them: \
             `airmode = \"roll-pitch\"` in the airframe file",
        );
    }
}

/// ArduPilot's parameters where its own mixer puts out the throttles.
fn own(compiled: &Compiled, _: &Options, all: &mut Parameters) {
    let curve = own_curve(compiled);
    let expo = curve.steadiest(compiled);
    all.because(STEADIEST).real("MOT_THST_EXPO", expo);
    let [least, most] = curve.range;
    all.because("ArduPilot's default, or throttle.min of the airframe where that is less: alone a rotor has no idle of the pair's.")
        .real("MOT_SPIN_MIN", least);
    spin(least, most, all);
    if let Some(voltage) = &compiled.airframe.voltage {
        all.because("Range of the battery.")
            .real("MOT_BAT_VOLT_MAX", voltage.range[1])
            .real("MOT_BAT_VOLT_MIN", voltage.range[0]);
        all.note(MONITOR);
    } else {
        all.note(NO_VOLTAGE);
    }
    let hover = curve.hover(compiled, expo);
    let why = "MOT_THST_EXPO's curve at the throttle that carries the weight at the reference voltage.";
    hover_throttle(hover, why, all);
}

/// `FRAME_CLASS` of this mixer; of ArduPilot's `own`, `FRAME_CLASS` and `FRAME_TYPE`, if a frame has these rotors on
/// these outputs.
fn geometry(compiled: &Compiled, options: &Options, all: &mut Parameters) -> Result<(), String> {
    if !options.own {
        all.because(
            "The motors class of the compiled airframe, which has its rotors; FRAME_TYPE has no effect.",
        )
        .whole("FRAME_CLASS", frames::COAXIAL_MIXER);
        return Ok(());
    }
    let Some((class, kind, name)) = frames::find(compiled) else {
        all.note(
            "FRAME_CLASS is missing: of ArduPilot's frames X and plus of 4 and 6 pairs, Y6 and Y4 are known here, and none has these \
             rotors on these outputs; `cargo mixer new --outputs ardupilot` writes those of pairs",
        );
        return Ok(());
    };
    let [class, kind] = [class, kind].map(|value| i32::try_from(value).unwrap_or_default());
    all.because(format!(
        "ArduPilot's {name}: channel 0 of the airframe is motor 1."
    ))
    .whole("FRAME_CLASS", class)
    .whole("FRAME_TYPE", kind);
    Ok(())
}

/// Pulse widths of throttle 0 and 1, microseconds.
fn pulses(_: &Compiled, [low, high]: [f64; 2], all: &mut Parameters) {
    all.because("Pulse widths of throttle 0 and 1 on the bench.")
        .whole("MOT_PWM_MIN", low as i32)
        .whole("MOT_PWM_MAX", high as i32);
}

/// Idle of the airframe, as far as ArduPilot arms with it.
fn idle(compiled: &Compiled, all: &mut Parameters) -> f64 {
    let throttle = &compiled.airframe.throttle;
    let least = throttle.min.min(MOST_SPIN_MIN);
    if least < throttle.min {
        all.note(format!(
            "throttle.min is {:?}, and ArduPilot does not arm with MOT_SPIN_MIN above {MOST_SPIN_MIN}: it is {MOST_SPIN_MIN}, \
             and the motors step up by the rest at take-off",
            throttle.min
        ));
    }
    all.because("Idle of the airframe, throttle.min.")
        .real("MOT_SPIN_MIN", least);
    least
}

fn spin(least: f64, most: f64, all: &mut Parameters) {
    all.because("Largest throttle of the airframe, throttle.max.")
        .real("MOT_SPIN_MAX", most);
    all.because("At most MOT_SPIN_MIN.")
        .real("MOT_SPIN_ARM", least.min(SPIN_ARM));
}

/// The curve of ArduPilot's own mixer above its own idle.
fn own_curve(compiled: &Compiled) -> OwnCurve {
    let throttle = &compiled.airframe.throttle;
    OwnCurve::parabola([throttle.min.min(DEFAULT_SPIN[0]), throttle.max])
}

fn hover_throttle(hover: Option<f64>, why: &str, all: &mut Parameters) {
    let [least, most] = HOVER_RANGE;
    if let Some(hover) = hover.filter(|hover| !(least..=most).contains(hover)) {
        all.note(format!(
            "MOT_THST_HOVER {hover:.3} is outside {least} to {most}, which ArduPilot limits it to"
        ));
    }
    all.hover("MOT_THST_HOVER", hover, why);
}

/// The note on gains of a vehicle that was tuned with ArduPilot's mixer.
fn gains(compiled: &Compiled) -> String {
    let fitted = own_curve(compiled);
    let slopes = [
        OwnCurve::parabola(DEFAULT_SPIN).slope_in_hover(compiled, DEFAULT_EXPO),
        fitted.slope_in_hover(compiled, fitted.steadiest(compiled)),
    ];
    let note = gains_note(
        "ATC_RAT_RLL_*, _PIT_*, _YAW_*",
        "ArduPilot's defaults of MOT_THST_EXPO, MOT_SPIN_MIN and MOT_SPIN_MAX",
        slopes,
    );
    match &compiled.airframe.voltage {
        Some(voltage) if slopes[0].is_some() => format!(
            "{note}; those that were tuned with MOT_BAT_VOLT_MAX 0 by {:.3} more, the thrust at {:?} V over that at {:?} V",
            1.0 / voltage.thrust_factor(voltage.range[1]),
            voltage.reference,
            voltage.range[1]
        ),
        _ => note,
    }
}
