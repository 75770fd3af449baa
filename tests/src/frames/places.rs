//! Where the units of the zoo's frames stand, how they lean and how they turn. The build script of
//! `tests/firmware` includes this file.

use std::f64::consts::TAU;
use std::fmt;

use mixer_setpoints::Random;

use super::pairs::log_uniform;

/// Arms, m.
const ARMS_M: [f64; 2] = [0.05, 3.0];

/// What is special about a frame's shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    /// Units at equal angles, spins alternating where their number is even.
    Regular,
    /// The same with all upper rotors turning alike: an X8 has no null space of torques then.
    LikeSpins,
    /// Two rows abreast.
    H,
    /// Three units, the rear one on an arm of its own.
    Y,
    /// Arms and angles of their own, heights and spins at random.
    Jittered,
    /// Thrust axes that lean.
    Tilted,
    /// Nearly in a line: ten to forty times as long as wide.
    Collinear,
    /// Two units.
    Bicopter,
    /// One unit.
    Single,
}

impl Class {
    /// The classes of successive specimens.
    pub(super) const CYCLE: [Class; 12] = [
        Class::Regular,
        Class::Jittered,
        Class::Tilted,
        Class::LikeSpins,
        Class::H,
        Class::Y,
        Class::Regular,
        Class::Collinear,
        Class::Tilted,
        Class::Bicopter,
        Class::Jittered,
        Class::Single,
    ];
}

impl fmt::Display for Class {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Class::Regular => "regular",
            Class::LikeSpins => "like spins",
            Class::H => "H",
            Class::Y => "Y",
            Class::Jittered => "jittered",
            Class::Tilted => "tilted",
            Class::Collinear => "collinear",
            Class::Bicopter => "bicopter",
            Class::Single => "single",
        })
    }
}

/// One unit of a frame.
pub(super) struct Unit {
    /// x, y, z, m.
    pub(super) position: [f64; 3],
    /// Of the thrust, of length 1.
    pub(super) axis: [f64; 3],
    /// How the upper rotor turns.
    pub(super) clockwise: bool,
}

/// Units at equal angles on a circle, the first at an angle that frames have.
fn circle(count: usize, arm: f64, random: &mut Random) -> Vec<Unit> {
    let spacing = TAU / count as f64;
    let first = match random.below(4) {
        0 => 0.0,
        1 => random.uniform(0.0, spacing),
        _ => 0.5 * spacing,
    };
    // An odd number of units has no way to alternate, and like spins are usual.
    let alternate = count.is_multiple_of(2) || random.below(2) == 0;
    (0..count)
        .map(|k| {
            let [x, y] = polar(arm, first + k as f64 * spacing);
            Unit {
                position: [x, y, 0.0],
                axis: [0.0, 0.0, -1.0],
                clockwise: !alternate || k % 2 == 0,
            }
        })
        .collect()
}

#[allow(
    clippy::disallowed_methods,
    reason = "positions are written to a micrometre, which hides the last bits"
)]
fn polar(arm: f64, angle: f64) -> [f64; 2] {
    [arm * angle.cos(), arm * angle.sin()]
}

fn count(random: &mut Random) -> usize {
    match random.below(16) {
        0 => 9 + random.below(8),
        usual => [3, 4, 4, 4, 6, 6, 8, 5, 3, 4, 6, 7, 8, 4, 6][usual - 1],
    }
}

