//! What a unit is: a coaxial pair or a single rotor.

use super::pair::Pair;
use super::single_rotor::SingleRotor;
use super::uncertainty::Uncertainty;

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

    /// Error of the model; `None` where the file has none.
    pub fn uncertainty(self) -> Option<&'a Uncertainty> {
        match self {
            Kind::Pair(pair) => pair.uncertainty.as_ref(),
            Kind::SingleRotor(rotor) => rotor.uncertainty.as_ref(),
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
