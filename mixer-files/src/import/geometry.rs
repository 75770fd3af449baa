//! PX4's geometry files: `[[rotors]]` with `position`, `direction` and `axis`.

use mixer_compiler::Source;
use mixer_compiler::airframe::Spin;
use toml::{Table, Value};

use super::rotors::{Imported, Rotor};

/// Whether a text is such a file.
pub(super) fn is_geometry(text: &str) -> bool {
    text.lines().any(|line| line.trim() == "[[rotors]]")
}

/// The rotors of all files in their order.
pub(super) fn read(files: &[Source]) -> Result<Imported, String> {
    let mut imported = Imported::default();
    for Source { name: file, text } in files {
        // The lines of the rotors' headers; values have no places of their own.
        let mut lines = text
            .lines()
            .zip(1..)
            .filter(|(line, _)| line.trim() == "[[rotors]]")
            .map(|(_, number): (_, u32)| number);
        let table: Table = text.parse().map_err(|error| format!("{file}: {error}"))?;
        let rotors = table.get("rotors").and_then(Value::as_array);
        for (rotor, index) in rotors.into_iter().flatten().zip(0..) {
            let axis = vector(rotor.get("axis"))
                .or_else(|| vector(table.get("rotor_default")?.get("axis")))
                .unwrap_or([0.0, 0.0, -1.0]);
            let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
            let place = lines.next().map_or(file.clone(), |line| format!("{file}:{line}"));
            let fault = |what: &str| format!("{place}: rotor {index}: {what}");
            if length == 0.0 {
                return Err(fault("its axis is 0: upward is [0.0, 0.0, -1.0]"));
            }
            imported.rotors.push(Rotor {
                channel: imported.rotors.len(),
                position_m: vector(rotor.get("position"))
                    .ok_or_else(|| fault("`position` is no array of three numbers"))?,
                axis: axis.map(|x| x / length),
                place: place.clone(),
                spin: match rotor.get("direction").and_then(Value::as_str) {
                    Some("CW") => Spin::Cw,
                    Some("CCW") => Spin::Ccw,
                    _ => return Err(fault("`direction` is neither \"CW\" nor \"CCW\"")),
                },
            });
        }
    }
    imported.origin = format!("{} rotors of PX4's geometry", imported.rotors.len());
    imported
        .notes
        .push("PX4's geometry files are of an arm of 1: check the positions, in metres".to_owned());
    Ok(imported)
}

fn vector(value: Option<&Value>) -> Option<[f64; 3]> {
    let values = value?.as_array()?.iter().map(|value| match value {
        Value::Float(x) => Some(*x),
        Value::Integer(x) => Some(*x as f64),
        _ => None,
    });
    let values: Option<Vec<f64>> = values.collect();
    <[f64; 3]>::try_from(values?)
        .ok()
        .filter(|values| values.iter().all(|x| x.is_finite()))
}
