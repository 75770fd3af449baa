//! Can the forward map be inverted over the whole throttle box?
//!
//! Locally it can where det J > 0, J the Jacobian of (f, Q) by (u, l). Globally a map with a
//! P-matrix Jacobian (all principal minors positive) is injective on a box (Gale and Nikaido 1965).
//! The principal minors of J itself need not be positive, but those of
//!
//! ```text
//! g = f/F - a Q/T,   h = Q/T + b f/F      a, b >= 0,  F, T scales
//! ```
//!
//! are, for some a and b, when dg/du > 0 and dh/dl > 0; and det d(g, h) = (1 + a b) det J / (F T).
//! An invertible linear change of the efforts changes nothing about injectivity. All signs are
//! proven by [`Bivariate`].

use crate::airframe::{Basis, Kind, Pair, RotorAlone, value_of_terms};
use crate::bounds::interval::Interval;
use crate::diagnostic::{Code, Diagnostic};
use crate::model::PairMap;
use crate::model::polynomial::{Bivariate, ThrottleBox};
use crate::model::wake::{self, Wake};
use crate::view::View;

/// The forward map with coefficients that are enclosed by intervals, for proofs. For its values see
/// [`PairMap`].
#[derive(Clone, Debug)]
pub struct EnclosedPairMap {
    thrust: [Bivariate; 2],
    torque: [Bivariate; 2],
    determinant: Bivariate,
    /// F and T: the efforts' sizes.
    scale: [f64; 2],
}

/// That the forward map is injective on a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Injectivity {
    /// Proven lower bound of det J over the box, N N m.
    pub least_determinant: f64,
    /// The combination (a, b) of efforts whose Jacobian is a P-matrix.
    pub combination: [f64; 2],
}

/// Why the forward map cannot be inverted, or not be proven to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fold {
    /// det J <= 0 at these throttles (u, l).
    Determinant([f64; 2]),
    /// det J < 0 at every corner: the sign of the torque is not the one of the conventions.
    Reversed,
    /// det J > 0 was proven, but no combination of the efforts is a P-matrix.
    NotGlobal,
}

/// Share of the largest thrust by which slopes in f64 and those that are rounded to f32 may differ.
const ROUNDING: f64 = 1e-5;

/// Factors a and b that are tried; the first works for ordinary pairs.
const COMBINATIONS: [f64; 6] = [0.0, 0.5, 1.0, 2.0, 4.0, 0.25];

impl EnclosedPairMap {
    /// The map of a pair model.
    pub fn new(pair: &Pair) -> Self {
        Self::of(pair.basis, &pair.thrust_n, &pair.torque_nm)
    }

    /// The map of these coefficients, N and N m, one per term of the basis.
    pub fn of(basis: Basis, thrust_n: &[f64], torque_nm: &[f64]) -> Self {
        let exponents = basis.exponents();
        let quantity = |coefficients: &[f64]| Bivariate::from_terms(exponents, coefficients);
        let gradient = |p: &Bivariate| [p.by_u(), p.by_l()];
        let thrust = gradient(&quantity(thrust_n));
        let torque = gradient(&quantity(torque_nm));
        let minus = Interval::exact(-1.0);
        let determinant = thrust[0]
            .times(&torque[1])
            .plus(minus, &thrust[1].times(&torque[0]));
        // The size of thrust is its value at full throttle, that of torque its range over the
        // diagonal's ends.
        let corner =
            |coefficients: &[f64], u: f64, l: f64| value_of_terms(exponents, coefficients, [u, l]).abs();
        let size = |c: &[f64]| {
            corner(c, 1.0, 1.0)
                .max(corner(c, 0.0, 1.0))
                .max(corner(c, 1.0, 0.0))
        };
        let scale = [size(thrust_n), size(torque_nm)];
        EnclosedPairMap {
            thrust,
            torque,
            determinant,
            scale,
        }
    }

    /// Proves that the map is injective on the box.
    ///
    /// # Errors
    /// Where it folds, or why nothing could be proven.
    pub fn prove_injective(&self, throttle: ThrottleBox) -> Result<Injectivity, Fold> {
        self.injective(throttle).map_err(|found| match found {
            Some(at) => self.fold(throttle, at),
            None => Fold::NotGlobal,
        })
    }

