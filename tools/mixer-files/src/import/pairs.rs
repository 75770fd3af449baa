//! Rotors to units: two on one axis, which contra-rotate.

use super::rotors::{Rotor, Unit};

/// Rotors whose axes are nearer than this are a pair, m.
const SAME_AXIS_M: f64 = 5e-3;

/// Cosine of the angle under which axes are parallel: a degree.
const PARALLEL: f64 = 0.999_85;

/// Layers nearer than this are one, m.
const SAME_LAYER_M: f64 = 1e-4;

/// The units by their upper rotors' channels. `upper` names the upper rotors where it is not empty.
pub(super) fn pair(rotors: &[Rotor], upper: &[usize]) -> Result<Vec<Unit>, String> {
    let is_known = |channel: usize| rotors.iter().any(|rotor| rotor.channel == channel);
    if let Some(channel) = upper.iter().find(|channel| !is_known(**channel)) {
        let last = rotors.len().max(1) - 1;
        return Err(format!("--upper {channel}: the outputs are 0 to {last}"));
    }
    let is_alone = |rotor: &&Rotor| partners(rotors, rotor).next().is_none();
    let alone: Vec<&Rotor> = rotors.iter().filter(is_alone).collect();
    if let ([first, second], 4) = (&alone[..], rotors.len()) {
        return Err(format!(
            "{}: a Y4: rotors {} and {} are alone, and two are a pair. The mixer is for frames whose rotors are all in pairs",
            first.place, first.channel, second.channel
        ));
    }
    let mut units: Vec<Unit> = Vec::new();
    for rotor in rotors {
        let mut partners = partners(rotors, rotor);
        let partner = match (partners.next(), partners.next()) {
            (Some(partner), None) => partner,
            (None, _) => {
                let [x, y, _] = rotor.position_m;
                return Err(format!(
                    "{}: rotor {} at ({x}, {y}) m is alone: give the two rotors of a pair one place, one above the other",
                    rotor.place, rotor.channel
                ));
            }
            (Some(first), Some(second)) => {
                return Err(format!(
                    "{}: rotors {}, {} and {} are in one place: move the one that belongs to another pair",
                    second.place, rotor.channel, first.channel, second.channel
                ));
            }
        };
        let is_paired = |channel| units.iter().any(|unit| unit.channels.contains(&channel));
        if !is_paired(rotor.channel) && !is_paired(partner.channel) {
            units.push(unit(rotor, partner, upper)?);
        }
    }
    units.sort_by_key(|unit| unit.channels[0]);
    Ok(units)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// How far `other` is along the rotor's axis, towards its thrust, and beside it.
fn apart(rotor: &Rotor, other: &Rotor) -> [f64; 2] {
    let apart: [f64; 3] = std::array::from_fn(|k| other.position_m[k] - rotor.position_m[k]);
    let along = dot(apart, rotor.axis);
    [along, (dot(apart, apart) - along * along).max(0.0).sqrt()]
}

/// The other rotors on the axis of one.
fn partners<'a>(rotors: &'a [Rotor], rotor: &'a Rotor) -> impl Iterator<Item = &'a Rotor> {
    let others = rotors.iter().filter(|other| other.channel != rotor.channel);
    others.filter(|other| apart(rotor, other)[1] < SAME_AXIS_M && dot(rotor.axis, other.axis) > PARALLEL)
}

fn unit(rotor: &Rotor, other: &Rotor, upper: &[usize]) -> Result<Unit, String> {
    let [a, b] = [rotor, other].map(|rotor| rotor.channel);
    let [higher, _] = apart(rotor, other);
    let other_is_upper = match (upper.contains(&a), upper.contains(&b)) {
        (true, true) => {
            return Err(format!(
                "--upper: rotors {a} and {b} are one pair, which has one upper rotor"
            ));
        }
        (true, false) => false,
        (false, true) => true,
        (false, false) if !upper.is_empty() => {
            return Err(format!(
                "--upper names neither rotor {a} nor {b}, which are a pair"
            ));
        }
        (false, false) if higher.abs() < SAME_LAYER_M => {
            return Err(format!(
                "{}: rotors {a} and {b} are at one height: which is on top? --upper CHANNELS names all upper rotors",
                other.place
            ));
        }
        (false, false) => higher > 0.0,
    };
    if rotor.spin == other.spin {
        return Err(format!(
            "{}: rotors {a} and {b} both turn {}: the mixer is for pairs that contra-rotate; turn one of them round",
            other.place,
            rotor.spin.name()
        ));
    }
    let (upper, lower) = match other_is_upper {
        true => (other, rotor),
        false => (rotor, other),
    };
    Ok(Unit {
        // To a hundredth of a millimetre: the middle of two numbers in single precision.
        position_m: std::array::from_fn(|k| {
            (0.5e5 * (upper.position_m[k] + lower.position_m[k])).round() / 1e5 + 0.0
        }),
        axis: upper.axis,
        upper_spin: upper.spin,
        channels: [upper.channel, lower.channel],
    })
}

#[cfg(test)]
mod tests {
    use mixer_compiler::airframe::Spin;

    use super::*;
    use crate::import::rotors::Own;

    fn rotor(channel: usize, position_m: [f64; 3], spin: Spin) -> Rotor {
        Rotor {
            channel,
            place: format!("a.params:{channel}"),
            position_m,
            axis: [0.0, 0.0, -1.0],
            spin,
            own: Own::NONE,
        }
    }

    #[test]
    fn pairs_are_found_and_refused() {
        let upper = rotor(3, [0.1, 0.2, -0.05], Spin::Cw);
        let lower = rotor(1, [0.1, 0.2, 0.03], Spin::Ccw);
        let units = pair(&[lower.clone(), upper.clone()], &[]).unwrap();
        assert_eq!((units[0].channels, units[0].upper_spin), ([3, 1], Spin::Cw));
        assert_eq!(units[0].position_m, [0.1, 0.2, -0.01]);
        let swapped = pair(&[lower.clone(), upper.clone()], &[1]).unwrap();
        assert_eq!((swapped[0].channels, swapped[0].upper_spin), ([1, 3], Spin::Ccw));

        let level = rotor(3, [0.1, 0.2, 0.03], Spin::Cw);
        let alike = rotor(3, [0.1, 0.2, -0.05], Spin::Ccw);
        let third = rotor(4, [0.1, 0.2, 0.1], Spin::Cw);
        for (rotors, upper, message) in [
            (
                vec![lower.clone(), level],
                vec![],
                "a.params:3: rotors 1 and 3 are at one height",
            ),
            (
                vec![lower.clone(), alike],
                vec![],
                "a.params:3: rotors 1 and 3 both turn ccw",
            ),
            (
                vec![lower.clone()],
                vec![],
                "a.params:1: rotor 1 at (0.1, 0.2) m is alone",
            ),
            (
                vec![lower.clone(), upper.clone(), third],
                vec![],
                "a.params:4: rotors 1, 3 and 4 are in one place",
            ),
            (
                vec![lower.clone(), upper.clone()],
                vec![1, 3],
                "--upper: rotors 1 and 3 are one pair",
            ),
            (vec![lower, upper], vec![7], "--upper 7"),
        ] {
            assert!(
                pair(&rotors, &upper).unwrap_err().starts_with(message),
                "{message}"
            );
        }
    }

    #[test]
    fn tilted_pairs_lie_along_their_axis() {
        let axis = [0.6, 0.0, -0.8];
        let place = |along: f64| [0.3 + 0.6 * along, 0.0, -0.8 * along];
        let rotors = [(0, 0.05, Spin::Cw), (1, -0.05, Spin::Ccw)].map(|(channel, along, spin)| Rotor {
            axis,
            ..rotor(channel, place(along), spin)
        });
        let units = pair(&rotors, &[]).unwrap();
        assert_eq!(
            (units[0].channels, units[0].position_m, units[0].axis),
            ([0, 1], [0.3, 0.0, 0.0], axis)
        );
    }
}
