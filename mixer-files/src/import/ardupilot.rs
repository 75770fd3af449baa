//! ArduPilot's parameters: `FRAME_CLASS` and `FRAME_TYPE` name one of its frames.

use super::parameters::Parameters;
use super::rotors::{Imported, Rotor};
use crate::frames::{Layer, motors};

/// ArduPilot's defaults.
const SPIN_MIN: f64 = 0.15;
const SPIN_MAX: f64 = 0.95;

pub(super) fn read(parameters: &Parameters, arm: Option<f64>) -> Result<Imported, String> {
    let file = parameters.place(if parameters.has("FRAME_TYPE") {
        "FRAME_TYPE"
    } else {
        "FRAME_CLASS"
    });
    let class = parameters.whole("FRAME_CLASS").unwrap_or(0);
    let kind = parameters.whole("FRAME_TYPE");
    if class != 5 && kind.is_none() {
        return Err(format!(
            "{file}: FRAME_TYPE is not a whole number, or is missing: 1 is an X"
        ));
    }
    let kind = kind.unwrap_or(1);
    let Some((name, motors)) = motors(class, kind) else {
        return Err(match (class, kind) {
            (4, 20 | 21) => format!(
                "{file}: FRAME_TYPE {kind}: both rotors of an arm turn the same way; the mixer is for pairs that \
                 contra-rotate"
            ),
            _ => format!(
                "{file}: FRAME_CLASS {class}, FRAME_TYPE {kind} is no frame of coaxial pairs: those are FRAME_CLASS 4 \
                 (octaquad: types 0 to 3, 12, 14, 18), 5 (Y6) and 12 (dodecahexa: types 0, 1)"
            ),
        });
    };
    let arm = match arm {
        Some(arm) if arm > 0.0 && arm.is_finite() => arm,
        Some(arm) => return Err(format!("--arm {arm}: metres from the centre to a pair, above 0")),
        None => {
            return Err(format!(
                "{file}: {name}: ArduPilot's parameters do not have the length of the arms: --arm METRES, from the centre to a \
                 pair"
            ));
        }
    };
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
    Ok(Imported {
        origin: format!("ArduPilot, {name} (FRAME_CLASS {class}, FRAME_TYPE {kind})"),
        rotors: rotors.collect(),
        throttle: Some([
            parameters.or("MOT_SPIN_MIN", SPIN_MIN),
            parameters.or("MOT_SPIN_MAX", SPIN_MAX),
        ]),
        range_v: battery(parameters),
        airmode: Some(("roll-pitch", "ArduPilot asks for roll and pitch at any throttle")),
        notes,
    })
}

/// Half the distance of two layers, m: any will do, the units lie between them.
const LAYER_M: f64 = 0.05;

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
fn battery(parameters: &Parameters) -> Option<[f64; 2]> {
    let [low, high] = ["MOT_BAT_VOLT_MIN", "MOT_BAT_VOLT_MAX"].map(|key| parameters.get(key));
    Some([low?, high?]).filter(|[low, high]| *low > 0.0 && low < high)
}
