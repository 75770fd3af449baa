//! The plant obeys mechanics, and both mixers are what they claim to be.

use mixer_compiler::model::PairMap;
use mixer_compiler::model::effectiveness::Effectiveness;
use nalgebra::{DVector, SVector, Vector3, Vector4};
use simulation::battery;
use simulation::conventional::ConventionalMixer;
use simulation::mixer::{Method, Mixer};
use simulation::plant::{Disturbance, Plant};
use simulation::state::State;
use simulation::vehicle::{self, BODY, GRAVITY_M_S2, INERTIA_KG_M2, ROTORS, WEIGHT_N};

fn nominal_plant() -> Plant<ROTORS> {
    Plant::new(
        &vehicle::airframe().unwrap(),
        BODY,
        battery::PAPER,
        SVector::zeros(),
    )
}

fn run(
    plant: &Plant<ROTORS>,
    mut state: State<ROTORS>,
    throttle: f64,
    step: f64,
    steps: usize,
) -> State<ROTORS> {
    let command = SVector::repeat(throttle);
    for _ in 0..steps {
        state = plant.step(&state, &command, &Disturbance::default(), step);
    }
    state
}

#[test]
fn without_rotors_it_falls() {
    let end = run(
        &nominal_plant(),
        State::level(Vector3::zeros(), 0.0),
        0.0,
        0.001,
        1000,
    );
    assert!(
        (end.velocity - Vector3::z() * GRAVITY_M_S2).norm() < 1e-10,
        "{end:?}"
    );
    assert!(
        (end.position - Vector3::z() * GRAVITY_M_S2 / 2.0).norm() < 1e-10,
        "{end:?}"
    );
    assert_eq!(end.rate, Vector3::zeros());
}

#[test]
fn thrust_equal_to_weight_hovers() {
    let plant = nominal_plant();
    let hover = |throttle| State::level(Vector3::zeros(), throttle);
    let lift = |throttle| -plant.rotor_wrench(&hover(throttle), &SVector::zeros()).0.z;
    let (mut low, mut high) = (0.1, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        (low, high) = if lift(middle) < WEIGHT_N {
            (middle, high)
        } else {
            (low, middle)
        };
    }
    let end = run(&plant, hover(low), low, 0.001, 200);
    // Within 0.2 s the battery loses half a millivolt: 60 ppm of the thrust, 0.1 mm/s.
    assert!(
        end.velocity.norm() < 2e-4 && end.position.norm() < 2e-5,
        "{end:?}"
    );
    // Four alternating units cancel each other's torque.
    assert!(end.rate.norm() < 1e-12, "{end:?}");
    // One per cent more throttle climbs.
    assert!(run(&plant, hover(low), 1.01 * low, 0.001, 200).velocity.z < -0.01);
}

#[test]
fn torque_free_rotation_conserves_angular_momentum_and_energy() {
    let mut state = State::level(Vector3::zeros(), 0.0);
    // About the middle axis, where the rotation tumbles.
    state.rate = Vector3::new(0.05, 6.0, 0.1);
    let momentum = |state: &State<ROTORS>| state.rotation() * INERTIA_KG_M2.component_mul(&state.rate);
    let energy = |state: &State<ROTORS>| 0.5 * INERTIA_KG_M2.component_mul(&state.rate).dot(&state.rate);
    let end = run(&nominal_plant(), state, 0.0, 0.001, 10_000);
    let turned = (end.rate - state.rate).norm();
    assert!(turned > 1.0, "it must tumble for this to mean anything: {turned}");
    let lost = (momentum(&end) - momentum(&state)).norm() / momentum(&state).norm();
    assert!(lost < 1e-9, "{lost:e}");
    let lost = (energy(&end) / energy(&state) - 1.0).abs();
    assert!(lost < 1e-9, "{lost:e}");
}

#[test]
fn one_millisecond_is_fine_enough() {
    // A rolling, yawing climb with unequal rotors, in steps of 1 ms and of 0.125 ms.
    let mismatch = SVector::from_fn(|k, _| 0.01 * (k as f64 - 3.0));
    let plant = Plant::new(&vehicle::airframe().unwrap(), BODY, battery::PAPER, mismatch);
    let start = State::level(Vector3::zeros(), 0.4);
    let (coarse, fine) = (
        run(&plant, start, 0.6, 0.001, 1000),
        run(&plant, start, 0.6, 0.000_125, 8000),
    );
    let moved = (fine.position - start.position).norm();
    let difference = (coarse.position - fine.position).norm() / moved;
    assert!(difference < 1e-8, "{difference:e}");
    assert!((coarse.attitude - fine.attitude).norm() < 1e-8);
}

