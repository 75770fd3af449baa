//! Rotors to units: two on one axis, which contra-rotate, or a single one beside such pairs.

use super::rotors::{Rotor, Unit};

/// Rotors whose axes are nearer than this are a pair, m.
const SAME_AXIS_M: f64 = 5e-3;

/// Cosine of the angle under which axes are parallel: a degree.
const PARALLEL: f64 = 0.999_85;

/// Distance of two rotors side by side over the arm of one, below which they would overlap: those of 12 arms are 0.52 apart.
const OVERLAP: f64 = 0.25;

/// Layers nearer than this are one, m.
const SAME_LAYER_M: f64 = 1e-4;

/// The units by their upper rotors' channels. `upper` names the upper rotors where it is not empty.
pub(super) fn pair(rotors: &[Rotor], upper: &[usize]) -> Result<Vec<Unit>, String> {
    let is_known = |channel: usize| rotors.iter().any(|rotor| rotor.channel == channel);
    if let Some(channel) = upper.iter().find(|channel| !is_known(**channel)) {
        let last = rotors.len().max(1) - 1;
        return Err(format!("--upper {channel}: the outputs are 0 to {last}"));
    }
    let mut units: Vec<Unit> = Vec::new();
    for rotor in rotors {
        let mut partners = partners(rotors, rotor);
        let partner = match (partners.next(), partners.next()) {
            (Some(partner), None) => partner,
            (None, _) => {
                if let Some((other, apart)) = too_near(rotor, rotors) {
                    let [x, y, _] = rotor.position_m;
                    return Err(format!(
                        "{}: rotor {} at ({x}, {y}) m is alone, {apart:.3} m from rotor {}: give the two rotors of a pair one \
                         place, one above the other",
                        rotor.place, rotor.channel, other.channel
                    ));
                }
                units.push(Unit {
                    position_m: rotor.position_m,
                    axis: rotor.axis,
                    upper_spin: rotor.spin,
                    channels: (rotor.channel, None),
                });
                continue;
            }
            (Some(first), Some(second)) => {
                return Err(format!(
                    "{}: rotors {}, {} and {} are in one place: move the one that belongs to another pair",
                    second.place, rotor.channel, first.channel, second.channel
                ));
            }
        };
        let is_paired = |channel| {
            let mut units = units.iter();
            units.any(|unit: &Unit| unit.channels.0 == channel || unit.channels.1 == Some(channel))
        };
        if !is_paired(rotor.channel) && !is_paired(partner.channel) {
            units.push(unit(rotor, partner, upper)?);
        }
    }
    if let (Some(rotor), true) = (rotors.first(), units.iter().all(|unit| unit.channels.1.is_none())) {
        let [x, y, _] = rotor.position_m;
        return Err(format!(
            "{}: rotor {} at ({x}, {y}) m is alone, as all others are: the mixer is for frames with a pair of rotors; give \
             the two of a pair one place, one above the other",
            rotor.place, rotor.channel
        ));
    }
    units.sort_by_key(|unit| unit.channels);
    Ok(units)
}

/// A rotor so near to one that is alone that they would overlap, and how near, m.
fn too_near<'a>(rotor: &Rotor, rotors: &'a [Rotor]) -> Option<(&'a Rotor, f64)> {
    let [x, y, _] = rotor.position_m;
    let others = rotors.iter().filter(|other| other.channel != rotor.channel);
    let apart = others.map(|other| {
        let [at_x, at_y, _] = other.position_m;
        (other, libm::hypot(at_x - x, at_y - y))
    });
    let nearest = apart.min_by(|a, b| a.1.total_cmp(&b.1));
    nearest.filter(|(_, apart)| *apart < OVERLAP * libm::hypot(x, y))
}

/// The note on single rotors; none where all are in pairs.
pub(super) fn alone(units: &[Unit]) -> Option<String> {
    let alone = units.iter().filter(|unit| unit.channels.1.is_none());
    let alone: Vec<String> = alone.map(|unit| unit.channels.0.to_string()).collect();
    match alone.as_slice() {
        [] => None,
        [one] => Some(format!(
            "rotor {one} has no partner on its axis: it is a single rotor"
        )),
        several => Some(format!(
            "rotors {} have no partners on their axes: they are single rotors",
            several.join(", ")
        )),
    }
}

/// The doubt where every upper rotor has the higher output: PX4's own frames count the upper ones first.
pub(super) fn upside_down(units: &[Unit]) -> Option<String> {
    let pairs = units
        .iter()
        .filter_map(|unit| Some((unit.channels.0, unit.channels.1?)));
    let pairs: Vec<(usize, usize)> = pairs.collect();
    let all = pairs.len() > 1 && pairs.iter().all(|(upper, lower)| upper > lower);
    let lower: Vec<String> = pairs.iter().map(|(_, lower)| lower.to_string()).collect();
    let lower = lower.join(",");
    all.then(|| {
        format!("by their PZ rotors {lower} are the lower ones: if it was counted upwards, they are the upper ones: --upper {lower}")
    })
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
        channels: (upper.channel, Some(lower.channel)),
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
        assert_eq!((units[0].channels, units[0].upper_spin), ((3, Some(1)), Spin::Cw));
        assert_eq!(units[0].position_m, [0.1, 0.2, -0.01]);
        let beside = rotor(0, [-0.4, 0.0, 0.0], Spin::Cw);
        let units_beside = pair(&[lower.clone(), beside, upper.clone()], &[]).unwrap();
        let channels: Vec<_> = units_beside.iter().map(|unit| unit.channels).collect();
        assert_eq!(channels, [(0, None), (3, Some(1))]);
        let swapped = pair(&[lower.clone(), upper.clone()], &[1]).unwrap();
        assert_eq!(
            (swapped[0].channels, swapped[0].upper_spin),
            ((1, Some(3)), Spin::Ccw)
        );

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
            ((0, Some(1)), [0.3, 0.0, 0.0], axis)
        );
    }
}
