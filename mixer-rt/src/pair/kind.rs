//! Units that differ on one frame: pairs of several kinds, and single rotors.

use super::forward::Pair;
use super::single::SingleRotor;

/// What a pair of one kind gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kind<P, I> {
    /// The forward map.
    pub pair: Pair<P>,
    /// The upper and the lower rotor alone.
    pub singles: [SingleRotor; 2],
    /// The inverse map.
    pub inverse: I,
    /// [`Tables::mean_square_slopes`](crate::tables::Tables::mean_square_slopes) of this kind.
    pub mean_square_slopes: [f32; 2],
}

/// The kinds of a frame's units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unlike<'a, P, I> {
    /// The kinds of pairs beside the tables' own.
    pub kinds: &'a [Kind<P, I>],
    /// The kind of each unit: an index into `kinds`, then of single rotors; beyond all of them the tables' own pair.
    pub of: &'a [u8],
}

/// [`Unlike`] on a frame with single rotors, which are units of one effort: their torque follows from their thrust.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WithSingleRotors<'a, P, I> {
    /// The kinds of pairs. `of` counts on past them for single rotors.
    pub unlike: Unlike<'a, P, I>,
    /// Thrust and torque of each kind of single rotor, twice: a unit has a row for its upper and for its lower rotor.
    pub rotors: &'a [[SingleRotor; 2]],
    /// Passes of least norm over them.
    pub passes: u8,
}
