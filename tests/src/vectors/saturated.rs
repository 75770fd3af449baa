//! Setpoints beyond what is attainable, at its border, and inside it where only the null space helps.

use mixer_compiler::Compiled;
use mixer_rt::{Axis, Health, Wrench};

use super::voltages;
use crate::physics::Physics;
use mixer_setpoints::Random;

/// Directions in which the corners of the attainable set are looked for.
const DIRECTIONS: usize = 12;

/// A corner's wrench and these shares of the size more of its direction: inside, next to the border, outside. Not on the
/// border itself, since a mixer may leave out as little as 0.2 % of the attainable set.
const STEPS: [f64; 3] = [-0.02, -0.004, 0.02];

/// Wrenches that need the null space.
const NULL_SPACE: usize = 24;

/// Random throttles among which those are looked for.
const TRIES: usize = 2000;

/// Torques and thrusts next to none, normal and subnormal.
const FAINT: [f64; 6] = [1e-3, 1e-6, 1e-20, 1e-38, 1e-40, 1e-45];

/// What the setpoints of one airframe are made from.
pub(super) struct Saturated {
    physics: Physics,
    /// The largest `[roll, pitch, yaw, thrust]`, N m and N.
    size: [f64; 4],
    served: [bool; 4],
    /// Reference voltage and ends of the range.
    volts: [f32; 3],
}

impl Saturated {
    pub(super) fn new(compiled: &Compiled) -> Self {
        let physics = Physics::new(compiled);
        Saturated {
            size: physics.authority(),
            physics,
            served: Axis::ALL.map(|axis| compiled.airframe.allocation.controls(axis)),
            volts: voltages(compiled),
        }
    }

    /// A list of setpoints in shares of the size, at the three voltages in turn.
    fn list(&self, shares: impl IntoIterator<Item = [f64; 4]>) -> Vec<(Wrench, f32)> {
        let volts = self.volts.into_iter().cycle();
        let sized = |shares: [f64; 4]| std::array::from_fn(|axis| (shares[axis] * self.size[axis]) as f32);
        shares
            .into_iter()
            .zip(volts)
            .map(|(shares, volts)| (Wrench::from_array(sized(shares)), volts))
            .collect()
    }

    pub(super) fn alone(&self) -> Vec<(Wrench, f32)> {
        let mut shares = Vec::new();
        for times in [1.5, 20.0, 1e6] {
            for axis in (0..3).filter(|&axis| self.served[axis]) {
                for sign in [1.0, -1.0] {
                    let mut share = [0.0, 0.0, 0.0, 0.4];
                    share[axis] = sign * times;
                    shares.push(share);
                }
            }
            shares.push([0.02, -0.02, 0.02, times]);
            shares.push([-0.02, 0.02, 0.02, -times]);
        }
        self.list(shares)
    }

    pub(super) fn together(&self) -> Vec<(Wrench, f32)> {
        let mut shares = Vec::new();
        for (thrust, times) in [(0.05, 0.6), (0.4, 2.0), (0.4, 20.0), (0.9, 1.0), (1.3, 0.1)] {
            for signs in 0..8 {
                let torque = |axis: usize| if signs >> axis & 1 == 0 { times } else { -times };
                shares.push([torque(0), 0.7 * torque(1), 0.8 * torque(2), thrust]);
            }
        }
        self.list(shares)
    }

    pub(super) fn faint(&self) -> Vec<(Wrench, f32)> {
        let mut shares = Vec::new();
        for thrust in [0.0, -0.0, -0.01, -0.5] {
            shares.push([0.0, 0.0, 0.0, thrust]);
            shares.push([0.1, -0.05, 0.1, thrust]);
            shares.push([0.0, 0.0, -0.5, thrust]);
        }
        for (k, faint) in FAINT.into_iter().enumerate() {
            shares.push([0.0, 0.05, -0.05, faint]);
            shares.push([faint, -faint, faint, 0.4]);
            let mut share = [0.0, 0.0, 0.0, 0.4];
            share[k % 3] = -faint;
            shares.push(share);
        }
        self.list(shares)
    }

    pub(super) fn edge(&self) -> Vec<(Wrench, f32)> {
        let mut random = Random::new(11);
        let [_, low, high] = self.volts;
        let mut list = Vec::new();
        for k in 0..DIRECTIONS {
            let volts = if k % 2 == 0 { low } else { high };
            let direction: [f64; 4] = std::array::from_fn(|axis| {
                let part = random.uniform(-1.0, 1.0);
                if self.served[axis] { part } else { 0.0 }
            });
            let corner = self.physics.furthest(direction, self.physics.factors(volts));
            for step in STEPS {
                let wrench = |axis: usize| corner[axis] + step * direction[axis] * self.size[axis];
                list.push((
                    Wrench::from_array(std::array::from_fn(|axis| wrench(axis) as f32)),
                    volts,
                ));
            }
        }
        list
    }

    pub(super) fn null_space(&self) -> Vec<(Wrench, f32)> {
        let mut random = Random::new(12);
        let [_, low, high] = self.volts;
        let rotors = 2 * self.physics.units();
        let wrenches = (0..TRIES).filter_map(|_| {
            let volts = random.uniform(f64::from(low), f64::from(high)) as f32;
            // Many near the ends of the range, where least norm is in need of help; none at the very end.
            let share = |random: &mut Random| match random.below(3) {
                0 => random.uniform(0.02, 0.1),
                1 => random.uniform(0.9, 0.98),
                _ => random.uniform(0.02, 0.98),
            };
            let shares: Vec<f64> = (0..rotors).map(|_| share(&mut random)).collect();
            let throttles = self.physics.throttles(shares.into_iter(), Health::GOOD);
            let wrench = self.physics.wrench(&throttles, volts);
            let factors = self.physics.factors(volts);
            let helped = !self.physics.least_norm_attains(wrench, factors);
            helped.then(|| (Wrench::from_array(wrench.map(|x| x as f32)), volts))
        });
        wrenches.take(NULL_SPACE).collect()
    }
}
