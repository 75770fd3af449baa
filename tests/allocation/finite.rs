//! No number that is not finite arises on the way from a finite setpoint to the throttles.
//!
//! The last step limits throttles by comparing bits, which takes a NaN to one end of the range or
//! to the other by its sign, and the sign of a NaN depends on the processor. So the throttles'
//! range says nothing; what is watched here is what goes into the inverse map, and every operation
//! within it.

use std::cell::Cell;
use std::ops::{Add, Div, Mul, Sub};

use mixer_compiler::airframe::Method;
use mixer_compiler::evaluator::Evaluator;
use mixer_compiler::tables::{InverseTable, MixerTables};
use mixer_rt::{
    Health, Wrench,
    tables::{Inverse, Pair, Quantity, Scalar, Tables, ThrottleRange, UnitState},
};
use mixer_setpoints::Random;
use mixer_tests::frames::{self, AIRMODES, Options};

use crate::degenerate::{NUMBERS, degenerate_frames};

/// An `f32` that is finite.
#[derive(Clone, Copy)]
struct Finite(f32);

fn finite(x: f32) -> Finite {
    assert!(x.is_finite(), "{x}");
    Finite(x)
}

macro_rules! operation {
    ($operation:ident, $method:ident, $symbol:tt) => {
        impl $operation for Finite {
            type Output = Finite;
            fn $method(self, other: Finite) -> Finite {
                finite(self.0 $symbol other.0)
            }
        }
        operation!($operation<f32>, $method, $symbol);
    };
    ($operation:ident<f32>, $method:ident, $symbol:tt) => {
        impl $operation<f32> for Finite {
            type Output = Finite;
            fn $method(self, other: f32) -> Finite {
                finite(self.0 $symbol other)
            }
        }
    };
}

operation!(Add, add, +);
operation!(Sub, sub, -);
operation!(Mul, mul, *);
operation!(Div<f32>, div, /);

impl Scalar for Finite {
    fn constant(value: f32) -> Self {
        finite(value)
    }
    fn reciprocal(self) -> Self {
        finite(self.0.reciprocal())
    }
    fn root(self) -> Self {
        finite(self.0.root())
    }
    fn within(self, low: f32, high: f32) -> Self {
        finite(self.0.within(low, high))
    }
}

/// [`mixer_rt::tables::Seeded`]'s and [`mixer_rt::tables::PolynomialInverse`]'s operations on
/// numbers that have to be finite.
fn evaluate(tables: &MixerTables, efforts: [f32; 2]) -> [f32; 2] {
    let efforts = efforts.map(finite);
    let mut throttles = tables.inverse.guess(efforts).map(|x| tables.throttle.clamp(x));
    for _ in 0..tables.inverse.steps() {
        let (given, jacobian) = tables.pair.efforts_and_jacobian(throttles);
        let step = mixer_rt::tables::solve(jacobian, [efforts[0] - given[0], efforts[1] - given[1]]);
        throttles = [0, 1].map(|k| tables.throttle.clamp(throttles[k] + step[k]));
    }
    throttles.map(|x| x.0)
}

/// An evaluator that keeps the largest efforts it is asked for, and refuses those that are not
/// finite.
struct Watched<'a> {
    inverse: &'a InverseTable,
    largest: Cell<f32>,
}

impl<P: Quantity> Inverse<P> for &Watched<'_> {
    fn throttles(&self, pair: &Pair<P>, range: &ThrottleRange, efforts: [f32; 2]) -> [f32; 2] {
        for effort in efforts {
            assert!(effort.is_finite(), "{efforts:?}");
            self.largest.set(self.largest.get().max(effort.abs()));
        }
        self.inverse.throttles(pair, range, efforts)
    }
}

