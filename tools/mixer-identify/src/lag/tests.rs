use std::fmt::Write;

use super::*;
use crate::bench::read::{Reading, read};
use crate::identified::Settings;
use crate::texts::{Outcome, Text, rotor_lag};

const EXPONENT: f64 = 1.75;
const HOVER: f64 = 0.5;

/// A bench that logs steps of a rotor, which is integrated in small steps by the law of `mix_dynamic`.
#[derive(Clone, Copy)]
struct Bench {
    lag_s: f64,
    rate_hz: f64,
    brakes: bool,
    by_speed: bool,
    /// Of what is measured, over its value at full throttle.
    noise: f64,
    held_s: f64,
    step: f64,
    seed: u64,
}

const BENCH: Bench = Bench {
    lag_s: 0.07,
    rate_hz: 200.0,
    brakes: true,
    by_speed: true,
    noise: 0.003,
    held_s: 1.0,
    step: 0.3,
    seed: 1,
};

struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// About normal, of deviation 1.
    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }
}

impl Bench {
    /// The log: pulses in whole microseconds, rows that know nothing of the steps, a delay.
    fn log(self) -> String {
        let s = ohmic_share(EXPONENT, 1.0);
        let root = |x: f64| ((1.0 - s) * (1.0 - s) + 4.0 * s * x).sqrt();
        let time_s = self.lag_s * root(HOVER);
        let mut random = Random(0x9e37_79b9_7f4a_7c15 ^ self.seed);
        let (delay_s, dt) = (0.012 * random.uniform(), 2e-4);
        let mut text = String::from("Time (s),ESC signal (µs),");
        text += if self.by_speed {
            "Motor Electrical Speed (RPM)\n"
        } else {
            "Thrust (N)\n"
        };
        let pulse = |time: f64| {
            let up = (time / self.held_s) as i64 % 2 == 1;
            (1000.0 * (1.0 + HOVER + if up { 0.5 } else { -0.5 } * self.step)).round()
        };
        let (mut worth, mut next) = ((pulse(0.0) - 1000.0) / 1000.0, 0.0);
        for k in 0..(16.0 * self.held_s / dt) as usize {
            let time = k as f64 * dt;
            let back_emf = (1.0 - s) * (root(worth) - (1.0 - s)) / (2.0 * s);
            let given = (pulse((time - delay_s).max(0.0)) - 1000.0) / 1000.0;
            let acts = if self.brakes { given } else { given.max(back_emf) };
            worth += dt * (acts - worth) * root(worth) / time_s;
            if time >= next {
                next = time + (1.0 + 0.1 * (random.uniform() - 0.5)) / self.rate_hz;
                let w = (root(worth) - (1.0 - s)) / (2.0 * s);
                let value = if self.by_speed {
                    (9000.0 * (w + self.noise * random.normal())).round()
                } else {
                    14.0 * (w * w + self.noise * random.normal())
                };
                let _ = writeln!(text, "{time:.4},{},{value}", pulse(time));
            }
        }
        text
    }

    fn found(self) -> Result<RotorLag, String> {
        of_text(self.log())
    }
}

fn of_text(log: String) -> Result<RotorLag, String> {
    let text = Text {
        name: "steps.csv".into(),
        content: Ok(log.into_bytes()),
    };
    let mut settings = Settings::default();
    settings.reading.by_hand.speed_serves = true;
    match rotor_lag(&[text], EXPONENT, HOVER, &settings) {
        Ok(Outcome { found, .. }) => Ok(found),
        Err(refusals) => Err(refusals[0].to_string()),
    }
}

