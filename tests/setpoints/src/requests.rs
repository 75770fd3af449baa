//! Requests to one airframe's mixer, drawn around what it can deliver.

use mixer_rt::tables::{AllocationMethod, Kinds, Law, Tables, ThrottleRange};

use mixer_rt::Conditions;

use crate::{Random, Setpoint};

/// Which requests to draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RequestKind {
    /// What random throttles give by the airframe's own forward map, so that every one can be
    /// delivered (to rounding). The voltage lies in its range.
    Attainable,
    /// Anything a controller may ask, most of it out of reach: up to four times the authority on
    /// all axes or on one alone, zeros, wrenches on and just beyond the border of the attainable
    /// ones, absurd numbers. All finite. One voltage in eight lies outside its range.
    Saturated,
}

/// Endless sequence of requests to the mixer of `tables`.
#[derive(Clone, Debug)]
pub struct Requests<'a, K, S> {
    random: Random,
    kind: RequestKind,
    tables: &'a Tables<'a, K, S>,
    throttle: ThrottleRange,
    voltage: Option<&'a Law<'a>>,
    air: Option<&'a Law<'a>>,
    /// The largest wrench on each axis at the reference voltage: all units at their best, whatever
    /// the others lose.
    authority: [f32; 4],
}

impl<'a, K: Kinds, S: AllocationMethod> Requests<'a, K, S> {
    /// The sequence of one seed.
    pub fn new(tables: &'a Tables<'a, K, S>, kind: RequestKind, seed: u64) -> Self {
        let ThrottleRange { min, max } = tables.throttle;
        let mut authority = [0.0; 4];
        for (index, unit) in tables.units.iter().enumerate() {
            let efforts = |throttles| tables.efforts_of(index, throttles);
            let [f, _] = efforts([max, max]);
            let [_, low] = efforts([max, min]);
            let [_, high] = efforts([min, max]);
            let q = if high > -low { high } else { -low };
            let [by_thrust, by_torque] = unit.effectiveness;
            for ((sum, by_f), by_q) in authority.iter_mut().zip(by_thrust).zip(by_torque) {
                *sum += by_f.abs() * f + by_q.abs() * q;
            }
        }
        Requests {
            random: Random::new(seed),
            kind,
            tables,
            throttle: tables.throttle,
            voltage: tables.voltage.as_ref(),
            air: tables.air.as_ref(),
            authority,
        }
    }

    /// The largest wrench on each axis at the reference voltage, whatever the others lose.
    pub fn authority(&self) -> [f32; 4] {
        self.authority
    }

    /// Voltage, by up to `outside` V beyond its range, and density, by up to a fifth of that in kg/m3; any where
    /// the airframe ignores them.
    fn conditions(&mut self, outside: f32) -> Conditions {
        let [low, high] = self.voltage.map_or([12.0, 16.0], |voltage| voltage.range);
        let voltage_v = self.random.between([low - outside, high + outside]);
        let density_kg_m3 = self.air.map_or(0.0, |air| {
            let ([low, high], outside) = (air.range, 0.2 * outside);
            self.random.between([low - outside, high + outside])
        });
        Conditions::at_voltage(voltage_v).in_air(density_kg_m3)
    }

    /// The wrench of throttles that `draw` gives for each rotor.
    fn wrench_of(
        &mut self,
        conditions: Conditions,
        mut draw: impl FnMut(&mut Random, ThrottleRange) -> f32,
    ) -> [f32; 4] {
        let [of_voltage, of_air] = [
            (self.voltage, conditions.voltage_v),
            (self.air, conditions.density_kg_m3.unwrap_or(0.0)),
        ]
        .map(|(law, x)| {
            law.map_or([1.0, 1.0], |law| {
                let [low, high] = law.range;
                law.factors(if x < low {
                    low
                } else if x > high {
                    high
                } else {
                    x
                })
            })
        });
        let factors = [of_voltage[0] * of_air[0], of_voltage[1] * of_air[1]];
        let mut wrench = [0.0; 4];
        for (index, unit) in self.tables.units.iter().enumerate() {
            let throttles = [
                draw(&mut self.random, self.throttle),
                draw(&mut self.random, self.throttle),
            ];
            let efforts = self.tables.efforts_of(index, throttles);
            for ((effect, effort), factor) in unit.effectiveness.iter().zip(efforts).zip(factors) {
                for (sum, effect) in wrench.iter_mut().zip(effect) {
                    *sum += effect * (factor * effort);
                }
            }
        }
        wrench
    }

