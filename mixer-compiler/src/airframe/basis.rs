//! The bases of the pair's polynomials.

use serde::Serialize;

/// The monomials u^a l^b of the pair's polynomials, u the upper and l the lower throttle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Basis {
    /// Degree 2 in each throttle without the constant, 8 terms: eq. (1) of Chebbi et al. 2020.
    Biquadratic,
    /// Total degree 3 without the constant, 9 terms.
    Cubic,
    /// Total degree 4 without the constant, 14 terms.
    Quartic,
}

/// Powers of one throttle in the terms of any basis, the power 0 included.
pub(crate) const POWERS: usize = 5;

impl Basis {
    /// All bases, by ascending number of terms.
    pub const ALL: [Basis; 3] = [Basis::Biquadratic, Basis::Cubic, Basis::Quartic];

    /// Their words in the file.
    pub(crate) const WORDS: [&'static str; 3] = ["biquadratic", "cubic", "quartic"];

    /// The word in the file.
    pub fn name(self) -> &'static str {
        Self::WORDS[self as usize]
    }

    /// Exponents (of u, of l) of each term, in the order of the file's coefficients. No term is
    /// constant: rotors that stand still give nothing.
    #[rustfmt::skip]
    pub const fn exponents(self) -> &'static [(u8, u8)] {
        match self {
            // u2l2, u2l, u2, ul2, ul, u, l2, l
            Basis::Biquadratic => &[(2, 2), (2, 1), (2, 0), (1, 2), (1, 1), (1, 0), (0, 2), (0, 1)],
            Basis::Cubic => &[
                (3, 0), (2, 1), (1, 2), (0, 3), // u3, u2l, ul2, l3
                (2, 0), (1, 1), (0, 2), // u2, ul, l2
                (1, 0), (0, 1), // u, l
            ],
            Basis::Quartic => &[
                (4, 0), (3, 1), (2, 2), (1, 3), (0, 4), // u4, u3l, u2l2, ul3, l4
                (3, 0), (2, 1), (1, 2), (0, 3), // then as the cubic
                (2, 0), (1, 1), (0, 2),
                (1, 0), (0, 1),
            ],
        }
    }

    /// Each term's name, like `u2l`, in the order of the file's coefficients.
    pub fn term_names(self) -> Vec<String> {
        let power = |letter: &str, exponent: u8| match exponent {
            0 => String::new(),
            1 => letter.to_string(),
            _ => format!("{letter}{exponent}"),
        };
        let exponents = self.exponents().iter();
        exponents.map(|&(u, l)| power("u", u) + &power("l", l)).collect()
    }

    /// The terms in words, like `u2l2, u2l, ..`.
    pub(crate) fn terms(self) -> String {
        self.term_names().join(", ")
    }
}

/// `sum coefficient u^i l^j` at `[u, l]`.
pub(crate) fn value_of_terms<'a>(
    exponents: impl IntoIterator<Item = &'a (u8, u8)>,
    coefficients: &[f64],
    [u, l]: [f64; 2],
) -> f64 {
    let power = |x: f64, exponent: u8| (0..exponent).fold(1.0, |product, _| product * x);
    let terms = exponents.into_iter().zip(coefficients);
    terms.map(|(&(i, j), c)| c * power(u, i) * power(l, j)).sum()
}