    /// The proof, or throttles where det J may not be positive, if that is what fails.
    fn injective(&self, throttle: ThrottleBox) -> Result<Injectivity, Option<[f64; 2]>> {
        let least_determinant = self.determinant.prove_positive(throttle).map_err(Some)?;
        let [thrust_size, torque_size] = self.scale.map(|size| Interval::exact(1.0 / size));
        let zero = Bivariate::from_terms(&[(0, 0)], &[0.0]);
        let combines = |p: &Bivariate, p_size, q: &Bivariate, q_size, factor: f64| {
            let sum = zero.plus(p_size, p).plus(Interval::exact(factor) * q_size, q);
            sum.prove_positive(throttle).is_ok()
        };
        let (f, q) = (&self.thrust, &self.torque);
        let mut factors = COMBINATIONS.into_iter();
        let a = factors.find(|&a| combines(&f[0], thrust_size, &q[0], torque_size, -a));
        let mut factors = COMBINATIONS.into_iter();
        let b = factors.find(|&b| combines(&q[1], torque_size, &f[1], thrust_size, b));
        match (a, b) {
            (Some(a), Some(b)) => Ok(Injectivity {
                least_determinant,
                combination: [a, b],
            }),
            _ => Err(None),
        }
    }

    /// The map of a unit; that of a single rotor is constant along the lower throttle.
    pub(crate) fn of_kind(kind: Kind<'_>) -> Self {
        match kind {
            Kind::Pair(pair) => Self::new(pair),
            Kind::SingleRotor(rotor) => {
                let [f, q] = [rotor.alone.thrust_n, rotor.alone.torque_nm].map(RotorAlone::in_cubic_terms);
                Self::of(Basis::Cubic, &f, &q)
            }
        }
    }

    /// Lower bounds over the box: of f_u + q f_l, N, for q from 1 / `ratio` to `ratio`, and from it an upper one of the rest of
    /// f after its tangent, over f_u + f_l and the square of the larger change of a throttle; `None` where there is no proof.
    pub(crate) fn proven_slopes(&self, ratio: f64, throttle: ThrottleBox) -> Option<(f64, f64)> {
        let [f_u, f_l] = &self.thrust;
        let margin_n = ROUNDING * self.scale[0];
        let margin = Bivariate::from_terms(&[(0, 0)], &[-margin_n]);
        let least = |q: f64| {
            let sum = margin
                .plus(Interval::exact(1.0), f_u)
                .plus(Interval::exact(q), f_l);
            Some(margin_n + sum.prove_positive(throttle).ok()?)
        };
        let most = |slope: Bivariate| slope.largest_magnitude(throttle);
        let curvature_n = most(f_u.by_u()) + 2.0 * most(f_u.by_l()) + most(f_l.by_l());
        Some((
            least(ratio)?.min(least(1.0 / ratio)?),
            0.5 * curvature_n / least(1.0)?,
        ))
    }

    /// det J at the throttles (u, l), N N m.
    pub(crate) fn determinant_at(&self, at: [f64; 2]) -> f64 {
        let value = self.determinant.at(at);
        0.5 * (value.low + value.high)
    }

    /// The point with the least det J among the one found, the corners and a grid, for the message.
    fn fold(&self, ThrottleBox { low, high }: ThrottleBox, found: [f64; 2]) -> Fold {
        let corners = [[low, low], [low, high], [high, low], [high, high]];
        if corners.into_iter().all(|at| self.determinant_at(at) < 0.0) {
            return Fold::Reversed;
        }
        let mut worst = (self.determinant_at(found), found);
        for i in 0..=GRID {
            for j in 0..=GRID {
                let at = [i, j].map(|k| low + (high - low) * f64::from(k) / f64::from(GRID));
                let value = self.determinant_at(at);
                if value < worst.0 {
                    worst = (value, at);
                }
            }
        }
        Fold::Determinant(worst.1)
    }

