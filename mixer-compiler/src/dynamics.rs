//! How rotors follow their throttles: the two constants of [`mixer_rt::tables::Lag`] for each kind of unit, and the proof that
//! `mix_dynamic` divides by nothing that is not positive.
//!
//! The lag in hover, of the file or estimated, gives the motor's time constant t, and the voltage's exponent its ohmic share
//! s at full throttle ([`crate::flywheel`]):
//!
//! ```text
//! 1/lag = sqrt((1 - s)^2 + 4 s x) / t       at the throttle x that would hold the speed
//! ```
//!
//! `mix_dynamic` divides by f_u + f_l and by r_u f_u + r_l f_l, r = 1/lag. Both have the sign of f_u + q f_l for a q between
//! the least and the largest ratio of two rotors' lags, the first for q = 1. That is linear in q, so its two ends are proven,
//! by [`Bivariate`](crate::model::polynomial::Bivariate) over the whole range of throttles.
//!
//! Its shift is the rest of the Taylor series of f over f_u + f_l: with h the largest of |f_uu| + 2 |f_ul| + |f_ll|, rotors
//! that are at most d of throttle from their command are shifted by at most h d^2 / (2 (f_u + f_l)), beside what unequal lags add
//! (`mixer-rt/src/dynamic.rs`).

use mixer_rt::tables::Lag;
use serde::Serialize;

use crate::airframe::{Airframe, GRAVITY, Kind};
use crate::bounds::bisected;
use crate::diagnostic::{Code, Diagnostic, rounded_up};
use crate::flywheel::{Flywheel, exponent, ohmic_share};
use crate::model::injectivity::EnclosedPairMap;
use crate::model::polynomial::ThrottleBox;
use crate::model::{equal_throttle, maps};
use crate::view::View;

/// What is said of an airframe without `mix_dynamic`.
pub const UNPROVEN: &str = "no mix_dynamic: its thrust is not proven to rise with both throttles over the whole range; a higher throttle.min may do";

/// Share of an estimated lag that is taken: half of the true one harms nothing, twice of it may be worse than none, and
/// the estimate is within a factor of two.
const OF_ESTIMATE: f64 = 0.7;

/// How the rotors of one kind of unit follow.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Dynamics {
    /// The lag that the mixer takes, s, in hover, or at half of the largest thrust where the vehicle is not known.
    pub lag_s: f64,
    /// Throttle of all rotors there.
    pub throttle: f64,
    /// Whether it is seven tenths of an estimate by the largest thrust, as the file has neither lag nor inertia.
    pub is_estimated: bool,
    /// Proven: least f_u + q f_l over the range, N; of a single rotor, the slope of its thrust.
    pub least_slope_n: f64,
    /// Proven: largest shift over the square of the largest distance of a rotor's throttle from that of its speed.
    pub shift_per_square: f64,
    /// The table.
    #[serde(skip)]
    pub(crate) lag: Lag,
}

impl Dynamics {
    /// Those of each kind of unit; `None` where the slopes are not proven positive for all.
    ///
    /// # Errors
    /// Such slopes where the file states a lag.
    pub(crate) fn of(airframe: &Airframe, most_n: f64) -> Result<Option<Vec<Dynamics>>, Vec<Diagnostic>> {
        let found = Dynamics::proven(airframe, most_n);
        let vehicle = airframe.vehicle.as_ref();
        if found.is_some() || vehicle.is_none_or(|vehicle| vehicle.rotor_lag_s.is_none()) {
            return Ok(found);
        }
        let range = [airframe.throttle.min, airframe.throttle.max];
        let is_proven = |min: f64| airframe.views().all(|view| slopes(&view, min).is_some());
        let least = rounded_up(bisected(range, is_proven));
        let help =
            format!("leave the key out, as `mix` needs none; it is proven from throttle.min = {least} on");
        Err(vec![airframe.diagnostic(
            Code::RotorLag,
            "vehicle.rotor_lag_s",
            UNPROVEN,
            "of no use without `mix_dynamic`",
            help,
        )])
    }

    fn proven(airframe: &Airframe, most_n: f64) -> Option<Vec<Dynamics>> {
        let maps = maps(airframe);
        let at = |thrust_n: f64| Some((equal_throttle(airframe, &maps, thrust_n)?, thrust_n / GRAVITY));
        let (throttle, mass_kg) = airframe.weight_n().and_then(at).or_else(|| at(0.5 * most_n))?;
        let vehicle = airframe.vehicle.as_ref();
        let inertia = vehicle.and_then(|vehicle| vehicle.rotor_inertia_kg_m2);
        let stated_s = vehicle.and_then(|vehicle| vehicle.rotor_lag_s);
        let is_estimated = inertia.or(stated_s).is_none();
        let of_estimate = if is_estimated { OF_ESTIMATE } else { 1.0 };
        let of_kind = |(view, rotor): (View<'_, Kind<'_>>, Option<Flywheel>)| {
            let lag_s = stated_s.or_else(|| Some(of_estimate * rotor?.lag_s()))?;
            let s = ohmic_share(exponent(&view), 1.0);
            let time_s = lag_s * root(s, throttle);
            let coast = [time_s, 1.0 - s].map(|factor| (factor * (1.0 - s) / (2.0 * s)) as f32);
            let (least_slope_n, shift_per_square) = slopes(&view, view.throttle.min)?;
            Some(Dynamics {
                lag_s,
                throttle,
                is_estimated,
                least_slope_n,
                shift_per_square,
                lag: Lag {
                    base: ((1.0 - s) * (1.0 - s) / (time_s * time_s)) as f32,
                    rise: (4.0 * s / (time_s * time_s)) as f32,
                    coast: vehicle
                        .is_some_and(|vehicle| !vehicle.rotor_brakes)
                        .then_some(coast),
                },
            })
        };
        let rotors = Flywheel::of_mass(airframe, mass_kg, inertia);
        airframe.views().zip(rotors).map(of_kind).collect()
    }
}

/// The root of 1/lag at a throttle, over t.
fn root(s: f64, throttle: f64) -> f64 {
    ((1.0 - s) * (1.0 - s) + 4.0 * s * throttle).sqrt()
}

/// The proof for a kind of unit from an idle on: the least slope, and the largest shift per square of the distance.
fn slopes(view: &View<'_, Kind<'_>>, min: f64) -> Option<(f64, f64)> {
    let (s, max) = (ohmic_share(exponent(view), 1.0), view.throttle.max);
    // Below half of idle the mixer shifts nothing.
    let ratio = root(s, max) / root(s, 0.5 * min);
    EnclosedPairMap::of_kind(view.of).proven_slopes(ratio, ThrottleBox { low: min, high: max })
}
