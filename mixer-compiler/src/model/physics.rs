//! What throttles give by the airframe file alone: forces and torques of each unit, added up in f64.

use mixer_rt::Health;

use super::pair_map::PairMap;
use crate::airframe::{Airframe, Unit};

/// The physics of one airframe.
pub struct Physics<'a> {
    /// The airframe.
    pub airframe: &'a Airframe,
    /// The forward map of each unit.
    pub maps: &'a [PairMap],
}

impl Physics<'_> {
    /// `[roll, pitch, yaw, thrust]` (N m, N) of a throttle per channel at the factors `[k_f, k_Q]`, with
    /// [`Airframe::factors`] those of a voltage and a density.
    pub fn wrench<T: Copy + Into<f64>>(&self, throttle: &[T], factors: [f64; 2], health: Health) -> [f64; 4] {
        let efforts = |unit: usize| self.efforts(unit, throttle, health);
        self.wrench_of((0..self.airframe.units.len()).map(efforts), factors)
    }

    /// The same of the units' efforts `[f, Q]` at the reference voltage: the force f a at r and the
    /// reaction -s Q a of the rotors.
    fn wrench_of(&self, efforts: impl Iterator<Item = [f64; 2]>, factors: [f64; 2]) -> [f64; 4] {
        let mut wrench = [0.0; 4];
        for (unit, efforts) in self.airframe.units.iter().zip(efforts) {
            let [f, q] = [factors[0] * efforts[0], factors[1] * efforts[1]];
            let ([x, y, z], axis) = (unit.position_m, unit.axis);
            let [fx, fy, fz] = axis.map(|a| f * a);
            let reaction = -self.airframe.spin_sign(unit) * q;
            wrench[0] += y * fz - z * fy + reaction * axis[0];
            wrench[1] += z * fx - x * fz + reaction * axis[1];
            wrench[2] += x * fy - y * fx + reaction * axis[2];
            wrench[3] -= fz;
        }
        wrench
    }

    /// `[f, Q]` (N, N m) of a unit, by index, at the reference voltage. A rotor that is out gives nothing; its partner gives what
    /// the file says of a rotor alone, else the pair's polynomial at throttle 0 of the other.
    pub fn efforts<T: Copy + Into<f64>>(&self, unit: usize, throttle: &[T], health: Health) -> [f64; 2] {
        let (unit, map): (&Unit, _) = (&self.airframe.units[unit], &self.maps[unit]);
        let [u, l] = unit.throttles(throttle);
        let is_out = |channel: usize| health.has_failed(channel as u8);
        // A single rotor is a pair whose lower rotor is out.
        let out = [is_out(unit.upper_channel), unit.lower_channel.is_none_or(is_out)];
        let pair = self.airframe.kind_of(unit).pair();
        let (alone, [u, l]) = match out {
            [false, false] => (None, [u, l]),
            [true, true] => return [0.0; 2],
            [false, true] => (pair.and_then(|pair| pair.lower_out.as_ref()), [u, 0.0]),
            [true, false] => (pair.and_then(|pair| pair.upper_out.as_ref()), [0.0, l]),
        };
        alone.map_or_else(|| map.efforts([u, l]), |alone| alone.efforts(u + l))
    }
}
