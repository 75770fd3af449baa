//! The forward map of one unit: total thrust and torque as polynomials of both throttles (eq. (1)).
//!
//! Each basis is evaluated by Horner's rule as a polynomial in u whose coefficients are polynomials
//! in l; neither has a constant term, since a stopped pair gives nothing. The order of the terms is
//! that of the airframe file.

use crate::arithmetic::Scalar;

/// A quantity of one unit, thrust in N or torque in N m, as a polynomial of the upper throttle `u`
/// and the lower throttle `l`, both in `[0, 1]`.
pub trait Quantity {
    /// The value at `(u, l)`.
    fn value<S: Scalar>(&self, u: S, l: S) -> S;

    /// The value at `(u, l)`, its derivatives by `u` and by `l`, and half its second derivatives by
    /// each. The value has the bits of [`Quantity::value`].
    fn expansion<S: Scalar>(&self, u: S, l: S) -> [S; 5];
}

/// Terms u2l2, u2l, u2, ul2, ul, u, l2, l: eq. (1) of the paper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Biquadratic(pub [f32; 8]);

/// Terms u3, u2l, ul2, l3, u2, ul, l2, u, l.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cubic(pub [f32; 9]);

/// Terms u4, u3l, u2l2, ul3, l4, u3, u2l, ul2, l3, u2, ul, l2, u, l.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quartic(pub [f32; 14]);

/// Both quantities of one unit at the reference voltage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair<P> {
    /// Total thrust f(u, l), N, upwards.
    pub thrust: P,
    /// Total torque Q(u, l), N m, signed as on the bench.
    pub torque: P,
}

impl<P: Quantity> Pair<P> {
    /// The efforts `[f, Q]` at `(u, l)`, in N and N m at the reference voltage.
    #[inline(always)]
    pub fn efforts<S: Scalar>(&self, [u, l]: [S; 2]) -> [S; 2] {
        [self.thrust.value(u, l), self.torque.value(u, l)]
    }

    /// The efforts `[f, Q]` at `(u, l)` and their Jacobian `[[f_u, f_l], [Q_u, Q_l]]`.
    #[inline(always)]
    pub fn efforts_and_jacobian<S: Scalar>(&self, [u, l]: [S; 2]) -> ([S; 2], [[S; 2]; 2]) {
        let [f, f_u, f_l, ..] = self.thrust.expansion(u, l);
        let [q, q_u, q_l, ..] = self.torque.expansion(u, l);
        ([f, q], [[f_u, f_l], [q_u, q_l]])
    }

    /// Efforts of both rotors at `[u, l]` with their derivatives.
    #[inline(always)]
    pub(crate) fn expansion(&self, [u, l]: [f32; 2]) -> Expansion {
        let [f, f_u, f_l, f_uu, f_ll] = self.thrust.expansion(u, l);
        let [q, q_u, q_l, q_uu, q_ll] = self.torque.expansion(u, l);
        Expansion {
            value: [f, q],
            slopes: [[f_u, q_u], [f_l, q_l]],
            curvatures: [[f_uu, q_uu], [f_ll, q_ll]],
        }
    }
}

/// Efforts `[f, Q]` of a unit, and by each throttle their slopes and their curvatures, which are half their
/// second derivatives.
#[derive(Clone, Copy)]
pub(crate) struct Expansion {
    pub(crate) value: [f32; 2],
    pub(crate) slopes: [[f32; 2]; 2],
    pub(crate) curvatures: [[f32; 2]; 2],
}

impl Expansion {
    /// Of a unit whose rotors are out.
    pub(crate) const NOTHING: Expansion = Expansion {
        value: [0.0; 2],
        slopes: [[0.0; 2]; 2],
        curvatures: [[0.0; 2]; 2],
    };
}

/// Value, slope and half the second derivative of `a x2 + b x + c` by Horner's rule.
#[inline(always)]
fn parabola<S: Scalar>([a, b, c]: [f32; 3], x: S) -> (S, S, f32) {
    let leading = x * a;
    let value = leading + b;
    (value * x + c, leading + value, a)
}

/// The same of `a x3 + b x2 + c x + d`.
#[inline(always)]
fn cubic<S: Scalar>([a, b, c, d]: [f32; 4], x: S) -> (S, S, S) {
    let (value, slope, _) = parabola([a, b, c], x);
    (value * x + d, slope * x + value, x * a + slope)
}

