//! PX4's control allocation: `CA_ROTOR_COUNT`, `CA_ROTORi_PX` and so on, with its defaults where
//! one is missing.

use mixer_compiler::airframe::Spin;

use crate::import::parameters::Parameters;
use crate::import::rotors::{Imported, LeftOut, Own, Rotor};

/// What PX4 takes where a file has no `CA_ROTORi_CT`, no `CA_ROTORi_KM` and no `CA_ROTORi_AZ`.
const THRUST: f64 = 6.5;
const MOMENT_RATIO: f64 = 0.05;
const UPWARD: f64 = -1.0;

/// Most rotors that PX4 has parameters for.
const MOST_ROTORS: usize = 12;

pub(crate) fn read(parameters: &Parameters) -> Result<Imported, String> {
    let count = match parameters.whole("CA_ROTOR_COUNT") {
        Some(count) if (1..=MOST_ROTORS).contains(&count) => count,
        _ => {
            return Err(format!(
                "{}: CA_ROTOR_COUNT is not a number from 1 to {MOST_ROTORS}: how many of CA_ROTOR0.. are there?",
                parameters.place("CA_ROTOR_COUNT")
            ));
        }
    };
    for index in 0..count {
        if !parameters
            .names()
            .any(|name| name.starts_with(&format!("CA_ROTOR{index}_")))
        {
            return Err(format!(
                "{}: CA_ROTOR_COUNT is {count}, and nothing is said of rotor {index}: CA_ROTOR{index}_PX, _PY and _PZ place it",
                parameters.place("CA_ROTOR_COUNT")
            ));
        }
    }
    let (flat, upright): (Vec<usize>, Vec<usize>) =
        (0..count).partition(|index| is_flat(axis(parameters, *index)));
    let left_out = flat.into_iter().map(|index| LeftOut {
        channel: index,
        place: parameters.place(&format!("CA_ROTOR{index}_AZ")),
        why: "pushes, its axis lying flat",
    });
    let rotors = upright.iter().map(|index| rotor(parameters, *index));
    let mut imported = Imported {
        origin: format!("{} rotors of PX4", upright.len()),
        rotors: rotors.collect::<Result<_, _>>()?,
        has_places: true,
        left_out: left_out.collect(),
        first_motors: "give it the last number of CA_ROTORn, and its output that motor (PWM_MAIN_FUNCn)",
        range_v: battery(parameters),
        ..Imported::default()
    };
    if let Some(kind) = parameters.get("CA_AIRFRAME").filter(|kind| *kind != 0.0) {
        imported.warnings.push(format!(
            "CA_AIRFRAME is {kind}, no multirotor (0): control surfaces, and rotors that tilt, are not in the model"
        ));
    }
    let is_placed = |index: &usize| {
        let place = ["PX", "PY"].map(|key| parameters.or(&format!("CA_ROTOR{index}_{key}"), 0.0));
        place != [0.0; 2]
    };
    if let Some(index) = (count..MOST_ROTORS).find(is_placed) {
        imported.warnings.push(format!(
            "CA_ROTOR_COUNT is {count}: rotor {index} and what follows it are left out"
        ));
    }
    imported.notes.push(scale(&imported.rotors));
    imported.notes.push(
        "the idle is not among PX4's parameters: throttle.min is 0.1 unless the pair's file has another"
            .to_owned(),
    );
    Ok(imported)
}

/// Part of a thrust's direction below which it lifts nothing: PX4's of a motor that pushes
/// (`ActuatorEffectivenessRotors::getForwardsMotors`).
const FLAT: f64 = 0.1;

fn is_flat(axis: [f64; 3]) -> bool {
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    axis[2].abs() < FLAT * length
}

/// Distances from the centre in PX4's own files, m: 11001_hexa_cox and 24001_dodeca_cox, 12001_octo_cox.
const STOCK_ARMS_M: [f64; 3] = [0.5, 0.425, 0.495];

/// Difference of distances that are one, m.
const SAME_ARM_M: f64 = 1e-3;

