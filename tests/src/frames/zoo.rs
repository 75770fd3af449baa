//! The zoo: frames as users have them, without end. A [`Specimen`] follows from the seed and its
//! index alone, has the same text on every machine, and is an airframe file that a user may have
//! written: nearly all compile, and the others are refused for a reason among [`REFUSALS`]. The
//! build script of `tests/firmware` includes this file.

use std::f64::consts::TAU;
use std::fmt::{self, Write as _};

use mixer_compiler::airframe::Spin;
use mixer_compiler::diagnostic::Code;
use mixer_setpoints::Random;

use super::pairs::{Pair, log_uniform};

/// What may be wrong with a specimen: no evaluator meets its tolerances, or it cannot hover since
/// its centre of gravity or its torques at idle forbid.
pub const REFUSALS: [Code; 2] = [Code::Tolerance, Code::Hover];

/// Whose bits are compared on the target: a seed, and the indices of frames of some size.
pub const ON_TARGET: (u64, [u64; 5]) = (1, [1, 3, 4, 8, 9]);

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
    const CYCLE: [Class; 12] = [
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
struct Unit {
    position: [f64; 3],
    axis: [f64; 3],
    clockwise: bool,
}

/// Frames made of real pairs, by index.
#[derive(Clone, Debug)]
pub struct Zoo {
    seed: u64,
    pairs: Vec<Pair>,
}

/// A frame of the zoo.
#[derive(Clone, Debug)]
pub struct Specimen {
    /// Its shape.
    pub class: Class,
    /// The airframe file.
    pub text: String,
}

impl Zoo {
    /// The frames of a seed, their pairs made of `pairs`, at least one.
    pub fn new(seed: u64, pairs: Vec<Pair>) -> Zoo {
        assert!(!pairs.is_empty(), "a zoo needs a pair");
        Zoo { seed, pairs }
    }

    /// The frame of this index.
    pub fn specimen(&self, index: u64) -> Specimen {
        let class = Class::CYCLE[(index % Class::CYCLE.len() as u64) as usize];
        let mut random = Random::new(Random::new(self.seed).bits() ^ Random::new(index).bits());
        let pair = Pair::draw(&mut random, &self.pairs);
        let mut text = format!(
            "name = \"zoo\"\ndescription = \"{class}, seed {}, index {index}\"\n",
            self.seed
        );
        write_pair(&mut text, &pair);
        write_voltage(&mut text, &mut random);
        write_inverse(&mut text, &pair, &mut random);
        let units = place(class, &mut random);
        write_allocation(&mut text, class, &pair, units.len(), &mut random);
        write_units(&mut text, &units, &mut random);
        Specimen { class, text }
    }
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

fn place(class: Class, random: &mut Random) -> Vec<Unit> {
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

/// Axes lean along the circle to and fro, inwards or outwards, or anyhow.
fn tilt(units: &mut [Unit], random: &mut Random) {
    let lean = random.uniform(0.03, 0.25);
    let kind = random.below(3);
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

fn list(numbers: &[f64]) -> String {
    let numbers: Vec<String> = numbers.iter().map(|number| format!("{number:?}")).collect();
    format!("[{}]", numbers.join(", "))
}

/// To a ten thousandth.
fn rounded(number: f64) -> f64 {
    (number * 1e4).round() / 1e4
}

/// To three digits.
fn three_digits(number: f64) -> f64 {
    format!("{number:.2e}").parse().unwrap_or(number)
}

// Writing to a String cannot fail; the results are dropped.

fn write_pair(text: &mut String, pair: &Pair) {
    let [min, max] = pair.throttle;
    let [thrust, torque] = pair.coefficients.each_ref().map(|numbers| list(numbers));
    let basis = pair.basis.name();
    let _ = write!(
        text,
        "\n[throttle]\nmin = {min:?}\nmax = {max:?}\n\n[pair]\nbasis = \"{basis}\"\nthrust_n = {thrust}\n\
         torque_nm = {torque}\nupper_spin = \"cw\"\n"
    );
    let curves = pair.alone.iter().flatten();
    for ([thrust, torque], name) in curves.zip(["lower_out", "upper_out"]) {
        let [thrust, torque] = [thrust, torque].map(|numbers| list(numbers));
        let _ = write!(
            text,
            "\n[pair.{name}]\nthrust_n = {thrust}\ntorque_nm = {torque}\n"
        );
    }
}

/// None, or one law of each kind for thrust and for torque.
fn write_voltage(text: &mut String, random: &mut Random) {
    if random.below(4) == 0 {
        return;
    }
    let reference = rounded(3.7 * (2 + random.below(13)) as f64);
    let [low, high] = [random.uniform(0.75, 0.95), random.uniform(1.02, 1.2)].map(|x| rounded(x * reference));
    let _ = write!(
        text,
        "\n[voltage]\nreference_v = {reference:?}\nrange_v = [{low:?}, {high:?}]\n"
    );
    for quantity in ["thrust", "torque"] {
        // 1 at the reference, growing by the power of about 1 to 2.2 there.
        let (slope, bend) = (random.uniform(1.0, 1.6), rounded(random.uniform(0.0, 0.3)));
        let linear = rounded(slope);
        let constant = rounded(1.0 - linear - bend);
        let _ = match random.below(3) {
            0 => writeln!(text, "{quantity}_exponent = {:?}", rounded(slope + bend)),
            1 => writeln!(
                text,
                "{quantity}_polynomial = {}",
                list(&[constant, linear, bend])
            ),
            _ => {
                let inner = [rounded(0.5 * (low + reference)), reference];
                let points = [low, inner[0], inner[1], high].map(|volts| {
                    let x = volts / reference;
                    list(&[volts, rounded(constant + x * (linear + x * bend))])
                });
                writeln!(text, "{quantity}_points = [{}]", points.join(", "))
            }
        };
    }
}

/// The defaults where they suit the pair, tolerances of its size, or the paper's polynomial.
fn write_inverse(text: &mut String, pair: &Pair, random: &mut Random) {
    let [f, q] = pair.largest();
    let share = match random.below(16) {
        0 => 0.02,
        1..8 if (8.0..200.0).contains(&f) && (0.08..5.0).contains(&q) => return,
        _ => log_uniform(random, [1e-4, 4e-3]),
    };
    let [f, q] = [share * f, share * q].map(three_digits);
    let _ = write!(
        text,
        "\n[inverse]\nthrust_tolerance_n = {f:?}\ntorque_tolerance_nm = {q:?}\n"
    );
    if share == 0.02 {
        text.push_str("method = \"polynomial\"\ndegree = 7\n");
    }
}

fn write_allocation(text: &mut String, class: Class, pair: &Pair, units: usize, random: &mut Random) {
    let airmode = ["disabled", "roll-pitch", "roll-pitch-yaw"][random.below(3)];
    let _ = write!(text, "\n[allocation]\nairmode = \"{airmode}\"\n");
    let left_out = match class {
        Class::Single => &["roll", "pitch"][..],
        Class::Bicopter => &["pitch"],
        _ if random.below(16) == 0 => [&["roll"], &["pitch"], &["yaw"]][random.below(3)],
        _ => &[],
    };
    let [f, q] = pair.largest();
    let (reserve, bias) = (random.below(3) == 0, random.below(4) == 0);
    let reserve_share = random.uniform(0.02, 0.25);
    let bias_share = random.uniform(-0.3, 0.8);
    if !left_out.is_empty() {
        let served = ["roll", "pitch", "yaw", "thrust"];
        let served = served.iter().filter(|axis| !left_out.contains(axis));
        let served: Vec<String> = served.map(|axis| format!("{axis:?}")).collect();
        let _ = writeln!(text, "axes = [{}]", served.join(", "));
    }
    if left_out.contains(&"yaw") {
        return;
    }
    if reserve {
        let _ = writeln!(
            text,
            "yaw_reserve_nm = {:?}",
            three_digits(reserve_share * q * units as f64)
        );
    }
    if bias {
        let _ = writeln!(
            text,
            "power_bias_nm_per_n = {:?}",
            three_digits(bias_share * q / f)
        );
    }
}

fn write_units(text: &mut String, units: &[Unit], random: &mut Random) {
    let n = units.len();
    let mut channels: Vec<usize> = match random.below(3) {
        0 => (0..2 * n).collect(),
        _ => (0..n).flat_map(|k| [k, n + k]).collect(),
    };
    if random.below(3) == 0 {
        random.shuffle(&mut channels);
    }
    for (unit, channels) in units.iter().zip(channels.chunks(2)) {
        let spin = if unit.clockwise { Spin::Cw } else { Spin::Ccw };
        // No negative zeros.
        let [x, y, z] = unit.position.map(|place| (place * 1e6).round() / 1e6 + 0.0);
        let _ = write!(
            text,
            "\n[[unit]]\nposition_m = [{x:?}, {y:?}, {z:?}]\nupper_spin = \"{}\"\nchannels = {channels:?}\n",
            spin.name()
        );
        if unit.axis != [0.0, 0.0, -1.0] {
            let [x, y, z] = unit.axis;
            let _ = writeln!(text, "axis = [{x:.9}, {y:.9}, {z:.9}]");
        }
    }
}
