//! Allocation and desaturation: what is attainable is delivered, what is not is given up in the stated order.
#![allow(missing_docs)]

use mixer_compiler::Compiled;
use mixer_compiler::model::PairMap;
use mixer_rt::{Axis, Health, SetpointError, Wrench};
use mixer_tests::frames::{self, AIRMODES, Options, Place};
use mixer_tests::optimum::{Optimum, Oracle};
use mixer_tests::random::Random;

const REFERENCE_V: f32 = 14.8;

fn regular_frames() -> [(&'static str, Vec<Place>); 4] {
    [
        ("X8", frames::regular(4, 45.0)),
        ("Y6", frames::regular(3, 60.0)),
        ("X10", frames::regular(5, 0.0)),
        ("X12", frames::regular(6, 30.0)),
    ]
}

fn compile(places: &[Place], airmode: &'static str, yaw_reserve_nm: f64) -> Compiled {
    let options = Options {
        airmode,
        yaw_reserve_nm,
    };
    frames::compile(places, options).unwrap_or_else(|faults| panic!("{faults}"))
}

/// Largest `[roll, pitch, yaw, thrust]` of a frame, all units at their best, N m and N.
fn authority(compiled: &Compiled) -> [f64; 4] {
    let [f, q] = PairMap::new(&compiled.airframe.pair, &compiled.airframe.throttle).scale();
    let n = compiled.airframe.units.len();
    let matrix = &compiled.effectiveness.matrix;
    std::array::from_fn(|axis| {
        (0..n)
            .map(|i| matrix[(axis, i)].abs() * f + matrix[(axis, n + i)].abs() * q)
            .sum()
    })
}

/// A request of up to about `size` times the authority, as f32.
fn request(random: &mut Random, authority: [f64; 4], size: f64) -> [f64; 4] {
    let size = random.between(0.0, size);
    let torque = |random: &mut Random, authority: f64| random.between(-size, size) * authority;
    let request = [
        torque(random, authority[0]),
        torque(random, authority[1]),
        torque(random, authority[2]),
        random.between(-0.05, 1.2) * authority[3],
    ];
    request.map(|x| f64::from(x as f32))
}

fn mix(compiled: &Compiled, request: [f64; 4], voltage_v: f32) -> (Vec<f32>, [f64; 4]) {
    let setpoint = Wrench::from_array(request.map(|x| x as f32));
    let (throttle, achieved, _) = compiled.tables.mix(&setpoint, voltage_v).expect("finite");
    (throttle, achieved.to_array().map(f64::from))
}

#[test]
fn attainable_wrenches_are_delivered_at_any_voltage_and_order_of_channels() {
    const COUNT: usize = 2000;
    let mut random = Random(1);
    for (name, places) in regular_frames() {
        let mut channels: Vec<usize> = (0..2 * places.len()).collect();
        random.shuffle(&mut channels);
        let compiled =
            frames::compile_text(&frames::toml(&places, &channels, Options::default())).expect(name);
        let pair = PairMap::new(&compiled.airframe.pair, &compiled.airframe.throttle);
        let voltage = compiled.airframe.voltage.clone().expect("voltage");
        let (n, matrix) = (places.len(), &compiled.effectiveness.matrix);
        let mut delivered = 0;
        for _ in 0..COUNT {
            let volts = random.between(voltage.range_v[0], voltage.range_v[1]) as f32;
            let factors = [
                voltage.thrust_factor(f64::from(volts)),
                voltage.torque_factor(f64::from(volts)),
            ];
            let mut wrench = [0.0; 4];
            for i in 0..n {
                let [f, q] = pair.efforts([random.between(0.1, 1.0), random.between(0.1, 1.0)]);
                for (axis, wrench) in wrench.iter_mut().enumerate() {
                    *wrench += matrix[(axis, i)] * factors[0] * f + matrix[(axis, n + i)] * factors[1] * q;
                }
            }
            let setpoint = Wrench::from_array(wrench.map(|x| x as f32));
            let (_, _, saturation) = compiled.tables.mix(&setpoint, volts).expect("finite");
            delivered += usize::from(!saturation.any_axis());
        }
        println!("{name}: {delivered} of {COUNT} delivered");
        assert!(delivered * 1000 >= COUNT * 999, "{name}: {delivered} of {COUNT}");
    }
}

/// Shortfalls against the optimum, as shares of the authority: roll and pitch, thrust, yaw.
fn shortfall(request: [f64; 4], achieved: [f64; 4], optimum: &Optimum, authority: [f64; 4]) -> [f64; 3] {
    let torque = (request[0] * request[0] + request[1] * request[1]).sqrt();
    let along = if torque > 0.0 {
        (achieved[0] * request[0] + achieved[1] * request[1]) / torque
    } else {
        0.0
    };
    let missed = |axis: usize, best: f64| {
        ((achieved[axis] - request[axis]).abs() - (best - request[axis]).abs()) / authority[axis]
    };
    [
        (optimum.share * torque - along) / authority[0].min(authority[1]),
        missed(3, optimum.thrust_n),
        missed(2, optimum.yaw_nm),
    ]
}

/// True where something of higher priority than what fell short was given less.
fn misses(shortfall: [f64; 3], yaw_first: bool) -> bool {
    const ALLOWED: f64 = 0.01;
    let [torque, thrust, yaw] = shortfall;
    let (second, third) = if yaw_first { (yaw, thrust) } else { (thrust, yaw) };
    // Giving up a little more of the higher one than the optimum buys much of the lower one, and the reverse.
    let paid = |higher: f64| higher < -0.002;
    torque > ALLOWED || (!paid(torque) && (second > ALLOWED || (!paid(second) && third > ALLOWED)))
}

#[derive(Default)]
struct Judged {
    requests: usize,
    missed: usize,
    worst: [f64; 3],
}

impl Judged {
    fn judge(&mut self, compiled: &Compiled, oracle: &Oracle, random: &mut Random, requests: usize) {
        let authority = authority(compiled);
        let yaw_first = compiled.airframe.allocation.airmode == mixer_rt::Airmode::RollPitchYaw;
        for _ in 0..requests {
            let request = request(random, authority, 0.6);
            let Some(optimum) = oracle.optimum(request) else {
                continue; // not even roll = pitch = 0 with the reserve
            };
            let (_, achieved) = mix(compiled, request, REFERENCE_V);
            let shortfall = shortfall(request, achieved, &optimum, authority);
            let missed = misses(shortfall, yaw_first);
            self.requests += 1;
            self.missed += usize::from(missed);
            for (worst, shortfall) in self.worst.iter_mut().zip(shortfall) {
                *worst = worst.max(shortfall);
            }
        }
    }

    fn print(&self, name: &str) {
        let [torque, thrust, yaw] = self.worst.map(|x| 100.0 * x);
        println!(
            "{name}: {} of {} miss the optimum; worst roll-pitch {torque:.2} %, thrust {thrust:.2} %, yaw {yaw:.2} %",
            self.missed, self.requests
        );
    }
}

#[test]
fn vertical_frames_of_three_and_four_units_reach_the_physical_optimum() {
    let mut random = Random(2);
    for n in [3, 4] {
        for airmode in ["disabled", "roll-pitch"] {
            let mut judged = Judged::default();
            for frame in 0..5 {
                let places = if frame == 0 {
                    frames::regular(n, 45.0)
                } else {
                    frames::irregular(&mut random, n, 0.0)
                };
                let options = Options {
                    airmode,
                    yaw_reserve_nm: 0.0,
                };
                // A random frame may be unable to hover.
                let Ok(compiled) = frames::compile(&places, options) else {
                    continue;
                };
                assert!(compiled.tables.shortcut.is_some());
                let oracle = Oracle::new(&compiled, [1.0, 1.0]);
                judged.judge(&compiled, &oracle, &mut random, 80);
            }
            judged.print(&format!("{n} vertical units, {airmode}"));
            assert!(judged.requests > 0);
            assert_eq!(judged.missed, 0);
        }
    }
}

#[test]
fn any_frame_reaches_the_optimum_of_its_polygon() {
    let mut random = Random(3);
    let mut all = Judged::default();
    for (kind, tilt) in [("vertical", 0.0), ("tilted", 0.08)] {
        for n in 3..=8 {
            let mut judged = Judged::default();
            for airmode in AIRMODES {
                for reserve in [0.0, 0.03] {
                    let places = frames::irregular(&mut random, n, tilt);
                    let options = Options {
                        airmode,
                        yaw_reserve_nm: reserve,
                    };
                    // A random frame may be unable to hover.
                    let Ok(compiled) = frames::compile(&places, options) else {
                        continue;
                    };
                    let oracle = Oracle::of_polygon(&compiled, [1.0, 1.0]);
                    judged.judge(&compiled, &oracle, &mut random, 40);
                }
            }
            judged.print(&format!("{n} {kind} units"));
            assert!(judged.requests > 0);
            all.requests += judged.requests;
            all.missed += judged.missed;
            assert!(judged.worst[0] < 0.03, "{n} {kind}: {:?}", judged.worst);
        }
    }
    // Rounding near the edge of what is attainable, mostly in the last priority.
    assert!(
        all.missed * 100 <= all.requests,
        "{} of {}",
        all.missed,
        all.requests
    );
}

/// Faults of one answer that no frame and no request excuses.
fn unsound(compiled: &Compiled, request: [f64; 4], throttle: &[f32], achieved: [f64; 4]) -> Option<String> {
    let tables = &compiled.tables;
    if throttle
        .iter()
        .any(|t| !(tables.throttle.min..=tables.throttle.max).contains(t))
    {
        return Some(format!("throttles {throttle:?}"));
    }
    // What the inverse map may miss, and 0.1 % of the authority.
    let slack: [f64; 4] = {
        let authority = authority(compiled);
        std::array::from_fn(|axis| f64::from(tables.tolerance.wrench[axis]) + 1e-3 * authority[axis])
    };
    for axis in 0..3 {
        let (asked, got) = (request[axis], achieved[axis]);
        if got * asked.signum() < -slack[axis] || got.abs() > asked.abs() + slack[axis] {
            return Some(format!("axis {axis}: {asked} asked, {got} given"));
        }
    }
    let torque = (request[0] * request[0] + request[1] * request[1]).sqrt();
    let turned = (achieved[0] * request[1] - achieved[1] * request[0]).abs() / torque.max(1e-9);
    if turned > slack[0] + slack[1] {
        return Some(format!("(roll, pitch) turns by {turned}"));
    }
    None
}

#[test]
fn no_axis_is_reversed_or_exceeded() {
    let mut random = Random(4);
    for (name, places) in regular_frames() {
        for airmode in AIRMODES {
            let compiled = compile(&places, airmode, 0.0);
            let authority = authority(&compiled);
            for _ in 0..1000 {
                let mut request = request(&mut random, authority, 2.0);
                // Corners: exact zeros, the ceiling, one axis alone.
                for value in &mut request {
                    match random.index(8) {
                        0 => *value = 0.0,
                        1 => *value *= 100.0,
                        _ => {}
                    }
                }
                let request = request.map(|x| f64::from(x as f32));
                let (throttle, achieved) = mix(&compiled, request, REFERENCE_V);
                if let Some(fault) = unsound(&compiled, request, &throttle, achieved) {
                    panic!("{name} {airmode} {request:?} -> {achieved:?}: {fault}");
                }
                if airmode == "disabled" {
                    let most = request[3].max(f64::from(compiled.thrust_range_n[0])) + 1e-3 * authority[3];
                    assert!(achieved[3] <= most, "{name} {request:?} -> {achieved:?}");
                }
            }
        }
    }
}

#[test]
fn throttles_are_continuous_in_the_request() {
    // A relative change of 1e-4 in one axis moves no throttle by more.
    const JUMP: f32 = 0.02;
    let mut random = Random(5);
    for (name, places) in regular_frames() {
        for airmode in AIRMODES {
            let compiled = compile(&places, airmode, 0.0);
            let authority = authority(&compiled);
            let (mut worst, mut jumps) = (0.0f32, 0);
            const COUNT: usize = 1500;
            for _ in 0..COUNT {
                let request = request(&mut random, authority, 1.0);
                let mut near = request;
                near[random.index(4)] *= 1.0 + 1e-4;
                let (before, _) = mix(&compiled, request, REFERENCE_V);
                let (after, _) = mix(&compiled, near, REFERENCE_V);
                let jump = before
                    .iter()
                    .zip(&after)
                    .map(|(a, b)| (a - b).abs())
                    .fold(0.0, f32::max);
                worst = worst.max(jump);
                jumps += usize::from(jump > JUMP);
            }
            println!("{name} {airmode}: largest change {worst:.4}, {jumps} of {COUNT} above {JUMP}");
            if compiled.tables.shortcut.is_some() {
                assert!(worst <= JUMP, "{name} {airmode}: {worst}");
            }
            assert!(jumps * 200 <= COUNT, "{name} {airmode}: {jumps}");
        }
    }
}

#[test]
fn degenerate_requests_are_answered() {
    let frames = [
        frames::regular(1, 0.0)
            .into_iter()
            .map(|place| Place {
                position: [0.0; 3],
                ..place
            })
            .collect(),
        vec![
            Place {
                position: [0.0, 0.3, 0.0],
                axis: [0.0, 0.0, -1.0],
                clockwise: true,
            },
            Place {
                position: [0.0, -0.3, 0.0],
                axis: [0.0, 0.0, -1.0],
                clockwise: false,
            },
        ],
        frames::regular(4, 45.0),
        // Lever arms that differ by a factor of ten.
        frames::regular(6, 0.0)
            .into_iter()
            .enumerate()
            .map(|(k, place)| Place {
                position: place.position.map(|x| if k % 3 == 0 { 0.2 * x } else { 2.0 * x }),
                ..place
            })
            .collect(),
    ];
    let numbers = [
        0.0,
        -0.0,
        1e-40,
        -1e-40,
        1e-6,
        0.1,
        -0.1,
        1.0,
        40.0,
        -40.0,
        1e4,
        1e30,
        f32::MAX,
        f32::MIN,
    ];
    let mut random = Random(6);
    for places in frames {
        let compiled = compile(&places, "disabled", 0.0);
        for _ in 0..400 {
            let wrench: [f32; 4] = std::array::from_fn(|_| numbers[random.index(numbers.len())]);
            let (throttle, achieved, _) = compiled
                .tables
                .mix(&Wrench::from_array(wrench), REFERENCE_V)
                .expect("finite");
            let range = compiled.tables.throttle;
            assert!(
                throttle.iter().all(|t| (range.min..=range.max).contains(t)),
                "{wrench:?} {throttle:?}"
            );
            assert!(achieved.to_array().iter().all(|x| x.is_finite()));
        }
        for (axis, index) in Axis::ALL.into_iter().zip(0..) {
            for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
                let mut wrench = [0.0, 0.0, 0.0, 20.0];
                wrench[index] = bad;
                let refused = compiled.tables.mix(&Wrench::from_array(wrench), REFERENCE_V);
                assert_eq!(refused, Err(SetpointError::NonFinite(axis)));
            }
        }
    }
}