    /// The least idle at which the map is proven injective up to the throttle `high`, rounded up to
    /// 1e-5; `None` where no idle works.
    pub fn least_idle(&self, high: f64) -> Option<f64> {
        let steps = (high * IDLE_STEPS) as u32;
        let works = |step: u32| {
            let low = f64::from(step) / IDLE_STEPS;
            low < high && self.injective(ThrottleBox { low, high }).is_ok()
        };
        if works(0) {
            return Some(0.0);
        }
        // Boxes shrink as the idle rises, so what holds at one idle holds at every larger one.
        let (mut fails, mut holds) = (0, steps.saturating_sub(1));
        if !works(holds) {
            return None;
        }
        while holds - fails > 1 {
            let middle = fails + (holds - fails) / 2;
            if works(middle) {
                holds = middle;
            } else {
                fails = middle;
            }
        }
        Some(f64::from(holds) / IDLE_STEPS)
    }
}

/// Proves that the airframe's forward map can be inverted over its throttle range; returns the
/// proof and the least idle for which it holds.
///
/// # Errors
/// A fold, at `throttle.min` with the least idle that would do, or a torque of the wrong sign.
pub(crate) fn prove(view: &View<'_, &Pair>) -> Result<(Injectivity, f64), Vec<Diagnostic>> {
    let map = EnclosedPairMap::new(view.of);
    let throttle = ThrottleBox {
        low: view.throttle.min,
        high: view.throttle.max,
    };
    let least_idle = map.least_idle(throttle.high);
    let fold = match map.prove_injective(throttle) {
        Ok(injectivity) => return Ok((injectivity, least_idle.unwrap_or(throttle.low).min(throttle.low))),
        Err(fold) => fold,
    };
    let mend = match least_idle {
        Some(idle) => {
            format!(
                "throttle.min = {idle} is the least idle at which the map can be inverted up to {}",
                throttle.high
            )
        }
        None => "check the order and the signs of the coefficients: thrust must rise with both throttles, torque fall \
                 with the upper one and rise with the lower one"
            .to_owned(),
    };
    Err(vec![match fold {
        Fold::Determinant([u, l]) => {
            let (key, label, message) = match least_idle {
                Some(idle) => (
                    "throttle.min",
                    "this idle is too low for the model",
                    format!("below an idle of {idle} the map of this pair cannot be inverted: the idle is {}", throttle.low),
                ),
                None => (
                    "pair",
                    "this model folds at every idle",
                    format!("the map of this pair cannot be inverted: it folds at throttles ({u:.3}, {l:.3})"),
                ),
            };
            view.diagnostic(Code::Fold, key, message, label, mend)
        }
        Fold::Reversed => view.diagnostic(
            Code::Fold,
            "pair.torque_nm",
            "this torque falls where the lower rotor speeds up, at all throttles",
            "signed for the other rotor",
            reversed(view),
        ),
        Fold::NotGlobal => view.diagnostic(
            Code::NotInjective,
            "throttle.min",
            "the map of this pair is not proven to have an inverse: two pairs of throttles may give one effort",
            "",
            mend,
        ),
    }])
}

/// What to do about a det J below 0. The mean torque of the rotors in their true order is negative
/// for a torque of the right sign.
fn reversed(view: &View<'_, &Pair>) -> &'static str {
    let map = PairMap::new(view.of, &view.throttle);
    match Wake::of_torque(wake::mean_torque(|at| map.efforts(at)[1], map.range())) {
        Wake::Above => {
            "by its mean the torque has the other sign: it counts positive where the lower rotor outweighs the upper; negate every \
             coefficient of torque_nm"
        }
        Wake::Below => {
            "by its mean the torque has the right sign, and the rotors are exchanged: run identify with --swap, or exchange u and l \
             in both polynomials"
        }
        Wake::Unknown => {
            "torque counts positive where the lower rotor outweighs the upper: negate every coefficient of torque_nm; if the \
             columns of the two rotors were exchanged, exchange u and l in both polynomials instead"
        }
    }
}

/// Points per side for the worst value in a message.
const GRID: u32 = 16;

/// Resolution of [`EnclosedPairMap::least_idle`]: steps per unit of throttle.
const IDLE_STEPS: f64 = 1e5;
