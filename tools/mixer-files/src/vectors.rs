//! The setpoints and conditions of an airframe's golden vectors and of its C self-test: always the
//! same for one airframe, all finite.
//!
//! They depend on the airframe and not on the mixer, so that a mixer that changes is asked the same
//! as before.

use mixer_rt::{Conditions, Health, Wrench};

use mixer_compiler::Compiled;
use mixer_compiler::airframe::{Axis, Correction};
use mixer_compiler::model::{PairMap, scales};

/// A setpoint and the conditions it is asked under. The density is 0 without `[air]`.
pub type Vector = (Wrench, Conditions);

/// The kind of a golden vector. The table holds the kinds in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum VectorKind {
    /// Zero, thrusts to beyond the ceiling at voltages and densities to beyond their ranges, each axis
    /// alone.
    ByHand,
    /// Wrenches of throttles within the range: anywhere, near its ends (where least-norm efforts
    /// often do not suffice), and about one throttle for all, as in hover.
    Attainable,
    /// Corners of the attainable set at the ends of the ranges of voltage and density, and a little
    /// inside and outside.
    Border,
    /// One axis or several far beyond what there is.
    Saturated,
    /// Torques with no thrust, with less than none and with next to none; torques next to none.
    Faint,
}

/// Wrenches of random throttles.
const ATTAINABLE: usize = 120;

/// Those throttles keep this share of the range from its ends: a mixer may leave out as little as
/// 0.2 % of the attainable set.
const MARGIN: f64 = 0.02;

/// Directions in which corners of the attainable set are taken.
const DIRECTIONS: usize = 36;

/// A corner's wrench and these shares of the size more of its direction. None on the border itself,
/// for the same reason.
const STEPS: [f64; 3] = [-0.02, -0.004, 0.02];

/// Points of the throttle box's border among which a unit's best is taken.
const BORDER_POINTS: usize = 64;

/// Random wrenches of up to three times what there is.
const BEYOND: usize = 60;

/// Torques and thrusts next to none, normal and subnormal.
const FAINT: [f64; 6] = [1e-3, 1e-6, 1e-20, 1e-38, 1e-40, 1e-45];

/// Setpoints for every rotor that is out, and for every two.
const ROTORS_OUT: [usize; 2] = [12, 6];

/// Setpoints with all rotors, kind by kind.
pub fn by_kind(compiled: &Compiled) -> Vec<(VectorKind, Vec<Vector>)> {
    let mut draw = Draw::new(compiled);
    let by_hand = draw.by_hand();
    let attainable = (0..ATTAINABLE).map(|index| draw.attainable(index)).collect();
    let border = (0..DIRECTIONS).flat_map(|_| draw.corner()).collect();
    vec![
        (VectorKind::ByHand, by_hand),
        (VectorKind::Attainable, attainable),
        (VectorKind::Border, border),
        (VectorKind::Saturated, draw.saturated()),
        (VectorKind::Faint, draw.faint()),
    ]
}

/// [`by_kind`] in one list.
pub fn healthy(compiled: &Compiled) -> Vec<Vector> {
    by_kind(compiled).into_iter().flat_map(|(_, list)| list).collect()
}

/// For every output its rotor out, then with it that of an output half of them further on and one more (with upper and
/// lower rotors apart the lower one of the next unit), a choice of the setpoints each: another one for every rotor.
pub fn rotors_out(compiled: &Compiled, vectors: &[Vector]) -> Vec<(Health, Vector)> {
    let rotors = compiled.airframe.rotors();
    let failed = |channel: usize| u8::try_from(channel % rotors).unwrap_or(u8::MAX);
    let mut list = Vec::new();
    for (out, count) in ROTORS_OUT.into_iter().enumerate() {
        for channel in 0..rotors {
            let mut health = Health::GOOD.with_failed(failed(channel));
            if out > 0 {
                health = health.with_failed(failed(channel + rotors / 2 + 1));
            }
            let index = |k: usize| (k * rotors + channel) * vectors.len() / (count * rotors);
            list.extend((0..count).filter_map(|k| Some((health, *vectors.get(index(k))?))));
        }
    }
    list
}

fn conditions(volts: f64, density: f64) -> Conditions {
    Conditions::at_voltage(volts as f32).in_air(density as f32)
}

