//! Requests of every kind in turn, and the digest of what a mixer makes of them.

use mixer_rt::{
    Saturation, SetpointError, Wrench,
    tables::{AllocationMethod, Inverse, Quantity, Tables},
};

use crate::{Digest, Ranges, RequestKind, Requests, Setpoint, Setpoints};

/// Endless sequence: attainable requests, saturated ones, and setpoints that may not be finite, in
/// turn.
#[derive(Clone, Debug)]
pub struct Mixture<'a, P, I, S> {
    attainable: Requests<'a, P, I, S>,
    saturated: Requests<'a, P, I, S>,
    anything: Setpoints,
    index: u32,
}

impl<'a, P: Quantity, I: Inverse, S: AllocationMethod<P>> Mixture<'a, P, I, S> {
    /// The sequence of one seed for the mixer of `tables`.
    pub fn new(tables: &'a Tables<'a, P, I, S>, seed: u64) -> Self {
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

impl<P: Quantity, I: Inverse, S: AllocationMethod<P>> Iterator for Mixture<'_, P, I, S> {
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
