//! The closed loop: deterministic, stable for every seed, and with the differences that the mixers
//! make.
//!
//! One test per scenario, because flying is what takes the time here.

use nalgebra::Vector4;
use simulation::air::{Air, Room};
use simulation::controller::{PERIOD_S, Tilt};
use simulation::flight::{ClosedLoop, Flight, FlightPair, Scenario, fly, periods};
use simulation::manoeuvre::{END_S, SETTLING_S, reference};
use simulation::mixer::{Method, Mixer};
use simulation::tracking::{Spread, ratio};
use simulation::vehicle;

/// The seeds that the program flies unless told otherwise.
const SEEDS: std::ops::RangeInclusive<u64> = 1..=10;

const MSE: usize = 0;
const MAE: usize = 1;

fn fly_seeds(scenario: Scenario) -> Vec<FlightPair> {
    let airframe = vehicle::airframe().unwrap();
    SEEDS.map(|seed| scenario.fly(&airframe, seed).unwrap()).collect()
}

/// Stays about x = y = 0, follows z and yaw, and ends on the spot, never out of the mixer's reach.
fn assert_stable(flight: &Flight) {
    assert_eq!(flight.samples.len(), 20_000);
    assert_eq!(flight.saturated(), 0);
    let mut previous = f64::NEG_INFINITY;
    for sample in &flight.samples {
        assert!(sample.time_s > previous);
        previous = sample.time_s;
        let error = sample.reference.position - sample.position;
        // Negated so that NaN fails.
        assert!(
            !(error.xy().norm().is_nan() || error.xy().norm() > 0.3),
            "{sample:?}"
        );
        // The steps in z are 0.5 m; their overshoot stays below half of it.
        assert!((-1.75..-0.75).contains(&sample.position.z), "{sample:?}");
        if sample.time_s > END_S - 5.0 {
            assert!(error.z.abs() < 0.1, "{sample:?}");
            assert!(sample.yaw.abs() < 0.02, "{sample:?}");
        }
        assert!((12.8..16.8).contains(&sample.voltage_v), "{sample:?}");
    }
}

/// What holds in every scenario.
fn assert_common(flights: &[FlightPair]) {
    for pair in flights {
        assert_stable(&pair.coaxial);
        assert_stable(&pair.conventional);
        // Eight rotors, each 1 % off in speed and hence some 2 % in thrust: 0.7 % of deviation,
        // three times.
        let coaxial = pair.coaxial.hover_thrust();
        assert!((coaxial - 1.0).abs() < 0.021, "seed {}: {coaxial}", pair.seed);
        let conventional = pair.conventional.hover_thrust();
        assert!(
            (1.15..1.23).contains(&conventional),
            "seed {}: {conventional}",
            pair.seed
        );
        // "No significant yaw tracking amelioration was noticed" (section V-B).
        let yaw = pair.coaxial.yaw_error() / pair.conventional.yaw_error();
        assert!((yaw - 1.0).abs() < 0.01, "seed {}: {yaw}", pair.seed);
        // The conventional mixer is never better in z, with any seed.
        let errors = [&pair.coaxial, &pair.conventional].map(Flight::tracking_error);
        assert!(
            errors[0].mse.z < errors[1].mse.z,
            "seed {}: {errors:?}",
            pair.seed
        );
    }
    let hover = Spread::of(flights.iter().map(|pair| pair.coaxial.hover_thrust()));
    assert!((hover.mean - 1.0).abs() < 0.01, "{hover:?}");
}

#[test]
fn in_still_air_the_conventional_mixer_couples_more() {
    let flights = fly_seeds(Scenario {
        air: Air::Still,
        tilt: Tilt::Decoupled,
    });
    assert_common(&flights);
    // Mismatch decides how much; on average over the seeds every axis is calmer with the coaxial
    // mixer.
    for axis in 0..3 {
        let ratio = ratio(&flights, MAE, axis);
        assert!(ratio.mean < 0.9, "axis {axis}: {ratio:?}");
    }
}

