//! How thrust and torque follow the supply voltage: f(V) = k_f(V) f, Q(V) = k_Q(V) Q, with k = 1 at the
//! reference voltage.
//!
//! A polynomial law is proven to stay above a least factor over the range by its Bernstein coefficients: a polynomial of degree n on
//! [0, 1] lies between the least and the greatest of b_i = sum over j <= i of C(i,j)/C(n,j) a_j, so what is left of
//! it above that factor is positive where all b_i are. Where they are not, the interval is halved (de Casteljau) until they are, or until an end of
//! an interval is itself not positive.

use std::ops::Range;

use toml::Spanned;

use crate::diagnostic::{Code, Diagnostic, any_of, number, rounded};
use crate::spec;

/// How far k may be from 1 at the reference voltage: coefficients and points are written to three or four digits.
const REFERENCE_TOLERANCE: f64 = 1e-3;

/// Least k over the range. The mixer divides by k; below this a rotor hardly turns.
const LEAST_FACTOR: f64 = 1e-3;

/// Steepest power that is taken for a law. Thrust follows about V^1.75; V^3 would be power.
const LARGEST_EXPONENT: f64 = 4.0;

/// Highest degree of a polynomial law. Bench data support 1 or 2.
const HIGHEST_DEGREE: usize = 8;

/// Above this, millivolts were meant.
const LARGEST_V: f64 = 1000.0;

/// A law k(V) for thrust or torque.
#[derive(Clone, Debug, PartialEq)]
pub enum VoltageLaw {
    /// k = (V / Vref)^e.
    Exponent(f64),
    /// k = c0 + c1 x + c2 x^2 + .. with x = V / Vref.
    Polynomial(Vec<f64>),
    /// (V, k) by ascending V, joined by straight lines.
    Points(Vec<[f64; 2]>),
}

impl VoltageLaw {
    /// k at `volts`, dimensionless. Beyond the points of [`VoltageLaw::Points`], k of the nearest.
    pub fn factor(&self, volts: f64, reference_v: f64) -> f64 {
        match self {
            VoltageLaw::Exponent(exponent) => libm::pow(volts / reference_v, *exponent),
            VoltageLaw::Polynomial(coefficients) => horner(coefficients, volts / reference_v),
            VoltageLaw::Points(points) => between_points(points, volts),
        }
    }
}

fn horner(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

fn between_points(points: &[[f64; 2]], volts: f64) -> f64 {
    let after = points
        .iter()
        .position(|point| point[0] > volts)
        .unwrap_or(points.len());
    match (
        after.checked_sub(1).and_then(|before| points.get(before)),
        points.get(after),
    ) {
        (Some([v0, k0]), Some([v1, k1])) => k0 + (k1 - k0) * ((volts - v0) / (v1 - v0)),
        (Some([_, k]), None) | (None, Some([_, k])) => *k,
        (None, None) => 1.0,
    }
}

/// The supply and its effect.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Voltage {
    /// Voltage of the bench model, V, within the range.
    pub reference_v: f64,
    /// Lowest and highest voltage in flight, V, 0 < lowest < highest. Beyond it the mixer clamps and flags.
    pub range_v: [f64; 2],
    /// Law of the thrust, positive over the range (k >= 1e-3), 1 within 1e-3 at the reference.
    pub thrust: VoltageLaw,
    /// Law of the torque, likewise.
    pub torque: VoltageLaw,
}

impl Voltage {
    /// k_f at `volts`, dimensionless.
    pub fn thrust_factor(&self, volts: f64) -> f64 {
        self.thrust.factor(volts, self.reference_v)
    }

    /// k_Q at `volts`, dimensionless.
    pub fn torque_factor(&self, volts: f64) -> f64 {
        self.torque.factor(volts, self.reference_v)
    }
}

pub(super) fn check(voltage: &spec::Voltage, faults: &mut Vec<Diagnostic>) -> Option<Voltage> {
    let supply = supply(voltage, faults);
    let thrust = law("thrust", &voltage.thrust, voltage, supply, faults);
    let torque = law("torque", &voltage.torque, voltage, supply, faults);
    let supply = supply?;
    Some(Voltage {
        reference_v: supply.reference_v,
        range_v: supply.range_v,
        thrust: thrust?,
        torque: torque?,
    })
}

/// Reference and range once they are sound.
#[derive(Clone, Copy)]
struct Supply {
    reference_v: f64,
    range_v: [f64; 2],
}

