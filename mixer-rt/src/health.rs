//! Which rotors are out.

/// The rotors that have failed, by output channel. A failed rotor is commanded to stop (throttle 0,
/// below idle) and is taken to give nothing. Its partner gives what the airframe file says of a
/// rotor alone (`[pair.lower_out]`, `[pair.upper_out]`); without that, the pair's polynomial with
/// the failed rotor's throttle at zero.
///
/// ```
/// # use mixer_rt::Health;
/// let health = Health::GOOD.with_failed(4);
/// assert!(health.has_failed(4) && !health.is_good());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(transparent))]
pub struct Health {
    failed: u64,
}

impl Health {
    /// All rotors work.
    pub const GOOD: Health = Health { failed: 0 };

    /// The rotors that a mask names: bit k is the rotor at output `k`.
    #[inline]
    pub const fn from_bits(failed: u64) -> Self {
        Health { failed }
    }

    /// The inverse of [`Health::from_bits`].
    #[inline]
    pub const fn bits(self) -> u64 {
        self.failed
    }

    /// This health with the rotor at output `channel` (0..=63) failed as well; others are ignored.
    #[inline]
    #[must_use]
    pub const fn with_failed(self, channel: u8) -> Self {
        let bit = match 1u64.checked_shl(channel as u32) {
            Some(bit) => bit,
            None => 0,
        };
        Health {
            failed: self.failed | bit,
        }
    }

    /// True where the rotor at output `channel` has failed.
    #[inline]
    pub const fn has_failed(self, channel: u8) -> bool {
        channel < 64 && (self.failed >> channel) & 1 != 0
    }

    /// True where no rotor at an output below `channels` has failed.
    #[inline(always)]
    pub(crate) const fn is_good_below(self, channels: usize) -> bool {
        // Frames have at most 64 channels, and at least two.
        let beyond = 64usize.saturating_sub(channels) as u32;
        self.failed.wrapping_shl(beyond) == 0
    }

    /// True where no rotor has failed.
    #[inline]
    pub const fn is_good(self) -> bool {
        self.failed == 0
    }
}
