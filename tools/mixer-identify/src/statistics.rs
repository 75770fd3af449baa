//! What fits ask of numbers.

/// a b.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A x, A by rows.
pub(crate) fn times(rows: &[Vec<f64>], x: &[f64]) -> Vec<f64> {
    rows.iter().map(|row| dot(row, x)).collect()
}

/// The least and the greatest.
pub(crate) fn extent(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let values = values.into_iter();
    values.fold([f64::MAX, f64::MIN], |[a, b], x| [a.min(x), b.max(x)])
}

/// The greatest size.
pub(crate) fn greatest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, x| most.max(x.abs()))
}

/// The mean of the finite ones, of equal ones that itself in every digit; NaN where there are none.
pub(crate) fn mean_of_finite(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut finite = values.into_iter().filter(|x| x.is_finite());
    let Some(first) = finite.next() else {
        return f64::NAN;
    };
    let (sum, count) = finite.fold((0.0, 1.0), |(sum, count), x| (sum + (x - first), count + 1.0));
    first + sum / count
}

/// Root of the mean square.
pub(crate) fn rms(values: impl IntoIterator<Item = f64>) -> f64 {
    let values = values.into_iter();
    let (sum, count) = values.fold((0.0, 0), |(sum, count), x| (sum + x * x, count + 1));
    (sum / f64::from(count)).sqrt()
}

/// The middle one of the finite ones; none where there are none.
pub(crate) fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut finite: Vec<f64> = values.into_iter().filter(|x| x.is_finite()).collect();
    finite.sort_by(f64::total_cmp);
    finite.get(finite.len() / 2).copied()
}
