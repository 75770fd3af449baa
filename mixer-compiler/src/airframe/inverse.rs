//! How the pair's map is to be inverted, and how truly.

use crate::diagnostic::{Code, Diagnostic, any_of, nearest, quoted};
use crate::spec::keys::{Kind, Range, keys};
use crate::spec::{Fields, Spanned};

/// Highest degree of the paper's polynomial in (f, Q): 136 terms per throttle.
const HIGHEST_INVERSE_DEGREE: usize = 15;

/// What `method` can be: a choice, the paper's polynomials, then the seeded evaluators by their cost.
pub(crate) const METHODS: [&str; 8] = [
    "auto",
    "polynomial",
    "bilinear-newton",
    "quadratic-newton",
    "cubic-newton",
    "bilinear-newton2",
    "quadratic-newton2",
    "cubic-newton2",
];

keys! { TABLE = "[inverse]":
    THRUST_TOLERANCE_N "thrust_tolerance_n" = "0.01", Kind::Number(Range::Positive),
        "What a unit's thrust may miss at any voltage, N.".default(THRUST_TOLERANCE)
        .refusing("must be above 0", "the largest error that the mixer may make; 0.01 N is the default");
    TORQUE_TOLERANCE_NM "torque_tolerance_nm" = "1e-4", Kind::Number(Range::Positive),
        "What a unit's torque may miss at any voltage, N m.".default(TORQUE_TOLERANCE)
        .refusing("must be above 0", "the largest error that the mixer may make; 0.0001 N m is the default");
    METHOD "method" = "\"auto\"", Kind::Word(&METHODS),
        "auto: the cheapest evaluator that is proven to meet the tolerances; polynomial: the paper's, with a degree; or one by name.";
    DEGREE "degree" = "7", Kind::Count([1, HIGHEST_INVERSE_DEGREE]),
        "Total degree of method = \"polynomial\".";
}

/// Tolerances of the thrust, N, and of the torque, N m, where the file has none.
const THRUST_TOLERANCE: f64 = 0.01;
const TORQUE_TOLERANCE: f64 = 1e-4;

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
            thrust_tolerance_n: THRUST_TOLERANCE,
            torque_tolerance_nm: TORQUE_TOLERANCE,
            method: Method::Auto,
        }
    }
}

pub(super) fn read(table: &mut Fields<'_, '_>) -> Option<Inverse> {
    let [thrust, torque] = [&THRUST_TOLERANCE_N, &TORQUE_TOLERANCE_NM].map(|key| table.number(key));
    let (method_field, degree) = (table.read(&METHOD), table.read(&DEGREE));
    let method = method(table, method_field.as_ref(), degree.as_ref());
    Some(Inverse {
        thrust_tolerance_n: thrust?,
        torque_tolerance_nm: torque?,
        method: method?,
    })
}

fn method(
    table: &mut Fields<'_, '_>,
    field: Option<&Spanned<String>>,
    degree: Option<&Spanned<usize>>,
) -> Option<Method> {
    let name = field.map_or("auto", |field| field.get_ref().as_str());
    if let ("polynomial", Some(field)) = (name, field) {
        return polynomial(table, field, degree);
    }
    if !METHODS.contains(&name) {
        let label = match nearest(name, METHODS) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "unknown method".to_string(),
        };
        let message = format!("`inverse.method` cannot be {}", quoted(name));
        let help = format!("write {}", any_of(METHODS));
        return table.refuse(&METHOD, Code::UnknownWord, message, label, help);
    }
    if let Some(degree) = degree {
        let message = format!(
            "`inverse.degree` = {} means nothing to method \"{name}\"",
            degree.get_ref()
        );
        let help = "remove it, or set `method = \"polynomial\"`";
        return table.refuse(&DEGREE, Code::Conflict, message, "only for the polynomial", help);
    }
    Some(match name {
        "auto" => Method::Auto,
        name => Method::Named(name.to_string()),
    })
}

fn polynomial(
    table: &mut Fields<'_, '_>,
    method: &Spanned<String>,
    degree: Option<&Spanned<usize>>,
) -> Option<Method> {
    let Some(field) = degree else {
        // A degree of a wrong shape was reported; saying that it is missing would be wrong.
        if !table.faults.iter().any(|fault| fault.key == "inverse.degree") {
            table.faults.push(
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
    table.refuse(
        &DEGREE,
        Code::OutOfRange,
        format!("`inverse.degree` = {degree} is not between 1 and {HIGHEST_INVERSE_DEGREE}"),
        format!("expected 1 to {HIGHEST_INVERSE_DEGREE}"),
        "errors shrink slowly with the degree; `method = \"auto\"` finds a cheaper evaluator",
    )
}