fn supply(voltage: &spec::Voltage, faults: &mut Vec<Diagnostic>) -> Option<Supply> {
    let range = voltage.range_v.as_ref()?;
    let [low, high] = range.get_ref().each_ref().map(|volts| *volts.get_ref());
    let fault =
        |message: String| Diagnostic::new(Code::VoltageRange, "voltage.range_v", range.span(), message);
    if low <= 0.0 || low >= high {
        let (low, high) = (number(low), number(high));
        faults.push(
            fault(format!(
                "the voltage range from {low} V to {high} V is empty or not positive"
            ))
            .label("expected [lowest, highest]")
            .help("write the pack's voltage under load when empty, then when full"),
        );
        return None;
    }
    if high > LARGEST_V {
        faults.push(
            fault(format!("a voltage of {} V is beyond {LARGEST_V} V", number(high)))
                .label("expected volts")
                .help(format!(
                    "if millivolts were meant, write {} V",
                    number(high / 1000.0)
                )),
        );
        return None;
    }
    let reference = voltage.reference_v.as_ref()?;
    let reference_v = *reference.get_ref();
    if !(low..=high).contains(&reference_v) {
        let (reference_v, low, high) = (number(reference_v), number(low), number(high));
        faults.push(
            Diagnostic::new(
                Code::VoltageRange,
                "voltage.reference_v",
                reference.span(),
                format!("the reference of {reference_v} V is outside the range from {low} V to {high} V"),
            )
            .label(format!("not in [{low}, {high}]"))
            .help(
                "the reference is the voltage at which the bench model holds; widen `range_v` to contain it",
            ),
        );
        return None;
    }
    Some(Supply {
        reference_v,
        range_v: [low, high],
    })
}

fn law(
    quantity: &str,
    forms: &spec::VoltageLaw,
    voltage: &spec::Voltage,
    supply: Option<Supply>,
    faults: &mut Vec<Diagnostic>,
) -> Option<VoltageLaw> {
    let path = |name: &str| format!("voltage.{name}");
    match forms.present.as_slice() {
        [] => {
            faults.push(
                Diagnostic::new(
                    Code::MissingKey,
                    format!("voltage.{quantity}_exponent"),
                    voltage.place.clone(),
                    format!("`[voltage]` says nothing of the {quantity}"),
                )
                .label(format!(
                    "no `{quantity}_exponent`, `{quantity}_polynomial` or `{quantity}_points`"
                ))
                .help(format!(
                    "where only one voltage was measured, `{quantity}_exponent = 1.75` is typical"
                )),
            );
            return None;
        }
        [_] => {}
        [(first, _), others @ ..] => {
            for (other, place) in others {
                faults.push(
                    Diagnostic::new(
                        Code::Conflict,
                        path(other),
                        place.clone(),
                        format!("`{other}` and `{first}` are two laws for the {quantity}"),
                    )
                    .label("second law")
                    .help(format!(
                        "keep one: {}",
                        any_of(forms.present.iter().map(|(name, _)| *name))
                    )),
                );
            }
            return None;
        }
    }
    let (name, _) = forms.present.first()?;
    let key = path(name);
    if let Some(field) = &forms.exponent {
        exponent(&key, field, supply, faults)
    } else if let Some(field) = &forms.polynomial {
        polynomial(&key, field, supply?, faults)
    } else {
        points(&key, forms.points.as_ref()?, supply?, faults)
    }
}

fn exponent(
    key: &str,
    field: &Spanned<f64>,
    supply: Option<Supply>,
    faults: &mut Vec<Diagnostic>,
) -> Option<VoltageLaw> {
    let exponent = *field.get_ref();
    if (0.0..=LARGEST_EXPONENT).contains(&exponent) {
        let (supply, law) = (supply?, VoltageLaw::Exponent(exponent));
        let low = supply.range_v[0];
        let k = law.factor(low, supply.reference_v);
        if k < LEAST_FACTOR {
            faults.push(too_small(key, field.span(), k, low).help("raise the lower end of `range_v`"));
            return None;
        }
        return Some(law);
    }
    faults.push(
        Diagnostic::new(
            Code::OutOfRange,
            key,
            field.span(),
            format!(
                "`{key}` = {} is not between 0 and {LARGEST_EXPONENT}",
                number(exponent)
            ),
        )
        .label("not a motor's exponent")
        .help("thrust and torque follow about the power 1.75 of the voltage"),
    );
    None
}

