//! How the pair's map is to be inverted, and how truly.

use toml::Spanned;

use crate::diagnostic::{Code, Diagnostic, any_of, nearest, number, quoted};
use crate::spec;
use crate::spec::keys::{EVALUATORS, HIGHEST_INVERSE_DEGREE};

/// Which evaluator of the inverse to emit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Method {
    /// The cheapest that meets the tolerances.
    Auto,
    /// The paper's: two polynomials in (f, Q).
    Polynomial {
        /// Total degree, 1 to 15.
        degree: usize,
    },
    /// One of the evaluators, by its name.
    Named(String),
}

/// `[inverse]` with its defaults.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Inverse {
    /// Largest error of a unit's thrust, N, positive.
    pub thrust_tolerance_n: f64,
    /// Largest error of a unit's torque, N m, positive.
    pub torque_tolerance_nm: f64,
    /// Evaluator.
    pub method: Method,
}

impl Default for Inverse {
    fn default() -> Self {
        Self {
            thrust_tolerance_n: 0.01,
            torque_tolerance_nm: 1e-4,
            method: Method::Auto,
        }
    }
}

pub(super) fn check(inverse: &spec::Inverse, faults: &mut Vec<Diagnostic>) -> Option<Inverse> {
    let default = Inverse::default();
    let thrust = tolerance(
        "inverse.thrust_tolerance_n",
        inverse.thrust_tolerance_n.as_ref(),
        default.thrust_tolerance_n,
        "N",
        faults,
    );
    let torque = tolerance(
        "inverse.torque_tolerance_nm",
        inverse.torque_tolerance_nm.as_ref(),
        default.torque_tolerance_nm,
        "N m",
        faults,
    );
    let method = method(inverse, faults);
    Some(Inverse {
        thrust_tolerance_n: thrust?,
        torque_tolerance_nm: torque?,
        method: method?,
    })
}

fn tolerance(
    key: &str,
    field: Option<&Spanned<f64>>,
    default: f64,
    unit: &str,
    faults: &mut Vec<Diagnostic>,
) -> Option<f64> {
    let Some(field) = field else { return Some(default) };
    let tolerance = *field.get_ref();
    if tolerance > 0.0 {
        return Some(tolerance);
    }
    faults.push(
        Diagnostic::new(
            Code::OutOfRange,
            key,
            field.span(),
            format!("`{key}` = {} is not positive", number(tolerance)),
        )
        .label("must be above 0")
        .help(format!(
            "the largest error that the mixer may make; {} {unit} is the default",
            number(default)
        )),
    );
    None
}

fn method(inverse: &spec::Inverse, faults: &mut Vec<Diagnostic>) -> Option<Method> {
    let Some(field) = &inverse.method else {
        return no_degree(inverse, "auto", faults).then_some(Method::Auto);
    };
    match field.get_ref().as_str() {
        "auto" => no_degree(inverse, "auto", faults).then_some(Method::Auto),
        "polynomial" => polynomial(inverse, field, faults),
        name if EVALUATORS.contains(&name) => {
            no_degree(inverse, name, faults).then(|| Method::Named(name.to_string()))
        }
        name => {
            let words = || {
                ["auto", "polynomial"]
                    .into_iter()
                    .chain(EVALUATORS.iter().copied())
            };
            let label = match nearest(name, words()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => "unknown method".to_string(),
            };
            faults.push(
                Diagnostic::new(
                    Code::UnknownWord,
                    "inverse.method",
                    field.span(),
                    format!("`inverse.method` cannot be {}", quoted(name)),
                )
                .label(label)
                .help(format!("write {}", any_of(words()))),
            );
            None
        }
    }
}

fn polynomial(
    inverse: &spec::Inverse,
    method: &Spanned<String>,
    faults: &mut Vec<Diagnostic>,
) -> Option<Method> {
    let Some(field) = &inverse.degree else {
        // A degree of a wrong shape was reported and leaves no field; saying that it is missing
        // would be wrong.
        if !faults.iter().any(|fault| fault.key == "inverse.degree") {
            faults.push(
                Diagnostic::new(
                    Code::MissingKey,
                    "inverse.degree",
                    method.span(),
                    "`inverse.degree` is missing: the polynomial has no degree of its own",
                )
                .label("needs `degree`")
                .help(format!(
                    "add `degree = 7`; 1 to {HIGHEST_INVERSE_DEGREE} are possible"
                )),
            );
        }
        return None;
    };
    let degree = *field.get_ref();
    if (1..=HIGHEST_INVERSE_DEGREE).contains(&degree) {
        return Some(Method::Polynomial { degree });
    }
    faults.push(
        Diagnostic::new(
            Code::OutOfRange,
            "inverse.degree",
            field.span(),
            format!("`inverse.degree` = {degree} is not between 1 and {HIGHEST_INVERSE_DEGREE}"),
        )
        .label(format!("expected 1 to {HIGHEST_INVERSE_DEGREE}"))
        .help("errors shrink slowly with the degree; `method = \"auto\"` finds a cheaper evaluator"),
    );
    None
}

/// Notes a degree that nothing would use.
fn no_degree(inverse: &spec::Inverse, method: &str, faults: &mut Vec<Diagnostic>) -> bool {
    let Some(field) = &inverse.degree else { return true };
    let degree = field.get_ref();
    faults.push(
        Diagnostic::new(
            Code::Conflict,
            "inverse.degree",
            field.span(),
            format!("`inverse.degree` = {degree} means nothing to method \"{method}\""),
        )
        .label("only for the polynomial")
        .help("remove it, or set `method = \"polynomial\"`"),
    );
    false
}
