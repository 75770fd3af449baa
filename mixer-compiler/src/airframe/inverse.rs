//! How the pair's map is to be inverted, and how truly.

use crate::diagnostic::Code;
use crate::spec::Fields;
use crate::spec::keys::{Range, ValueKind, keys};

/// Highest degree of the paper's polynomial in (f, Q): 136 terms per throttle.
const HIGHEST_INVERSE_DEGREE: usize = 15;

/// What `method` can be.
const METHODS: [&str; 2] = ["auto", "polynomial"];

keys! { TABLE = "[inverse]":
    THRUST_TOLERANCE_N "thrust_tolerance_n" = "0.01", ValueKind::Number(Range::Positive),
        "What a unit's thrust may miss at any voltage and density, N; where it is left out, a thousandth of the least unit's largest thrust, if that is less.".default(THRUST_TOLERANCE)
        .refusing("must be above 0", "the largest error that the mixer may make; 0.01 N is the default");
    TORQUE_TOLERANCE_NM "torque_tolerance_nm" = "1e-4", ValueKind::Number(Range::Positive),
        "What a unit's torque may miss at any voltage and density, N m; where it is left out, a thousandth of the least unit's largest torque, if that is less.".default(TORQUE_TOLERANCE)
        .refusing("must be above 0", "the largest error that the mixer may make; 0.0001 N m is the default");
    METHOD "method" = "\"auto\"", ValueKind::Word(&METHODS),
        "auto: the cheapest evaluator that is proven to meet the tolerances; polynomial: the paper's, with a degree.";
    DEGREE "degree" = "7", ValueKind::Count([1, HIGHEST_INVERSE_DEGREE]),
        "Total degree of method = \"polynomial\".";
}

/// Tolerances of the thrust, N, and of the torque, N m, where the file has none.
const THRUST_TOLERANCE: f64 = 0.01;
const TORQUE_TOLERANCE: f64 = 1e-4;

/// Which evaluator of the inverse to emit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// The cheapest that meets the tolerances.
    Auto,
    /// The paper's: two polynomials in (f, Q).
    Polynomial {
        /// Total degree, 1 to 15.
        degree: usize,
    },
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

impl Inverse {
    /// Largest errors of thrust, N, and torque, N m.
    pub fn tolerances(&self) -> [f64; 2] {
        [self.thrust_tolerance_n, self.torque_tolerance_nm]
    }
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
    let method = method(table);
    Some(Inverse {
        thrust_tolerance_n: thrust?,
        torque_tolerance_nm: torque?,
        method: method?,
    })
}

fn method(table: &mut Fields<'_, '_>) -> Option<Method> {
    let degree = table.read::<usize>(&DEGREE).map(|degree| *degree.get_ref());
    let name = match table.read(&METHOD) {
        Some(written) => table.meaning(&METHOD, &written, &METHODS)?,
        None => "auto",
    };
    match (name, degree) {
        ("polynomial", Some(degree)) if (1..=HIGHEST_INVERSE_DEGREE).contains(&degree) => {
            Some(Method::Polynomial { degree })
        }
        ("polynomial", Some(degree)) => {
            let message =
                format!("`inverse.degree` = {degree} is not between 1 and {HIGHEST_INVERSE_DEGREE}");
            let label = format!("expected 1 to {HIGHEST_INVERSE_DEGREE}");
            let help = "errors shrink slowly with the degree; `method = \"auto\"` finds a cheaper evaluator";
            table.refuse(&DEGREE, Code::OutOfRange, message, label, help)
        }
        // A degree of a wrong shape was reported; saying that it is missing would be wrong.
        ("polynomial", None) if table.key_place(&DEGREE).is_some() => None,
        ("polynomial", None) => {
            let message = "`inverse.degree` is missing: the polynomial has no degree of its own".to_owned();
            let help = format!("add `degree = 7`; 1 to {HIGHEST_INVERSE_DEGREE} are possible");
            table.refuse(&METHOD, Code::MissingKey, message, "needs `degree`", help)
        }
        (name, Some(degree)) => {
            let message = format!("`inverse.degree` = {degree} means nothing to method \"{name}\"");
            let help = "remove it, or set `method = \"polynomial\"`";
            table.refuse(&DEGREE, Code::Conflict, message, "only for the polynomial", help)
        }
        (_, None) => Some(Method::Auto),
    }
}