/// Random setpoints of one airframe.
struct Draw<'a> {
    compiled: &'a Compiled,
    /// Efforts `[f, Q]` along the border of the throttle box.
    borders: Vec<Vec<[f64; 2]>>,
    /// Largest wrench on each axis: all units at their best, whatever the others lose.
    size: [f64; 4],
    /// Lowest, reference and highest voltage, V; any where the airframe ignores it.
    volts: [f64; 3],
    /// The same of the density, kg/m3; 0 where the airframe ignores it.
    densities: [f64; 3],
    state: u64,
}

impl<'a> Draw<'a> {
    fn new(compiled: &'a Compiled) -> Self {
        let airframe = &compiled.airframe;
        let scales = scales(airframe, [1.0; 2]);
        let largest = |axis| compiled.effectiveness.largest(axis as usize, &scales);
        let size = Axis::ALL.map(largest);
        let values = |correction: &Correction| {
            let [low, high] = correction.range;
            [low, correction.reference, high]
        };
        let border = |map: &PairMap| {
            let border = map.border(BORDER_POINTS).into_iter();
            border.map(|throttles| map.efforts(throttles)).collect()
        };
        Draw {
            compiled,
            borders: compiled.maps.iter().map(border).collect(),
            size,
            volts: airframe.voltage.as_ref().map_or([12.0, 14.0, 16.0], values),
            densities: airframe.air.as_ref().map_or([0.0; 3], values),
            state: 0x9e37_79b9_7f4a_7c15,
        }
    }

    /// A number in [0, 1): xorshift64*, of which the upper 32 bits are used.
    fn share(&mut self) -> f64 {
        self.state ^= self.state >> 12;
        self.state ^= self.state << 25;
        self.state ^= self.state >> 27;
        let bits = self.state.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 32;
        bits as f64 / 4_294_967_296.0
    }

    /// [`Self::share`] between two ends.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    /// A density of the range.
    fn density(&mut self) -> f64 {
        let [low, _, high] = self.densities;
        if low < high { self.between(low, high) } else { low }
    }

    /// One end of the density's range.
    fn end_of_density(&mut self) -> f64 {
        let [low, _, high] = self.densities;
        if low < high && self.share() < 0.5 {
            low
        } else {
            high
        }
    }

    /// Correction `[k_f, k_Q]` at a voltage and a density of the ranges.
    fn factors(&self, volts: f64, density: f64) -> [f64; 2] {
        self.compiled.airframe.factors(volts, density)
    }

    /// A wrench in shares of the size.
    fn sized(&self, shares: [f64; 4]) -> Wrench {
        Wrench::from_array(std::array::from_fn(|k| (shares[k] * self.size[k]) as f32))
    }

    /// Wrenches in shares of the size, at the three voltages in turn, each at the three densities in
    /// turn.
    fn list(&self, shares: impl IntoIterator<Item = [f64; 4]>) -> Vec<Vector> {
        let all = self.densities.into_iter();
        let all = all.flat_map(|density| self.volts.map(|volts| conditions(volts, density)));
        let vectors = shares.into_iter().zip(all.cycle());
        vectors
            .map(|(shares, conditions)| (self.sized(shares), conditions))
            .collect()
    }

    /// The wrench (N m, N) of the units' efforts `[f, Q]` at the reference voltage, under the
    /// correction `factors`.
    fn wrench(&self, efforts: impl ExactSizeIterator<Item = [f64; 2]>, factors: [f64; 2]) -> [f64; 4] {
        let matrix = &self.compiled.effectiveness.matrix;
        let n = efforts.len();
        let mut wrench = [0.0; 4];
        for (i, [f, q]) in efforts.enumerate() {
            for (axis, sum) in wrench.iter_mut().enumerate() {
                *sum += matrix[(axis, i)] * factors[0] * f + matrix[(axis, n + i)] * factors[1] * q;
            }
        }
        wrench
    }

