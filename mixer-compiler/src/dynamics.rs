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

use crate::airframe::{Airframe, GRAVITY, Kind, View};
use crate::flywheel::{Flywheel, exponent, ohmic_share};
use crate::model::injectivity::EnclosedPairMap;
use crate::model::polynomial::ThrottleBox;
use crate::model::{PairMap, equal_throttle, maps};

/// Share of an estimated lag that is taken: half of the true one harms nothing, twice of it may be worse than none, and
/// the estimate is within a factor of two.
const OF_ESTIMATE: f64 = 0.7;

/// Share of the largest thrust by which slopes in f64 and those that are rounded to f32 may differ.
const ROUNDING: f64 = 1e-5;

/// Where a lag is from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Origin {
    /// `[vehicle] rotor_lag_s`.
    Lag,
    /// `[vehicle] rotor_inertia_kg_m2`.
    Inertia,
    /// Seven tenths of the estimate by the largest thrust.
    Estimate,
}

/// How the rotors of one kind of unit follow.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Dynamics {
    /// The lag that the mixer takes, s, in hover, or at half of the largest thrust where the vehicle is not known.
    pub lag_s: f64,
    /// Throttle of all rotors there.
    pub throttle: f64,
    /// Where it is from.
    pub origin: Origin,
    /// Whether controllers brake.
    pub brakes: bool,
    /// Ohmic share s at full throttle.
    pub ohmic_share: f64,
    /// Proven: least f_u + q f_l over the range, N; of a single rotor, the slope of its thrust.
    pub least_slope_n: f64,
    /// Proven: largest shift over the square of the largest distance of a rotor's throttle from that of its speed.
    pub shift_per_square: f64,
}

impl Dynamics {
    /// Those of each kind of unit; `None` where the slopes are not proven positive for all.
    pub fn of(airframe: &Airframe) -> Option<Vec<Dynamics>> {
        let maps = maps(airframe);
        let full_n: f64 = airframe
            .units
            .iter()
            .zip(&maps)
            .map(|(unit, map)| -unit.axis[2] * map.efforts([airframe.throttle.max; 2])[0])
            .sum();
        let lifts = |thrust_n: f64| {
            equal_throttle(airframe, &maps, thrust_n).map(|throttle| (throttle, thrust_n / GRAVITY))
        };
        let (throttle, mass_kg) = airframe
            .weight_n()
            .and_then(lifts)
            .or_else(|| lifts(0.5 * full_n))?;
        let vehicle = airframe.vehicle.as_ref();
        let inertia = vehicle.and_then(|vehicle| vehicle.rotor_inertia_kg_m2);
        let rotors = Flywheel::of_mass(airframe, mass_kg, inertia);
        let of_kind = |(view, rotor): (View<'_, Kind<'_>>, Option<Flywheel>)| {
            let (lag_s, origin) = match (vehicle.and_then(|vehicle| vehicle.rotor_lag_s), inertia) {
                (Some(lag_s), _) => (lag_s, Origin::Lag),
                (None, Some(_)) => (rotor?.lag_s(), Origin::Inertia),
                (None, None) => (OF_ESTIMATE * rotor?.lag_s(), Origin::Estimate),
            };
            let share = ohmic_share(exponent(&view), 1.0);
            let (least_slope_n, shift_per_square) = proven(&view, share)?;
            Some(Dynamics {
                lag_s,
                throttle,
                origin,
                brakes: vehicle.is_none_or(|vehicle| vehicle.rotor_brakes),
                ohmic_share: share,
                least_slope_n,
                shift_per_square,
            })
        };
        airframe.views().zip(rotors).map(of_kind).collect()
    }

    /// The table.
    pub(crate) fn lag(&self) -> Lag {
        let s = self.ohmic_share;
        let time_s = self.lag_s * root(s, self.throttle);
        let per_square = 1.0 / (time_s * time_s);
        let coast = [(1.0 - s) * time_s / (2.0 * s), (1.0 - s) * (1.0 - s) / (2.0 * s)];
        Lag {
            base: ((1.0 - s) * (1.0 - s) * per_square) as f32,
            rise: (4.0 * s * per_square) as f32,
            coast: (!self.brakes).then_some(coast.map(|x| x as f32)),
        }
    }
}

/// t / lag at a throttle.
fn root(share: f64, throttle: f64) -> f64 {
    ((1.0 - share) * (1.0 - share) + 4.0 * share * throttle).sqrt()
}

/// The least slope, N, and the largest shift over the square of the distance.
fn proven(view: &View<'_, Kind<'_>>, share: f64) -> Option<(f64, f64)> {
    let throttle = ThrottleBox {
        low: view.throttle.min,
        high: view.throttle.max,
    };
    let margin_n = ROUNDING * PairMap::of_kind(view.of, &view.throttle).scale()[0];
    let map = match view.of {
        Kind::Pair(pair) => EnclosedPairMap::new(pair),
        Kind::SingleRotor(rotor) => EnclosedPairMap::of_rotor(&rotor.alone),
    };
    // Below half of idle the mixer shifts nothing.
    let ratio = root(share, throttle.high) / root(share, 0.5 * throttle.low);
    let least = [ratio, 1.0 / ratio].map(|q| map.least_sum_of_slopes(q, margin_n, throttle));
    let least_n = least
        .into_iter()
        .try_fold(f64::INFINITY, |least, proven| Some(least.min(proven?)))?;
    let sum_n = map.least_sum_of_slopes(1.0, margin_n, throttle)?;
    Some((least_n, 0.5 * map.largest_curvature(throttle) / sum_n))
}
