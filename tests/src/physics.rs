//! What throttles give by the airframe file's own numbers, in f64: what mixers in f32 are judged
//! against.

use mixer_compiler::Compiled;
use mixer_compiler::airframe::{Airframe, Correction, Kind, RotorAlone, Spin};
use mixer_compiler::model::PairMap;
use mixer_rt::Health;
use nalgebra::{Matrix4xX, MatrixXx4, Vector3};

/// The output of a rotor that does not exist.
pub const NONE: usize = usize::MAX;

/// Newton steps that tell whether efforts are attainable.
const STEPS: usize = 40;

/// M of a layout. A unit at r with unit thrust axis a gives the force f a, which has the torque
/// r x f a about the centre of gravity, and the reaction -s Q a of its rotors.
fn effectiveness(airframe: &Airframe) -> Matrix4xX<f64> {
    let n = airframe.units.len();
    let mut matrix = Matrix4xX::zeros(2 * n);
    for (i, unit) in airframe.units.iter().enumerate() {
        let [position, axis] = [unit.position_m, unit.axis].map(Vector3::from);
        // The torque of a single rotor counts positive: it turns the frame clockwise where it spins the other way.
        let positive = match airframe.kind_of(unit) {
            Kind::Pair(pair) => pair.upper_spin,
            _ => Spin::Ccw,
        };
        let spin = if unit.upper_spin == positive { 1.0 } else { -1.0 };
        matrix.set_column(i, &position.cross(&axis).push(-axis.z));
        matrix.set_column(n + i, &(-spin * axis).push(0.0));
    }
    matrix
}

/// The forward physics of one frame.
pub struct Physics {
    /// Least and largest throttle.
    pub throttle: [f64; 2],
    /// Thrust and torque of each unit.
    pub pairs: Vec<PairMap>,
    /// M, 4 x 2n: all thrusts, then all torques.
    pub matrix: Matrix4xX<f64>,
    /// M+, 2n x 4.
    pseudo_inverse: MatrixXx4<f64>,
    /// Outputs of the upper and of the lower rotor, per unit; [`NONE`] of the lower rotor that a single one does not have.
    pub channels: Vec<[usize; 2]>,
    /// Of voltage and of density.
    corrections: [Option<Correction>; 2],
    /// What the upper and the lower rotor of each unit give alone, where the file says it.
    alone: Vec<[Option<RotorAlone>; 2]>,
}

impl Physics {
    /// The physics of a compiled frame.
    pub fn new(compiled: &Compiled) -> Self {
        let airframe = &compiled.airframe;
        let kinds = || airframe.units.iter().map(|unit| airframe.kind_of(unit));
        Physics {
            throttle: airframe.throttle.range(),
            pairs: kinds()
                .map(|kind| PairMap::of_kind(kind, &airframe.throttle))
                .collect(),
            matrix: effectiveness(airframe),
            pseudo_inverse: compiled.effectiveness.pseudo_inverse.clone(),
            channels: airframe
                .units
                .iter()
                .map(|unit| [unit.upper_channel, unit.lower_channel.unwrap_or(NONE)])
                .collect(),
            corrections: [airframe.voltage.clone(), airframe.air.clone()],
            alone: kinds()
                .map(|kind| match kind {
                    Kind::Pair(pair) => [pair.lower_out.clone(), pair.upper_out.clone()],
                    Kind::SingleRotor(rotor) => [Some(rotor.alone.clone()), None],
                })
                .collect(),
        }
    }

    /// Number of units.
    pub fn units(&self) -> usize {
        self.channels.len()
    }

    /// Number of rotors.
    pub fn rotors(&self) -> usize {
        let channels = self.channels.as_flattened().iter();
        channels.filter(|channel| **channel != NONE).count()
    }

    /// Thrust and torque of a unit that is a single rotor.
    pub fn curve(&self, unit: usize) -> Option<&RotorAlone> {
        let is_single = self.channels[unit][1] == NONE;
        self.alone[unit][0].as_ref().filter(|_| is_single)
    }

    /// Whether torques give yaw alone, and thrusts none: all axes are vertical.
    pub fn is_vertical(&self) -> bool {
        let n = self.units();
        (0..n).all(|i| {
            let torque = [0, 1, 3].map(|axis| self.matrix[(axis, n + i)]);
            torque == [0.0; 3] && self.matrix[(2, i)] == 0.0
        })
    }