/// Mixes and returns the largest effort that went into the inverse map.
fn largest_effort(tables: &MixerTables, setpoint: [f32; 4], volts: f32, health: Health) -> f32 {
    let watched = Watched {
        inverse: &tables.inverse,
        largest: Cell::new(0.0),
    };
    let view = tables.view();
    let view = Tables {
        units: view.units,
        pair: view.pair,
        singles: view.singles,
        inverse: &watched,
        throttle: view.throttle,
        voltage: view.voltage,
        rows: view.rows,
        spread: view.spread,
        level_n: view.level_n,
        is_vertical: view.is_vertical,
        priorities: view.priorities,
        power_bias_nm_per_n: view.power_bias_nm_per_n,
        closed_form: view.closed_form,
        tolerance: view.tolerance,
    };
    let units = tables.units.len();
    let (mut states, mut throttle) = (vec![UnitState::default(); units], vec![0.0; 2 * units]);
    let [roll_nm, pitch_nm, yaw_nm, thrust_n] = setpoint;
    let wrench = Wrench {
        roll_nm,
        pitch_nm,
        yaw_nm,
        thrust_n,
    };
    let mixed = mixer_rt::tables::mix_into(&view, &wrench, volts, health, &mut states, &mut throttle);
    let (achieved, _) = mixed.expect("finite");
    assert!(
        achieved.to_array().iter().all(|x| x.is_finite()),
        "{wrench:?} -> {achieved:?}"
    );
    watched.largest.get()
}

/// An evaluator is asked for less than this in the test below.
const LARGEST: f32 = 1e8;

#[test]
fn efforts_are_finite() {
    let mut random = Random::new(11);
    for (name, places) in degenerate_frames() {
        let cases = [
            (0, 0.0, 0.0),
            (1, 0.02, 0.0),
            (2, 0.0, 0.0),
            (0, 0.0, 0.004),
            (2, 0.0, -0.004),
        ];
        for (mode, yaw_reserve_nm, power_bias_nm_per_n) in cases {
            let airmode = AIRMODES[mode];
            let options = Options {
                airmode,
                yaw_reserve_nm,
                power_bias_nm_per_n,
            };
            let compiled = frames::compile(&places, options).expect("a frame");
            for _ in 0..400 {
                let setpoint = std::array::from_fn(|_| NUMBERS[random.below(NUMBERS.len())]);
                let volts = NUMBERS[random.below(NUMBERS.len())];
                let health = match random.below(2) {
                    0 => Health::GOOD,
                    _ => Health::GOOD.with_failed(random.below(2 * places.len()) as u8),
                };
                let largest = largest_effort(&compiled.tables, setpoint, volts, health);
                assert!(largest < LARGEST, "{name} {airmode}: {setpoint:?} -> {largest}");
            }
        }
    }
}

#[test]
fn evaluators_are_finite_far_outside_the_attainable_set() {
    let file = mixer_tests::root().join("airframes/isae-x8.toml");
    let text = std::fs::read_to_string(file).expect("an airframe");
    let mut methods: Vec<&str> = Evaluator::candidates(&Method::Auto)
        .into_iter()
        .map(Evaluator::name)
        .collect();
    methods.push("polynomial");
    let numbers = [0.0, 1e-45, 1e-30, 1e-6, 0.1, 1.0, 12.0, 30.0, 1e3, 1e6, LARGEST];
    let numbers: Vec<f32> = numbers.into_iter().flat_map(|x| [x, -x]).collect();
    for method in methods {
        let mut airframe: toml::Table = text.parse().expect("TOML");
        let mut inverse = toml::Table::new();
        inverse.insert("method".into(), method.into());
        if method == "polynomial" {
            inverse.insert("degree".into(), 9.into());
        }
        inverse.insert("thrust_tolerance_n".into(), 2.0.into());
        inverse.insert("torque_tolerance_nm".into(), 0.02.into());
        airframe.insert("inverse".into(), inverse.into());
        let compiled =
            frames::compile_text(&airframe.to_string()).unwrap_or_else(|faults| panic!("{method}: {faults}"));
        let tables = &compiled.tables;
        for &f in &numbers {
            for &q in &numbers {
                let watched = evaluate(tables, [f, q]);
                let given = (&tables.inverse).throttles(&tables.pair, &tables.throttle, [f, q]);
                let bits = |throttles: [f32; 2]| throttles.map(f32::to_bits);
                assert_eq!(bits(watched), bits(given), "{method} at {f} {q}");
            }
        }
    }
}
