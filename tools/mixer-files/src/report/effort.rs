//! The two efforts of a unit, with their words and units.

/// Label of an axis for thrust.
pub(crate) const THRUST: &str = "thrust f (N)";
/// Label of an axis for torque.
pub(crate) const TORQUE: &str = "torque Q (N m)";

/// Name and unit of both in read-outs.
pub(crate) const EFFORTS: [(&str, &str); 2] = [("thrust f", "N"), ("torque Q", "N m")];

/// Thrust and torque of one unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// f, N.
    Thrust,
    /// Q, N m.
    Torque,
}

impl Effort {
    /// Both.
    pub const BOTH: [Effort; 2] = [Effort::Thrust, Effort::Torque];

    /// The word at the beginning of a sentence.
    pub(crate) fn name(self) -> &'static str {
        ["Thrust", "Torque"][self as usize]
    }

    /// The word within a sentence, in names of files and columns.
    pub(crate) fn word(self) -> &'static str {
        ["thrust", "torque"][self as usize]
    }

    pub(crate) fn label(self) -> &'static str {
        [THRUST, TORQUE][self as usize]
    }

    pub(crate) fn unit(self) -> &'static str {
        ["N", "N m"][self as usize]
    }
}