    /// The declared range of voltage, V; `None` where voltage is ignored.
    pub fn voltage_range(&self) -> Option<[f64; 2]> {
        self.corrections[0].as_ref().map(|voltage| voltage.range)
    }

    /// The declared range of density, kg/m3; `None` where density is ignored.
    pub fn density_range(&self) -> Option<[f64; 2]> {
        self.corrections[1].as_ref().map(|air| air.range)
    }

    /// The correction `[k_f, k_Q]` at a battery voltage and the bench's density.
    pub fn factors(&self, volts: f32) -> [f64; 2] {
        self.factors_in(volts, None)
    }

    /// The correction `[k_f, k_Q]` at a battery voltage and a density, `None` for the bench's; both are clamped
    /// into their ranges.
    pub fn factors_in(&self, volts: f32, density: Option<f32>) -> [f64; 2] {
        let [of_voltage, of_air] = [Some(volts), density].map(|x| x.map(f64::from));
        let [[f, q], [by_f, by_q]] = [(0, of_voltage), (1, of_air)].map(|(k, x)| {
            let correction = self.corrections[k].as_ref().zip(x);
            correction.map_or([1.0, 1.0], |(correction, x)| {
                let [low, high] = correction.range;
                correction.factors(x.clamp(low, high))
            })
        });
        [f * by_f, q * by_q]
    }

    /// `[roll, pitch, yaw, thrust]` (N m, N) that the units' efforts `[f, Q]` at the reference
    /// voltage give under the correction `factors`.
    pub fn wrench_of(&self, efforts: impl Iterator<Item = [f64; 2]>, factors: [f64; 2]) -> [f64; 4] {
        let mut wrench = [0.0; 4];
        for (i, efforts) in efforts.enumerate() {
            for (wrench, part) in wrench.iter_mut().zip(self.contribution(i, efforts, factors)) {
                *wrench += part;
            }
        }
        wrench
    }

    /// What unit `i` contributes to that.
    pub(crate) fn contribution(&self, i: usize, [f, q]: [f64; 2], factors: [f64; 2]) -> [f64; 4] {
        let n = self.units();
        std::array::from_fn(|axis| {
            self.matrix[(axis, i)] * factors[0] * f + self.matrix[(axis, n + i)] * factors[1] * q
        })
    }

    /// `[roll, pitch, yaw, thrust]` (N m, N) that throttles, one per output, give at a battery
    /// voltage and the bench's density.
    pub fn wrench(&self, throttle: &[f32], volts: f32) -> [f64; 4] {
        self.wrench_in(throttle, self.factors(volts))
    }

    /// The same under a correction.
    pub fn wrench_in(&self, throttle: &[f32], factors: [f64; 2]) -> [f64; 4] {
        let efforts = self.channels.iter().enumerate().map(|(unit, channels)| {
            let throttles = channels.map(|channel| throttle.get(channel).map_or(0.0, |x| f64::from(*x)));
            self.given(unit, throttles)
        });
        self.wrench_of(efforts, factors)
    }

    /// What a unit gives: a rotor below idle is out.
    pub(crate) fn given(&self, unit: usize, throttles: [f64; 2]) -> [f64; 2] {
        let idle = self.throttle[0];
        let is_out = throttles.map(|throttle| throttle < 0.999 * idle);
        match (is_out, &self.alone[unit]) {
            ([false, true], [Some(alone), _]) => alone.efforts(throttles[0]),
            ([true, false], [_, Some(alone)]) => alone.efforts(throttles[1]),
            _ => self.pairs[unit].efforts(throttles),
        }
    }

    /// The largest `[roll, pitch, yaw, thrust]` at the reference voltage, N m and N: all units at
    /// their best, whatever the other axes lose.
    pub fn authority(&self) -> [f64; 4] {
        let scales: Vec<[f64; 2]> = self.pairs.iter().map(PairMap::scale).collect();
        let n = self.units();
        std::array::from_fn(|axis| {
            let most = |(i, [f, q]): (usize, &[f64; 2])| {
                self.matrix[(axis, i)].abs() * f + self.matrix[(axis, n + i)].abs() * q
            };
            scales.iter().enumerate().map(most).sum()
        })
    }

