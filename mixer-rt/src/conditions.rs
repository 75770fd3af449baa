//! Conditions that are measured in flight, and the factors of thrust and torque that follow from it:
//! f = k_f(V) d_f(rho) f(u, l) and Q = k_Q(V) d_Q(rho) Q(u, l), all 1 at the bench's voltage and
//! density. (The paper multiplies its maps by k, section IV-B2. Thin air acts like a lower voltage,
//! so d(rho) = (rho / rho_ref)^(k's exponent - 1) with ordinary speed controllers.)

use crate::arithmetic::Scalar;
use crate::{Saturation, SetpointError, clamp};

/// Conditions that are measured in flight. A voltage alone makes them, too.
///
/// ```
/// # use mixer_rt::Conditions;
/// let conditions = Conditions::at_voltage(15.2).in_air(0.909);
/// assert_eq!(conditions.density_kg_m3, Some(0.909));
/// assert_eq!(Conditions::from(15.2), Conditions::at_voltage(15.2));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Conditions {
    /// The battery's present voltage, V: outside the airframe's range it is taken as the nearest
    /// within and flagged, zero as well. An airframe without `[voltage]` ignores it.
    pub voltage_v: f32,
    /// The air's density, kg/m3; `None`, where nothing measures it, means the bench's. Outside the
    /// airframe's range it is taken as the nearest within and flagged. One that is NaN, infinite,
    /// zero or negative means the bench's, and is flagged. An airframe without `[air]` ignores it.
    pub density_kg_m3: Option<f32>,
}

impl Conditions {
    /// A battery's voltage, V, in the bench's air.
    #[inline]
    pub const fn at_voltage(voltage_v: f32) -> Self {
        Conditions {
            voltage_v,
            density_kg_m3: None,
        }
    }

    /// The same in air of a measured density, kg/m3.
    #[inline]
    #[must_use]
    pub const fn in_air(self, density_kg_m3: f32) -> Self {
        Conditions {
            density_kg_m3: Some(density_kg_m3),
            ..self
        }
    }
}

/// [`Conditions::at_voltage`].
impl From<f32> for Conditions {
    #[inline]
    fn from(voltage_v: f32) -> Self {
        Conditions::at_voltage(voltage_v)
    }
}

/// How thrust and torque follow one measured quantity x, in its unit (V, or kg/m3). `powf` has no
/// place in a mixer: the factors are polynomials between nodes,
/// mostly one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law<'a> {
    /// x of the bench, where the factors are 1.
    pub reference: f32,
    /// Least and largest x; one outside is clamped and flagged.
    pub range: [f32; 2],
    /// The pieces by ascending x, the first from the least x on, the last up to the largest.
    pub pieces: &'a [LawPiece],
}

/// A piece of a [`Law`]: two polynomials in x - `start`, coefficients in descending powers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawPiece {
    /// Where the piece starts.
    pub start: f32,
    /// Factor of thrust.
    pub thrust: [f32; 5],
    /// Factor of torque.
    pub torque: [f32; 5],
}

impl Law<'_> {
    /// The factors `[of thrust, of torque]` at `x`, which lies within the range.
    #[inline]
    pub fn factors(&self, x: f32) -> [f32; 2] {
        let mut pieces = self.pieces.iter();
        let Some(mut piece) = pieces.next() else {
            return [1.0; 2];
        };
        for next in pieces {
            if x < next.start {
                break;
            }
            piece = next;
        }
        piece.factors(x)
    }
}

impl LawPiece {
    /// The factors `[of thrust, of torque]` at `x`, by this piece.
    #[inline]
    pub fn factors<S: Scalar>(&self, x: S) -> [S; 2] {
        let t = x + -self.start;
        [self.thrust, self.torque].map(|[a, b, c, d, e]| (((S::constant(a) * t + b) * t + c) * t + d) * t + e)
    }
}

/// The correction under the present conditions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Correction {
    /// Factors `[of thrust, of torque]`, both positive.
    pub(crate) factors: [f32; 2],
    /// Which conditions were clamped.
    pub(crate) clamped: Saturation,
}

impl Correction {
    /// The correction by an airframe's laws; a condition without a law is ignored.
    ///
    /// # Errors
    /// [`SetpointError::NonFiniteVoltage`] where there is a law of the voltage and the voltage is not
    /// finite.
    #[inline]
    pub(crate) fn at(
        voltage: Option<&Law<'_>>,
        air: Option<&Law<'_>>,
        conditions: Conditions,
    ) -> Result<Self, SetpointError> {
        let mut correction = Correction {
            factors: [1.0, 1.0],
            clamped: Saturation::NONE,
        };
        if let Some(law) = voltage {
            if !conditions.voltage_v.is_finite() {
                return Err(SetpointError::NonFiniteVoltage);
            }
            correction = correction.by(law, conditions.voltage_v, Saturation::VOLTAGE);
        }
        if let Some(law) = air {
            let density = conditions.density_kg_m3.unwrap_or(law.reference);
            let is_measured = density.is_finite() && density > 0.0;
            if !is_measured {
                correction.clamped = correction.clamped.with(Saturation::DENSITY);
            }
            let density = if is_measured { density } else { law.reference };
            correction = correction.by(law, density, Saturation::DENSITY);
        }
        Ok(correction)
    }

    /// Times the factors of one law.
    #[inline]
    fn by(self, law: &Law<'_>, x: f32, flag: Saturation) -> Self {
        let [low, high] = law.range;
        let within = clamp(x, low, high);
        let [thrust, torque] = law.factors(within);
        let [f, q] = self.factors;
        let clamped = if within != x { flag } else { Saturation::NONE };
        Correction {
            factors: [f * thrust, q * torque],
            clamped: self.clamped.with(clamped),
        }
    }
}
