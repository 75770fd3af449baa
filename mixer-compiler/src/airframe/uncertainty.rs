//! How far the model of the pair may be from the pair itself.

use toml::Spanned;

use crate::diagnostic::{Code, Diagnostic, number};
use crate::spec;

/// `[pair.uncertainty]`: one standard deviation of the model's error.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Uncertainty {
    /// Of the thrust, % of full scale, above 0, at most 100.
    pub thrust_percent: f64,
    /// Of the torque, % of full scale, above 0, at most 100.
    pub torque_percent: f64,
}

pub(super) fn check(table: &spec::Uncertainty, faults: &mut Vec<Diagnostic>) -> Option<Uncertainty> {
    let thrust = percent("thrust_percent", table.thrust_percent.as_ref(), faults);
    let torque = percent("torque_percent", table.torque_percent.as_ref(), faults);
    Some(Uncertainty {
        thrust_percent: thrust?,
        torque_percent: torque?,
    })
}

fn percent(name: &str, field: Option<&Spanned<f64>>, faults: &mut Vec<Diagnostic>) -> Option<f64> {
    let field = field?;
    let percent = *field.get_ref();
    if percent > 0.0 && percent <= 100.0 {
        return Some(percent);
    }
    let key = format!("pair.uncertainty.{name}");
    let message = format!("`{key}` = {} is not above 0 and at most 100", number(percent));
    faults.push(
        Diagnostic::new(Code::OutOfRange, key, field.span(), message)
            .label("expected per cent of full scale")
            .help("one standard deviation; leave `[pair.uncertainty]` out where it is not known"),
    );
    None
}
