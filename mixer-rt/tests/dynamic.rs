//! Rotors under way: what `mix_dynamic` gives, on two frames of constant tables.
#![allow(missing_docs)]

mod common;

use common::Random;
use common::x8::isae_x8::{self as x8, CHANNELS, State};
use mixer_rt::tables::{Lag, mix_dynamic};
use mixer_rt::{Axis, Conditions, Health, RotorState, SetpointError, Wrench};

const REFERENCE_V: f32 = 14.8;
const HELD_S: f32 = 0.004;

fn wrench(yaw_nm: f32, thrust_n: f32) -> Wrench {
    Wrench {
        yaw_nm,
        thrust_n,
        ..Wrench::default()
    }
}

/// A state in which the rotors have the speeds of a request.
fn steady(request: &Wrench) -> State {
    RotorState {
        worth: x8::mix(request, REFERENCE_V).unwrap().throttle,
    }
}

/// Rotors in f64 by the law of `lag`, slower than it by a factor.
struct Rotors {
    worth: [f64; CHANNELS],
    slower: f64,
    lag: Lag,
}

impl Rotors {
    fn follow(&mut self, throttle: &[f32; CHANNELS], time_s: f64, coast: Option<[f64; 2]>) {
        const STEPS: u32 = 20;
        for (worth, throttle) in self.worth.iter_mut().zip(throttle) {
            for _ in 0..STEPS {
                let change = |worth: f64| {
                    let rate = (f64::from(self.lag.base) + f64::from(self.lag.rise) * worth).sqrt();
                    let least = coast.map_or(0.0, |[a, b]| a * rate - b);
                    rate / self.slower * (f64::from(*throttle).max(least) - worth)
                };
                let step = time_s / f64::from(STEPS);
                *worth += step * change(*worth + 0.5 * step * change(*worth));
            }
        }
    }

    /// The thrust of all units, N.
    fn thrust_n(&self) -> f64 {
        let of = |unit: usize| {
            let channels = x8::TABLES.units[unit].channels.map(usize::from);
            f64::from(x8::TABLES.efforts_of(unit, channels.map(|channel| self.worth[channel] as f32))[0])
        };
        (0..x8::UNITS).map(of).sum()
    }
}

/// The lags of the golden module, or those of controllers that do not brake.
fn lag() -> Lag {
    x8::LAGS[0]
}

/// Factor and offset of the back-EMF over 1 / lag, and the lag of a mixer that knows it.
fn coasting() -> ([f64; 2], Lag) {
    let [base, rise] = [lag().base, lag().rise].map(f64::from);
    // rise / base = 4 s / (1 - s)^2
    let half = 1.0 + 2.0 * base / rise;
    let s = half - (half * half - 1.0).sqrt();
    let time_s = (1.0 - s) / base.sqrt();
    let coast = [(1.0 - s) * time_s / (2.0 * s), (1.0 - s) * (1.0 - s) / (2.0 * s)];
    (
        coast,
        Lag {
            coast: Some(coast.map(|x| x as f32)),
            ..lag()
        },
    )
}

/// Least and largest thrust over that of a request in a pulse of yaw, and its mean over half a second.
fn pulse(mixer: Option<Lag>, slower: f64, coast: Option<[f64; 2]>) -> [f64; 3] {
    let mut state = steady(&wrench(0.0, 31.4));
    let mut rotors = Rotors {
        worth: state.worth.map(f64::from),
        slower,
        lag: lag(),
    };
    let (mut least, mut most, mut sum) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
    const STEPS: usize = 125;
    let steady_n = rotors.thrust_n();
    for step in 0..STEPS {
        let request = wrench(if (10..48).contains(&step) { 0.4 } else { 0.0 }, 31.4);
        let throttle = match mixer {
            Some(lag) => dynamic(&lag, &mut state, &request, REFERENCE_V, Health::GOOD, HELD_S).unwrap(),
            None => x8::mix(&request, REFERENCE_V).unwrap().throttle,
        };
        rotors.follow(&throttle, f64::from(HELD_S), coast);
        let over = rotors.thrust_n() / steady_n;
        (least, most, sum) = (least.min(over), most.max(over), sum + over);
    }
    [least, most, sum / STEPS as f64]
}

fn dynamic(
    lag: &Lag,
    state: &mut State,
    request: &Wrench,
    conditions: impl Into<Conditions>,
    health: Health,
    held_s: f32,
) -> Result<[f32; CHANNELS], SetpointError> {
    let lags = [*lag];
    mix_dynamic::<{ x8::UNITS }, CHANNELS, true, _, _>(
        &x8::TABLES,
        &lags,
        state,
        request,
        conditions.into(),
        health,
        held_s,
    )
    .map(|mix| mix.throttle)
}