/// That places may have any scale: PX4 divides its matrix by its largest entries, so a vehicle flies with each.
fn scale(rotors: &[Rotor]) -> String {
    let is = |distance: f64, known: f64| (distance - known).abs() < SAME_ARM_M;
    let arms = || {
        rotors
            .iter()
            .map(|rotor| libm::hypot(rotor.position_m[0], rotor.position_m[1]))
    };
    let sides = rotors
        .iter()
        .flat_map(|rotor| [rotor.position_m[0].abs(), rotor.position_m[1].abs()]);
    let what = if is(arms().fold(0.0, f64::max), 1.0) || is(sides.fold(0.0, f64::max), 1.0) {
        "the outermost places are at 1 m, as where they were divided by the arm"
    } else if arms().all(|arm| STOCK_ARMS_M.into_iter().any(|stock| is(arm, stock))) {
        "the arms are those of PX4's own airframe files, which many vehicles keep"
    } else {
        "places are taken as metres"
    };
    format!(
        "{what}: compare position_m with the vehicle, since PX4 flies with places of any scale, and this mixer does not"
    )
}

/// The direction of a thrust, of any length.
fn axis(parameters: &Parameters, index: usize) -> [f64; 3] {
    let value = |key: &str, default| parameters.or(&format!("CA_ROTOR{index}_{key}"), default);
    [value("AX", 0.0), value("AY", 0.0), value("AZ", UPWARD)]
}

fn rotor(parameters: &Parameters, index: usize) -> Result<Rotor, String> {
    let value = |key: &str, default| parameters.or(&format!("CA_ROTOR{index}_{key}"), default);
    let position_m = ["PX", "PY", "PZ"].map(|key| value(key, 0.0));
    let axis = axis(parameters, index);
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    let place = |key: &str| parameters.place(&format!("CA_ROTOR{index}_{key}"));
    if axis[2] > 0.0 {
        return Err(format!(
            "{}: CA_ROTOR{index}_AZ is {}: the thrust points down; z counts downwards, upward is -1",
            place("AZ"),
            axis[2]
        ));
    }
    // A multirotor, `CA_AIRFRAME` 0, has no tilts.
    if value("TILT", 0.0) != 0.0 && parameters.or("CA_AIRFRAME", 0.0) != 0.0 {
        return Err(format!(
            "{}: CA_ROTOR{index}_TILT: a rotor that a servo tilts is not in the model; 0 is a fixed one",
            place("TILT")
        ));
    }
    if length == 0.0 {
        return Err(format!(
            "{}: CA_ROTOR{index}_AX, _AY and _AZ are all 0: upward is 0, 0, -1",
            place("AZ")
        ));
    }
    let moment = value("KM", MOMENT_RATIO);
    if moment == 0.0 {
        return Err(format!(
            "{}: CA_ROTOR{index}_KM is 0: the sign of it says how the rotor turns (positive: counter-clockwise)",
            place("KM")
        ));
    }
    Ok(Rotor {
        channel: index,
        place: place("PX"),
        position_m,
        // Stacks hold single precision.
        axis: axis.map(|x| (x / length * 1e7).round() / 1e7 + 0.0),
        spin: if moment > 0.0 { Spin::Ccw } else { Spin::Cw },
        own: Own {
            thrust: value("CT", THRUST),
            yaw: moment.abs(),
            is_reversible: parameters.whole("CA_R_REV").unwrap_or(0) >> index & 1 == 1,
            ..Own::NONE
        },
    })
}

/// The first battery's range.
fn battery(parameters: &Parameters) -> Option<[f64; 2]> {
    let cells = parameters.get("BAT1_N_CELLS").filter(|cells| *cells > 0.0)?;
    let [empty, charged] = ["BAT1_V_EMPTY", "BAT1_V_CHARGED"].map(|key| parameters.get(key));
    Some([cells * empty?, cells * charged?]).filter(|[low, high]| low < high)
}
