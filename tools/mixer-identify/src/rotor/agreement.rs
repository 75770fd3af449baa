//! Whether rows of a pair agree with the runs of its rotors, and which mistake explains it if they do
//! not.
//!
//! The least sum of squares of the [`posterior`](mod@super::posterior) is chi squared of the rows under
//! what the runs predict. A mistake exchanges the rotors, spoils one row, or multiplies thrust and
//! torque. Each is undone in turn, and the one that leaves the least is the likeliest.

use crate::bench::is_one_signal;
use crate::refusal::Refusal;
use crate::rotor::interaction::Interaction;
use crate::rotor::posterior::{BETWEEN_SYSTEMS, Case, Posterior, fit};
use crate::rotor::single::EXPONENT;
use crate::statistics::rms;

/// Misfit above which rows are doubted, and refused. Four to twelve rows of seven maps with runs of
/// their rotors have up to 2 in 95 % and 4.5 in all; rows of other units, halved or of another voltage in
/// four places 5 and more (`tests/agreement.rs`).
const DOUBTED: f64 = 2.0;
/// As above.
const REFUSED: f64 = 5.0;

/// What a mistake costs, in chi squared, and two ratios that may be any, besides: the simplest
/// explanation goes first.
const COST: f64 = 6.0;
const COST_OF_RATIOS: f64 = 34.0;

/// Rows of which one is left out: fewer are fitted by anything, of more a plain `identify` finds the
/// wrong one.
const LEFT_OUT: std::ops::Range<usize> = 4..17;
/// Ratios of another voltage or propeller.
const RATIOS: std::ops::Range<f64> = 0.25..4.0;
/// A ratio this far from a factor with a name, as a logarithm, is not of it.
const NEAR: f64 = 0.15;

/// What mistakes multiply thrust and torque by.
const FACTORS: [&[(f64, &str)]; 2] = [
    &[
        (1.0, "the other sign"),
        (0.5, "half of the pair's"),
        (2.0, "twice the pair's"),
        (101.9716, "gf read as N"),
        (0.1019716, "kgf read as N"),
        (0.2248089, "lbf read as N"),
        (3.596943, "ozf read as N"),
        (0.00980665, "N read as gf"),
        (9.80665, "N read as kgf"),
        (4.448222, "N read as lbf"),
        (1000.0, "gf read as kgf"),
        (0.001, "kgf read as gf"),
    ],
    &[
        (1.0, "the other sign"),
        (0.5, "half of the pair's"),
        (2.0, "twice the pair's"),
        (100.0, "N cm read as N m"),
        (1000.0, "mN m read as N m"),
        (10.19716, "kgf cm read as N m"),
        (8.850746, "lbf in read as N m"),
        (141.6119, "ozf in read as N m"),
        (0.01, "N m read as N cm"),
        (0.001, "N m read as mN m"),
        (0.0980665, "N m read as kgf cm"),
        (0.1129848, "N m read as lbf in"),
    ],
];

/// What undoes a mistake, and what to look after.
type Words<'a> = [&'a str; 2];
const EXCHANGED: Words = ["with the rotors exchanged", "which rotor is the upper (--swap)"];
const ALONE: Words = ["as rows of one rotor alone", "rows in which both rotors turn"];
const OTHER: &str = "the voltage of both (a column, or --run-voltage VOLT) and the propeller";
const NONE: &str = "whether rows and run are of one propeller, motor and voltage, in which units, and which rotor is the upper";

/// Rows without mistakes.
#[derive(Clone)]
struct Mended {
    case: Case,
    words: [Vec<String>; 2],
    cost: f64,
}

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
    let (cause, check) = match cause(start, case, places, &found) {
        Some(Mended { case, words, .. }) => (
            format!("; {}, by {}", words[0].join(" and "), missed(start, &case)),
            words[1].join("; "),
        ),
        None => (", and no single mistake explains it".into(), NONE.into()),
    };
    let told = format!(
        "the rows miss what {runs} predicts by {}{cause}",
        missed(start, case)
    );
    if found.misfit > REFUSED {
        let file = places.first().and_then(|place| place.rsplit_once(':'));
        return Err(Refusal::of(file.map_or("", |(file, _)| file), told, check));
    }
    let wider = found.misfit.sqrt();
    warnings.push(format!(
        "{told}; the uncertainty is widened {wider:.1} times; check {check}"
    ));
    Ok(found)
}

/// Thrusts (0) or torques (1) that were measured, and what the rotors alone predict for them.
fn measured(start: Interaction, case: &Case, k: usize) -> impl Iterator<Item = [f64; 2]> {
    let predicted = move |&[u, l, ..]: &[f64; 4]| start.pair(&case.rotors, case.spacing_ratio, [u, l])[k];
    let rows = case.rows.iter().filter(move |row| row[2 + k].is_finite());
    rows.map(move |row| [row[2 + k], predicted(row)])
}

