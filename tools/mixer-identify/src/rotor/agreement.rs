//! Whether rows of a pair agree with the runs of its rotors.
//!
//! The least sum of squares of the [`posterior`](mod@super::posterior) is chi squared of the rows under
//! what the runs predict. Where it is too large, the misfit is told with what to check.

use crate::refusal::Refusal;
use crate::rotor::interaction::Interaction;
use crate::rotor::posterior::{BETWEEN_SYSTEMS, Case, Posterior, fit};
use crate::statistics::rms;

/// Misfit above which rows are doubted, and refused. Four to twelve rows of seven maps with runs of
/// their rotors have up to 2 in 95 % and 4.5 in all; rows of other units, halved or of another voltage in
/// four places 5 and more (`tests/agreement.rs`).
const DOUBTED: f64 = 2.0;
/// As above.
const REFUSED: f64 = 5.0;

/// What people get wrong, the most frequent first.
const CHECK: &str = "the units of thrust and torque in both files (--unit), which rotor is the upper (--swap), that thrust and torque are \
                     of both rotors, each counted once, and that rows and run are of one propeller, motor and voltage";

/// The best constants for rows; `runs` are the files of the rotors, `places` those of the rows.
///
/// # Errors
/// Rows that cannot be of this pair.
pub fn agreed(
    start: Interaction,
    case: &Case,
    runs: &str,
    places: &[String],
    warnings: &mut Vec<String>,
) -> Result<Posterior, Refusal> {
    let found = fit(start, BETWEEN_SYSTEMS, std::slice::from_ref(case));
    if found.misfit <= DOUBTED {
        return Ok(found);
    }
    let told = format!("the rows miss what {runs} predicts by {}", missed(start, case));
    if found.misfit > REFUSED {
        let file = places.first().and_then(|place| place.rsplit_once(':'));
        return Err(Refusal::of(file.map_or("", |(file, _)| file), told, CHECK));
    }
    let wider = found.misfit.sqrt();
    warnings.push(format!(
        "{told}; the uncertainty is widened {wider:.1} times; check {CHECK}"
    ));
    Ok(found)
}

/// What the runs alone miss of rows.
fn missed(start: Interaction, case: &Case) -> String {
    let [thrust, torque] = [0, 1].map(|k| {
        let predicted = |&[u, l, ..]: &[f64; 4]| start.pair(&case.rotors, case.spacing_ratio, [u, l])[k];
        let rows = case.rows.iter().filter(|row| row[2 + k].is_finite());
        100.0 * rms(rows.map(|row| row[2 + k] - predicted(row))) / case.full_scale[k]
    });
    match torque.is_nan() {
        true => format!("{thrust:.1} % of thrust"),
        false => format!("{thrust:.1} % of thrust and {torque:.1} % of torque"),
    }
}
