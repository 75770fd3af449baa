//! ArduPilot's parameters: `FRAME_CLASS` and `FRAME_TYPE` name one of its frames. A QuadPlane has
//! them with `Q_` before and `Q_M_` in place of `MOT_`.

use crate::import::outputs;
use crate::import::parameters::Parameters;
use crate::import::rotors::{Imported, Own, Rotor, UPWARD};
use crate::stacks::ardupilot::frames::{COAXIAL_MIXER, LAYER_M, Layer, motors};

/// ArduPilot's defaults.
const SPIN_MIN: f64 = 0.15;
const SPIN_MAX: f64 = 0.95;

/// Of a QuadPlane, on if above 0.
const TILTS: [&str; 3] = ["Q_TILT_ENABLE", "Q_TILT_MASK", "Q_TAILSIT_ENABLE"];

/// Where a QuadPlane's names begin with `Q_`.
pub(crate) fn is_quadplane(parameters: &Parameters) -> bool {
    parameters.has("Q_FRAME_CLASS") && !parameters.has("FRAME_CLASS")
}

pub(crate) fn read(parameters: &Parameters, arm: Option<f64>) -> Result<Imported, String> {
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
            (class, _) if class == COAXIAL_MIXER as usize => format!(
                "{file}: {class_name} {class} is this mixer's own: the frame is that of the airframe file that it was compiled of"
            ),
            (4, 20 | 21) => format!(
                "{file}: {type_name} {kind}: both rotors of an arm turn the same way; the mixer is for pairs that \
                 contra-rotate"
            ),
            _ => format!(
                "{file}: {class_name} {class}, {type_name} {kind} is no frame of coaxial pairs: those are FRAME_CLASS 4 \
                 (octaquad: types 0 to 3, 12, 14, 18), 5 (Y6) and 12 (dodecahexa: types 0, 1); FRAME_CLASS 1 with type 19 (Y4) has one"
            ),
        });
    };
    let arm = outputs::arm(arm, &format!("{file}: {name}: ArduPilot's parameters"))?;
    let rotors = motors.iter().zip(0..).map(|(motor, channel)| Rotor {
        channel,
        place: file.clone(),
        position_m: place(arm * motor.reach, motor.angle_deg, motor.layer),
        axis: UPWARD,
        spin: motor.spin,
        own: Own::NONE,
    });
    let arms = match class {
        1 => {
            format!("front arms of {arm} m at 45 degrees, and the rear pair as far behind as they are ahead,")
        }
        _ => format!("arms of {arm} m at equal angles"),
    };
    let mut notes = vec![format!(
        "{arms} are assumed, and the upper rotors of ArduPilot's table; --upper says otherwise"
    )];
    if class == 1 {
        notes.push(
            "ArduPilot's Y4 moves the front rotors for yaw, too, which rolls the vehicle; here they move by what their torque gives"
                .to_owned(),
        );
    }
    if (class, kind) == (4, 2) {
        notes.push("ArduPilot's V gives the front rotors less yaw; the angles of its arms are not among its parameters".to_owned());
    }
    if is_quadplane(parameters) {
        notes.push(
            "the names of a QuadPlane begin with Q_ and Q_M_: of what `cargo mixer params` writes, FRAME_CLASS, FRAME_TYPE and MOT_* are \
             Q_FRAME_CLASS, Q_FRAME_TYPE and Q_M_* there"
                .to_owned(),
        );
    }
    let tilts = TILTS.iter().find(|name| parameters.or(name, 0.0) > 0.0);
    let tilts = tilts.map(|name| {
        format!("{name} is on: the airframe is that of hover; rotors that tilt are not in the model")
    });
    let spin = [("SPIN_MIN", SPIN_MIN), ("SPIN_MAX", SPIN_MAX)];
    Ok(Imported {
        origin: format!("ArduPilot, {name} ({class_name} {class}, {type_name} {kind})"),
        rotors: rotors.collect(),
        throttle: Some((
            spin.map(|(key, default)| parameters.or(&format!("{mot}{key}"), default)),
            spin.map(|(key, _)| format!("{mot}{key}")),
        )),
        range_v: battery(parameters, mot),
        airmode: Some(("roll-pitch", "ArduPilot asks for roll and pitch at any throttle")),
        warnings: tilts.into_iter().collect(),
        notes,
        ..Imported::default()
    })
}

/// Forward, right, down.
fn place(arm: f64, angle_deg: f64, layer: Layer) -> [f64; 3] {
    let angle = angle_deg.to_radians();
    // To a tenth of a millimetre; nobody measures an arm better.
    let rounded = |x: f64| (x * 1e4).round() / 1e4 + 0.0;
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    let down = match layer {
        Layer::Upper => -LAYER_M,
        Layer::Lower => LAYER_M,
        Layer::Single => 0.0,
    };
    [rounded(arm * cos), rounded(arm * sin), down]
}

/// The range that ArduPilot corrects for; 0 switches it off.
fn battery(parameters: &Parameters, mot: &str) -> Option<[f64; 2]> {
    let [low, high] = ["MIN", "MAX"].map(|end| parameters.get(&format!("{mot}BAT_VOLT_{end}")));
    Some([low?, high?]).filter(|[low, high]| *low > 0.0 && low < high)
}