fn polynomial(
    key: &str,
    field: &Spanned<Vec<Spanned<f64>>>,
    supply: Supply,
    faults: &mut Vec<Diagnostic>,
) -> Option<VoltageLaw> {
    let coefficients: Vec<f64> = field.get_ref().iter().map(|c| *c.get_ref()).collect();
    if !(1..=HIGHEST_DEGREE + 1).contains(&coefficients.len()) {
        faults.push(
            Diagnostic::new(
                Code::WrongLength,
                key,
                field.span(),
                format!(
                    "`{key}` has {} coefficients, not 1 to {}",
                    coefficients.len(),
                    HIGHEST_DEGREE + 1
                ),
            )
            .label("c0, c1, .. in V/Vref")
            .help("two or three are enough for a measured pack"),
        );
        return None;
    }
    let range = supply.range_v.map(|volts| volts / supply.reference_v);
    if let Some((x, k)) = below_least(&coefficients, range) {
        faults.push(
            too_small(key, field.span(), k, x * supply.reference_v)
                .help("the coefficients multiply 1, V/Vref, (V/Vref)^2, .., not volts"),
        );
        return None;
    }
    let law = VoltageLaw::Polynomial(coefficients);
    one_at_reference(key, field.span(), &law, "coefficient", supply, faults)?;
    Some(law)
}

fn points(
    key: &str,
    field: &Spanned<Vec<spec::Point>>,
    supply: Supply,
    faults: &mut Vec<Diagnostic>,
) -> Option<VoltageLaw> {
    let before = faults.len();
    let fault = |code, place: Range<usize>, message: String| Diagnostic::new(code, key, place, message);
    let points: Vec<[f64; 2]> = field
        .get_ref()
        .iter()
        .map(|point| point.get_ref().each_ref().map(|x| *x.get_ref()))
        .collect();
    let [low, high] = supply.range_v;
    for (index, (&[volts, k], written)) in points.iter().zip(field.get_ref()).enumerate() {
        if let Some(&[previous, _]) = index.checked_sub(1).and_then(|index| points.get(index))
            && volts <= previous
        {
            let (volts, previous) = (number(volts), number(previous));
            faults.push(
                fault(
                    Code::VoltagePoints,
                    written.span(),
                    format!("{volts} V does not come after {previous} V"),
                )
                .label("expected ascending voltages")
                .help("sort the points by voltage and keep one at each"),
            );
        }
        if k < LEAST_FACTOR {
            faults.push(
                too_small(key, written.span(), k, volts)
                    .help("a point is [volts, factor], the factor relative to the reference voltage"),
            );
        }
    }
    let covered = points
        .first()
        .zip(points.last())
        .filter(|(first, last)| first[0] <= low && high <= last[0]);
    if covered.is_none() && faults.len() == before {
        let reach = match (points.first(), points.last()) {
            (Some(first), Some(last)) => {
                format!("reaches from {} V to {} V", number(first[0]), number(last[0]))
            }
            _ => "is empty".to_string(),
        };
        faults.push(
            fault(
                Code::VoltagePoints,
                field.span(),
                format!(
                    "`{key}` {reach}, `range_v` from {} V to {} V",
                    number(low),
                    number(high)
                ),
            )
            .label("does not cover `range_v`")
            .help("add measured points at both ends, or narrow `range_v`"),
        );
    }
    if faults.len() > before {
        return None;
    }
    let law = VoltageLaw::Points(points);
    one_at_reference(key, field.span(), &law, "factor", supply, faults)?;
    Some(law)
}

fn too_small(key: &str, place: Range<usize>, k: f64, volts: f64) -> Diagnostic {
    let (k, volts) = (rounded(k), rounded(volts));
    Diagnostic::new(
        Code::VoltageNotPositive,
        key,
        place,
        format!("`{key}` falls to {k} at {volts} V"),
    )
    .label(format!("must stay above {LEAST_FACTOR} over `range_v`"))
}

fn one_at_reference(
    key: &str,
    place: Range<usize>,
    law: &VoltageLaw,
    parts: &str,
    supply: Supply,
    faults: &mut Vec<Diagnostic>,
) -> Option<()> {
    let k = law.factor(supply.reference_v, supply.reference_v);
    if (k - 1.0).abs() <= REFERENCE_TOLERANCE {
        return Some(());
    }
    let (k, volts) = (rounded(k), number(supply.reference_v));
    faults.push(
        Diagnostic::new(
            Code::VoltageNotOne,
            key,
            place,
            format!("`{key}` is {k} at the reference of {volts} V"),
        )
        .label("must be 1 there, within 0.001")
        .help(format!(
            "divide every {parts} by {k}, or set `reference_v` to the voltage of the bench model"
        )),
    );
    None
}

