//! Flights whose plant is off by a known factor, logged as the stacks log them, in wind, with noise and a battery
//! that sags: `mixer_files::review` finds the factor, and its interval holds it.

mod wind;

use clap::Parser;
use mixer_compiler::{Compiled, Source};
use mixer_files::params::Stack;
use mixer_files::review::{Flight, Review, Series};
use mixer_rt::Wrench;
use nalgebra::{UnitQuaternion, Vector3};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::SeedableRng;
use simulation::air::normal;
use simulation::sitl::arguments::Arguments;
use simulation::sitl::sensors::Sensors;
use simulation::sitl::vehicle::{Throttles, Vehicle};
use simulation::sitl::world::World;
use wind::Wind;

const X8: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/simulator/x8.toml");

/// A step of the controller and of the inertial sensors, s: 100 Hz.
const STEP_S: f64 = 0.01;

/// Steps between rows of outputs: 10 Hz, as both stacks log them.
const OUTPUTS: usize = 10;

const TAKE_OFF_S: f64 = 3.0;
const END_S: f64 = 35.0;
const RELEASED_S: f64 = 20.0;

const MASS_KG: f64 = 6.5;

/// Offset of the accelerometer's vertical axis, m/s2.
const OFFSET_M_S2: f64 = 0.15;

fn compiled() -> Compiled {
    let text = std::fs::read_to_string(X8).unwrap();
    mixer_compiler::compile(&Source::new("x8.toml", text)).unwrap()
}

/// Thrust and torques that hold the vehicle at 5 m, heading north, with integrators as the stacks have them; N, N m.
fn controller(world: &World, sum: &mut Vector3<f64>) -> [f64; 4] {
    let (state, mass) = (&world.state, world.vehicle.mass_kg);
    let error = Vector3::new(0.0, 0.0, -5.0) - state.position;
    *sum = (*sum + error * STEP_S).map(|x| x.clamp(-4.0, 4.0));
    let demanded = (error.cap_magnitude(2.0) * 2.0 - state.velocity * 2.4 + *sum * 0.8).cap_magnitude(4.0);
    let attitude: UnitQuaternion<f64> = state.rotation();
    let wanted = UnitQuaternion::from_euler_angles(demanded.y / 9.8, -demanded.x / 9.8, 0.0);
    let turn = (attitude.inverse() * wanted).scaled_axis();
    let torque =
        |axis: usize, stiffness: f64, damping: f64| stiffness * turn[axis] - damping * state.rate[axis];
    let level = (attitude * Vector3::z()).z.max(0.5);
    [
        torque(0, 10.0, 2.0),
        torque(1, 10.0, 2.0),
        torque(2, 1.3, 1.1),
        mass * (9.806_65 - demanded.z) / level,
    ]
}

/// A vehicle of a mass, kg, whose pairs give `scale` times the thrust of the file.
fn vehicle(scale: f64, wind_m_s: f64, mass_kg: f64) -> Vehicle {
    let text = [scale, wind_m_s, mass_kg].map(|x| x.to_string());
    let flags = [
        "--thrust-scale",
        &text[0],
        "--resistance",
        "0.03",
        "--capacity",
        "3",
        // About the bench's: elsewhere the motors' law is not the file's, and by 0.4 % at 23 V the scale is not the factor alone.
        "--volts",
        "22.9",
        "--mass-kg",
        &text[2],
    ];
    let arguments = ["sitl", X8, "--px4"].into_iter().chain(flags);
    Vehicle::new(&Arguments::try_parse_from(arguments).unwrap()).unwrap()
}

/// A flight of the vehicle of the file but for its thrust.
fn fly(compiled: &Compiled, scale: f64, wind_m_s: f64, noise: f64, seed: u64) -> Flight {
    let vehicle = vehicle(scale, wind_m_s, MASS_KG);
    fly_with(compiled, &vehicle, &vehicle, wind_m_s, noise, seed)
}

