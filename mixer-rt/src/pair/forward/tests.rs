use super::*;

/// The term orders of the airframe file, written out as exponents (u, l).
const BIQUADRATIC: [(i32, i32); 8] = [(2, 2), (2, 1), (2, 0), (1, 2), (1, 1), (1, 0), (0, 2), (0, 1)];
const CUBIC: [(i32, i32); 9] = [
    (3, 0),
    (2, 1),
    (1, 2),
    (0, 3),
    (2, 0),
    (1, 1),
    (0, 2),
    (1, 0),
    (0, 1),
];
const QUARTIC: [(i32, i32); 14] = [
    (4, 0),
    (3, 1),
    (2, 2),
    (1, 3),
    (0, 4),
    (3, 0),
    (2, 1),
    (1, 2),
    (0, 3),
    (2, 0),
    (1, 1),
    (0, 2),
    (1, 0),
    (0, 1),
];

fn power(x: f64, exponent: i32) -> f64 {
    (0..exponent).fold(1.0, |product, _| product * x)
}

/// Every term alone, against the definition in f64.
fn check<Q: Quantity, const TERMS: usize>(exponents: [(i32, i32); TERMS], quantity: fn([f32; TERMS]) -> Q) {
    for (index, (m, n)) in exponents.into_iter().enumerate() {
        let mut coefficients = [0.0; TERMS];
        coefficients[index] = 1.0;
        let quantity = quantity(coefficients);
        for (u, l) in [(0.1, 0.9), (0.7, 0.3), (1.0, 1.0), (0.45, 0.0), (0.0, 0.8)] {
            let (x, y) = (f64::from(u), f64::from(l));
            // The k-th derivative of x^n over k!.
            let part = |x: f64, n: i32, k: i32| match (n, k) {
                (n, 0) => power(x, n),
                (n, 1) if n >= 1 => f64::from(n) * power(x, n - 1),
                (n, 2) if n >= 2 => 0.5 * f64::from(n * (n - 1)) * power(x, n - 2),
                _ => 0.0,
            };
            let expected = [(0, 0), (1, 0), (0, 1), (2, 0), (0, 2)]
                .map(|(by_u, by_l)| part(x, m, by_u) * part(y, n, by_l));
            let got = quantity.expansion(u, l);
            for (got, expected) in got.into_iter().zip(expected) {
                assert!(
                    (f64::from(got) - expected).abs() < 1e-6,
                    "term {index} at ({u}, {l})"
                );
            }
            assert!((f64::from(quantity.value(u, l)) - expected[0]).abs() < 1e-6);
        }
    }
}

#[test]
fn terms_stand_in_the_order_of_the_file() {
    check(BIQUADRATIC, Biquadratic);
    check(CUBIC, Cubic);
    check(QUARTIC, Quartic);
}
