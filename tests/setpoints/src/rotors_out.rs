//! Which rotors are out, request by request.

use mixer_rt::Health;

use crate::Random;

/// Endless sequence of frames' states of health: always as many rotors out, at random channels.
#[derive(Clone, Debug)]
pub struct RotorsOut {
    random: Random,
    channels: u32,
    out: u32,
}

impl RotorsOut {
    /// The sequence of one seed: `out` of a frame's rotors, at output `channels` 0.. (64 at most).
    pub const fn new(seed: u64, channels: usize, out: u32) -> Self {
        let channels = if channels < 64 { channels as u32 } else { 64 };
        RotorsOut {
            random: Random::new(seed),
            channels,
            out: if out < channels { out } else { channels },
        }
    }
}

impl Iterator for RotorsOut {
    type Item = Health;

    fn next(&mut self) -> Option<Health> {
        let (mut health, mut left) = (Health::GOOD, self.out);
        while left > 0 {
            let channel = self.random.index(self.channels) as u8;
            if !health.has_failed(channel) {
                health = health.with_failed(channel);
                left -= 1;
            }
        }
        Some(health)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rotor_fails_and_always_as_many() {
        for out in 0..=8 {
            let mut failures = [0; 8];
            for health in RotorsOut::new(1, failures.len(), out).take(2_000) {
                let failed = (0..64).filter(|&channel| health.has_failed(channel));
                assert_eq!(failed.clone().count(), out as usize);
                failed.for_each(|channel| failures[usize::from(channel)] += 1);
            }
            let expected = 250 * out;
            assert!(
                failures
                    .iter()
                    .all(|count| expected.abs_diff(*count) <= expected / 5),
                "{out}: {failures:?}"
            );
        }
    }

    #[test]
    fn no_more_rotors_fail_than_there_are() {
        let health = RotorsOut::new(1, 2, 3).next().expect("endless");
        assert_eq!(health, Health::GOOD.with_failed(0).with_failed(1));
    }
}
