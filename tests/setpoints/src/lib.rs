//! Random setpoints and a digest of what a mixer makes of them, the same on the host and on the
//! target.
//!
//! Both sides draw the same sequence from the same seed and compare one number, where a table of
//! golden vectors would not fit into flash. Only integer arithmetic and one rounded f32 operation
//! at a time, so the bits do not depend on the machine. [`Requests`] are drawn around what one
//! airframe's mixer can deliver, from its own tables.
#![no_std]

mod mixture;
mod random;
mod requests;
mod rotors_out;

use mixer_rt::Conditions;

pub use mixture::Mixture;
pub use random::Random;
pub use requests::{RequestKind, Requests};
pub use rotors_out::RotorsOut;

/// Half-widths and limits of the setpoints to draw.
#[derive(Clone, Copy, Debug)]
pub struct Ranges {
    /// Roll, pitch and yaw lie in [-moment, moment], N m.
    pub moments_nm: [f32; 3],
    /// Thrust lies in [min, max], N.
    pub thrust_n: [f32; 2],
    /// Battery voltage lies in [min, max], V.
    pub voltage_v: [f32; 2],
    /// Density of the air lies in [min, max], kg/m3, but for one in sixteen; none is drawn where it is ignored.
    pub density_kg_m3: Option<[f32; 2]>,
}

/// One setpoint and the conditions.
#[derive(Clone, Copy, Debug)]
pub struct Setpoint {
    /// Roll, pitch, yaw (N m), thrust (N).
    pub wrench: [f32; 4],
    /// V.
    pub voltage_v: f32,
    /// kg/m3; 0 where the airframe ignores it.
    pub density_kg_m3: f32,
}

impl Setpoint {
    /// Voltage and density.
    pub const fn conditions(&self) -> Conditions {
        Conditions::at_voltage(self.voltage_v).in_air(self.density_kg_m3)
    }
}

/// Numbers that arithmetic treats in its own way. Not finite: a mixer refuses these.
const SPECIAL: [f32; 12] = [
    0.0,
    -0.0,
    1.0e-45,
    -1.0e-45,
    f32::MIN_POSITIVE,
    1.0e9,
    -1.0e9,
    f32::MAX,
    f32::MIN,
    f32::NAN,
    f32::INFINITY,
    f32::NEG_INFINITY,
];

/// Endless sequence of setpoints. One in sixteen has an axis replaced by a special number: signed
/// zero, subnormal, far outside every range, not finite.
#[derive(Clone, Debug)]
pub struct Setpoints {
    random: Random,
    ranges: Ranges,
}

impl Setpoints {
    /// The sequence of one seed.
    pub const fn new(seed: u64, ranges: Ranges) -> Self {
        Setpoints {
            random: Random::new(seed),
            ranges,
        }
    }
}

impl Iterator for Setpoints {
    type Item = Setpoint;

    fn next(&mut self) -> Option<Setpoint> {
        let [roll, pitch, yaw] = self
            .ranges
            .moments_nm
            .map(|moment| self.random.between([-moment, moment]));
        let mut wrench = [roll, pitch, yaw, self.random.between(self.ranges.thrust_n)];
        let voltage_v = self.random.between(self.ranges.voltage_v);
        let choice = self.random.bits();
        if choice & 0xf == 0 {
            let axis = (choice >> 4) as usize % wrench.len();
            wrench[axis] = SPECIAL[(choice >> 32) as usize % SPECIAL.len()];
        }
        let mut density_kg_m3 = 0.0;
        if let Some(range) = self.ranges.density_kg_m3 {
            density_kg_m3 = self.random.between(range);
            if choice & 0xf00 == 0 {
                density_kg_m3 = SPECIAL[(choice >> 40) as usize % SPECIAL.len()];
            }
        }
        Some(Setpoint {
            wrench,
            voltage_v,
            density_kg_m3,
        })
    }
}

/// FNV-1a, 64 bits, over words in little-endian order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Digest(u64);

impl Digest {
    /// Where the sequences of setpoints and of rotors out start whose digests are compared.
    pub const SEED: u64 = 17;

    /// Digests are compared with none to so many rotors out.
    pub const MOST_ROTORS_OUT: u32 = 2;

    /// How many setpoints are compared: twenty thousand, or a `million`; with rotors out, which
    /// takes longer, two thousand or twenty.
    pub const fn setpoints(million: bool, rotors_out: u32) -> usize {
        match (million, rotors_out) {
            (false, 0) => 20_000,
            (true, 0) => 1_000_000,
            (false, _) => 2_000,
            (true, _) => 20_000,
        }
    }

    /// Of nothing.
    pub const fn new() -> Self {
        Digest(0xcbf2_9ce4_8422_2325)
    }

    /// Takes in one word.
    pub fn word(&mut self, word: u32) {
        for byte in word.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    /// Takes in the bits of one float.
    pub fn float(&mut self, value: f32) {
        self.word(value.to_bits());
    }

    /// The digest of everything taken in so far.
    pub const fn value(self) -> u64 {
        self.0
    }
}

impl Default for Digest {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RANGES: Ranges = Ranges {
        moments_nm: [2.0, 3.0, 0.5],
        thrust_n: [5.0, 90.0],
        voltage_v: [12.8, 16.8],
        density_kg_m3: None,
    };

    #[test]
    fn digest_is_fnv_1a() {
        let mut digest = Digest::new();
        digest.word(u32::from_le_bytes(*b"foob"));
        // From the test vectors of the FNV reference implementation.
        assert_eq!(digest.value(), 0xdd12_0e79_0c25_12af);
    }

    #[test]
    fn setpoints_fill_their_ranges_and_every_special_number_occurs() {
        let (mut low, mut high, mut special) = ([f32::MAX; 5], [f32::MIN; 5], [0; SPECIAL.len()]);
        for setpoint in Setpoints::new(1, RANGES).take(10_000) {
            let [roll, pitch, yaw, thrust] = setpoint.wrench;
            let values = [roll, pitch, yaw, thrust, setpoint.voltage_v];
            let found = |value: &f32| SPECIAL.iter().position(|s| s.to_bits() == value.to_bits());
            if let Some(index) = values.iter().find_map(found) {
                special[index] += 1;
                continue;
            }
            for (index, value) in values.into_iter().enumerate() {
                low[index] = value.min(low[index]);
                high[index] = value.max(high[index]);
            }
        }
        let (min, max) = ([-2.0, -3.0, -0.5, 5.0, 12.8], [2.0, 3.0, 0.5, 90.0, 16.8]);
        for index in 0..5 {
            let margin = 0.01 * (max[index] - min[index]);
            assert!(
                low[index] >= min[index] && low[index] < min[index] + margin,
                "{index}: {low:?}"
            );
            assert!(
                high[index] <= max[index] && high[index] > max[index] - margin,
                "{index}: {high:?}"
            );
        }
        assert!(special.iter().all(|&count| count > 0), "{special:?}");
    }
}