/// What the fuzz target does, with bits that are the same in every run.
#[test]
fn any_bits_give_throttles_in_range_or_a_refusal() {
    let mut random = Random(7);
    for places in [frames::regular(4, 45.0), frames::regular(5, 0.0)] {
        for airmode in AIRMODES {
            let compiled = compile(&places, airmode, 0.02);
            for _ in 0..1500 {
                let float = |random: &mut Random| f32::from_bits(random.bits() as u32);
                let wrench: [f32; 4] = std::array::from_fn(|_| float(&mut random));
                let volts = float(&mut random);
                let health = Health::GOOD
                    .with_failed(random.bits() as u8)
                    .with_failed(random.bits() as u8);
                let finite = wrench.iter().all(|x| x.is_finite()) && volts.is_finite();
                let mixed = compiled
                    .tables
                    .mix_with_health(&Wrench::from_array(wrench), volts, health);
                assert_eq!(mixed.is_ok(), finite, "{wrench:?} {volts}");
                if let Ok((throttle, achieved, _)) = mixed {
                    let range = compiled.tables.throttle;
                    for (channel, throttle) in (0..).zip(throttle) {
                        let in_range = (range.min..=range.max).contains(&throttle);
                        assert!(
                            in_range || (health.has_failed(channel) && throttle == 0.0),
                            "{wrench:?}"
                        );
                    }
                    assert!(
                        achieved.to_array().iter().all(|x| x.is_finite()),
                        "{wrench:?} {achieved:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn an_x8_without_a_rotor_still_flies() {
    let compiled = compile(&frames::regular(4, 45.0), "disabled", 0.0);
    let full = f64::from(compiled.thrust_range_n[1]);
    let hover = 0.6 * full;
    for channel in 0..8u8 {
        let health = Health::GOOD.with_failed(channel);
        let fly = |torques: [f64; 3]| {
            let [roll, pitch, yaw] = torques;
            let setpoint = Wrench::from_array([roll, pitch, yaw, hover].map(|x| x as f32));
            let (throttle, achieved, _) = compiled
                .tables
                .mix_with_health(&setpoint, REFERENCE_V, health)
                .expect("finite");
            assert_eq!(throttle[usize::from(channel)], 0.0);
            achieved.to_array().map(f64::from)
        };
        for (roll, pitch) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0), (0.7, -0.7)] {
            let achieved = fly([roll, pitch, 0.0]);
            assert!((achieved[0] - roll).abs() < 0.05, "{channel}: {achieved:?}");
            assert!((achieved[1] - pitch).abs() < 0.05, "{channel}: {achieved:?}");
            assert!(
                (achieved[3] - hover).abs() < 0.01 * full,
                "{channel}: {achieved:?}"
            );
        }
        let yaw = [-10.0, 10.0].map(|yaw| fly([0.0, 0.0, yaw])[2]);
        println!(
            "rotor {channel} out, 60 % thrust: yaw {:.3} to {:.3} N m",
            yaw[0], yaw[1]
        );
        // Yaw is left on at least one side.
        assert!(yaw[0] < -0.1 || yaw[1] > 0.1, "{channel}: {yaw:?}");
    }
}