#[test]
fn with_decoupled_tilt_unsteady_air_tells_the_mixers_apart_in_z_alone() {
    let flights = fly_seeds(Scenario {
        air: Air::Unsteady,
        tilt: Tilt::Decoupled,
    });
    assert_common(&flights);
    for axis in 0..2 {
        let ratio = ratio(&flights, MSE, axis);
        assert!((ratio.mean - 1.0).abs() < 0.03, "axis {axis}: {ratio:?}");
    }
    // A loop of 1 / 1.19 of the gain lets slow disturbances through 1.19 times, 1 / 0.71 when
    // squared; less damping near the crossover does the rest.
    let z = ratio(&flights, MSE, 2);
    assert!((0.55..0.75).contains(&z.mean) && z.deviation < 0.05, "{z:?}");
}

#[test]
fn with_coupled_tilt_the_thrust_error_weakens_x_and_y_too() {
    let flights = fly_seeds(Scenario {
        air: Air::Unsteady,
        tilt: Tilt::Coupled,
    });
    assert_common(&flights);
    for axis in 0..3 {
        let ratio = ratio(&flights, MSE, axis);
        assert!((0.55..0.75).contains(&ratio.mean), "axis {axis}: {ratio:?}");
    }
}

#[test]
fn with_equal_rotors_the_coaxial_mixer_hovers_on_the_weight() {
    let airframe = vehicle::airframe().unwrap();
    let hover = |method| {
        let mixer = Mixer::new(method, &airframe).unwrap();
        let mut room = Room::new(Air::Still, 0);
        room.mismatch.fill(0.0);
        let flight = fly(&airframe, &mixer, Tilt::Decoupled, room).unwrap();
        assert_stable(&flight);
        flight.hover_thrust()
    };
    // The battery has 16 V, the bench had 14.8: the motors follow the voltage more steeply in hover than the law of the file.
    let coaxial = hover(Method::Coaxial);
    assert!((0.99..0.998).contains(&coaxial), "{coaxial}");
    // 31.4 N asked, 26.43 N given by `tests/oracle.py conventional`: a command of 1.19 weights.
    let conventional = hover(Method::Conventional);
    assert!(
        (conventional / coaxial - 31.4 / 26.4256).abs() < 0.01,
        "{conventional}"
    );
}

#[test]
fn equal_seeds_give_equal_flights_and_others_do_not() {
    let airframe = vehicle::airframe().unwrap();
    let scenario = Scenario {
        air: Air::Unsteady,
        tilt: Tilt::Decoupled,
    };
    let [first, again, other] = [1, 1, 2].map(|seed| scenario.fly(&airframe, seed).unwrap());
    assert!(first == again);
    assert!(first.coaxial != other.coaxial && first.conventional != other.conventional);
    assert!(first.coaxial != first.conventional);
}

#[test]
fn a_known_hover_thrust_makes_up_for_nearly_all_of_the_difference_in_z() {
    let airframe = vehicle::airframe().unwrap();
    let conventional = Mixer::new(Method::Conventional, &airframe).unwrap();
    let scenario = Scenario {
        air: Air::Unsteady,
        tilt: Tilt::Decoupled,
    };
    for seed in 1..=3 {
        let mut flown = ClosedLoop::new(&airframe, scenario.tilt, Room::new(scenario.air, seed));
        let mut fly = |number: i32| {
            let reference = reference(f64::from(number) * PERIOD_S);
            let known = |wrench: &Vector4<f64>, volts: f64| {
                let factor = Vector4::new(1.0, 1.0, 1.0, 31.4 / 26.4256);
                conventional.mix(&wrench.component_mul(&factor), volts)
            };
            flown.period(number, &reference, known).unwrap()
        };
        for number in -periods(SETTLING_S)..0 {
            fly(number);
        }
        let calibrated = Flight {
            samples: (0..periods(END_S)).map(fly).collect(),
        };
        let pair = scenario.fly(&airframe, seed).unwrap();
        let mse = |flight: &Flight| flight.tracking_error().mse.z;
        let coaxial = mse(&pair.coaxial);
        let ratios = [&calibrated, &pair.conventional].map(|flight| coaxial / mse(flight));
        assert!(
            (ratios[0] - 1.0).abs() < 0.1 && ratios[1] < 0.75,
            "seed {seed}: {ratios:?}"
        );
    }
}
