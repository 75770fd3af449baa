//! ArduPilot's parameters: `FRAME_CLASS` and `FRAME_TYPE` name one of its frames. A QuadPlane has
//! them with `Q_` before and `Q_M_` in place of `MOT_`.

use super::outputs::{self, Bank};
use super::parameters::Parameters;
use super::rotors::{Imported, Pulses, Rotor};
use crate::frames::{LAYER_M, Layer, motors};

/// ArduPilot's defaults.
const SPIN_MIN: f64 = 0.15;
const SPIN_MAX: f64 = 0.95;

/// Values of `MOT_PWM_TYPE` from DShot150 to DShot1200, and that of SERVOn_MIN and SERVOn_MAX.
const DSHOT: std::ops::RangeInclusive<usize> = 4..=7;
const PWM_RANGE: usize = 8;

/// Where a QuadPlane's names begin with `Q_`.
pub(super) fn is_quadplane(parameters: &Parameters) -> bool {
    parameters.has("Q_FRAME_CLASS") && !parameters.has("FRAME_CLASS")
}

pub(super) fn read(parameters: &Parameters, arm: Option<f64>) -> Result<Imported, String> {
    let [q, mot] = match is_quadplane(parameters) {
        true => ["Q_", "Q_M_"],
        false => ["", "MOT_"],
    };
    let (class_name, type_name) = (format!("{q}FRAME_CLASS"), format!("{q}FRAME_TYPE"));
    let file = parameters.place(if parameters.has(&type_name) {
        &type_name
    } else {
        &class_name
    });
    let class = parameters.whole(&class_name).unwrap_or(0);
    let kind = parameters.whole(&type_name);
    if class != 5 && kind.is_none() {
        return Err(format!(
            "{file}: {type_name} is not a whole number, or is missing: 1 is an X"
        ));
    }
    let kind = kind.unwrap_or(1);
    let Some((name, motors)) = motors(class, kind) else {
        return Err(match (class, kind) {
            (4, 20 | 21) => format!(
                "{file}: {type_name} {kind}: both rotors of an arm turn the same way; the mixer is for pairs that \
                 contra-rotate"
            ),
            _ => format!(
                "{file}: {class_name} {class}, {type_name} {kind} is no frame of coaxial pairs: those are FRAME_CLASS 4 \
                 (octaquad: types 0 to 3, 12, 14, 18), 5 (Y6) and 12 (dodecahexa: types 0, 1)"
            ),
        });
    };
    let arm = outputs::arm(arm, &format!("{file}: {name}: ArduPilot's parameters"))?;
    let rotors = motors.iter().zip(0..).map(|(motor, channel)| Rotor {
        channel,
        place: file.clone(),
        position_m: place(arm, motor.angle_deg, motor.layer),
        axis: [0.0, 0.0, -1.0],
        spin: motor.spin,
    });
    let mut notes = vec![format!(
        "arms of {arm} m at equal angles are assumed, and the upper rotors of ArduPilot's table; --upper says otherwise"
    )];
    if (class, kind) == (4, 2) {
        notes.push("ArduPilot's V gives the front rotors less yaw; the angles of its arms are not among its parameters".to_owned());
    }
    notes.extend(quadplane(parameters));
    notes.extend(SERVOS.order(parameters));
    if !has_own_pulses(parameters, mot) && !parameters.has("RC3_MAX") {
        notes.push(format!(
            "{mot}PWM_MIN and {mot}PWM_MAX are 0: the pulses are those of the throttle stick, which the file lacks; compare \
             them with the bench's"
        ));
    }
    let spin = [("SPIN_MIN", SPIN_MIN), ("SPIN_MAX", SPIN_MAX)];
    Ok(Imported {
        origin: format!("ArduPilot, {name} ({class_name} {class}, {type_name} {kind})"),
        rotors: rotors.collect(),
        throttle: Some((
            spin.map(|(key, default)| parameters.or(&format!("{mot}{key}"), default)),
            spin.map(|(key, _)| format!("{mot}{key}")),
        )),
        pulses: pulses(parameters, mot),
        range_v: battery(parameters, mot),
        airmode: Some(("roll-pitch", "ArduPilot asks for roll and pitch at any throttle")),
        notes,
    })
}

/// What of a QuadPlane is not in the model of a multirotor.
fn quadplane(parameters: &Parameters) -> Vec<String> {
    let is = |name: &str, on: fn(f64) -> bool| parameters.get(name).filter(|value| on(*value));
    let told = [
        (
            is("Q_ENABLE", |value| value == 0.0),
            "Q_ENABLE",
            "the rotors are switched off there",
        ),
        (is("Q_TILT_ENABLE", |value| value > 0.0), "Q_TILT_ENABLE", TILTS),
        (is("Q_TILT_MASK", |value| value > 0.0), "Q_TILT_MASK", TILTS),
        (
            is("Q_TAILSIT_ENABLE", |value| value > 0.0),
            "Q_TAILSIT_ENABLE",
            "the airframe is that of hover, nose up",
        ),
    ];
    let told = told.into_iter();
    told.filter_map(|(value, name, what)| Some(format!("{name} is {}: {what}", value?)))
        .collect()
}

const TILTS: &str = "rotors that tilt are not in the model; the airframe has them upright, as in hover";

const SERVOS: Bank = Bank {
    function: |pin| format!("SERVO{pin}_FUNCTION"),
    motor,
    end: |pin, end| format!("SERVO{pin}_{end}"),
};

/// The motor, from 0, of a value of `SERVOn_FUNCTION`.
fn motor(function: usize) -> Option<usize> {
    match function {
        33..=40 => Some(function - 33),
        82..=85 => Some(function - 82 + 8),
        _ => None,
    }
}

/// Whether `MOT_PWM_MIN` and `_MAX` are above 0; else the pulses are the throttle stick's.
fn has_own_pulses(parameters: &Parameters, mot: &str) -> bool {
    ["MIN", "MAX"].map(|end| parameters.or(&format!("{mot}PWM_{end}"), 1.0) > 0.0) == [true; 2]
}

/// Digital protocols have the whole range (`AP_MotorsMulticopter::get_pwm_output_min`,
/// `update_throttle_range`).
fn pulses(parameters: &Parameters, mot: &str) -> Option<Pulses> {
    let kind = parameters.whole(&format!("{mot}PWM_TYPE")).unwrap_or(0);
    outputs::pulses(parameters, |end| match kind {
        kind if DSHOT.contains(&kind) => Vec::new(),
        PWM_RANGE => SERVOS.ends(SERVOS.motors(parameters).into_iter().map(|(pin, _)| pin), end),
        _ if has_own_pulses(parameters, mot) => vec![format!("{mot}PWM_{end}")],
        _ => vec![format!("RC3_{end}")],
    })
}

/// Forward, right, down.
fn place(arm: f64, angle_deg: f64, layer: Layer) -> [f64; 3] {
    let angle = angle_deg.to_radians();
    // To a tenth of a millimetre; nobody measures an arm better.
    let rounded = |x: f64| (x * 1e4).round() / 1e4 + 0.0;
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    let down = if layer == Layer::Upper { -LAYER_M } else { LAYER_M };
    [rounded(arm * cos), rounded(arm * sin), down]
}

/// The range that ArduPilot corrects for; 0 switches it off.
fn battery(parameters: &Parameters, mot: &str) -> Option<[f64; 2]> {
    let [low, high] = ["MIN", "MAX"].map(|end| parameters.get(&format!("{mot}BAT_VOLT_{end}")));
    Some([low?, high?]).filter(|[low, high]| *low > 0.0 && low < high)
}
