//! Other allocators, for comparison: what flight stacks do with a coaxial frame today.
//!
//! Both take the rotors of a unit for isolated ones, each with the thrust curve f(d, 0) of the upper rotor and a
//! torque of kappa times its thrust. They command a thrust per rotor; a throttle follows from f(d, 0) = F.

use mixer_compiler::Compiled;
use mixer_compiler::model::PairMap;
use nalgebra::{DMatrix, DVector};

/// A frame of isolated rotors: twice as many as units, the upper ones first.
pub struct Isolated {
    pair: PairMap,
    /// 2n x 4.
    allocation: DMatrix<f64>,
    /// Least and largest thrust of a rotor, N at the reference voltage.
    range: [f64; 2],
}

impl Isolated {
    /// The isolated rotors of a compiled frame at its reference voltage.
    pub fn new(compiled: &Compiled) -> Self {
        let pair = PairMap::new(&compiled.airframe.pair, &compiled.airframe.throttle);
        let n = compiled.airframe.units.len();
        let matrix = &compiled.effectiveness.matrix;
        let [low, high] = pair.range();
        let [f, q] = pair.efforts([0.5 * (low + high), 0.0]);
        let kappa = q / f;
        let effectiveness = DMatrix::from_fn(4, 2 * n, |axis, rotor| {
            let spin = if rotor < n { kappa } else { -kappa };
            matrix[(axis, rotor % n)] + spin * matrix[(axis, n + rotor % n)]
        });
        let allocation = effectiveness
            .clone()
            .pseudo_inverse(1e-9)
            .unwrap_or_else(|_| DMatrix::zeros(2 * n, 4));
        let range = [pair.efforts([low, 0.0])[0], pair.efforts([high, 0.0])[0]];
        Isolated {
            pair,

            allocation,
            range,
        }
    }

    /// The paper's conventional mixer: the pseudo-inverse, every rotor clipped.
    pub fn conventional(&self, request: [f64; 4]) -> DVector<f64> {
        &self.allocation * DVector::from_column_slice(&request)
    }

    /// Sequential desaturation after PX4, airmode disabled (DESIGN section 7).
    pub fn sequential(&self, request: [f64; 4]) -> DVector<f64> {
        let [roll, pitch, yaw, thrust] = request;
        let mut rotors = self.conventional([roll, pitch, 0.0, thrust]);
        let axis = |axis: usize| {
            let column: DVector<f64> = self.allocation.column(axis).into();
            let largest = column.amax();
            column / largest
        };
        let [low, high] = self.range;
        self.slide(&mut rotors, &axis(3), [low, high], true);
        self.slide(&mut rotors, &axis(0), [low, high], false);
        self.slide(&mut rotors, &axis(1), [low, high], false);
        rotors += self.conventional([0.0, 0.0, yaw, 0.0]);
        // PX4 lets yaw have 15 % more than there is, then takes it back from yaw and from thrust.
        self.slide(&mut rotors, &axis(2), [low, high + 0.15 * (high - low)], false);
        self.slide(&mut rotors, &axis(3), [low, high], true);
        rotors
    }

    fn slide(&self, rotors: &mut DVector<f64>, direction: &DVector<f64>, range: [f64; 2], only_down: bool) {
        let gain = |rotors: &DVector<f64>| {
            let (mut least, mut largest) = (0.0f64, 0.0f64);
            for (u, d) in rotors.iter().zip(direction.iter()) {
                if d.abs() < 0.2 {
                    continue;
                }
                let bound = if *u < range[0] {
                    range[0]
                } else if *u > range[1] {
                    range[1]
                } else {
                    continue;
                };
                let k = (bound - u) / d;
                least = least.min(k);
                largest = largest.max(k);
            }
            least + largest
        };
        let first = gain(rotors);
        if only_down && first > 0.0 {
            return;
        }
        *rotors += first * direction;
        let second = 0.5 * gain(rotors);
        *rotors += second * direction;
    }

    /// The wrench that these rotor thrusts give in truth, by the coaxial model at the reference voltage.
    pub fn achieved(&self, compiled: &Compiled, rotors: &DVector<f64>) -> [f64; 4] {
        let n = compiled.airframe.units.len();
        let matrix = &compiled.effectiveness.matrix;
        let mut wrench = [0.0; 4];
        for i in 0..n {
            let [f, q] = self
                .pair
                .efforts([self.throttle(rotors[i]), self.throttle(rotors[n + i])]);
            for (axis, wrench) in wrench.iter_mut().enumerate() {
                *wrench += matrix[(axis, i)] * f + matrix[(axis, n + i)] * q;
            }
        }
        wrench
    }

    /// The throttle at which an isolated rotor has this thrust.
    fn throttle(&self, thrust: f64) -> f64 {
        let [mut low, mut high] = self.pair.range();
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if self.pair.efforts([middle, 0.0])[0] < thrust {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }
}