#[test]
fn thrust_stays_in_a_pulse_of_yaw() {
    let [least, ..] = pulse(None, 1.0, None);
    assert!(least < 0.96, "{least}");
    let [least, most, mean] = pulse(Some(lag()), 1.0, None);
    println!("{least} {most} {mean}");
    assert!(
        least > 0.998 && most < 1.002 && (mean - 1.0).abs() < 2e-4,
        "{least} {most} {mean}"
    );
}

/// A lag that is believed half of the true one, or too long by half, is better than none.
#[test]
fn a_wrong_lag_is_better_than_none() {
    let [without, .., mean_without] = pulse(None, 1.0, None);
    for slower in [2.0, 1.4, 0.7] {
        let [least, most, mean] = pulse(Some(lag()), slower, None);
        let [own, .., mean_of_own] = pulse(None, slower, None);
        println!("{slower}: {least} {most} {mean}, without {own} {mean_of_own}");
        assert!(
            (1.0 - least).max(most - 1.0) < 0.7 * (1.0 - without),
            "{slower}: {least} {most}"
        );
        assert!(
            (mean - 1.0).abs() < 0.75 * (1.0 - mean_of_own),
            "{slower}: {mean} {mean_without}"
        );
    }
}

#[test]
fn a_mixer_that_knows_that_rotors_coast_keeps_the_thrust() {
    let (coast, knows) = coasting();
    let [_, without, _] = pulse(None, 1.0, Some(coast));
    let [_, not_knowing, _] = pulse(Some(lag()), 1.0, Some(coast));
    let [least, most, _] = pulse(Some(knows), 1.0, Some(coast));
    println!("{without} {not_knowing} {least} {most}");
    assert!(without > 1.08 && not_knowing > 1.08, "{without} {not_knowing}");
    assert!(least > 0.99 && most < 1.01, "{least} {most}");
}

/// Throttles at rest are those of `mix` to the bit, its answer is that of `mix` at any time.
#[test]
fn at_rest_it_is_mix() {
    let mut random = Random::new(3);
    for _ in 0..2_000 {
        let request = Wrench {
            roll_nm: random.between(-6.0, 6.0),
            pitch_nm: random.between(-6.0, 6.0),
            ..wrench(random.between(-0.6, 0.6), random.between(2.0, 95.0))
        };
        let volts = random.between(12.0, 17.0);
        let mix = x8::mix(&request, volts).unwrap();
        let mut state = RotorState { worth: mix.throttle };
        let held_s = random.between(0.0, 0.1);
        let dynamic = x8::mix_dynamic(&mut state, &request, volts, held_s).unwrap();
        assert_eq!((dynamic, state.worth), (mix, mix.throttle), "{request:?}");
        let mut state = RotorState {
            worth: std::array::from_fn(|_| random.between(0.0, 1.0)),
        };
        let dynamic = x8::mix_dynamic(&mut state, &request, volts, held_s).unwrap();
        assert_eq!(
            (dynamic.achieved, dynamic.saturation),
            (mix.achieved, mix.saturation)
        );
        assert!(
            dynamic
                .throttle
                .iter()
                .all(|throttle| (0.1..=1.0).contains(throttle))
        );
    }
}

/// Time, state and conditions that no flight has: throttles are in range, and the state is a number.
#[test]
fn nothing_is_ever_nan() {
    let mut random = Random::new(7);
    let times = [
        0.0,
        -1.0,
        f32::NAN,
        -f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        1e-30,
        0.004,
        1.0,
        1e9,
        f32::MAX,
    ];
    for _ in 0..20_000 {
        let worth = std::array::from_fn(|_| match random.below(4) {
            0 => random.wild(),
            1 => f32::NAN,
            _ => random.between(0.0, 1.0),
        });
        let mut state = RotorState { worth };
        let request = Wrench::from_array(std::array::from_fn(|_| random.wild()));
        let conditions = Conditions::at_voltage(random.wild()).in_air(random.wild());
        let held_s = times[random.below(times.len() as u32) as usize];
        let health = Health::from_bits(u64::from(random.below(256) & random.below(256)));
        let lag = if random.below(2) == 0 { lag() } else { coasting().1 };
        let throttle = dynamic(&lag, &mut state, &request, conditions, health, held_s).unwrap();
        for (channel, (throttle, worth)) in (0..).zip(throttle.iter().zip(state.worth)) {
            let is_sound = if health.has_failed(channel) {
                *throttle == 0.0
            } else {
                (0.1..=1.0).contains(throttle)
            };
            assert!(
                is_sound && (0.0..=1.0).contains(&worth),
                "{throttle} {worth} {request:?} {held_s}"
            );
        }
    }
}