/// What the runs alone miss of rows.
fn missed(start: Interaction, case: &Case) -> String {
    let [thrust, torque] = [0, 1].map(|k| {
        let missed = measured(start, case, k).map(|[row, predicted]| row - predicted);
        100.0 * rms(missed) / case.full_scale[k]
    });
    match torque.is_nan() {
        true => format!("{thrust:.1} % of thrust"),
        false => format!("{thrust:.1} % of thrust and {torque:.1} % of torque"),
    }
}

/// The likeliest mistakes: which rotor it is with factors of thrust and torque, or one row.
fn cause(start: Interaction, case: &Case, places: &[String], found: &Posterior) -> Option<Mended> {
    let as_is = Mended {
        case: case.clone(),
        words: [vec![], vec![]],
        cost: 0.0,
    };
    let mut tried = vec![as_is.with(EXCHANGED, |_, [u, l, f, q]| [l, u, f, -q])];
    if case.rows.iter().all(|[u, l, ..]| is_one_signal([*u, *l])) {
        // A torque that rises with the lower throttle was made of it when it was read.
        tried.push(as_is.with(ALONE, |_, [u, _, f, q]| [u, 1e-6, f, -q.abs()]));
    }
    tried.push(as_is.clone());
    for k in 0..tried.len() {
        let scaled = tried[k].scaled(start);
        tried.extend(scaled);
    }
    for (k, place) in places
        .iter()
        .enumerate()
        .filter(|_| LEFT_OUT.contains(&places.len()))
    {
        let [undone, check] = [format!("without {place}"), format!("that row: {place}")];
        let without = as_is.with([&undone, &check], |i, [u, l, f, q]| {
            if i == k {
                [u, l, f64::NAN, f64::NAN]
            } else {
                [u, l, f, q]
            }
        });
        // One row of the wrong sign may have turned all others when they were read.
        tried.extend([without.named(1, -1.0), Some(without)].into_iter().flatten());
    }
    let most = DOUBTED.max(0.25 * found.misfit);
    let explain = tried.into_iter().filter_map(|mended| {
        let of = fit(start, BETWEEN_SYSTEMS, std::slice::from_ref(&mended.case));
        let cost = of.chi_squared + mended.cost;
        (of.misfit < most && cost < found.chi_squared).then_some((cost, mended))
    });
    explain
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, mended)| mended)
}

impl Mended {
    fn with(&self, words: Words, undo: impl Fn(usize, [f64; 4]) -> [f64; 4]) -> Mended {
        let mut next = self.clone();
        for (k, row) in next.case.rows.iter_mut().enumerate() {
            *row = undo(k, *row);
        }
        next.words
            .iter_mut()
            .zip(words)
            .for_each(|(all, word)| all.push(word.into()));
        next.cost += COST;
        next
    }

    /// Thrust, torque or both divided by factors.
    fn scaled(&self, start: Interaction) -> impl Iterator<Item = Mended> + use<> {
        // By least squares, as torque has both signs.
        let [thrust, torque] = [0, 1].map(|k| {
            let of = measured(start, &self.case, k)
                .map(|[row, predicted]| [row * predicted, predicted * predicted]);
            let [product, square] = of.fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
            product / square
        });
        let named = self.named(0, thrust);
        let both = named.as_ref().and_then(|named| named.named(1, torque));
        // Rows of equal throttles say too little of the torque for a ratio of it.
        let other = [torque, 1.0].map(|torque| self.of_another([thrust, torque]));
        [named, both, self.named(1, torque)]
            .into_iter()
            .chain(other)
            .flatten()
    }

    /// Divided by the factor of [`FACTORS`] that is nearest to a ratio.
    fn named(&self, k: usize, ratio: f64) -> Option<Mended> {
        let name = ["thrust", "torque"][k];
        let far = |by: f64| libm::log(ratio.abs() / by).abs();
        let (by, why) = FACTORS[k].iter().min_by(|a, b| far(a.0).total_cmp(&far(b.0)))?;
        let divisor = by * ratio.signum();
        let undone = format!("with {name} divided by {divisor} ({why})");
        let check = match why.contains("read as") {
            true => format!("the unit of {name} in both files (--unit {name}=UNIT)"),
            false => {
                format!("that {name} is of both rotors, each counted once, and its sign (--{name}-sign)")
            }
        };
        let divide = |_, mut row: [f64; 4]| {
            row[2 + k] /= divisor;
            row
        };
        (far(*by) < NEAR && divisor != 1.0).then(|| self.with([&undone, &check], divide))
    }

    /// Divided by ratios that another voltage or propeller may have.
    fn of_another(&self, [thrust, torque]: [f64; 2]) -> Option<Mended> {
        let volts = libm::pow(thrust, 1.0 / EXPONENT);
        let undone = format!(
            "with thrust divided by {thrust:.2} and torque by {torque:.2} ({volts:.2} times the voltage, or another propeller)"
        );
        let divided = |_, [u, l, f, q]: [f64; 4]| [u, l, f / thrust, q / torque];
        let possible = [thrust, torque].iter().all(|ratio| RATIOS.contains(ratio));
        possible.then(|| {
            let mut other = self.with([&undone, OTHER], divided);
            other.cost += COST_OF_RATIOS;
            other
        })
    }
}
