//! What a law may multiply thrust and torque by.

use std::ops::Range;

use super::law::VoltageLaw;
use crate::diagnostic::{Code, Diagnostic, rounded};

/// Reference and range once they are sound.
#[derive(Clone, Copy)]
pub(super) struct Supply {
    pub(super) reference_v: f64,
    pub(super) range_v: [f64; 2],
}

/// Largest k over the range: ten times the voltage by the square. No pack does that, and larger
/// ones overflow.
const LARGEST_FACTOR: f64 = 100.0;

/// Voltages at which polynomials are looked at, over the range.
const STEPS: u32 = 64;

/// Refuses factors that overflow what is computed of them.
pub(super) fn not_too_large(
    key: &str,
    place: Range<usize>,
    law: &VoltageLaw,
    supply: Supply,
    faults: &mut Vec<Diagnostic>,
) -> Option<()> {
    let [low, high] = supply.range_v;
    let even = (0..=STEPS).map(|step| low + (high - low) * f64::from(step) / f64::from(STEPS));
    let own: &[[f64; 2]] = match law {
        VoltageLaw::Points(points) => points,
        _ => &[],
    };
    let all = even.chain(own.iter().map(|[volts, _]| *volts));
    let factors = all.map(|volts| (volts, law.factor(volts, supply.reference_v)));
    let (volts, k) = factors.max_by(|(_, a), (_, b)| a.total_cmp(b))?;
    if k <= LARGEST_FACTOR {
        return Some(());
    }
    let (k, volts) = (rounded(k), rounded(volts));
    faults.push(
        Diagnostic::new(
            Code::VoltageTooLarge,
            key,
            place,
            format!("`{key}` rises to {k} at {volts} V"),
        )
        .label(format!("must stay below {LARGEST_FACTOR} over `range_v`"))
        .help("the law is a factor, 1 at the reference voltage, not a thrust or a torque"),
    );
    None
}
