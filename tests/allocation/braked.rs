//! Closed loops with a rotor out: turns of 90 degrees in both senses, by a controller that asks for all the yaw it likes.
//! The vehicle brakes what it turns, and keeps its height and its attitude.

use std::path::Path;

use mixer_compiler::airframe::GRAVITY;
use mixer_compiler::model::Physics;
use mixer_rt::tables::{LEVEL_YAWS, REQUEST_LIMIT};
use mixer_rt::{Conditions, Health, Wrench};
use mixer_tests::frames::{self, zoo::Zoo};
use mixer_tests::request::Frame;
use nalgebra::{UnitQuaternion, Vector3};

use crate::{number, rotors_out};

/// Steps of the loop and of the controllers, and the lag of the rotors, s.
const STEP_S: f64 = 0.0025;
const LAG_S: f64 = 0.04;

/// When the turn begins and the flight ends, s.
const TURN_S: [f64; 2] = [5.0, 20.0];
const QUARTER: f64 = std::f64::consts::FRAC_PI_2;

/// Largest yaw rate asked, rad/s: PX4's `MC_YAWRATE_MAX` of 200 degrees/s.
const RATE: f64 = 3.49;

/// Files whose pairs were identified from benches.
const PAIRS: [&str; 3] = [
    "airframes/isae-x8.toml",
    "airframes/x8-11in-cubic.toml",
    "airframes/x8-16in-quartic.toml",
];

/// Extremes of a flight after its turn has begun.
#[derive(Debug)]
struct Flown {
    /// Least and largest heading in the sense of the turn, degrees.
    heading_deg: [f64; 2],
    /// Largest yaw rate, and that at the end, degrees/s.
    rate_deg_s: [f64; 2],
    /// Largest error of the height, m, and tilt, degrees.
    height_m: f64,
    tilt_deg: f64,
}

/// Flies a frame of a weight, N, with the rotor of a channel out, and turns in a sense.
fn fly(frame: &Frame, weight_n: f64, channel: u8, sense: f64) -> Flown {
    let compiled = &frame.compiled;
    let airframe = &compiled.airframe;
    let physics = Physics {
        airframe,
        map: &compiled.pair,
    };
    let conditions =
        Conditions::at_voltage(airframe.reference_v() as f32).in_air(airframe.reference_density() as f32);
    let health = Health::GOOD.with_failed(channel);
    let mass_kg = weight_n / GRAVITY;
    // A quarter of the mass at the units, as the paper's X8.
    let square = |axis: usize| {
        airframe
            .units
            .iter()
            .map(move |unit| unit.position_m[axis] * unit.position_m[axis])
    };
    let mean = |axis: usize| square(axis).sum::<f64>() / airframe.units.len() as f64;
    let tilt = 0.25 * mass_kg * 0.5 * (mean(0) + mean(1));
    let inertia = Vector3::new(tilt, tilt, 2.0 * tilt);
    let mix = |wrench: [f64; 4]| {
        let setpoint = Wrench::from_array(wrench.map(|x| x as f32));
        compiled
            .tables
            .mix_with_health(&setpoint, conditions, health)
            .expect("finite")
            .0
    };
    let mut throttle: Vec<f64> = mix([0.0, 0.0, 0.0, weight_n])
        .iter()
        .map(|x| f64::from(*x))
        .collect();
    let (mut attitude, mut rate) = (UnitQuaternion::<f64>::identity(), Vector3::zeros());
    let (mut height, mut climb, mut heading) = (0.0, 0.0, 0.0);
    let mut flown = Flown {
        heading_deg: [0.0; 2],
        rate_deg_s: [0.0; 2],
        height_m: 0.0,
        tilt_deg: 0.0,
    };
    for step in 0..(TURN_S[1] / STEP_S) as usize {
        let time_s = step as f64 * STEP_S;
        let wanted = if time_s > TURN_S[0] { sense * QUARTER } else { 0.0 };
        let up = attitude.inverse() * Vector3::z();
        let level = up.cross(&Vector3::z());
        let asked = Vector3::new(
            (-6.5 * level.x).clamp(-3.8, 3.8),
            (-6.5 * level.y).clamp(-3.8, 3.8),
            (2.8f64 * (wanted - heading)).clamp(-RATE, RATE),
        );
        let torque = inertia
            .component_mul(&Vector3::new(20.0, 20.0, 8.0))
            .component_mul(&(asked - rate))
            + rate.cross(&inertia.component_mul(&rate));
        let thrust = mass_kg * (GRAVITY + 3.0 * (-height - climb)) / up.z.max(0.5);
        let told = mix([
            torque.x,
            torque.y,
            torque.z,
            thrust.clamp(0.1 * weight_n, 2.5 * weight_n),
        ]);
        for (throttle, told) in throttle.iter_mut().zip(told) {
            *throttle += STEP_S / LAG_S * (f64::from(told) - *throttle);
        }
        let [roll, pitch, yaw, thrust] = physics.wrench(&throttle, [1.0, 1.0], health);
        let given = Vector3::new(roll, pitch, yaw);
        let turned = (given - rate.cross(&inertia.component_mul(&rate))).component_div(&inertia);
        rate += STEP_S * turned;
        attitude *= UnitQuaternion::from_scaled_axis(STEP_S * rate);
        heading += STEP_S * rate.z;
        climb += STEP_S * (thrust * up.z / mass_kg - GRAVITY);
        height += STEP_S * climb;
        if time_s > TURN_S[0] {
            let [least, most] = flown.heading_deg;
            let turned_deg = (sense * heading).to_degrees();
            flown.heading_deg = [least.min(turned_deg), most.max(turned_deg)];
            let degrees = rate.z.abs().to_degrees();
            flown.rate_deg_s = [flown.rate_deg_s[0].max(degrees), degrees];
            flown.height_m = flown.height_m.max(f64::abs(height));
            flown.tilt_deg = flown.tilt_deg.max(libm::acos(up.z.clamp(-1.0, 1.0)).to_degrees());
        }
    }
    flown
}