#[test]
fn times_that_are_none_leave_the_state() {
    let before = steady(&wrench(0.0, 30.0));
    for held_s in [0.0, -0.0, -1.0, f32::NAN, f32::NEG_INFINITY] {
        let mut state = before;
        let given = x8::mix_dynamic(&mut state, &wrench(0.3, 30.0), REFERENCE_V, held_s).unwrap();
        assert_eq!(state, before, "{held_s}");
        assert_ne!(
            given,
            x8::mix(&wrench(0.3, 30.0), REFERENCE_V).unwrap(),
            "{held_s}"
        );
    }
    // Held for many lags, rotors come to rest at the throttles of `mix`.
    for held_s in [5.0, 1e3, f32::INFINITY] {
        let mut state = before;
        let mix = x8::mix(&wrench(0.3, 30.0), REFERENCE_V).unwrap();
        let given = x8::mix_dynamic(&mut state, &wrench(0.3, 30.0), REFERENCE_V, held_s).unwrap();
        for channel in 0..CHANNELS {
            let off =
                [given.throttle[channel], state.worth[channel]].map(|x| (x - mix.throttle[channel]).abs());
            assert!(off[0] < 1e-4 && off[1] < 1e-4, "{held_s}: {off:?}");
        }
    }
}

#[test]
fn what_is_refused_leaves_the_state() {
    let mut state = steady(&wrench(0.0, 30.0));
    let before = state;
    let refused = x8::mix_dynamic(&mut state, &wrench(f32::NAN, 30.0), REFERENCE_V, HELD_S);
    assert_eq!(refused, Err(SetpointError::NonFinite(Axis::Yaw)));
    let refused = x8::mix_dynamic(&mut state, &wrench(0.0, 30.0), f32::INFINITY, HELD_S);
    assert_eq!((refused, state), (Err(SetpointError::NonFiniteVoltage), before));
}

/// Rotors that start have the throttles of `mix` until they are at half of idle.
#[test]
fn rotors_start_as_mix_starts_them() {
    let mut state = State::default();
    let request = wrench(0.0, 30.0);
    let mix = x8::mix(&request, REFERENCE_V).unwrap();
    let mut last = 0.0;
    while state.worth.iter().any(|worth| *worth < 0.05) {
        assert_eq!(
            x8::mix_dynamic(&mut state, &request, REFERENCE_V, 0.001).unwrap(),
            mix
        );
        assert!(state.worth[0] > last);
        last = state.worth[0];
    }
    assert_ne!(
        x8::mix_dynamic(&mut state, &request, REFERENCE_V, 0.001).unwrap(),
        mix
    );
}

/// The partner of a rotor that is out brings the thrust of its unit with one lag.
#[test]
fn a_rotor_alone_follows_with_one_lag() {
    let health = Health::GOOD.with_failed(4);
    let [before, after] =
        [24.0, 34.0].map(|thrust| x8::mix_with_health(&wrench(0.0, thrust), REFERENCE_V, health).unwrap());
    let mut state = RotorState {
        worth: before.throttle,
    };
    let alone = |worth: f32| x8::TABLES.kinds.alone[0].efforts(worth)[0];
    let [begin, end] = [before, after].map(|mix| alone(mix.throttle[0]));
    for step in 1..=100 {
        let way = (alone(state.worth[0]) - begin) / (end - begin);
        let rate = (lag().base + lag().rise * state.worth[0]).sqrt();
        let mix =
            x8::mix_dynamic_with_health(&mut state, &wrench(0.0, 34.0), REFERENCE_V, health, 0.001).unwrap();
        assert_eq!(mix.throttle[4], 0.0);
        let next = (alone(state.worth[0]) - begin) / (end - begin);
        let expected = way + (1.0 - way) * (1.0 - (-0.001 * rate).exp());
        assert!((next - expected).abs() < 2e-4, "{step}: {way} {next} {expected}");
    }
    // A rotor that is out is remembered as it stops.
    assert!(state.worth[4] < 0.2 * before.throttle[0].max(0.3));
}

/// A host that gave other throttles tells them to the state from before.
#[test]
fn a_host_tells_what_it_gave() {
    let before = steady(&wrench(0.0, 30.0));
    let (mut state, mut told) = (before, before);
    let given = x8::mix_dynamic(&mut state, &wrench(0.3, 35.0), REFERENCE_V, HELD_S).unwrap();
    x8::follow(&mut told, &given.throttle, HELD_S);
    assert_eq!(told, state);
    x8::follow(&mut told, &[f32::NAN; CHANNELS], HELD_S);
    assert!(told.worth.iter().all(|worth| worth.is_finite()));
}
