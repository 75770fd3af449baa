//! What units give: all the same pair, or pairs of several kinds and single rotors.

use super::alone::RotorAlone;
use super::forward::{Pair, Quantity};
use super::inverse::Inverse;

/// What a pair of one kind gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairKind<P, I> {
    /// The forward map.
    pub pair: Pair<P>,
    /// Thrust and torque of the upper and of the lower rotor, the other one out.
    pub alone: [RotorAlone; 2],
    /// The inverse map.
    pub inverse: I,
    /// Means over the throttles of f_u^2 + f_l^2 (N^2) and of Q_u^2 + Q_l^2 (N^2 m^2).
    pub mean_square_slopes: [f32; 2],
}

/// The kinds of a frame's units, by [`Unit::kind`](crate::tables::Unit::kind). One pair alone is that of all units.
pub trait Kinds {
    /// The basis of the pairs.
    type Quantity: Quantity;
    /// The evaluator of their inverses.
    type Inverse: Inverse;

    /// Whether units may be single rotors: images of other frames leave out what serves them.
    const MAY_BE_SINGLE: bool = false;

    /// The pair of a kind; `None` of a single rotor.
    fn pair(&self, kind: u8) -> Option<&PairKind<Self::Quantity, Self::Inverse>>;

    /// What the upper (0) or the lower (1) rotor of a kind gives alone. A single rotor is an upper one.
    fn alone(&self, kind: u8, side: usize) -> &RotorAlone;
}

impl<P: Quantity, I: Inverse> Kinds for PairKind<P, I> {
    type Quantity = P;
    type Inverse = I;

    #[inline(always)]
    fn pair(&self, _kind: u8) -> Option<&PairKind<P, I>> {
        Some(self)
    }

    #[inline(always)]
    fn alone(&self, _kind: u8, side: usize) -> &RotorAlone {
        &self.alone[side & 1]
    }
}

/// Units that differ: kinds count the pairs, then the single rotors, which `SINGLE` says that there may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unlike<'a, P, I, const SINGLE: bool> {
    /// The kinds of pairs.
    pub pairs: &'a [PairKind<P, I>],
    /// The kinds of single rotors.
    pub single_rotors: &'a [RotorAlone],
}

impl<P: Quantity, I: Inverse, const SINGLE: bool> Kinds for Unlike<'_, P, I, SINGLE> {
    type Quantity = P;
    type Inverse = I;

    const MAY_BE_SINGLE: bool = SINGLE;

    #[inline(always)]
    fn pair(&self, kind: u8) -> Option<&PairKind<P, I>> {
        self.pairs.get(usize::from(kind))
    }

    #[inline(always)]
    fn alone(&self, kind: u8, side: usize) -> &RotorAlone {
        match self.pair(kind) {
            Some(pair) => &pair.alone[side & 1],
            None => {
                let place = usize::from(kind).wrapping_sub(self.pairs.len());
                self.single_rotors.get(place).unwrap_or(&RotorAlone::NOTHING)
            }
        }
    }
}
