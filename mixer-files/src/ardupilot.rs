//! ArduPilot's parameters.

use mixer_compiler::airframe::Airmode;
use mixer_compiler::{ARDUPILOT_MOST_SPIN_MIN as MOST_SPIN_MIN, Compiled};

use crate::frames;
use crate::parameter::{Parameter, Parameters, curve, no_mass, on_curve, real, slope_in_hover, whole};

/// ArduPilot's own `MOT_SPIN_ARM`.
const SPIN_ARM: f64 = 0.1;

/// Range of `MOT_THST_HOVER` in ArduPilot.
const HOVER_RANGE: [f64; 2] = [0.125, 0.6875];

/// ArduPilot has no monitor by default, and no voltage without one.
const MONITOR: &str = "BATT_MONITOR is your board's; 0 measures no voltage, the simulator has 4";

/// ArduPilot's parameters where this mixer puts out the throttles.
pub(crate) fn settings(compiled: &Compiled) -> Parameters {
    let airframe = &compiled.airframe;
    let mut notes = Vec::new();
    let mut list = vec![real(
        "MOT_THST_EXPO",
        0.0,
        "The mixer inverts the rotors' curve; all else that reads this is linear then.",
    )];
    list.extend(spin(compiled, &mut notes));
    if airframe.voltage.is_some() {
        let why = "The mixer follows the battery's voltage.";
        list.push(real("MOT_BAT_VOLT_MAX", 0.0, why));
        list.push(real("MOT_BAT_VOLT_MIN", 0.0, why));
        notes.push(MONITOR.to_owned());
    }
    let why = "The rotors of a pair would slew apart.";
    list.push(real("MOT_SLEW_UP_TIME", 0.0, why));
    list.push(real("MOT_SLEW_DN_TIME", 0.0, why));
    let hover = airframe
        .weight_n()
        .map(|weight| weight / f64::from(compiled.ardupilot_scale().thrust_n));
    let why = match &airframe.voltage {
        Some(voltage) => format!(
            "Weight over the thrust of all rotors at full throttle and {:?} V.",
            voltage.range_v[1]
        ),
        None => "Weight over the thrust of all rotors at full throttle.".to_owned(),
    };
    hover_throttle(hover, &why, &mut list, &mut notes);
    notes.push(gains(compiled));
    if airframe.allocation.airmode == Airmode::Disabled {
        notes.push(
            "the airmode is \"disabled\", which gives no roll and pitch at throttle 0; ArduPilot counts on them: \
             `airmode = \"roll-pitch\"` in the airframe file"
                .to_owned(),
        );
    }
    Parameters { list, notes }
}

/// ArduPilot's parameters where its own mixer puts out the throttles.
pub(crate) fn own(compiled: &Compiled) -> Parameters {
    let mut notes = Vec::new();
    let expo = (100.0 * curve(compiled, true)).round() / 100.0;
    let mut list = vec![real(
        "MOT_THST_EXPO",
        expo,
        "Fitted to the thrust of the pair with both rotors alike.",
    )];
    list.extend(spin(compiled, &mut notes));
    if let Some(voltage) = &compiled.airframe.voltage {
        let why = "Range of the battery.";
        list.push(real("MOT_BAT_VOLT_MAX", voltage.range_v[1], why));
        list.push(real("MOT_BAT_VOLT_MIN", voltage.range_v[0], why));
        notes.push(MONITOR.to_owned());
    }
    let [min, max] = compiled.pair.range();
    let throttle = compiled.equal_hover_throttle();
    let hover = throttle.map(|throttle| on_curve(expo, (throttle - min) / (max - min)));
    let why = "MOT_THST_EXPO's curve at the throttle that carries the weight at the reference voltage.";
    hover_throttle(hover, why, &mut list, &mut notes);
    Parameters { list, notes }
}

/// `FRAME_CLASS` and `FRAME_TYPE`, if a frame has these rotors on these outputs.
pub(crate) fn geometry(compiled: &Compiled) -> Parameters {
    match frames::find(compiled) {
        Some((class, kind, name)) => {
            let why = format!("ArduPilot's {name}: channel 0 of the airframe is motor 1.");
            let number = |value: usize| i32::try_from(value).unwrap_or_default();
            Parameters {
                list: vec![
                    whole("FRAME_CLASS", number(class), &why),
                    whole("FRAME_TYPE", number(kind), &why),
                ],
                notes: Vec::new(),
            }
        }
        None => Parameters {
            list: Vec::new(),
            notes: vec![
                "no FRAME_CLASS has these rotors on these outputs: `cargo mixer new --outputs ardupilot` writes an airframe \
                 whose `channels` and spins are one's"
                    .to_owned(),
            ],
        },
    }
}

/// Pulse widths of throttle 0 and 1, microseconds.
pub(crate) fn pulses([low, high]: [f64; 2]) -> Vec<Parameter> {
    let why = "Pulse widths of throttle 0 and 1 on the bench.";
    vec![
        whole("MOT_PWM_MIN", low as i32, why),
        whole("MOT_PWM_MAX", high as i32, why),
    ]
}

fn spin(compiled: &Compiled, notes: &mut Vec<String>) -> [Parameter; 3] {
    let throttle = &compiled.airframe.throttle;
    let least = throttle.min.min(MOST_SPIN_MIN);
    if least < throttle.min {
        notes.push(format!(
            "throttle.min is {:?}, and ArduPilot does not arm with MOT_SPIN_MIN above {MOST_SPIN_MIN}: it is {MOST_SPIN_MIN}, \
             and the motors step up by the rest at take-off",
            throttle.min
        ));
    }
    [
        real("MOT_SPIN_MIN", least, "Idle of the airframe, throttle.min."),
        real(
            "MOT_SPIN_MAX",
            throttle.max,
            "Largest throttle of the airframe, throttle.max.",
        ),
        real("MOT_SPIN_ARM", least.min(SPIN_ARM), "At most MOT_SPIN_MIN."),
    ]
}

fn hover_throttle(hover: Option<f64>, why: &str, list: &mut Vec<Parameter>, notes: &mut Vec<String>) {
    let Some(hover) = hover else {
        notes.push(no_mass("MOT_THST_HOVER"));
        return;
    };
    let [least, most] = HOVER_RANGE;
    if !(least..=most).contains(&hover) {
        notes.push(format!(
            "MOT_THST_HOVER {hover:.3} is outside {least} to {most}, which ArduPilot limits it to"
        ));
    }
    list.push(real("MOT_THST_HOVER", hover, why));
}

/// The note on gains of a vehicle that was tuned with ArduPilot's mixer.
fn gains(compiled: &Compiled) -> String {
    let Some(slope) = slope_in_hover(compiled) else {
        return "ATC_RAT_RLL_*, _PIT_*, _YAW_*: which factor keeps the loop gain is known with `[vehicle] mass_kg` in the \
                airframe file; one unit of yaw is then the pair's slope in hover"
            .to_owned();
    };
    let voltage = match &compiled.airframe.voltage {
        Some(voltage) => format!(
            "; those tuned with MOT_BAT_VOLT_MAX 0 by {:.3} more, the thrust at {:?} V over that at {:?} V",
            1.0 / voltage.thrust_factor(voltage.range_v[1]),
            voltage.reference_v,
            voltage.range_v[1]
        ),
        None => String::new(),
    };
    format!(
        "ATC_RAT_RLL_*, _PIT_*, _YAW_*: gains that were tuned with a fitted MOT_THST_EXPO stay; those tuned with \
         MOT_THST_EXPO 0 are multiplied by {slope:.3}, the slope of thrust over throttle in hover{voltage}"
    )
}
