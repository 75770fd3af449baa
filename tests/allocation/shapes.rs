//! Pairs whose attainable sets are not convex: made up ones, and the real maps of
//! `MIXER_BENCH_DATA` in three bases. On an X8, where yaw may have several peaks along the null
//! space of the thrusts, and on a Y6.

#[path = "../../tools/cargo-mixer/tests/maps/mod.rs"]
mod maps;

use mixer_compiler::Source;
use mixer_compiler::airframe::{Airframe, Spin};
use mixer_compiler::model::PairMap;
use mixer_compiler::model::injectivity::EnclosedPairMap;
use mixer_identify::fragment;
use mixer_rt::Health;
use mixer_setpoints::Random;
use mixer_tests::frames::{self, BENT, Options};
use mixer_tests::request::{Answer, Frame, Request};
use mixer_tests::soundness;

/// Distance of the drawn throttles to the ends of their range, as a share of it.
const MARGIN: f64 = 0.01;

/// Share of the attainable set's area that may be lost between the sides of the closed form.
const LOST: f64 = 0.002;

/// Share of the authority by which an axis may be short, and yaw of the best along the null space.
const SHORT: f64 = 0.01;

/// What came of many requests.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    /// Attainable, and of these delivered.
    attainable: usize,
    delivered: usize,
    /// Answers with a fault.
    faults: usize,
    /// Out of reach, and how much these are short of the best yaw at worst.
    saturated: usize,
    shortest: f64,
}

impl Tally {
    fn add(&mut self, other: Tally) {
        self.attainable += other.attainable;
        self.delivered += other.delivered;
        self.faults += other.faults;
        self.saturated += other.saturated;
        self.shortest = self.shortest.max(other.shortest);
    }
}

/// Wrenches of random throttles.
fn deliver(frame: &Frame, random: &mut Random, count: usize, tally: &mut Tally) {
    for _ in 0..count {
        let shares: Vec<f64> = (0..frame.physics.rotors())
            .map(|_| random.uniform(MARGIN, 1.0 - MARGIN))
            .collect();
        let throttles = frame.physics.throttles(shares.into_iter(), Health::GOOD);
        let request = Request {
            wrench: frame.physics.wrench(&throttles, 0.0).map(|x| x as f32),
            volts: 0.0,
            density: None,
            health: Health::GOOD,
        };
        let answer = request.mix(frame).expect("finite");
        let delivered = !answer.saturation.any_axis();
        tally.delivered += usize::from(delivered);
        if !delivered && std::env::var_os("MIXER_MISSES").is_some() {
            println!("  {request:?} -> {:?}", answer.achieved);
        }
    }
    tally.attainable += count;
}

/// The most yaw in the direction asked (N m) that the answer's own roll, pitch and thrust leave, by
/// small steps along the null space of an X8's thrusts.
fn best_yaw(frame: &Frame, answer: &Answer, direction: f64) -> f64 {
    const STEPS: usize = 2000;
    let table = frame.compiled.tables.closed_form.as_ref().expect("closed form");
    let view = table.view();
    let [roll, pitch, _, thrust] = answer.achieved;
    let least: Vec<f64> = table
        .units
        .iter()
        .map(|unit| {
            let [by_roll, by_pitch, by_thrust] = unit.allocation.map(f64::from);
            by_roll * roll + by_pitch * pitch + by_thrust * thrust
        })
        .collect();
    let [low, high] = view.thrust_n.map(f64::from);
    let size = high - low;
    let mut best = f64::NEG_INFINITY;
    for step in 0..=2 * STEPS {
        let z = size * (step as f64 / STEPS as f64 - 1.0);
        let mut yaw = 0.0;
        let mut within = true;
        for (unit, least) in table.units.iter().zip(&least) {
            let f = least + z * f64::from(unit.null);
            within &= f >= low && f <= high;
            let turn = direction * f64::from(unit.spin);
            let [middle, half] = view.border.torques(f as f32).map(f64::from);
            yaw += turn * middle + half;
        }
        if within && yaw > best {
            best = yaw;
        }
    }
    best
}

/// Requests of which most are out of reach: sound, near the best.
fn saturate(frame: &Frame, random: &mut Random, count: usize, tally: &mut Tally) {
    for _ in 0..count {
        let request = frame.draw(random, 1.0, 0.0);
        let answer = request.mix(frame).expect("finite");
        let fault = soundness::fault(frame, &request, &answer).expect("solved");
        if let Some(fault) = fault {
            println!("  {fault}: {request:?} -> {answer:?}");
            tally.faults += 1;
        }
        let asked = request.asked();
        let direction = if asked[2] < 0.0 { -1.0 } else { 1.0 };
        if answer.saturation.any_axis() && frame.physics.units() == 4 {
            let best = best_yaw(frame, &answer, direction).min(direction * asked[2]);
            let short = (best - direction * answer.achieved[2]) / frame.authority[2];
            tally.saturated += 1;
            tally.shortest = tally.shortest.max(short);
            if short > SHORT && std::env::var_os("MIXER_MISSES").is_some() {
                println!("  short {short}: {request:?} -> {:?}", answer.achieved);
            }
        }
    }
}