/// A flight of a vehicle that becomes another one, as a load is released, at [`RELEASED_S`].
fn fly_with(
    compiled: &Compiled,
    before: &Vehicle,
    after: &Vehicle,
    wind_m_s: f64,
    noise: f64,
    seed: u64,
) -> Flight {
    let mut world = World::new(before.clone());
    let mut wind = Wind::new(wind_m_s, 1.15, seed);
    let mut sensors = Sensors::new(noise, seed);
    let mut sum = Vector3::zeros();
    let [
        mut throttle,
        mut force,
        mut down,
        mut velocity,
        mut voltage,
        mut landed,
    ] = [(); 6].map(|()| Series::default());
    for step in 0..(END_S / STEP_S) as usize {
        let time_s = world.time_s();
        let flies = time_s > TAKE_OFF_S;
        if time_s > RELEASED_S {
            world.vehicle = after.clone();
        }
        let [roll, pitch, yaw, thrust] = controller(&world, &mut sum);
        let setpoint = Wrench {
            roll_nm: roll as f32,
            pitch_nm: pitch as f32,
            yaw_nm: yaw as f32,
            thrust_n: if flies { thrust as f32 } else { 0.0 },
        };
        let volts = world.voltage_v();
        let (throttles, ..) = compiled.tables.mix(&setpoint, volts as f32).unwrap();
        let [acceleration, _] = sensors.inertial(&world);
        let axes = |x: Vector3<f64>| x.iter().copied().collect::<Vec<f64>>();
        force.push(time_s, axes(acceleration + Vector3::z() * OFFSET_M_S2));
        if step.is_multiple_of(OUTPUTS) {
            throttle.push(
                time_s,
                throttles.iter().map(|throttle| f64::from(*throttle)).collect(),
            );
            voltage.push(time_s, vec![volts]);
            velocity.push(time_s, axes(sensors.fix(&world).1));
            down.push(time_s, axes(world.state.rotation().inverse() * Vector3::z()));
            landed.push(time_s, vec![f64::from(u8::from(world.on_ground))]);
        }
        let command = Throttles::from_fn(|rotor, _| throttles.get(rotor).copied().unwrap_or(0.0).into());
        world.push_m_s2 = wind.drag(&world.state);
        wind.advance(STEP_S);
        world.advance(&command, (1e6 * STEP_S) as u64);
    }
    assert_eq!(world.crashed_s, None);
    Flight {
        down: Some(down),
        velocity: Some(velocity),
        landed: Some(landed),
        voltage: Some(voltage),
        ..Flight::new(Stack::Px4, throttle, force)
    }
}

#[test]
fn the_scale_is_found_to_one_percent_in_wind_and_noise() {
    let compiled = compiled();
    let mut scales = Pcg64Mcg::seed_from_u64(47);
    let (mut held, mut worst) = (0, 0.0f64);
    for seed in 1..=20 {
        let scale = 0.85 + 0.015 * seed as f64;
        let wind_m_s = (seed % 4) as f64 * 2.0;
        let noise = 0.25 * (1 + seed % 5) as f64;
        let flight = fly(&compiled, scale, wind_m_s, noise, seed);
        // The mass as it is weighed: 0.5 % off.
        let mass_kg = 6.5 * (1.0 + 0.005 * normal(&mut scales));
        let review = Review::of(&flight, &compiled, Some(mass_kg)).unwrap();
        let found = review.thrust.scale.unwrap() * scale * mass_kg / 6.5 - 1.0;
        let [low, high] = review.thrust.interval.map(|end| end * scale);
        println!("{scale:.3} {wind_m_s} {noise} {found:+.4} {low:.4} {high:.4}");
        held += u32::from((low..=high).contains(&1.0));
        worst = worst.max(found.abs());
        assert!(high - low < 0.05, "{seed}: {low} to {high}");
        assert_eq!(review.thrust.parts.len(), 1, "{seed}: {review}");
    }
    assert!(held >= 19, "{held} of 20");
    assert!(worst < 0.01, "{worst}");
}

/// One log of two flights, the second behind the first.
fn one_log(first: &Flight, second: &Flight) -> Flight {
    let behind = |first: &Series, second: &Series| {
        let mut all = first.clone();
        second
            .rows()
            .for_each(|(time_s, row)| all.push(time_s + END_S, row.to_vec()));
        all
    };
    let some = |of: fn(&Flight) -> &Option<Series>| {
        let both = of(first).as_ref().zip(of(second).as_ref());
        both.map(|(first, second)| behind(first, second))
    };
    Flight {
        down: some(|flight| &flight.down),
        velocity: some(|flight| &flight.velocity),
        landed: some(|flight| &flight.landed),
        voltage: some(|flight| &flight.voltage),
        ..Flight::new(
            Stack::Px4,
            behind(&first.throttle, &second.throttle),
            behind(&first.force, &second.force),
        )
    }
}

/// Loads that are known: each take-off has its scale, a release in the air is found, and there is one number only where
/// all agree.
#[test]
fn take_offs_and_loads_have_their_own_scales() {
    let compiled = compiled();
    for (seed, wind_m_s, noise) in [(1, 0.0, 0.25), (2, 3.0, 0.5), (3, 6.0, 1.0)] {
        let [bare, loaded] = [MASS_KG, MASS_KG + 0.8].map(|mass_kg| vehicle(1.0, wind_m_s, mass_kg));
        let fly = |before: &Vehicle, after: &Vehicle, seed: u64| {
            fly_with(&compiled, before, after, wind_m_s, noise, seed)
        };
        let first = fly(&bare, &bare, seed);
        let factor = 1.0 + 0.8 / MASS_KG;
        for (second, wanted) in [
            (fly(&bare, &bare, seed + 10), vec![(1, 1.0), (2, 1.0)]),
            (fly(&loaded, &loaded, seed + 10), vec![(1, 1.0), (2, factor)]),
            (
                fly(&loaded, &bare, seed + 10),
                vec![(1, 1.0), (2, factor), (2, 1.0)],
            ),
        ] {
            let review = Review::of(&one_log(&first, &second), &compiled, Some(MASS_KG)).unwrap();
            let parts = &review.thrust.parts;
            println!("{seed} {wanted:?}: {:?} {parts:?}", review.thrust.scale);
            assert_eq!(
                parts.iter().map(|part| part.flight).collect::<Vec<_>>(),
                wanted.iter().map(|of| of.0).collect::<Vec<_>>()
            );
            for (part, (_, scale)) in parts.iter().zip(&wanted) {
                let [low, high] = part.interval;
                assert!(
                    (low..=high).contains(scale) && (part.scale / scale - 1.0).abs() < 0.01,
                    "{part:?}"
                );
            }
            let all_alike = wanted.iter().all(|(_, scale)| *scale == 1.0);
            assert_eq!(review.thrust.scale.is_some(), all_alike, "{review}");
            assert!(
                review
                    .undecided()
                    .unwrap()
                    .contains(if all_alike { "holds 1" } else { "not one" })
            );
            let released = parts.len() > 2;
            let told = review
                .warnings
                .iter()
                .any(|warning| warning.contains("A load that is taken up or released"));
            assert_eq!(told, released, "{review}");
            if released {
                assert!((parts[1].to_s - END_S - RELEASED_S).abs() < 1.5, "{parts:?}");
            }
        }
    }
}