    fn by_hand(&self) -> Vec<Vector> {
        let [low, reference, high] = self.volts;
        let [thinnest, of_bench, densest] = self.densities;
        let mut list = vec![(Wrench::default(), conditions(reference, of_bench))];
        for thrust in [0.02, 0.3, 0.6, 0.95, 1.2] {
            for volts in [low - 1.0, low, reference, high, high + 1.0] {
                list.push((self.sized([0.0, 0.0, 0.0, thrust]), conditions(volts, of_bench)));
            }
            // Zero is an unknown density.
            let densities = [0.0, 0.9 * thinnest, thinnest, densest, 1.1 * densest];
            for density in densities.into_iter().filter(|_| thinnest < densest) {
                let shares = [0.02, -0.02, 0.02, thrust];
                list.push((self.sized(shares), conditions(reference, density)));
            }
            for axis in 0..3 {
                for torque in [-20.0, -1.0, -0.1, 0.1, 1.0, 20.0] {
                    let mut shares = [0.0, 0.0, 0.0, thrust];
                    shares[axis] = torque;
                    list.push((self.sized(shares), conditions(reference, of_bench)));
                }
            }
        }
        list
    }

    fn attainable(&mut self, index: usize) -> Vector {
        let [low, high] = self.compiled.airframe.throttle.range();
        let [lowest_v, _, highest_v] = self.volts;
        let volts = self.between(lowest_v, highest_v);
        let density = self.density();
        let common = self.between(0.15, 0.85);
        let units = self.compiled.airframe.units.len();
        let mut throttle = || {
            let [from, to] = match index % 4 {
                0 => [MARGIN, 1.0 - MARGIN],
                1 => [common - 0.1, common + 0.1],
                _ if self.share() < 0.5 => [MARGIN, 0.1],
                _ => [0.9, 1.0 - MARGIN],
            };
            low + (high - low) * self.between(from, to)
        };
        let throttles: Vec<[f64; 2]> = (0..units).map(|_| [throttle(), throttle()]).collect();
        let throttles = throttles.into_iter().zip(&self.compiled.maps);
        let efforts = throttles.map(|(throttles, map)| map.efforts(throttles));
        let wrench = self.wrench(efforts, self.factors(volts, density));
        (
            Wrench::from_array(wrench.map(|x| x as f32)),
            conditions(volts, density),
        )
    }

    /// Every unit at the best point of its border in one direction, which is a corner of the
    /// attainable set.
    fn corner(&mut self) -> [Vector; 3] {
        let [low, _, high] = self.volts;
        let volts = if self.share() < 0.5 { low } else { high };
        let density = self.end_of_density();
        let factors = self.factors(volts, density);
        let direction = Axis::ALL.map(|axis| {
            let part = self.between(-1.0, 1.0);
            let is_served = self.compiled.airframe.allocation.controls(axis);
            if is_served { part } else { 0.0 }
        });
        let matrix = &self.compiled.effectiveness.matrix;
        let gain = |column: usize| -> f64 {
            let parts = direction.iter().zip(self.size).enumerate();
            parts
                .filter(|(_, (_, size))| *size > 0.0)
                .map(|(axis, (part, size))| part * matrix[(axis, column)] / size)
                .sum()
        };
        let units = self.compiled.airframe.units.len();
        let best = (0..units).map(|i| {
            let (by_f, by_q) = (factors[0] * gain(i), factors[1] * gain(units + i));
            let value = |[f, q]: &[f64; 2]| by_f * f + by_q * q;
            let border = &self.borders[i];
            let best = border.iter().max_by(|a, b| value(a).total_cmp(&value(b)));
            best.copied().unwrap_or_default()
        });
        let corner = self.wrench(best, factors);
        STEPS.map(|step| {
            let wrench = |axis: usize| corner[axis] + step * direction[axis] * self.size[axis];
            let wrench = std::array::from_fn(|axis| wrench(axis) as f32);
            (Wrench::from_array(wrench), conditions(volts, density))
        })
    }

    fn saturated(&mut self) -> Vec<Vector> {
        let mut shares = Vec::new();
        for (thrust, times) in [(0.05, 0.6), (0.4, 2.0), (0.4, 20.0), (0.9, 1.0), (1.3, 0.1)] {
            for signs in 0..8 {
                let torque = |axis: usize| if signs >> axis & 1 == 0 { times } else { -times };
                shares.push([torque(0), 0.7 * torque(1), 0.8 * torque(2), thrust]);
            }
        }
        shares.push([0.02, -0.02, 0.02, 1e6]);
        shares.push([-0.02, 0.02, 0.02, -1e6]);
        for _ in 0..BEYOND {
            let [roll, pitch, yaw] = [(); 3].map(|()| self.between(-3.0, 3.0));
            shares.push([roll, pitch, yaw, self.between(-0.2, 1.5)]);
        }
        self.list(shares)
    }

    fn faint(&self) -> Vec<Vector> {
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
}