/// The least thrust in all at which equal thrusts f leave no yaw: torques q of the units with one
/// spin, their negative share of the others.
fn least_level_thrust(frame: &Frame, most: f64) -> f64 {
    const STEPS: usize = 100;
    let pair = &frame.physics.pairs[0];
    let units = frame.physics.units();
    let clockwise = frame
        .compiled
        .airframe
        .units
        .iter()
        .filter(|unit| unit.upper_spin == Spin::Cw);
    let clockwise = clockwise.count() as f64;
    let share = clockwise / (units as f64 - clockwise);
    let [idle, torque] = [pair.efforts([pair.range()[0]; 2])[0], pair.scale()[1]];
    let at = |k: usize, from: f64, to: f64| from + (to - from) * k as f64 / STEPS as f64;
    let is_level = |f: f64| {
        (0..=STEPS).any(|k| {
            let q = at(k, -0.3 * torque, 0.3 * torque);
            frame.physics.attains(0, [f, q]) && frame.physics.attains(0, [f, share * q])
        })
    };
    let each = (0..=STEPS)
        .map(|k| at(k, idle, most / units as f64))
        .find(|&f| is_level(f));
    each.map_or(most, |f| f * units as f64)
}

/// The pair on an X8 and a Y6.
fn judge(name: &str, pair: &str, count: usize) -> Tally {
    let mut tally = Tally::default();
    let mut random = Random::new(21);
    for (frame_name, places) in frames::regular_frames().into_iter().take(2) {
        for airmode in ["disabled", "roll-pitch"] {
            let mut channels: Vec<usize> = (0..2 * places.len()).collect();
            random.shuffle(&mut channels);
            let options = Options {
                airmode,
                ..Options::default()
            };
            let text = frames::toml_with_pair(pair, &places, &channels, options);
            let compiled = frames::compile_text(&text).unwrap_or_else(|faults| panic!("{name}: {faults}"));
            let frame = Frame::new(compiled);
            let lost = frame.compiled.lost_outside_border;
            let lost = lost.unwrap_or_else(|reason| panic!("{name}, {frame_name}: {reason}"));
            assert!(lost <= LOST, "{name}, {frame_name}: {lost}");
            let table = frame.compiled.tables.closed_form.as_ref().expect("closed form");
            let floor = f64::from(table.view().thrust_floor_n);
            if airmode == "disabled" {
                let above = floor - least_level_thrust(&frame, floor);
                assert!(
                    above <= SHORT * frame.authority[3],
                    "{name}, {frame_name}: {above} N of {floor} N"
                );
            }
            deliver(&frame, &mut random, count, &mut tally);
            saturate(&frame, &mut random, count, &mut tally);
        }
    }
    println!("{name}: {tally:?}");
    tally
}

/// No answer is shorter of the best yaw than `short`.
fn hold(tally: &Tally, short: f64) {
    assert_eq!(tally.delivered, tally.attainable, "{tally:?}");
    assert_eq!(tally.faults, 0, "{tally:?}");
    assert!(tally.shortest <= short, "{tally:?}");
}

#[test]
fn sets_that_bend_inwards_are_used() {
    for (name, pair) in BENT {
        hold(&judge(name, pair, 2000), SHORT);
    }
}

/// The real pairs in three bases, with their names.
fn real_pairs() -> Vec<(String, String)> {
    const IDLE: f64 = 1.03;
    let mut pairs = Vec::new();
    for map in &maps::files() {
        for basis in ["biquadratic", "cubic", "quartic"] {
            let identified = maps::identified(map, basis);
            let name = map.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let text = maps::with_throttle(&identified, [0.1, 1.0]);
            let places = frames::regular(4, 45.0);
            let channels: Vec<usize> = (0..8).collect();
            let text = frames::toml_with_pair(&text, &places, &channels, Options::default());
            let own =
                Airframe::read(&Source::new("own.toml", text)).unwrap_or_else(|faults| panic!("{faults}"));
            let least = EnclosedPairMap::new(&own.pairs[0])
                .least_idle(1.0)
                .expect("an idle");
            let idle = IDLE * least;
            let [idle_n, _] = PairMap::new(&own.pairs[0], &own.throttle).efforts([idle; 2]);
            let widest = maps::with_throttle(&identified, [idle, 1.0]);
            let text = frames::toml_with_pair(&widest, &places, &channels, Options::default());
            // Beyond the throttles of its bench a map may give a negative thrust, or all but fold.
            let pair = if idle_n < 0.0 || frames::compile_text(&text).is_err() {
                fragment::text(&identified)
            } else {
                widest
            };
            pairs.push((format!("{} {basis}", &name[4..23]), pair));
        }
    }
    pairs
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn sets_of_real_pairs_are_used() {
    let pairs = real_pairs();
    let mut sum = Tally::default();
    for (name, pair) in &pairs {
        sum.add(judge(name, pair, 200));
    }
    println!("{} pairs: {sum:?}", pairs.len());
    hold(&sum, 6.0 * SHORT);
}
