//! What a unit is: a coaxial pair or a single rotor.

use super::measured::Measured;
use super::pair::Pair;
use super::single_rotor::SingleRotor;

/// What a unit is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind<'a> {
    /// A coaxial pair.
    Pair(&'a Pair),
    /// A single rotor.
    SingleRotor(&'a SingleRotor),
}

impl<'a> Kind<'a> {
    /// The pair; `None` of a single rotor.
    pub fn pair(self) -> Option<&'a Pair> {
        match self {
            Kind::Pair(pair) => Some(pair),
            Kind::SingleRotor(_) => None,
        }
    }

    /// How it was measured.
    pub fn measured(self) -> &'a Measured {
        match self {
            Kind::Pair(pair) => &pair.measured,
            Kind::SingleRotor(rotor) => &rotor.measured,
        }
    }

    /// The word of the file, and the name by which units have it, empty where a file of one pair has none.
    pub fn name(self) -> (&'static str, &'a str) {
        match self {
            Kind::Pair(pair) => ("pair", &pair.name),
            Kind::SingleRotor(rotor) => ("rotor", &rotor.name),
        }
    }
}
