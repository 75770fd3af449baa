//! Rotors under way on drawn frames: what `mix_dynamic` promises of every one of them.
#![allow(missing_docs)]

use mixer_compiler::tables::AnyState;
use mixer_compiler::{Compiled, Source};
use mixer_rt::tables::{Lag, NO_CHANNEL, Unit};
use mixer_rt::{Conditions, Health, Wrench};
use mixer_setpoints::Random;
use mixer_tests::frames;

/// Frames of each kind, and requests of each frame.
const FRAMES: u64 = 8;
const REQUESTS: usize = 150;

/// What f32 leaves of a shift that is none.
const ROUNDING: f32 = 2e-5;

struct Frame {
    compiled: Compiled,
    random: Random,
}

/// Runs a check on frames of one pair, of two pairs, and with single rotors.
fn each(check: impl Fn(&mut Frame)) {
    let zoo = || frames::zoo(5).expect("airframes/");
    let mut compiled = 0;
    for zoo in [zoo(), zoo().unlike(), zoo().with_single_rotors()] {
        for index in 0..FRAMES {
            let specimen = zoo.specimen(index);
            // Some are refused, for what `tests/zoo.rs` allows.
            if let Ok(frame) = mixer_compiler::compile(&Source::new("zoo.toml", specimen.text)) {
                compiled += 1;
                assert!(frame.dynamics.is_some(), "no proof: {}", frame.source.text);
                check(&mut Frame {
                    compiled: frame,
                    random: Random::new(index),
                });
            }
        }
    }
    assert!(compiled > 2 * FRAMES);
}

impl Frame {
    fn conditions(&self) -> Conditions {
        Conditions::at_voltage(self.compiled.airframe.reference_v() as f32)
    }

    /// A request that is mostly attainable.
    fn request(&mut self) -> Wrench {
        let [low, high] = self.compiled.thrust_range_n;
        let [roll, pitch, yaw, _] = self.compiled.scale().to_array().map(f32::abs);
        let random = &mut self.random;
        let mut torque = |unit: f32| random.between([-0.1 * unit, 0.1 * unit]);
        let [roll_nm, pitch_nm, yaw_nm] = [torque(roll), torque(pitch), torque(yaw)];
        Wrench {
            roll_nm,
            pitch_nm,
            yaw_nm,
            thrust_n: random.between([low, high]),
        }
    }

    fn mix(&self, request: &Wrench) -> Vec<f32> {
        self.compiled.tables.mix(request, self.conditions()).unwrap().0
    }

    fn dynamic(&self, state: &mut AnyState, request: &Wrench, held_s: f32) -> Vec<f32> {
        let tables = &self.compiled.tables;
        let mixed = tables.mix_dynamic(state, request, self.conditions(), Health::GOOD, held_s);
        mixed.unwrap().0
    }

    /// A state of rotors somewhere in the range, or within `near` of throttles.
    fn state(&mut self, about: &[f32], near: f32) -> AnyState {
        let range = self.compiled.tables.throttle;
        let mut state = AnyState::default();
        for (worth, about) in state.worth.iter_mut().zip(about) {
            *worth = (about + self.random.between([-near, near])).clamp(range.min, range.max);
        }
        state
    }
}

/// Channels of a unit that exist.
fn channels(unit: &Unit) -> Vec<usize> {
    let all = unit.channels.iter().filter(|channel| **channel != NO_CHANNEL);
    all.map(|channel| usize::from(*channel)).collect()
}

fn rate(lag: &Lag, worth: f32) -> f32 {
    (lag.base + lag.rise * worth).sqrt()
}

/// The largest shift that is stated: of the second order in the distance, and of lags that differ.
fn stated(frame: &Frame, unit: &Unit, worth: &[f32], steady: &[f32]) -> f32 {
    let kind = usize::from(unit.kind);
    let per_square = frame.compiled.dynamics.as_ref().unwrap()[kind].shift_per_square as f32;
    let lag = &frame.compiled.tables.lags[kind];
    let rotors = channels(unit);
    let distance = rotors
        .iter()
        .map(|k| (worth[*k] - steady[*k]).abs())
        .fold(0.0, f32::max);
    let rates: Vec<f32> = rotors.iter().map(|k| rate(lag, worth[*k])).collect();
    let [least, most] = [
        rates.iter().copied().fold(f32::MAX, f32::min),
        rates.iter().copied().fold(0.0, f32::max),
    ];
    per_square * distance * distance + (most - least) / (most + least) * 2.0 * distance + ROUNDING
}