/// The units of a frame.
pub(super) fn place(class: Class, random: &mut Random) -> Vec<Unit> {
    let arm = log_uniform(random, ARMS_M);
    let at = |x: f64, y: f64, clockwise: bool| Unit {
        position: [x, y, 0.0],
        axis: [0.0, 0.0, -1.0],
        clockwise,
    };
    let mut units = match class {
        Class::Regular => circle(count(random), arm, random),
        Class::LikeSpins => {
            let mut units = circle(count(random), arm, random);
            units.iter_mut().for_each(|unit| unit.clockwise = true);
            units
        }
        Class::H => {
            let rows = 2 + random.below(3);
            let [wide, apart] = [random.uniform(0.4, 1.0) * arm, random.uniform(0.4, 1.0) * arm];
            let alike = random.below(2);
            let row = |k: usize| apart * (k as f64 - 0.5 * (rows - 1) as f64);
            (0..2 * rows)
                .map(|k| {
                    let right = k % 2 == 0;
                    at(
                        -row(k / 2),
                        if right { wide } else { -wide },
                        (k + k / 2 * alike).is_multiple_of(2),
                    )
                })
                .collect()
        }
        Class::Y => {
            let open = random.uniform(0.5, 1.3);
            let rear = random.uniform(0.7, 1.5) * arm;
            let alike = random.below(2) == 0;
            let [x, y] = polar(arm, open);
            vec![at(x, y, true), at(x, -y, alike), at(-rear, 0.0, true)]
        }
        Class::Jittered => {
            let mut units = circle(count(random), arm, random);
            jitter(&mut units, arm, random);
            units
        }
        Class::Tilted => {
            let mut units = circle(count(random), arm, random);
            if random.below(2) == 0 {
                jitter(&mut units, arm, random);
            }
            tilt(&mut units, random);
            units
        }
        Class::Collinear => {
            let count = 3 + random.below(6);
            let across = arm / log_uniform(random, [10.0, 40.0]);
            let abreast = random.below(2) == 0;
            let along = |k: usize| arm * (2.0 * k as f64 / (count - 1) as f64 - 1.0);
            let units = (0..count).map(|k| {
                let (along, across) = (along(k), if k % 2 == 0 { across } else { -across });
                let [x, y] = if abreast { [across, along] } else { [along, across] };
                at(x, y, k % 2 == 0)
            });
            units.collect()
        }
        Class::Bicopter => vec![at(0.0, arm, true), at(0.0, -arm, random.below(3) == 0)],
        Class::Single => vec![at(0.0, 0.0, random.below(2) == 0)],
    };
    if units.len() > 2 {
        centre(&mut units, random);
    }
    units
}

fn jitter(units: &mut [Unit], arm: f64, random: &mut Random) {
    let spacing = TAU / units.len() as f64;
    for (k, unit) in units.iter_mut().enumerate() {
        let length = random.uniform(0.6, 1.4);
        let [cos, sin] = polar(length, spacing * random.uniform(-0.3, 0.3));
        let [x, y, _] = unit.position;
        unit.position = [
            cos * x - sin * y,
            sin * x + cos * y,
            arm * random.uniform(-0.1, 0.1),
        ];
        if k > 1 {
            unit.clockwise = random.below(2) == 0;
        }
    }
}

/// Axes lean along the circle to and fro, outwards, or anyhow. An odd number to and fro would turn.
fn tilt(units: &mut [Unit], random: &mut Random) {
    let lean = random.uniform(0.03, 0.25);
    let kind = match random.below(3) {
        0 if units.len() % 2 == 1 => 1,
        kind => kind,
    };
    for (k, unit) in units.iter_mut().enumerate() {
        let [x, y, _] = unit.position;
        let per = lean / (x * x + y * y).sqrt();
        let [ax, ay] = match kind {
            0 if k % 2 == 0 => [-per * y, per * x],
            0 => [per * y, -per * x],
            1 => [per * x, per * y],
            _ => [random.uniform(-lean, lean), random.uniform(-lean, lean)],
        };
        let length = (1.0 + ax * ax + ay * ay).sqrt();
        unit.axis = [ax / length, ay / length, -1.0 / length];
    }
}

/// Moves the units so that the centre of gravity is in the middle of the thrusts, or nearly.
fn centre(units: &mut [Unit], random: &mut Random) {
    let is_off = random.below(3) == 0;
    for axis in 0..2 {
        let places = units.iter().map(|unit| unit.position[axis]);
        let mean = places.clone().sum::<f64>() / units.len() as f64;
        let extent = places.map(|place| (place - mean).abs()).fold(0.0, f64::max);
        let off = if is_off {
            0.15 * extent * random.uniform(-1.0, 1.0)
        } else {
            0.0
        };
        units
            .iter_mut()
            .for_each(|unit| unit.position[axis] -= mean + off);
    }
}
