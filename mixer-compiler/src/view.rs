//! An airframe with one of its kinds of units: what proofs and rules look at.

use std::ops::Deref;

use crate::airframe::{Airframe, Kind, Pair};
use crate::diagnostic::{Code, Diagnostic};

/// An airframe with one of its kinds: `of` is a [`Kind`], or the [`Pair`] where it can be nothing else.
#[derive(Clone, Debug)]
pub struct View<'a, K> {
    airframe: &'a Airframe,
    /// The kind.
    pub of: K,
    kind: Kind<'a>,
    /// Its place among those of its table.
    place: usize,
}

impl<K> Deref for View<'_, K> {
    type Target = Airframe;

    fn deref(&self) -> &Airframe {
        self.airframe
    }
}

impl Airframe {
    /// The airframe with each of its kinds.
    pub fn views(&self) -> impl Iterator<Item = View<'_, Kind<'_>>> {
        let pairs = self.pairs.iter().map(Kind::Pair).enumerate();
        let rotors = self.single_rotors.iter().map(Kind::SingleRotor).enumerate();
        pairs.chain(rotors).map(|(place, kind)| View {
            airframe: self,
            of: kind,
            kind,
            place,
        })
    }

    /// The airframe with each of its pairs.
    pub fn pair_views(&self) -> impl Iterator<Item = View<'_, &Pair>> {
        self.views().filter_map(|view| {
            Some(View {
                airframe: view.airframe,
                of: view.kind.pair()?,
                kind: view.kind,
                place: view.place,
            })
        })
    }
}

impl<K> View<'_, K> {
    /// [`Airframe::diagnostic`] of the kind: a key that begins with `pair` is that of its own table, and the message names it
    /// where it has a name.
    pub fn diagnostic(
        &self,
        code: Code,
        key: &str,
        message: impl Into<String>,
        label: impl Into<String>,
        help: impl Into<String>,
    ) -> Diagnostic {
        let (word, name) = self.kind.name();
        let message = match name {
            "" => message.into(),
            name => format!("{word} \"{name}\": {}", message.into()),
        };
        let listed = format!("{word}[{}]", self.place);
        let table = if self.airframe.states(&listed) {
            &listed
        } else {
            word
        };
        let key = key
            .strip_prefix("pair")
            .map_or_else(|| key.to_owned(), |rest| format!("{table}{rest}"));
        self.airframe.diagnostic(code, &key, message, label, help)
    }
}