/// Lags of 0.03 to 0.2 s at 50 to 400 Hz, noise, quantised throttle and speed, delay: within 15 %, and whether the controller
/// brakes is told.
#[test]
fn lags_are_found_within_fifteen_per_cent() {
    let (mut seed, mut within, mut all) = (0, 0, 0);
    for lag_s in [0.03, 0.05, 0.1, 0.2] {
        for rate_hz in [50.0, 100.0, 400.0] {
            for (brakes, by_speed) in [(true, true), (true, false), (false, true), (false, false)] {
                seed += 1;
                let bench = Bench {
                    lag_s,
                    rate_hz,
                    brakes,
                    by_speed,
                    noise: if by_speed { 0.003 } else { 0.006 },
                    held_s: f64::max(0.5, 8.0 * lag_s),
                    seed,
                    ..BENCH
                };
                let told = format!("{lag_s} s, {rate_hz} Hz, brakes {brakes}, speed {by_speed}");
                let found = bench
                    .found()
                    .unwrap_or_else(|refusal| panic!("{told}: {refusal}"));
                println!(
                    "{told}: {} {:?} {:?}",
                    found.lag_s, found.interval_s, found.up_down_s
                );
                assert!((found.lag_s / lag_s - 1.0).abs() < 0.15, "{told}: {found:?}");
                assert_eq!(found.brakes, Some(brakes), "{told}: {found:?}");
                let [low, high] = found.interval_s;
                within += usize::from((low..=high).contains(&lag_s));
                all += 1;
            }
        }
    }
    assert!(within * 10 >= all * 8, "{within} of {all}");
}

#[test]
fn a_controller_that_does_not_brake_is_slower_down() {
    let [up, down] = Bench {
        brakes: false,
        ..BENCH
    }
    .found()
    .unwrap()
    .up_down_s;
    assert!(down > 1.5 * up, "{up} {down}");
    let [up, down] = BENCH.found().unwrap().up_down_s;
    assert!((down / up - 1.0).abs() < 0.1, "{up} {down}");
    // A rotor that is to turn a little slower needs no brake.
    let small = Bench {
        step: 0.04,
        noise: 0.0005,
        ..BENCH
    }
    .found()
    .unwrap();
    assert_eq!(small.brakes, None, "{small:?}");
}

#[test]
fn what_tells_no_lag_is_refused() {
    let refused = |log: String, why: &str| {
        let told = of_text(log).unwrap_err();
        assert!(told.contains(why) && told.contains("steps.csv"), "{why}: {told}");
    };
    refused(
        Bench {
            lag_s: 0.05,
            rate_hz: 15.0,
            ..BENCH
        }
        .log(),
        "the rows are too rare",
    );
    // Telemetry of 7 Hz in a log of 200 Hz.
    let (mut held, mut count) = (String::new(), 0);
    let log = BENCH.log();
    let values: Vec<&str> = log.lines().map(|line| line.rsplit_once(',').unwrap().1).collect();
    for line in log.lines() {
        let value = values[if count == 0 { 0 } else { 1 + (count - 1) / 30 * 30 }];
        held += &format!("{},{value}\n", line.rsplit_once(',').unwrap().0);
        count += 1;
    }
    refused(held, "the rows are too rare");
    refused(
        Bench { step: 0.0, ..BENCH }.log(),
        "0 steps of the throttle up and 0 down",
    );
    refused(Bench { noise: 0.5, ..BENCH }.log(), "agree on no lag");
    refused(
        Bench {
            held_s: 0.05,
            ..BENCH
        }
        .log(),
        "steps of the throttle up",
    );
    let without_time = BENCH.log().replace("Time (s)", "Row");
    refused(without_time, "0 steps of the throttle up and 0 down");
}

#[test]
fn the_response_is_that_of_the_law() {
    let law = Law {
        share: ohmic_share(EXPONENT, 1.0),
        throttle: HOVER,
        by_speed: true,
    };
    let s = law.share;
    for (from, to, coasts) in [
        (0.2, 0.8, false),
        (0.8, 0.2, false),
        (0.8, 0.2, true),
        (0.5, 0.48, true),
    ] {
        let speed = |time: f64| law.of_root(law.after(law.root(from), to, coasts, time));
        let mut w = speed(0.0);
        assert!(((1.0 - s) * w + s * w * w - from).abs() < 1e-12);
        let dt = 1e-5;
        for k in 1..400_000 {
            let acts = if coasts { f64::max(to, (1.0 - s) * w) } else { to };
            w += dt * (acts - (1.0 - s) * w - s * w * w);
            if k % 20_000 == 0 {
                let exact = speed(f64::from(k) * dt);
                assert!((exact - w).abs() < 1e-4, "{from} {to} {k}: {w} {exact}");
            }
        }
    }
}

