//! From bench files of a coaxial pair to the `[throttle]`, `[pair]` and `[voltage]` tables of an
//! airframe file.
//!
//! text -> [`bench::read`] -> [`mod@bench`] (start and stop rows, plateaus, signs) ->
//! [`fit::voltage`] exponents -> [`fit::pair`]: outliers ([`fit::robust`]), choice of the basis
//! ([`fit::cross`]), least squares ([`mod@fit`]), [`fit::fold`] -> [`fragment`], [`report`]. Of one rotor: [`rotor::single`] -> [`rotor::predict`].
//!
//! The crate opens no file and prints nothing. A [`Refusal`](refusal::Refusal) names the file, the
//! line where there is one, and what would serve. A caller that wants to show progress counts the
//! bytes that [`bench::read::read`] takes from the source that it is given.
//!
//! ```
//! use mixer_identify::identified::{Settings, from_benches};
//! use mixer_identify::bench::{self, read};
//! use mixer_identify::fragment;
//!
//! // A sweep of both throttles in five levels. (A bench would have measured it.)
//! let mut csv = String::from("upper,lower,thrust_n,torque_nm\n");
//! for (i, j) in (0..25).map(|k| (k / 5, k % 5)) {
//!     let (u, l) = (0.2 + 0.2 * f64::from(i), 0.2 + 0.2 * f64::from(j));
//!     let (thrust, torque) = (12.0 * u * u + 9.0 * l * l, 0.2 * l * l - 0.18 * u * u);
//!     csv += &format!("{u:.1},{l:.1},{thrust:.3},{torque:.5}\n");
//! }
//!
//! let settings = Settings::default();
//! let log = read::read("map.csv", csv.as_bytes(), &settings.reading)?;
//! let bench = bench::prepare(log, &settings.preparation)?;
//! let identified = from_benches(vec![bench], &settings.wishes)?;
//!
//! let pair = identified.pair.as_ref().expect("a map of both rotors");
//! assert!(pair.thrust.leave_one_out_rms < 0.01);
//! assert!(fragment::text(&identified).contains("[pair]"));
//! # Ok::<(), mixer_identify::refusal::Refusal>(())
//! ```

pub mod bench;
pub mod fit;
pub mod fragment;
pub mod identified;
pub mod paper;
pub mod plan;
pub mod refusal;
pub mod report;
pub mod rotor;
pub mod verdict;
pub mod wording;