#[test]
fn the_plant_gives_the_wrench_that_the_coaxial_mixer_was_asked_for() {
    let (airframe, plant) = (vehicle::airframe().unwrap(), nominal_plant());
    let mixer = Mixer::new(Method::Coaxial, &airframe).unwrap();
    for asked in [
        [0.0, 0.0, 0.0, 31.4],
        [0.5, -0.3, 0.2, 31.4],
        [-1.0, 0.5, -0.3, 40.0],
    ] {
        let mut state = State::level(Vector3::zeros(), 0.5);
        // The load sets the voltage, the voltage the throttles.
        for _ in 0..20 {
            let (throttle, saturated) = mixer.mix(&asked.into(), plant.voltage_v(&state)).unwrap();
            assert!(!saturated);
            state.throttle = throttle;
        }
        let (force, torque) = plant.rotor_wrench(&state, &SVector::zeros());
        // The file's tolerance per unit, times k_f < 1.25: 0.0125 N on four units, 1.25e-4 N m
        // likewise.
        for (axis, arm) in [(0, 0.3182), (1, 0.3182)] {
            assert!(
                (torque[axis] - asked[axis]).abs() < 4.0 * 0.0125 * arm,
                "{torque} {asked:?}"
            );
        }
        assert!((torque.z - asked[2]).abs() < 4.0 * 1.25e-4, "{torque} {asked:?}");
        assert!((-force.z - asked[3]).abs() < 4.0 * 0.0125, "{force} {asked:?}");
    }
}

/// `python3 tests/oracle.py conventional airframes/isae-x8.toml`: asked at volts, given.
const ORACLE: [([f64; 4], f64, [f64; 4]); 6] = [
    ([0.0, 0.0, 0.0, 31.4], 14.8, [0.0, 0.0, 0.0, 26.4256]),
    ([0.0, 0.0, 0.3, 31.4], 14.8, [0.0, 0.0, 0.3059, 26.7924]),
    ([0.5, 0.0, 0.0, 31.4], 14.8, [0.4212, 0.0, 0.0, 26.4237]),
    ([1.0, -0.5, 0.2, 40.0], 14.8, [0.8266, -0.4097, 0.2023, 33.7473]),
    ([-0.4, 0.7, -0.25, 35.0], 15.6, [-0.3381, 0.5888, -0.2554, 29.672]),
    ([0.2, 0.1, 0.1, 30.0], 13.1, [0.1669, 0.0838, 0.1016, 25.2748]),
];

#[test]
fn the_conventional_mixer_agrees_with_the_oracle() {
    let airframe = vehicle::airframe().unwrap();
    let effectiveness = Effectiveness::new(&airframe).unwrap();
    let mixer = ConventionalMixer::new(&airframe, &effectiveness).unwrap();
    let map = PairMap::new(&airframe.pair, &airframe.throttle);
    let voltage = airframe.voltage.as_ref().unwrap();
    for (asked, volts, given) in ORACLE {
        let (throttle, limited) = mixer.mix(&Vector4::from(asked), volts).unwrap();
        assert!(!limited);
        let efforts: Vec<[f64; 2]> = airframe
            .units
            .iter()
            .map(|unit| map.efforts([throttle[unit.upper_channel], throttle[unit.lower_channel]]))
            .collect();
        let thrusts = efforts.iter().map(|e| voltage.thrust_factor(volts) * e[0]);
        let torques = efforts.iter().map(|e| voltage.torque_factor(volts) * e[1]);
        let efforts = DVector::from_vec(thrusts.chain(torques).collect());
        let wrench = &effectiveness.matrix * efforts;
        let difference = (wrench - Vector4::from(given)).amax();
        assert!(difference < 1e-4, "{asked:?} {difference:e}");
    }
}

#[test]
fn the_conventional_mixer_limits_and_says_so() {
    let airframe = vehicle::airframe().unwrap();
    let Mixer::Conventional(mixer) = Mixer::new(Method::Conventional, &airframe).unwrap() else {
        unreachable!("asked for the conventional mixer")
    };
    for thrust in [-10.0, 0.0, 500.0] {
        let (throttle, limited) = mixer.mix(&Vector4::new(0.0, 0.0, 0.0, thrust), 14.8).unwrap();
        assert!(
            limited && throttle.iter().all(|d| (0.1..=1.0).contains(d)),
            "{throttle}"
        );
    }
}