/// RCbenchmark's ramps at 8 Hz are no steps.
#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn ramps_of_a_bench_are_refused() {
    let folder = std::env::var_os("MIXER_BENCH_DATA").expect("MIXER_BENCH_DATA");
    let path = std::path::Path::new(&folder).join("aerostack2/multirotor_xNova-MR-steps.csv");
    let log = read("steps.csv", &std::fs::read(path).unwrap(), &Reading::default()).unwrap();
    let refusal = find(&[log], EXPONENT, HOVER).unwrap_err().to_string();
    assert!(refusal.contains("0 steps of the throttle up"), "{refusal}");
}

/// Rotors in flight: a throttle that wanders about hover, speeds at a rate, late and noisy. Rows of time, throttle, speed.
fn flight(lag_s: f64, rate_hz: f64, late_s: f64, brakes: bool, seed: u64) -> Vec<Vec<[f64; 3]>> {
    let s = ohmic_share(EXPONENT, 1.0);
    let root = |x: f64| ((1.0 - s) * (1.0 - s) + 4.0 * s * x).sqrt();
    let (time_s, dt) = (lag_s * root(HOVER), 1e-3);
    let rotor = |k: u64| {
        let mut random = Random(0x9e37_79b9_7f4a_7c15 ^ (8 * seed + k + 1));
        let (mut worth, mut slow, mut fast, mut next) = (HOVER, 0.0, 0.0, 0.0);
        let mut late = std::collections::VecDeque::from(vec![HOVER; (late_s / dt) as usize + 1]);
        let mut rows = Vec::new();
        for step in 0..30_000 {
            // Attitude control: swings of about a second and of a tenth.
            slow += -dt * slow + 0.05 * dt.sqrt() * random.normal();
            fast += -10.0 * dt * fast + 0.08 * dt.sqrt() * random.normal();
            let given = (HOVER + slow + fast).clamp(0.1, 1.0);
            let back_emf = (1.0 - s) * (root(worth) - (1.0 - s)) / (2.0 * s);
            let acts = if brakes { given } else { given.max(back_emf) };
            worth += dt * (acts - worth) * root(worth) / time_s;
            late.push_back(worth);
            let seen = late.pop_front().unwrap();
            let time = f64::from(step) * dt;
            if time >= next {
                next += 1.0 / rate_hz;
                let w = (root(seen) - (1.0 - s)) / (2.0 * s);
                rows.push([time, given, (8000.0 * w + 10.0 * random.normal()).round()]);
            }
        }
        rows
    };
    (0..8).map(rotor).collect()
}

#[test]
fn lags_are_found_in_flight() {
    for (lag_s, rate_hz, late_s, brakes) in [
        (0.03, 50.0, 0.0, true),
        (0.06, 20.0, 0.0, true),
        (0.06, 50.0, 0.02, true),
        (0.08, 25.0, 0.01, false),
        (0.15, 20.0, 0.03, true),
    ] {
        let flown = Flown {
            exponent: EXPONENT,
            throttle: HOVER,
            brakes,
        };
        let (found, [low, high]) = in_flight(&flight(lag_s, rate_hz, late_s, brakes, 1), flown).unwrap();
        println!("{lag_s} s at {rate_hz} Hz, {late_s} s late: {found} ({low} to {high})");
        assert!((found / lag_s - 1.0).abs() < 0.1 && low < found && found < high);
    }
}

#[test]
fn flights_that_tell_no_lag_say_none() {
    let flown = Flown {
        exponent: EXPONENT,
        throttle: HOVER,
        brakes: true,
    };
    let slow = flight(0.06, 10.0, 0.0, true, 1);
    assert_eq!(in_flight(&slow, flown), None, "10 Hz");
    let mut random = Random(1);
    let mut noise = flight(0.06, 25.0, 0.0, true, 1);
    noise
        .iter_mut()
        .flatten()
        .for_each(|row| row[2] = 5000.0 + 50.0 * random.normal());
    assert_eq!(in_flight(&noise, flown), None, "speeds that follow nothing");
    let mut still = flight(0.06, 25.0, 0.0, true, 1);
    still.iter_mut().flatten().for_each(|row| row[1] = HOVER);
    assert_eq!(in_flight(&still, flown), None, "throttles that do not move");
    assert_eq!(in_flight(&[Vec::new(), vec![[0.0, 0.5, 1.0]]], flown), None);
}