/// Shifts are within what is stated, both throttles of a unit alike while neither is at a limit; throttles are in range.
/// So about every steady state, where distances are small, the mixer is `mix` to the first order but for unequal lags.
#[test]
fn shifts_are_alike_and_within_what_is_stated() {
    let counted = std::cell::Cell::new(0);
    each(|frame| {
        let range = frame.compiled.tables.throttle;
        for _ in 0..REQUESTS {
            let request = frame.request();
            let steady = frame.mix(&request);
            for near in [1e-3, 1e-2, 0.1, 1.0] {
                let before = frame.state(&steady, near);
                let held_s = frame.random.between([0.0, 0.02]);
                let given = frame.dynamic(&mut { before }, &request, held_s);
                for unit in frame.compiled.tables.units.clone() {
                    let rotors = channels(&unit);
                    let is_within = |k: &usize| given[*k] > range.min && given[*k] < range.max;
                    assert!(
                        rotors
                            .iter()
                            .all(|k| (range.min..=range.max).contains(&given[*k]))
                    );
                    if !rotors.iter().all(is_within) {
                        continue;
                    }
                    counted.set(counted.get() + 1);
                    let most = stated(frame, &unit, &before.worth, &steady);
                    let shifts: Vec<f32> = rotors.iter().map(|k| given[*k] - steady[*k]).collect();
                    assert!(
                        shifts.iter().all(|shift| (shift - shifts[0]).abs() < 1e-6),
                        "{shifts:?}"
                    );
                    assert!(shifts[0].abs() <= most, "{shifts:?} {most} {near}");
                }
            }
        }
    });
    assert!(counted.get() > 1000);
}

/// Where the request rests, shifts go to zero: after k of the longest lags what is left of the second order is below exp(-2 k) of
/// its bound, and at the speeds of `mix` the throttles are its, to the bit.
#[test]
fn it_ends_at_the_throttles_of_mix() {
    each(|frame| {
        let range = frame.compiled.tables.throttle;
        for _ in 0..REQUESTS / 10 {
            let request = frame.request();
            let steady = frame.mix(&request);
            let mut at = AnyState::default();
            at.worth[..steady.len()].copy_from_slice(&steady);
            assert_eq!(frame.dynamic(&mut at, &request, 0.004), steady);
            let mut state = frame.state(&steady, 0.2);
            let units = frame.compiled.tables.units.clone();
            let first: Vec<f32> = units
                .iter()
                .map(|unit| stated(frame, unit, &state.worth, &steady))
                .collect();
            let longest_s = |unit: &Unit| {
                let lag = &frame.compiled.tables.lags[usize::from(unit.kind)];
                1.0 / rate(
                    lag,
                    channels(unit)
                        .iter()
                        .map(|k| steady[*k].min(state.worth[*k]))
                        .fold(1.0, f32::min),
                )
            };
            let lag_s = units.iter().map(longest_s).fold(0.0, f32::max);
            for step in 0..160 {
                let before = state;
                let given = frame.dynamic(&mut state, &request, 0.05 * lag_s);
                let left = (-2.0 * 0.05 * step as f32).exp();
                for (unit, first) in units.iter().zip(&first) {
                    let rotors = channels(unit);
                    if rotors
                        .iter()
                        .any(|k| given[*k] <= range.min || given[*k] >= range.max)
                    {
                        continue;
                    }
                    let shift = (given[rotors[0]] - steady[rotors[0]]).abs();
                    let of_lags = stated(frame, unit, &before.worth, &steady);
                    assert!(
                        shift
                            <= 1.1 * left * first + of_lags.min(0.2 * left.sqrt() * first.sqrt()) + ROUNDING,
                        "{step}: {shift} {first}"
                    );
                }
            }
            let last = frame.dynamic(&mut state, &request, 0.05 * lag_s);
            let off = last
                .iter()
                .zip(&steady)
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, f32::max);
            assert!(off < 1e-3, "{off}");
        }
    });
}
