//! The voltage correction: f(V) = k_f(V) f(u, l) and Q(V) = k_Q(V) Q(u, l), k = 1 at the reference
//! voltage. (The paper multiplies its maps by such a coefficient, section IV-B2.)

use crate::arithmetic::Scalar;
use crate::{SetpointError, clamp};

/// How a correction factor depends on voltage. `powf` has no place in a mixer: the compiler fits an
/// exponent law by a polynomial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum VoltageLaw<'a> {
    /// A polynomial in `scale V + offset`, coefficients in descending powers.
    Polynomial {
        /// Scale (1/V) and offset of the variable, which runs through [-1, 1] over the range.
        variable: [f32; 2],
        /// Coefficients, the leading one first.
        coefficients: &'a [f32],
    },
    /// Straight lines between points `[volts, k]`, ascending in volts and covering the range.
    Points(&'a [[f32; 2]]),
}

impl VoltageLaw<'_> {
    /// The factor k at `voltage_v`, which lies within the range.
    #[inline]
    pub fn factor(&self, voltage_v: f32) -> f32 {
        match self {
            VoltageLaw::Polynomial {
                variable,
                coefficients,
            } => VoltageLaw::polynomial(*variable, coefficients, voltage_v),
            VoltageLaw::Points(points) => {
                let mut factor = 1.0;
                for (left, right) in points.iter().zip(points.iter().skip(1)) {
                    factor = VoltageLaw::line(*left, *right, voltage_v);
                    if voltage_v <= right[0] {
                        break;
                    }
                }
                factor
            }
        }
    }

    /// [`VoltageLaw::Polynomial`] at `voltage_v`.
    #[inline]
    pub fn polynomial<S: Scalar>([scale, offset]: [f32; 2], coefficients: &[f32], voltage_v: S) -> S {
        let x = voltage_v * scale + offset;
        coefficients
            .iter()
            .fold(S::constant(0.0), |value, coefficient| value * x + *coefficient)
    }

    /// The straight line through two points of [`VoltageLaw::Points`], which differ in volts, at
    /// `voltage_v`.
    #[inline]
    pub fn line<S: Scalar>(left: [f32; 2], right: [f32; 2], voltage_v: S) -> S {
        let share = (voltage_v + -left[0]) / (right[0] - left[0]);
        share * (right[1] - left[1]) + left[1]
    }
}

/// The voltage correction of an airframe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Voltage<'a> {
    /// The declared range, V; a voltage outside is clamped and flagged.
    pub range_v: [f32; 2],
    /// k_f(V).
    pub thrust: VoltageLaw<'a>,
    /// k_Q(V).
    pub torque: VoltageLaw<'a>,
}

/// The correction at the present voltage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Correction {
    /// `[k_f, k_Q]`, both positive.
    pub(crate) factors: [f32; 2],
    /// True where the voltage lay outside the range.
    pub(crate) clamped: bool,
}

impl Correction {
    /// The correction at `voltage_v`; an airframe without `[voltage]` ignores the voltage.
    ///
    /// # Errors
    /// [`SetpointError::NonFiniteVoltage`] where the airframe has a correction and the voltage is
    /// not finite.
    #[inline]
    pub(crate) fn at(voltage: Option<&Voltage<'_>>, voltage_v: f32) -> Result<Self, SetpointError> {
        let Some(voltage) = voltage else {
            return Ok(Correction {
                factors: [1.0, 1.0],
                clamped: false,
            });
        };
        if !voltage_v.is_finite() {
            return Err(SetpointError::NonFiniteVoltage);
        }
        let [low, high] = voltage.range_v;
        let within = clamp(voltage_v, low, high);
        Ok(Correction {
            factors: [voltage.thrust.factor(within), voltage.torque.factor(within)],
            clamped: within != voltage_v,
        })
    }
}