    fn attainable(&mut self, conditions: Conditions) -> [f32; 4] {
        self.wrench_of(conditions, |random, range| random.between([range.min, range.max]))
    }

    /// Every rotor at idle, at the ceiling or, one in three, between.
    fn corner(&mut self, conditions: Conditions) -> [f32; 4] {
        self.wrench_of(conditions, |random, range| match random.index(3) {
            0 => range.min,
            1 => range.max,
            _ => random.between([range.min, range.max]),
        })
    }

    /// Uniform within `share` times the authority; thrust from a little below zero.
    fn within(&mut self, share: f32) -> [f32; 4] {
        let [roll, pitch, yaw, thrust] = self.authority;
        let mut torque = |size: f32| self.random.between([-share * size, share * size]);
        let [roll, pitch, yaw] = [torque(roll), torque(pitch), torque(yaw)];
        let thrust = self.random.between([-0.2 * thrust, (0.6 + 0.4 * share) * thrust]);
        [roll, pitch, yaw, thrust]
    }

    fn saturated(&mut self, conditions: Conditions) -> [f32; 4] {
        let choice = self.random.bits();
        let axis = (choice >> 32) as usize % 4;
        match choice % 10 {
            0 => self.within(0.3),
            1 => self.within(1.0),
            2 => self.within(4.0),
            // Each axis zero with even odds.
            3 => {
                let mut wrench = self.within(1.5);
                for (bit, value) in wrench.iter_mut().enumerate() {
                    if choice >> (16 + bit) & 1 == 0 {
                        *value = 0.0;
                    }
                }
                wrench
            }
            // One axis alone.
            4 => {
                let drawn = self.within(4.0);
                let mut wrench = [0.0; 4];
                wrench[axis] = drawn[axis];
                wrench
            }
            // A wrench that can be delivered, one of its axes stretched or replaced.
            5 => {
                let mut wrench = self.attainable(conditions);
                wrench[axis] *= self.random.between([-1.0, 4.0]);
                wrench
            }
            6 => {
                let mut wrench = self.attainable(conditions);
                wrench[axis] = self.within(1.2)[axis];
                wrench
            }
            // On the border, just within and just beyond it.
            7 => {
                let by = [1.0, 0.9999, 1.0001, 1.01, 1.2, 1.5][self.random.index(6) as usize];
                self.corner(conditions).map(|value| by * value)
            }
            // All axes of an attainable wrench stretched.
            8 => {
                let by = self.random.between([1.0, 3.0]);
                self.attainable(conditions).map(|value| by * value)
            }
            // Absurd: far beyond, on one axis or on all, or almost nothing.
            _ => {
                let by = [1e-38, 1e-6, 1e2, 1e6, 1e30][self.random.index(5) as usize];
                let mut wrench = self.within(1.0);
                if choice >> 16 & 1 == 0 {
                    wrench[axis] *= by;
                    wrench
                } else {
                    wrench.map(|value| by * value)
                }
            }
        }
    }
}

impl<K: Kinds, S: AllocationMethod> Iterator for Requests<'_, K, S> {
    type Item = Setpoint;

    fn next(&mut self) -> Option<Setpoint> {
        let (conditions, wrench) = match self.kind {
            RequestKind::Attainable => {
                let conditions = self.conditions(0.0);
                (conditions, self.attainable(conditions))
            }
            RequestKind::Saturated => {
                let outside = if self.random.index(8) == 0 { 2.0 } else { 0.0 };
                let conditions = self.conditions(outside);
                (conditions, self.saturated(conditions))
            }
        };
        Some(Setpoint {
            wrench,
            voltage_v: conditions.voltage_v,
            density_kg_m3: conditions.density_kg_m3.unwrap_or(0.0),
        })
    }
}