/// Where on [a, b] the polynomial is not above the least factor, and its value there; `None` where it is proven to
/// be. The place is that of the least value among the found one and a fine grid.
fn below_least(coefficients: &[f64], [a, b]: [f64; 2]) -> Option<(f64, f64)> {
    // Shift and scale to t in [0, 1], x = a + (b - a) t, by repeated synthetic division.
    let mut c = coefficients.to_vec();
    let n = c.len().checked_sub(1)?;
    c[0] -= LEAST_FACTOR;
    for i in 0..n {
        for j in (i..n).rev() {
            c[j] += a * c[j + 1];
        }
    }
    let mut scale = 1.0;
    for c in &mut c {
        *c *= scale;
        scale *= b - a;
    }
    let bernstein: Vec<f64> = (0..=n)
        .map(|i| (0..=i).map(|j| choose(i, j) / choose(n, j) * c[j]).sum())
        .collect();
    let found = descend(bernstein, 0.0, 1.0, 0)?;
    const GRID: usize = 256;
    let grid = (0..=GRID).map(|i| i as f64 / GRID as f64);
    let worst = grid
        .chain([found])
        .map(|t| a + (b - a) * t)
        .map(|x| (x, horner(coefficients, x)));
    worst.min_by(|(_, k), (_, other)| k.total_cmp(other))
}

/// A place t in [t0, t1] where the polynomial with these Bernstein coefficients is not positive.
fn descend(bernstein: Vec<f64>, t0: f64, t1: f64, depth: usize) -> Option<f64> {
    // A polynomial that touches zero within 2^-30 of the range is taken for one that reaches it.
    const DEEPEST: usize = 30;
    if bernstein.iter().all(|&b| b > 0.0) {
        return None;
    }
    let is_positive = |b: Option<&f64>| b.is_some_and(|&b| b > 0.0);
    if !is_positive(bernstein.first()) || depth == DEEPEST {
        return Some(t0);
    }
    if !is_positive(bernstein.last()) {
        return Some(t1);
    }
    let (mut left, mut right) = (Vec::new(), bernstein);
    let mut tail = Vec::new();
    while let (Some(&first), Some(&last)) = (right.first(), right.last()) {
        left.push(first);
        tail.push(last);
        right = right.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
    }
    tail.reverse();
    let middle = 0.5 * (t0 + t1);
    descend(left, t0, middle, depth + 1).or_else(|| descend(tail, middle, t1, depth + 1))
}

/// Binomial coefficient, for n <= 8.
fn choose(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |product, i| product * (n - i) as f64 / (i + 1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn laws_give_their_factors() {
        let reference = 14.8;
        assert_eq!(VoltageLaw::Exponent(2.0).factor(29.6, reference), 4.0);
        assert_eq!(
            VoltageLaw::Polynomial(vec![-0.5, 1.5]).factor(29.6, reference),
            2.5
        );
        let points = VoltageLaw::Points(vec![[10.0, 0.5], [14.0, 1.0], [15.0, 2.0]]);
        assert_eq!(
            [9.0, 10.0, 12.0, 14.0, 14.5, 15.0, 16.0].map(|v| points.factor(v, reference)),
            [0.5, 0.5, 0.75, 1.0, 1.5, 2.0, 2.0]
        );
    }

    #[test]
    fn positivity_is_decided_between_the_ends() {
        // (x - 1)^2 + d: positive at both ends of [0.8, 1.2], least at 1.
        for (d, positive) in [(1.001e-3, true), (0.999e-3, false), (0.0, false), (-1e-6, false)] {
            assert_eq!(
                below_least(&[1.0 + d, -2.0, 1.0], [0.8, 1.2]).is_none(),
                positive,
                "{d}"
            );
        }
        let (x, k) = below_least(&[-1.0, 1.0], [0.8, 1.2]).unwrap();
        assert!((x - 0.8).abs() < 1e-12 && (k + 0.2).abs() < 1e-12, "{x} {k}");
        assert!(below_least(&[1.0], [0.8, 1.2]).is_none());
        // Degree 8, positive with negative coefficients: 1 - 0.9 x^8 / 1.2^8.
        let mut eight = [0.0; 9];
        eight[0] = 1.0;
        eight[8] = -0.9 / 4.299_816_96;
        assert!(below_least(&eight, [0.1, 1.2]).is_none());
    }
}