/// The frame without a limit of yaw: as it was.
fn without_limit(frame: &Frame) -> Frame {
    let mut compiled = frame.compiled.clone();
    for unit in &mut compiled.tables.units {
        unit.level_yaw_nm = [[REQUEST_LIMIT; LEVEL_YAWS]; 2];
    }
    Frame::new(compiled)
}

/// Turns by less than twice what is asked: with as much yaw to brake as to speed up it does.
fn brakes(flown: &Flown) -> bool {
    let [least, most] = flown.heading_deg;
    least > -90.0 && most < 180.0
}

/// Both senses, as they are named.
const SENSES: [(&str, f64); 2] = [("right", 1.0), ("left", -1.0)];

#[test]
fn a_rotor_out_leaves_a_vehicle_that_brakes_what_it_turns() {
    let mut spun = 0;
    println!(
        "| pair, units | out | turn | limit | heading, degrees | rate: most, at the end, degrees/s | height, m | tilt, degrees |"
    );
    for path in PAIRS {
        for units in [3, 4, 6] {
            let frame = rotors_out::frame(path, units, "roll-pitch", 0.1);
            let before = without_limit(&frame);
            let weight_n = 0.4 * f64::from(frame.compiled.thrust_range_n[1]);
            for (channel, out) in [(0, "upper"), (1, "lower")] {
                for (turn, sense) in SENSES {
                    for (limit, frame) in [("no", &before), ("yes", &frame)] {
                        let flown = fly(frame, weight_n, channel, sense);
                        let ([least, most], [rate, end]) = (flown.heading_deg, flown.rate_deg_s);
                        println!(
                            "| {path}, {units} | {out} | {turn} | {limit} | {least:.0} to {most:.0} | {rate:.0}, {end:.0} | {:.2} | {:.1} |",
                            flown.height_m, flown.tilt_deg
                        );
                        if limit == "no" {
                            spun += u32::from(!brakes(&flown));
                            continue;
                        }
                        assert!(
                            brakes(&flown) && flown.height_m < 0.1 && flown.tilt_deg < 2.0,
                            "{flown:?}"
                        );
                    }
                }
            }
        }
    }
    // A fault that is planted: without the limit some never stop.
    assert!(spun > 0);
}

/// Frames of the zoo drawn; `MIXER_FLIGHTS` draws more.
const FLIGHTS: u64 = 12;

#[test]
fn the_zoo_brakes_what_it_turns() {
    let data = std::env::var_os("MIXER_BENCH_DATA");
    let pairs = frames::real_pairs(data.as_deref().map(Path::new)).expect("pairs");
    let zoo = Zoo::new(58, pairs);
    let (mut flown, mut index, mut fails) = (0, 0, Vec::new());
    while flown < number("MIXER_FLIGHTS", FLIGHTS) {
        let specimen = zoo.specimen(index);
        index += 1;
        let Ok(compiled) = frames::compile_text(&specimen.text) else {
            continue;
        };
        let is_whole = compiled.airframe.allocation.axes.len() == 4 && compiled.airframe.units.len() >= 3;
        let frame = Frame::new(compiled);
        let weight_n = 0.4 * f64::from(frame.compiled.thrust_range_n[1]);
        let share = 0.4 * (LEVEL_YAWS - 1) as f32;
        for unit in frame.compiled.tables.units.iter().filter(|_| is_whole) {
            for (channel, yaws) in unit.channels.into_iter().zip(unit.level_yaw_nm) {
                // Whether level flight has some yaw at that weight.
                if yaws[share as usize].min(yaws[share as usize + 1]) <= 0.0 {
                    continue;
                }
                for (turn, sense) in SENSES {
                    let flight = fly(&frame, weight_n, channel, sense);
                    if !brakes(&flight) {
                        fails.push(format!(
                            "index {}, channel {channel}, {turn}: {flight:?}",
                            index - 1
                        ));
                    }
                }
            }
        }
        flown += u64::from(is_whole);
    }
    assert!(fails.is_empty(), "{fails:#?}");
}
