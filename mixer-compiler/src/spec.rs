//! The airframe file as TOML: what a key is, and how typed values are read from tables. Whether
//! values make sense is for [`crate::airframe`] to say, which has the keys.

mod fields;
pub mod keys;
mod syntax;
mod value;

pub(crate) use toml::Spanned;

pub(crate) use self::fields::Fields;
pub(crate) use self::syntax::{Places, parse, place_in, places};

/// A list of numbers, each with its place.
pub(crate) type Numbers = Vec<Spanned<f64>>;

/// A voltage and its factor.
pub(crate) type Point = Spanned<[Spanned<f64>; 2]>;
