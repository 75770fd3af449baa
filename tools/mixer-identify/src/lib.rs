//! From bench files of a coaxial pair to the `[throttle]`, `[pair]` and `[voltage]` tables of an
//! airframe file.
//!
//! text -> [`bench::read`] -> [`mod@bench`] (start and stop rows, plateaus, signs) ->
//! [`fit::voltage`] exponents -> [`fit::pair`]: outliers ([`fit::robust`]), choice of the basis
//! ([`fit::cross`]), least squares ([`mod@fit`]), [`fit::fold`] -> [`fragment`], [`report`]. Of one
//! rotor: [`rotor::single`] -> [`rotor::predict`]; of its steps: [`mod@lag`].
//!
//! What there is to say of a result is one list of statements ([`statement`]): [`report`] prints it, and
//! [`fragment`] has it as comments of the tables. [`texts`] is for front ends: text in, text out.
//!
//! The crate opens no file and prints nothing. A [`Refusal`](refusal::Refusal) names the file, the
//! line where there is one, and what would serve.
//!
//! ```
//! use mixer_identify::identified::Settings;
//! use mixer_identify::texts::{Text, identify};
//!
//! // A sweep of both throttles in five levels. (A bench would have measured it.)
//! let mut csv = String::from("upper,lower,thrust_n,torque_nm\n");
//! for (i, j) in (0..25).map(|k| (k / 5, k % 5)) {
//!     let (u, l) = (0.2 + 0.2 * f64::from(i), 0.2 + 0.2 * f64::from(j));
//!     let (thrust, torque) = (12.0 * u * u + 9.0 * l * l, 0.2 * l * l - 0.18 * u * u);
//!     csv += &format!("{u:.1},{l:.1},{thrust:.3},{torque:.5}\n");
//! }
//!
//! let map = Text { name: "map.csv".into(), content: Ok(csv.into_bytes()) };
//! let answer = identify(&[map], [None, None], &Settings::default()).expect("a map");
//! assert!(answer.report.contains("the map has no fold"));
//! assert!(answer.tables.contains("[pair]"));
//! ```

pub mod air;
pub mod bench;
pub mod fit;
pub mod fragment;
pub mod identified;
pub mod lag;
pub mod numbers;
pub mod pair_file;
pub mod paper;
pub mod plan;
pub mod refusal;
pub mod report;
pub mod rotor;
pub mod statement;
mod statistics;
mod table;
pub mod texts;