/// Rows that cannot be, and what is missing, are left out: none moves the scale out of its interval.
#[test]
fn damaged_rows_do_not_move_the_scale() {
    let compiled = compiled();
    let flight = fly(&compiled, 1.0, 2.0, 0.5, 3);
    let of = |flight: &Flight| Review::of(flight, &compiled, Some(6.5)).unwrap();
    let whole = of(&flight);
    // The rows of a channel with another time or other values in some of them.
    let changed = |series: &Series, change: &dyn Fn(usize, &mut f64, &mut Vec<f64>)| {
        let mut made = Series::default();
        for (k, (mut time_s, row)) in series.rows().enumerate() {
            let mut row = row.to_vec();
            change(k, &mut time_s, &mut row);
            made.push(time_s, row);
        }
        made
    };
    let voltage = |change: &dyn Fn(usize, &mut f64, &mut Vec<f64>)| Flight {
        voltage: flight.voltage.as_ref().map(|volts| changed(volts, change)),
        ..flight.clone()
    };
    let outputs = |change: &dyn Fn(usize, &mut f64, &mut Vec<f64>)| Flight {
        throttle: changed(&flight.throttle, change),
        ..flight.clone()
    };
    let force = |change: &dyn Fn(usize, &mut f64, &mut Vec<f64>)| Flight {
        force: changed(&flight.force, change),
        ..flight.clone()
    };
    let cases = [
        (
            "the battery stops early",
            voltage(&|k, _, row| {
                if k > 150 {
                    row[0] = 0.0
                }
            }),
        ),
        (
            "it falls out",
            voltage(&|k, _, row| {
                if k % 50 > 10 {
                    row[0] = 0.0
                }
            }),
        ),
        (
            "one voltage",
            voltage(&|k, _, row| {
                if k == 200 {
                    row[0] = 1e9
                }
            }),
        ),
        (
            "one pulse",
            outputs(&|k, _, row| {
                if k == 200 {
                    row[2] = 64.5
                }
            }),
        ),
        (
            "one time far ahead",
            outputs(&|k, time_s, _| {
                if k == 100 {
                    *time_s = 1e6
                }
            }),
        ),
        (
            "the last time",
            outputs(&|k, time_s, _| {
                if k == 349 {
                    *time_s = 1e6
                }
            }),
        ),
        (
            "one time far back",
            force(&|k, time_s, _| {
                if k == 1000 {
                    *time_s = -5.0
                }
            }),
        ),
        (
            "one NaN",
            force(&|k, _, row| {
                if k == 1500 {
                    row[1] = f64::NAN
                }
            }),
        ),
        (
            "one force",
            force(&|k, _, row| {
                if k == 1500 {
                    row[2] = -3e8
                }
            }),
        ),
    ];
    for (what, damaged) in cases {
        let review = of(&damaged);
        let [low, high] = review.thrust.interval;
        println!(
            "{what}: {:.4} in {low:.4} to {high:.4}, {:?}",
            review.thrust.scale.unwrap(),
            review.seconds
        );
        assert!(
            (low..=high).contains(&whole.thrust.scale.unwrap()),
            "{what}: {low} to {high}"
        );
        assert!(
            (review.thrust.scale.unwrap() / whole.thrust.scale.unwrap() - 1.0).abs() < 0.01,
            "{what}"
        );
        assert!(
            (review.seconds[0] - whole.seconds[0]).abs() < 1.0,
            "{what}: {:?}",
            review.seconds
        );
    }
    // Without any voltage the interval is that of the whole pack, and a sentence says so.
    let none = of(&voltage(&|_, _, row| row[0] = 0.0));
    let [low, high] = none.thrust.interval;
    assert!(
        (low..=high).contains(&whole.thrust.scale.unwrap()) && high - low > 0.1,
        "{low} to {high}"
    );
    assert!(
        none.warnings
            .iter()
            .any(|text| text.contains("rows of the voltage cannot be"))
    );
    assert!(
        none.warnings
            .iter()
            .any(|text| text.contains("interval that of the whole range"))
    );
}