impl Quantity for Biquadratic {
    #[inline(always)]
    fn value<S: Scalar>(&self, u: S, l: S) -> S {
        let [c0, c1, c2, c3, c4, c5, c6, c7] = self.0;
        let p2 = (l * c0 + c1) * l + c2;
        let p1 = (l * c3 + c4) * l + c5;
        let p0 = (l * c6 + c7) * l;
        (p2 * u + p1) * u + p0
    }

    #[inline(always)]
    fn expansion<S: Scalar>(&self, u: S, l: S) -> [S; 5] {
        let [c0, c1, c2, c3, c4, c5, c6, c7] = self.0;
        let (p2, p2_l, _) = parabola([c0, c1, c2], l);
        let (p1, p1_l, _) = parabola([c3, c4, c5], l);
        let q0 = l * c6 + c7;
        let (p0, p0_l) = (q0 * l, l * c6 + q0);
        let leading = p2 * u;
        let value = leading + p1;
        [
            value * u + p0,
            leading + value,
            (p2_l * u + p1_l) * u + p0_l,
            p2,
            (u * c0 + c3) * u + c6,
        ]
    }
}

impl Quantity for Cubic {
    #[inline(always)]
    fn value<S: Scalar>(&self, u: S, l: S) -> S {
        let [c0, c1, c2, c3, c4, c5, c6, c7, c8] = self.0;
        let p2 = l * c1 + c4;
        let p1 = (l * c2 + c5) * l + c7;
        let p0 = ((l * c3 + c6) * l + c8) * l;
        ((u * c0 + p2) * u + p1) * u + p0
    }

    #[inline(always)]
    fn expansion<S: Scalar>(&self, u: S, l: S) -> [S; 5] {
        let [c0, c1, c2, c3, c4, c5, c6, c7, c8] = self.0;
        let p2 = l * c1 + c4;
        let (p1, p1_l, _) = parabola([c2, c5, c7], l);
        let (q0, q0_l, _) = parabola([c3, c6, c8], l);
        let (p0, p0_l) = (q0 * l, q0_l * l + q0);
        let leading = u * c0;
        let inner = leading + p2;
        let (value, slope) = (inner * u + p1, leading + inner);
        [
            value * u + p0,
            slope * u + value,
            (u * c1 + p1_l) * u + p0_l,
            leading + slope,
            u * c2 + (l * c3 + q0_l),
        ]
    }
}

impl Quantity for Quartic {
    #[inline(always)]
    fn value<S: Scalar>(&self, u: S, l: S) -> S {
        let [c0, c1, c2, c3, c4, c5, c6, c7, c8, c9, c10, c11, c12, c13] = self.0;
        let p3 = l * c1 + c5;
        let p2 = (l * c2 + c6) * l + c9;
        let p1 = ((l * c3 + c7) * l + c10) * l + c12;
        let p0 = (((l * c4 + c8) * l + c11) * l + c13) * l;
        (((u * c0 + p3) * u + p2) * u + p1) * u + p0
    }

    #[inline(always)]
    fn expansion<S: Scalar>(&self, u: S, l: S) -> [S; 5] {
        let [c0, c1, c2, c3, c4, c5, c6, c7, c8, c9, c10, c11, c12, c13] = self.0;
        let p3 = l * c1 + c5;
        let (p2, p2_l, _) = parabola([c2, c6, c9], l);
        let (p1, p1_l, p1_ll) = cubic([c3, c7, c10, c12], l);
        let (q0, q0_l, q0_ll) = cubic([c4, c8, c11, c13], l);
        let (p0, p0_l) = (q0 * l, q0_l * l + q0);
        let leading = u * c0;
        let inner = leading + p3;
        let (outer, outer_u) = (inner * u + p2, leading + inner);
        let (value, slope) = (outer * u + p1, outer_u * u + outer);
        [
            value * u + p0,
            slope * u + value,
            ((u * c1 + p2_l) * u + p1_l) * u + p0_l,
            (leading + outer_u) * u + slope,
            (u * c2 + p1_ll) * u + (q0_ll * l + q0_l),
        ]
    }
}

#[cfg(test)]
mod tests;
