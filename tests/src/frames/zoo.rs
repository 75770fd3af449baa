//! The zoo: frames as users have them, without end. A [`Specimen`] follows from the seed and its
//! index alone, has the same text on every machine, and is an airframe file that a user may have
//! written: nearly all compile, and the others are refused for a reason among [`REFUSALS`]. The
//! build script of `tests/firmware` includes this file.

use std::fmt::Write as _;

use mixer_compiler::airframe::Spin;
use mixer_compiler::diagnostic::Code;
use mixer_setpoints::Random;

use super::pairs::{Pair, log_uniform};
use super::places::{Unit, place};

pub use super::places::Class;

/// What may be wrong with a specimen: no evaluator meets its tolerances, or it cannot hover since
/// its centre of gravity or its torques at idle forbid.
pub const REFUSALS: [Code; 2] = [Code::Tolerance, Code::Hover];

/// Whose bits are compared on the target: a seed, and the indices of frames of some size.
pub const ON_TARGET: (u64, [u64; 5]) = (1, [1, 3, 4, 8, 9]);

/// Frames made of real pairs, by index.
#[derive(Clone, Debug)]
pub struct Zoo {
    seed: u64,
    pairs: Vec<Pair>,
    is_unlike: bool,
    has_single_rotors: bool,
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
        Zoo {
            seed,
            pairs,
            is_unlike: false,
            has_single_rotors: false,
        }
    }

    /// The same frames with single rotors in the front half of their units, where they have several; of regular
    /// frames of an even number of units every other one has no pair.
    #[must_use]
    pub fn with_single_rotors(self) -> Zoo {
        Zoo {
            has_single_rotors: true,
            ..self
        }
    }

    /// The same frames with another pair in the rear half of their units, where they have several.
    #[must_use]
    pub fn unlike(self) -> Zoo {
        Zoo {
            is_unlike: true,
            ..self
        }
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
        let mut of_rear = random.clone();
        write_voltage(&mut text, &mut random);
        // A sequence of its own, so that frames are otherwise those that they were before.
        write_air(&mut text, &mut Random::new(random.clone().bits()));
        write_inverse(&mut text, &pair, &mut random);
        let units = place(class, &mut random);
        let is_rear = behind(&units);
        let is_unlike = self.is_unlike && units.len() > 1;
        if is_unlike {
            let mut rear = String::new();
            write_pair(&mut rear, &pair.another(&mut of_rear));
            let (_, rear) = rear.split_once("\n[pair]\n").unwrap_or_default();
            text = text.replacen("\n[pair]\n", "\n[[pair]]\nname = \"front\"\n", 1);
            text.insert_str(
                end_of_pair(&text),
                &format!("\n[[pair]]\nname = \"rear\"\n{rear}"),
            );
        }
        write_allocation(&mut text, class, &pair, units.len(), &mut random);
        let has_single_rotors = self.has_single_rotors && units.len() > 1;
        // Their yaw balances.
        let is_balanced = class == Class::Regular && units.len() > 3 && units.len().is_multiple_of(2);
        let has_no_pair = has_single_rotors && is_balanced && index.is_multiple_of(12);
        if has_single_rotors {
            write_single_rotor(&mut text, &pair, &mut of_rear);
            if has_no_pair && let Some(begin) = text.find("\n[pair]\n") {
                text.replace_range(begin..end_of_pair(&text), "");
            }
        }
        let of_unit = |unit: usize| match (is_rear[unit], is_unlike) {
            _ if has_no_pair => Some("rotor = \"single\""),
            (false, _) if has_single_rotors => Some("rotor = \"single\""),
            (true, true) => Some("pair = \"rear\""),
            (false, true) => Some("pair = \"front\""),
            _ => None,
        };
        write_units(&mut text, &units, &of_unit, &mut random);
        Specimen { class, text }
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

pub(super) fn write_pair(text: &mut String, pair: &Pair) {
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

/// None, or exponents of its own, or those of the voltage less 1 where it has them.
fn write_air(text: &mut String, random: &mut Random) {
    if random.below(2) == 0 {
        return;
    }
    let reference = three_digits(random.uniform(1.0, 1.25));
    let range =
        [random.uniform(0.6, 0.95), random.uniform(1.01, 1.2)].map(|share| three_digits(share * reference));
    let _ = write!(
        text,
        "\n[air]\nreference_density_kg_m3 = {reference:?}\nrange_kg_m3 = {range:?}\n"
    );
    if !text.contains("[voltage]") || random.below(2) == 0 {
        for quantity in ["thrust", "torque"] {
            let exponent = rounded(random.uniform(0.5, 1.0));
            let _ = writeln!(text, "{quantity}_exponent = {exponent:?}");
        }
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
            0 | 1 => writeln!(text, "{quantity}_exponent = {:?}", rounded(slope + bend)),
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

/// Whether a unit is one of the rear half.
fn behind(units: &[Unit]) -> Vec<bool> {
    let mut order: Vec<usize> = (0..units.len()).collect();
    order.sort_by(|a, b| units[*a].position[0].total_cmp(&units[*b].position[0]));
    let rear = &order[..units.len() / 2];
    (0..units.len()).map(|unit| rear.contains(&unit)).collect()
}

/// A single rotor of about half of a pair's thrust. Its torque over thrust differs by some ten percent over the throttle
/// range, as it does on benches.
fn write_single_rotor(text: &mut String, pair: &Pair, random: &mut Random) {
    let [f, q] = pair.largest();
    let share = random.uniform(0.4, 0.65);
    let (linear, cubic) = (random.uniform(0.01, 0.1), random.uniform(-0.35, 0.0));
    let curve = |full: f64, linear: f64, cubic: f64| {
        list(&[linear, 1.0 - linear - cubic, cubic].map(|part| three_digits(part * share * full)))
    };
    let thrust = curve(f, linear, cubic);
    let (more, bend) = (random.uniform(-0.005, 0.03), random.uniform(-0.05, 0.05));
    let torque = curve(q, linear + more, cubic + bend);
    let _ = write!(
        text,
        "\n[[rotor]]\nname = \"single\"\nthrust_n = {thrust}\ntorque_nm = {torque}\n"
    );
    // Least power is for pairs.
    let without = |line: &&str| !line.starts_with("power_bias");
    *text = text
        .lines()
        .filter(without)
        .map(|line| format!("{line}\n"))
        .collect();
}

/// Where the tables of the first pair end: where another table begins.
fn end_of_pair(text: &str) -> usize {
    let tables = [
        "\n[voltage]",
        "\n[air]",
        "\n[inverse]",
        "\n[allocation]",
        "\n[[rotor]]",
    ];
    let end = tables.iter().filter_map(|table| text.find(table)).min();
    end.unwrap_or(text.len())
}

fn write_units(
    text: &mut String,
    units: &[Unit],
    of_unit: &dyn Fn(usize) -> Option<&'static str>,
    random: &mut Random,
) {
    let n = units.len();
    let is_single = |unit: usize| of_unit(unit).is_some_and(|line| line.starts_with("rotor"));
    let singles = (0..n).filter(|unit| is_single(*unit)).count();
    let mut channels: Vec<usize> = match random.below(3) {
        0 => (0..2 * n).collect(),
        _ => (0..n).flat_map(|k| [k, n + k]).collect(),
    };
    if random.below(3) == 0 {
        random.shuffle(&mut channels);
    }
    if singles > 0 {
        channels.retain(|channel| *channel < 2 * n - singles);
    }
    let mut channels = channels.into_iter();
    let mut is_clockwise = false;
    for (index, unit) in units.iter().enumerate() {
        let rotors = if is_single(index) { 1 } else { 2 };
        let channels: Vec<usize> = channels.by_ref().take(rotors).collect();
        // Single rotors must balance each other.
        is_clockwise ^= is_single(index);
        let is_clockwise = if is_single(index) {
            is_clockwise
        } else {
            unit.clockwise
        };
        let spin = if is_clockwise { Spin::Cw } else { Spin::Ccw };
        // No negative zeros.
        let [x, y, z] = unit.position.map(|place| (place * 1e6).round() / 1e6 + 0.0);
        let _ = write!(
            text,
            "\n[[unit]]\nposition_m = [{x:?}, {y:?}, {z:?}]\nupper_spin = \"{}\"\nchannels = {channels:?}\n",
            spin.name()
        );
        if let Some(line) = of_unit(index) {
            let _ = writeln!(text, "{line}");
        }
        if unit.axis != [0.0, 0.0, -1.0] {
            let [x, y, z] = unit.axis;
            let _ = writeln!(text, "axis = [{x:.9}, {y:.9}, {z:.9}]");
        }
    }
}
