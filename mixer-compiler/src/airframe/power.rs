//! `[pair.power]`: the electrical power of one pair over its throttles.

use super::basis::{Basis, value_of_terms};
use super::limits;
use super::throttle::Throttle;
use crate::diagnostic::Code;
use crate::spec::Fields;
use crate::spec::keys::{ValueKind, keys};

/// Coefficients of a power map: the quartic's and a constant.
const POWER_TERMS: usize = 15;

keys! { TABLE = "[pair.power]":
    POWER_W "power_w" = "[0, 0, 0, 0, 0, 620, 90, 40, 560, 160, -60, 150, 8, 6, 5]", ValueKind::Numbers([POWER_TERMS, POWER_TERMS]),
        "Electrical power of both rotors, W: the quartic's coefficients and a constant; `identify` writes it.".required();
}

/// `[pair.power]`: what `check` and the report say of power comes from it, nothing else does.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Power {
    /// Coefficients, W: the quartic's in their order, then a constant, as standby takes some. The
    /// power is positive over the throttle range.
    pub power_w: Vec<f64>,
}

impl Power {
    /// A map that holds for throttles from `min` to `max` of both rotors.
    ///
    /// # Errors
    /// What is wrong with it: power that is not positive, or that does not grow from idle to full
    /// throttle.
    pub fn over(power_w: Vec<f64>, [min, max]: [f64; 2]) -> Result<Power, String> {
        let along = |k: u32| min + (max - min) * f64::from(k) / f64::from(STEPS);
        let places = (0..=STEPS).flat_map(|i| (0..=STEPS).map(move |k| [along(i), along(k)]));
        let powers = places.map(|at| (value(&power_w, at), at));
        let (least, [u, l]) = powers.fold((f64::INFINITY, [min; 2]), |least, here| {
            if here.0 < least.0 { here } else { least }
        });
        let [idle, full] = [min, max].map(|throttle| value(&power_w, [throttle; 2]));
        if least <= 0.0 {
            Err(format!("is {least:.1} W at (u, l) = ({u:.2}, {l:.2})"))
        } else if full <= idle {
            Err(format!(
                "falls from {idle:.1} W at idle to {full:.1} W at full throttle"
            ))
        } else {
            Ok(Power { power_w })
        }
    }

    /// Power of both rotors at `[u, l]`, W.
    pub(crate) fn at(&self, [u, l]: [f64; 2]) -> f64 {
        value(&self.power_w, [u, l])
    }
}

/// Throttles per side of the range at which the power is looked at.
const STEPS: u32 = 64;

pub(super) fn read(table: &mut Fields<'_, '_>, throttle: Option<&Throttle>) -> Option<Power> {
    let key = table.key_path(POWER_W.name);
    let terms = format!("the terms are {}, 1, in this order", Basis::Quartic.terms());
    let what = ("a power map", POWER_TERMS);
    let power_w = limits::coefficients(table, &POWER_W, what, |_| terms.clone())?;
    let Throttle { min, max } = throttle?;
    Power::over(power_w, [*min, *max]).map(Some).unwrap_or_else(|reason| {
        let message = format!("the power of `{key}` {reason}");
        let label = "must be positive and grow with the throttles";
        let help = format!(
            "{terms}; `cargo mixer identify` writes them for the throttles it states; without [pair.power] only the \
             figures of power are missing"
        );
        table.refuse(&POWER_W, Code::PowerMap, message, label, help)
    })
}

fn value(coefficients: &[f64], at: [f64; 2]) -> f64 {
    let exponents = Basis::Quartic.exponents().iter().chain(&[(0, 0)]);
    value_of_terms(exponents, coefficients, at)
}
