//! Steps of yaw under PX4's cascade of yaw and height, with `mix` and with `mix_dynamic` on one plant: what the rotors that are
//! on their way cost in height. Level, with the true state: of the stack only gains and filter.
#![allow(clippy::disallowed_methods, missing_docs)]

use std::f64::consts::{PI, TAU};

use mixer_compiler::airframe::Airframe;
use mixer_compiler::tables::AnyState;
use mixer_compiler::{Compiled, Source};
use mixer_rt::{Health, Wrench};
use nalgebra::{SVector, Vector3};
use simulation::battery::{self, Battery};
use simulation::plant::{Disturbance, Plant};
use simulation::vehicle::{Body, GRAVITY_M_S2};

const ROTORS: usize = 8;
/// Lag of the plant's rotors in hover, s.
const LAG_S: f64 = 0.074;
const HELD_S: f64 = 0.004;

/// Text of `examples/simulator/x8.toml` with more keys of `[vehicle]`.
fn text(vehicle: &str) -> Source {
    let file = format!("{}/../../examples/simulator/x8.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&file).unwrap();
    Source::new(
        file,
        text.replace("[vehicle]\n", &format!("[vehicle]\n{vehicle}\n")),
    )
}

fn compiled(vehicle: &str) -> Compiled {
    mixer_compiler::compile(&text(vehicle)).unwrap_or_else(|faults| panic!("{faults}"))
}

struct Flown {
    /// Largest error of height after the step, m.
    height_m: f64,
    /// Least and largest thrust over weight.
    thrust: [f64; 2],
    /// Overshoot of the yaw, share of the step.
    overshoot: f64,
    /// Change of the throttles, 1/s, rms.
    activity: f64,
}

/// Flies a step of yaw on a plant of `vehicle`'s keys.
fn fly(compiled: &Compiled, is_dynamic: bool, vehicle: &str, step_deg: f64) -> Flown {
    let airframe = Airframe::read(&text(vehicle)).unwrap();
    let body = Body {
        mass_kg: 6.5,
        inertia_kg_m2: Vector3::new(0.165, 0.165, 0.329),
        rotor_lag_s: LAG_S,
    };
    let volts = airframe.reference_v();
    let supply = Battery {
        full_v: volts,
        slope_v_per_ah: 0.0,
        resistance_ohm: 0.0,
        ..battery::PAPER
    };
    let plant = Plant::<ROTORS>::new(&airframe, body, supply, SVector::zeros());
    let mut state = plant.alike(plant.hover_throttle().unwrap());
    let mut rotors = AnyState::default();
    rotors.worth[..ROTORS].fill(plant.hover_throttle().unwrap() as f32);
    let yaw_nm = f64::from(compiled.scale().yaw_nm);
    let (mut integral, mut lift, mut torque) = (0.0f64, 0.0f64, 0.0f64);
    let mut last: Option<Vec<f32>> = None;
    let mut flown = Flown {
        height_m: 0.0,
        thrust: [f64::INFINITY, 0.0],
        overshoot: 0.0,
        activity: 0.0,
    };
    let (settling, periods) = (1500, 2250);
    let mut base_m = 0.0;
    for period in 0..periods {
        let target = if period >= settling {
            step_deg.to_radians()
        } else {
            0.0
        };
        // MC_YAW_P and MC_YAW_WEIGHT, MC_YAWRATE_P, _I and _MAX, MC_YAW_TQ_CUTOFF; MPC_Z_P, MPC_Z_VEL_P_ACC, _I_ACC.
        let error = (target - state.yaw() + PI).rem_euclid(TAU) - PI;
        let rate = (2.8 / 0.4 * 2.0 * (0.2 * error).sin()).clamp(-TAU, TAU) - state.rate.z;
        integral = (integral + 0.1 * rate * HELD_S).clamp(-0.3, 0.3);
        let share = 1.0 - (-TAU * 2.0 * HELD_S).exp();
        torque += share * ((0.2 * rate + integral).clamp(-1.0, 1.0) - torque);
        let sink = state.position.z + state.velocity.z;
        lift += 2.0 * sink * HELD_S;
        let thrust_n = body.mass_kg * (GRAVITY_M_S2 + 4.0 * sink + lift);
        let setpoint = Wrench {
            yaw_nm: (torque * yaw_nm) as f32,
            thrust_n: thrust_n as f32,
            ..Wrench::default()
        };
        let mixed = match is_dynamic {
            true => {
                compiled
                    .tables
                    .mix_dynamic(&mut rotors, &setpoint, volts as f32, Health::GOOD, HELD_S as f32)
            }
            false => compiled.tables.mix(&setpoint, volts as f32),
        };
        let (throttle, ..) = mixed.unwrap();
        let command = SVector::from_fn(|channel, _| f64::from(throttle[channel]));
        for _ in 0..4 {
            state = plant.step(&state, &command, &Disturbance::default(), 0.25 * HELD_S);
        }
        if period < settling {
            base_m = state.position.z;
            continue;
        }
        let thrust = -plant.rotor_wrench(&state, &SVector::zeros()).0.z / (body.mass_kg * GRAVITY_M_S2);
        flown.thrust = [flown.thrust[0].min(thrust), flown.thrust[1].max(thrust)];
        flown.height_m = flown.height_m.max((state.position.z - base_m).abs());
        flown.overshoot = flown.overshoot.max(-error / target);
        if let Some(last) = &last {
            let change = throttle
                .iter()
                .zip(last)
                .map(|(now, last)| f64::from(now - last).powi(2));
            flown.activity +=
                change.sum::<f64>() / (ROTORS as f64 * HELD_S * HELD_S * f64::from(periods - settling));
        }
        last = Some(throttle);
    }
    flown.activity = flown.activity.sqrt();
    flown
}

fn show(name: &str, step_deg: f64, of: &Flown) {
    println!(
        "{name:>28} {step_deg:>4}: height {:.4} m, thrust {:.3} to {:.3}, overshoot {:.1} %, activity {:.2}",
        of.height_m,
        of.thrust[0],
        of.thrust[1],
        100.0 * of.overshoot,
        of.activity
    );
}

#[test]
fn height_stays_in_steps_of_yaw() {
    let own = compiled(&format!("rotor_lag_s = {LAG_S}"));
    for step_deg in [90.0, 175.0] {
        let without = fly(&own, false, "", step_deg);
        show("mix", step_deg, &without);
        assert!(without.height_m > 0.02 && without.thrust[0] < 0.95);
        let with = fly(&own, true, "", step_deg);
        show("mix_dynamic", step_deg, &with);
        assert!(with.height_m < 0.003 && with.thrust[0] > 0.99 && with.thrust[1] < 1.01);
        assert!((with.overshoot - without.overshoot).abs() < 0.01 && with.activity < 1.03 * without.activity);
        for share in [0.5, 0.7, 1.3] {
            let wrong = fly(
                &compiled(&format!("rotor_lag_s = {}", share * LAG_S)),
                true,
                "",
                step_deg,
            );
            show(&format!("lag x {share}"), step_deg, &wrong);
            assert!(wrong.height_m < 0.75 * without.height_m);
        }
        let estimate = fly(&compiled(""), true, "", step_deg);
        show("estimate", step_deg, &estimate);
        assert!(estimate.height_m < without.height_m);
    }
}

#[test]
fn height_stays_without_brakes_where_the_mixer_knows() {
    const NO_BRAKES: &str = "rotor_brakes = false";
    let lag = format!("rotor_lag_s = {LAG_S}\n");
    let [braking, coasting] = [compiled(&lag), compiled(&(lag + NO_BRAKES))];
    for step_deg in [90.0, 175.0] {
        let without = fly(&braking, false, NO_BRAKES, step_deg);
        let misled = fly(&braking, true, NO_BRAKES, step_deg);
        let knows = fly(&coasting, true, NO_BRAKES, step_deg);
        show("mix, no brakes", step_deg, &without);
        show("mix_dynamic, does not know", step_deg, &misled);
        show("mix_dynamic, knows", step_deg, &knows);
        assert!(without.height_m > 0.06 && knows.height_m < 0.02);
    }
}
