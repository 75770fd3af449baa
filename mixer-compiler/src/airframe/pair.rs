//! The model of one pair: total thrust and torque as polynomials of the two throttles.

use toml::Spanned;

use super::basis::Basis;
use super::check::{LARGEST_EFFORT, word};
use super::power::{self, Power};
use super::rotor_alone::{self, RotorAlone};
use super::throttle::Throttle;
use super::uncertainty::{self, Uncertainty};
use crate::diagnostic::{Code, Diagnostic, number};
use crate::spec;

/// Sense of rotation of a unit's upper rotor, seen from above. The lower rotor turns the other way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spin {
    /// Clockwise.
    Cw,
    /// Counter-clockwise.
    Ccw,
}

impl Spin {
    /// The words in the file.
    pub(crate) const WORDS: [(&'static str, Spin); 2] = [("cw", Spin::Cw), ("ccw", Spin::Ccw)];

    /// The word in the file.
    pub fn name(self) -> &'static str {
        match self {
            Spin::Cw => "cw",
            Spin::Ccw => "ccw",
        }
    }

    /// The sense in words.
    pub(crate) fn in_words(self) -> &'static str {
        match self {
            Spin::Cw => "clockwise",
            Spin::Ccw => "counter-clockwise",
        }
    }

    /// The other sense.
    #[must_use]
    pub fn reversed(self) -> Spin {
        match self {
            Spin::Cw => Spin::Ccw,
            Spin::Ccw => Spin::Cw,
        }
    }
}

/// Total thrust and torque of one pair at the reference voltage, as measured on the bench.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Pair {
    /// Terms of both polynomials.
    pub basis: Basis,
    /// Coefficients of the thrust, N, one per term of [`Basis::exponents`], each within 1e6.
    pub thrust_n: Vec<f64>,
    /// Coefficients of the torque, N m, one per term, signed as on the bench, each within 1e6.
    pub torque_nm: Vec<f64>,
    /// Spin of the upper rotor on the bench.
    pub upper_spin: Spin,
    /// The upper rotor alone; `None` where the polynomials at l = 0 stand for it.
    pub lower_out: Option<RotorAlone>,
    /// The lower rotor alone; `None` where the polynomials at u = 0 stand for it.
    pub upper_out: Option<RotorAlone>,
    /// Electrical power; `None` where the file has no `[pair.power]`.
    pub power: Option<Power>,
    /// Error of the model; `None` where the file has no `[pair.uncertainty]`.
    pub uncertainty: Option<Uncertainty>,
}

pub(super) fn check(
    pair: &spec::Pair,
    throttle: Option<&Throttle>,
    faults: &mut Vec<Diagnostic>,
) -> Option<Pair> {
    let bases = Basis::ALL.map(|basis| (basis.name(), basis));
    let basis = pair
        .basis
        .as_ref()
        .and_then(|field| word(field, "pair.basis", &bases, faults));
    let thrust_n = coefficients("pair.thrust_n", pair.thrust_n.as_ref(), basis, faults);
    let torque_nm = coefficients("pair.torque_nm", pair.torque_nm.as_ref(), basis, faults);
    let upper_spin = pair
        .upper_spin
        .as_ref()
        .and_then(|field| word(field, "pair.upper_spin", &Spin::WORDS, faults));
    let mut alone = |key, table: &Option<spec::RotorAlone>, sign| {
        let table = table.as_ref()?;
        Some(rotor_alone::check(key, table, sign, throttle, faults))
    };
    let lower_out = alone("lower_out", &pair.lower_out, -1.0);
    let upper_out = alone("upper_out", &pair.upper_out, 1.0);
    let power = pair
        .power
        .as_ref()
        .map(|table| power::check(table, throttle, faults));
    let uncertainty = pair.uncertainty.as_ref();
    let uncertainty = uncertainty.map(|table| uncertainty::check(table, faults));
    Some(Pair {
        uncertainty: uncertainty.map_or(Some(None), |checked| checked.map(Some))?,
        power: power.map_or(Some(None), |power| power.map(Some))?,
        lower_out: lower_out.map_or(Some(None), |alone| alone.map(Some))?,
        upper_out: upper_out.map_or(Some(None), |alone| alone.map(Some))?,
        basis: basis?,
        thrust_n: thrust_n?,
        torque_nm: torque_nm?,
        upper_spin: upper_spin?,
    })
}

fn coefficients(
    key: &str,
    field: Option<&Spanned<Vec<Spanned<f64>>>>,
    basis: Option<Basis>,
    faults: &mut Vec<Diagnostic>,
) -> Option<Vec<f64>> {
    let (field, basis) = (field?, basis?);
    let (found, terms) = (field.get_ref().len(), basis.exponents().len());
    if found != terms {
        let fits = Basis::ALL
            .into_iter()
            .find(|other| other.exponents().len() == found);
        let help = match fits {
            Some(other) => format!("{found} coefficients are those of basis = \"{}\"", other.name()),
            None => format!(
                "the terms are {}, in this order; a term that is not needed is 0",
                basis.terms()
            ),
        };
        faults.push(
            Diagnostic::new(
                Code::WrongLength,
                key,
                field.span(),
                format!(
                    "`{key}` has {found} coefficients, basis \"{}\" takes {terms}",
                    basis.name()
                ),
            )
            .label(format!("expected {terms} numbers"))
            .help(help),
        );
        return None;
    }
    let mut coefficients = Vec::with_capacity(terms);
    for written in field.get_ref() {
        let coefficient = *written.get_ref();
        if coefficient.abs() <= LARGEST_EFFORT {
            coefficients.push(coefficient);
            continue;
        }
        let (coefficient, largest) = (number(coefficient), number(LARGEST_EFFORT));
        faults.push(
            Diagnostic::new(
                Code::OutOfRange,
                key,
                written.span(),
                format!("a coefficient of {coefficient} in `{key}` is beyond {largest}"),
            )
            .label("no rotor gives that")
            .help("the throttles of the polynomial run from 0 to 1, not in microseconds"),
        );
    }
    (coefficients.len() == terms).then_some(coefficients)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terms_follow_the_contract() {
        assert_eq!(Basis::Biquadratic.terms(), "u2l2, u2l, u2, ul2, ul, u, l2, l");
        assert_eq!(Basis::Cubic.terms(), "u3, u2l, ul2, l3, u2, ul, l2, u, l");
        assert_eq!(
            Basis::Quartic.terms(),
            "u4, u3l, u2l2, ul3, l4, u3, u2l, ul2, l3, u2, ul, l2, u, l"
        );
    }
}
