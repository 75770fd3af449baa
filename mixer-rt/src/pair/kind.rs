//! Pairs that differ on one frame.

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
    /// The kinds.
    pub kinds: &'a [Kind<P, I>],
    /// The kind of each unit, by index.
    pub of: &'a [u8],
}
