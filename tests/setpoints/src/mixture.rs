//! Requests of every kind in turn, and the digest of what a mixer makes of them.

use mixer_rt::{
    Saturation, SetpointError, Wrench,
    tables::{AllocationMethod, Kinds, Tables},
};

use crate::{Digest, Ranges, RequestKind, Requests, Setpoint, Setpoints};

/// Endless sequence: attainable requests, saturated ones, and setpoints that may not be finite, in
/// turn.
#[derive(Clone, Debug)]
pub struct Mixture<'a, K, S> {
    attainable: Requests<'a, K, S>,
    saturated: Requests<'a, K, S>,
    anything: Setpoints,
    index: u32,
}

impl<'a, K: Kinds, S: AllocationMethod> Mixture<'a, K, S> {
    /// The sequence of one seed for the mixer of `tables`.
    pub fn new(tables: &'a Tables<'a, K, S>, seed: u64) -> Self {
        let attainable = Requests::new(tables, RequestKind::Attainable, seed);
        let [roll, pitch, yaw, thrust] = attainable.authority();
        let [low, high] = tables
            .voltage
            .as_ref()
            .map_or([12.0, 16.0], |voltage| voltage.range);
        let ranges = Ranges {
            moments_nm: [roll, pitch, yaw],
            thrust_n: [-0.2 * thrust, 1.2 * thrust],
            voltage_v: [low - 1.0, high + 1.0],
            density_kg_m3: tables
                .air
                .as_ref()
                .map(|air| air.range.map(|density| 1.5 * density - 0.4)),
        };
        Mixture {
            attainable,
            saturated: Requests::new(tables, RequestKind::Saturated, seed),
            anything: Setpoints::new(seed, ranges),
            index: 0,
        }
    }
}

impl<K: Kinds, S: AllocationMethod> Iterator for Mixture<'_, K, S> {
    type Item = Setpoint;

    fn next(&mut self) -> Option<Setpoint> {
        self.index = (self.index + 1) % 3;
        match self.index {
            0 => self.attainable.next(),
            1 => self.saturated.next(),
            _ => self.anything.next(),
        }
    }
}

/// Whether a setpoint was refused, and why.
type Outcome<'a> = Result<(&'a [f32], &'a Wrench, Saturation), SetpointError>;

impl Digest {
    /// Takes in all that a mixer gives.
    pub fn mix(&mut self, outcome: Outcome<'_>) {
        match outcome {
            Ok((throttle, achieved, saturation)) => {
                for value in throttle.iter().chain(&achieved.to_array()) {
                    self.float(*value);
                }
                self.word(saturation.bits().into());
            }
            Err(SetpointError::NonFinite(axis)) => self.word(0xffff_0000 | axis as u32),
            Err(_) => self.word(0xffff_ffff),
        }
    }
}
