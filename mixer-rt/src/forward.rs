//! The forward map of one unit: total thrust and torque as polynomials of both throttles (eq. (1)).
//!
//! Each basis is evaluated by Horner's rule as a polynomial in u whose coefficients are polynomials in l; neither
//! has a constant term, since a stopped pair gives nothing. The order of the terms is that of the airframe file.

/// A quantity of one unit, thrust in N or torque in N m, as a polynomial of the upper throttle `u` and the lower
/// throttle `l`, both in `[0, 1]`.
pub trait Quantity {
    /// The value at `(u, l)`.
    fn value(&self, u: f32, l: f32) -> f32;

    /// The value at `(u, l)` and its derivatives by `u` and by `l`.
    fn value_and_gradient(&self, u: f32, l: f32) -> [f32; 3];
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
    pub fn efforts(&self, [u, l]: [f32; 2]) -> [f32; 2] {
        [self.thrust.value(u, l), self.torque.value(u, l)]
    }
}

/// A polynomial's value and slope by Horner's rule, from its coefficients in descending order.
#[inline(always)]
fn horner<const TERMS: usize>(coefficients: [f32; TERMS], x: f32) -> (f32, f32) {
    let (mut value, mut slope) = (0.0, 0.0);
    let mut rest = coefficients.into_iter();
    if let Some(leading) = rest.next() {
        value = leading;
    }
    if let Some(second) = rest.next() {
        slope = value;
        value = value * x + second;
    }
    for coefficient in rest {
        slope = slope * x + value;
        value = value * x + coefficient;
    }
    (value, slope)
}

/// Combines the coefficients of powers of u, each as (value, slope by l) in descending order.
#[inline(always)]
fn with_gradient<const TERMS: usize>(powers: [(f32, f32); TERMS], u: f32) -> [f32; 3] {
    let (value, by_u) = horner(powers.map(|(value, _)| value), u);
    let (by_l, _) = horner(powers.map(|(_, slope)| slope), u);
    [value, by_u, by_l]
}

impl Quantity for Biquadratic {
    #[inline(always)]
    fn value(&self, u: f32, l: f32) -> f32 {
        let [c0, c1, c2, c3, c4, c5, c6, c7] = self.0;
        let p2 = (c0 * l + c1) * l + c2;
        let p1 = (c3 * l + c4) * l + c5;
        let p0 = (c6 * l + c7) * l;
        (p2 * u + p1) * u + p0
    }

    #[inline(always)]
    fn value_and_gradient(&self, u: f32, l: f32) -> [f32; 3] {
        let [c0, c1, c2, c3, c4, c5, c6, c7] = self.0;
        let p2 = horner([c0, c1, c2], l);
        let p1 = horner([c3, c4, c5], l);
        let p0 = without_constant([c6, c7], l);
        with_gradient([p2, p1, p0], u)
    }
}

impl Quantity for Cubic {
    #[inline(always)]
    fn value(&self, u: f32, l: f32) -> f32 {
        let [c0, c1, c2, c3, c4, c5, c6, c7, c8] = self.0;
        let p2 = c1 * l + c4;
        let p1 = (c2 * l + c5) * l + c7;
        let p0 = ((c3 * l + c6) * l + c8) * l;
        ((c0 * u + p2) * u + p1) * u + p0
    }

    #[inline(always)]
    fn value_and_gradient(&self, u: f32, l: f32) -> [f32; 3] {
        let [c0, c1, c2, c3, c4, c5, c6, c7, c8] = self.0;
        let p3 = (c0, 0.0);
        let p2 = horner([c1, c4], l);
        let p1 = horner([c2, c5, c7], l);
        let p0 = without_constant([c3, c6, c8], l);
        with_gradient([p3, p2, p1, p0], u)
    }
}

impl Quantity for Quartic {
    #[inline(always)]
    fn value(&self, u: f32, l: f32) -> f32 {
        let [c0, c1, c2, c3, c4, c5, c6, c7, c8, c9, c10, c11, c12, c13] = self.0;
        let p3 = c1 * l + c5;
        let p2 = (c2 * l + c6) * l + c9;
        let p1 = ((c3 * l + c7) * l + c10) * l + c12;
        let p0 = (((c4 * l + c8) * l + c11) * l + c13) * l;
        (((c0 * u + p3) * u + p2) * u + p1) * u + p0
    }

    #[inline(always)]
    fn value_and_gradient(&self, u: f32, l: f32) -> [f32; 3] {
        let [c0, c1, c2, c3, c4, c5, c6, c7, c8, c9, c10, c11, c12, c13] = self.0;
        let p4 = (c0, 0.0);
        let p3 = horner([c1, c5], l);
        let p2 = horner([c2, c6, c9], l);
        let p1 = horner([c3, c7, c10, c12], l);
        let p0 = without_constant([c4, c8, c11, c13], l);
        with_gradient([p4, p3, p2, p1, p0], u)
    }
}

/// [`horner`] of `x` times the polynomial: value and slope of a polynomial that has no constant term.
#[inline(always)]
fn without_constant<const TERMS: usize>(coefficients: [f32; TERMS], x: f32) -> (f32, f32) {
    let (value, slope) = horner(coefficients, x);
    (value * x, slope * x + value)
}

#[cfg(test)]
mod tests;