    /// The wrench furthest in `direction` (per axis, of the authority's size) that the frame can
    /// give: every unit at the best point of its border. A corner of what is attainable.
    pub fn furthest(&self, direction: [f64; 4], factors: [f64; 2]) -> [f64; 4] {
        let n = self.units();
        let per = self
            .authority()
            .map(|authority| if authority > 0.0 { 1.0 / authority } else { 0.0 });
        let border = |pair: &PairMap| -> Vec<[f64; 2]> {
            let border = pair.border(64).into_iter();
            border.map(|t| pair.efforts(t)).collect()
        };
        let borders: Vec<Vec<[f64; 2]>> = self.pairs.iter().map(border).collect();
        let best = (0..n).map(|i| {
            let gain = |column: usize| -> f64 {
                (0..4)
                    .map(|axis| direction[axis] * per[axis] * self.matrix[(axis, column)])
                    .sum()
            };
            let (by_f, by_q) = (factors[0] * gain(i), factors[1] * gain(n + i));
            let value = |[f, q]: &[f64; 2]| by_f * f + by_q * q;
            let best = borders[i].iter().max_by(|a, b| value(a).total_cmp(&value(b)));
            best.copied().unwrap_or_default()
        });
        self.wrench_of(best, factors)
    }

    /// True where some throttles within the range give a unit's efforts `[f, Q]` at the reference
    /// voltage: Newton steps, clamped, from the middle and the corners of the range.
    pub fn attains(&self, unit: usize, efforts: [f64; 2]) -> bool {
        let pair = &self.pairs[unit];
        let [low, high] = pair.range();
        let middle = 0.5 * (low + high);
        let starts = [
            [middle, middle],
            [low, low],
            [low, high],
            [high, low],
            [high, high],
        ];
        let scale = pair.scale();
        starts.into_iter().any(|start| {
            let mut throttles = start;
            for _ in 0..STEPS {
                throttles = pair.newton(throttles, efforts);
            }
            let given = pair.efforts(throttles);
            (0..2).all(|k| (given[k] - efforts[k]).abs() <= 1e-9 * scale[k])
        })
    }

    /// True where the least-norm efforts M+ `wrench` are attainable for every unit; with single rotors M+ of the wrench
    /// from which what their torques differ from their share is taken.
    pub fn least_norm_attains(&self, wrench: [f64; 4], factors: [f64; 2]) -> bool {
        const PASSES: usize = 40;
        let n = self.units();
        let effort = |asked: &[f64; 4], row: usize, factor: f64| -> f64 {
            let shares = (0..4).map(|axis| self.pseudo_inverse[(row, axis)] * asked[axis]);
            shares.sum::<f64>() / factor
        };
        let mut asked = wrench;
        for _ in 0..PASSES {
            let mut next = wrench;
            for (i, curve) in (0..n).filter_map(|i| Some((i, self.curve(i)?))) {
                let [f, q] = [(i, factors[0]), (n + i, factors[1])].map(|(row, k)| effort(&asked, row, k));
                let off = curve.efforts(self.throttle_of(curve, f))[1] - q;
                for (axis, next) in next.iter_mut().enumerate() {
                    *next -= self.matrix[(axis, n + i)] * factors[1] * off;
                }
            }
            asked = next;
        }
        (0..n).all(|i| {
            let wanted = [effort(&asked, i, factors[0]), effort(&asked, n + i, factors[1])];
            let Some(curve) = self.curve(i) else {
                return self.attains(i, wanted);
            };
            let [least, most] = self.throttle.map(|throttle| curve.efforts(throttle)[0]);
            (least..=most).contains(&wanted[0])
        })
    }

    /// The throttle of a single rotor's thrust, N, within the range.
    fn throttle_of(&self, curve: &RotorAlone, thrust_n: f64) -> f64 {
        let [mut low, mut high] = self.throttle;
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if curve.efforts(middle)[0] < thrust_n {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }

    /// The throttle at `share` of the allowed range, rounded into it.
    pub fn throttle(&self, share: f64) -> f32 {
        let [low, high] = self.throttle;
        let throttle = (low + share * (high - low)) as f32;
        if f64::from(throttle) < low {
            throttle.next_up()
        } else if f64::from(throttle) > high {
            throttle.next_down()
        } else {
            throttle
        }
    }

    /// Throttles per output for shares of the allowed range; stopped rotors at 0.
    pub fn throttles(&self, shares: impl Iterator<Item = f64>, health: Health) -> Vec<f32> {
        (0..self.rotors() as u8)
            .zip(shares)
            .map(|(channel, share)| {
                if health.has_failed(channel) {
                    0.0
                } else {
                    self.throttle(share)
                }
            })
            .collect()
    }
}
