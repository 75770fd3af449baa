//! PX4's control allocation: `CA_ROTOR_COUNT`, `CA_ROTORi_PX` and so on, with its defaults where
//! one is missing.

use mixer_compiler::airframe::Spin;

use super::parameters::Parameters;
use super::rotors::{Imported, Own, Rotor};

/// What PX4 takes where a file has no `CA_ROTORi_CT`, no `CA_ROTORi_KM` and no `CA_ROTORi_AZ`.
const THRUST: f64 = 6.5;
const MOMENT_RATIO: f64 = 0.05;
const UPWARD: f64 = -1.0;

/// Most rotors that PX4 has parameters for.
const MOST_ROTORS: usize = 12;

pub(super) fn read(parameters: &Parameters) -> Result<Imported, String> {
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
    let rotors = (0..count).map(|index| rotor(parameters, index));
    let mut imported = Imported {
        origin: format!("{count} rotors of PX4"),
        rotors: rotors.collect::<Result<_, _>>()?,
        range_v: battery(parameters),
        ..Imported::default()
    };
    if let Some(kind) = parameters.get("CA_AIRFRAME").filter(|kind| *kind != 0.0) {
        imported.notes.push(format!(
            "CA_AIRFRAME is {kind}, no multirotor (0): control surfaces, and rotors that tilt, are not in the model"
        ));
    }
    let is_placed = |index: &usize| {
        let place = ["PX", "PY"].map(|key| parameters.or(&format!("CA_ROTOR{index}_{key}"), 0.0));
        place != [0.0; 2]
    };
    if let Some(index) = (count..MOST_ROTORS).find(is_placed) {
        imported.notes.push(format!(
            "CA_ROTOR_COUNT is {count}: rotor {index} and what follows it are left out"
        ));
    }
    imported.notes.push(
        "the idle is not among PX4's parameters: throttle.min is 0.1 unless the pair's file has another"
            .to_owned(),
    );
    Ok(imported)
}

fn rotor(parameters: &Parameters, index: usize) -> Result<Rotor, String> {
    let value = |key: &str, default| parameters.or(&format!("CA_ROTOR{index}_{key}"), default);
    let position_m = ["PX", "PY", "PZ"].map(|key| value(key, 0.0));
    let axis = [value("AX", 0.0), value("AY", 0.0), value("AZ", UPWARD)];
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    let place = |key: &str| parameters.place(&format!("CA_ROTOR{index}_{key}"));
    if axis[2] > 0.0 {
        return Err(format!(
            "{}: CA_ROTOR{index}_AZ is {}: the thrust points down; z counts downwards, upward is -1",
            place("AZ"),
            axis[2]
        ));
    }
    if value("TILT", 0.0) != 0.0 {
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
