//! Whether rows of a pair agree with the runs of its rotors, and which mistake would explain it if
//! they do not.
//!
//! The least sum of squares of the [`posterior`](mod@super::posterior) is chi squared of the rows under
//! what the runs predict. Each mistake that is common in such rows is undone in turn, and the one that
//! leaves the least is the likeliest.

use crate::bench::units::{Quantity, Scale, scale};
use crate::rotor::interaction::Interaction;
use crate::rotor::posterior::{BETWEEN_SYSTEMS, Case, Posterior, fit};
use crate::rotor::single::EXPONENT;
use crate::statistics::rms;

/// Numbers that rows have beside their own in common: the scales of thrust and of either torque, and
/// what is left at equal commands.
const SHARED: usize = 4;

/// Chi squared over the numbers and [`SHARED`] above which rows are doubted, and refused. Four to
/// twelve rows of nine maps with runs of their rotors have up to 2 in 95 % and 4.5 in all; rows of other
/// units, halved or of another voltage in four places 5 and more (`tests/agreement.rs`).
pub const DOUBTED: f64 = 2.0;
/// As above.
pub const REFUSED: f64 = 5.0;

/// What a mistake costs, in chi squared, and two ratios that may be any: the simplest explanation goes
/// first.
const COST: f64 = 6.0;
const COST_OF_ANY: f64 = 40.0;

/// The greatest ratio that another voltage or propeller is thought of for.
const ANY: f64 = 4.0;

/// Units that are taken for one another.
const THRUST: [[&str; 2]; 5] = [
    ["N", "gf"],
    ["N", "kgf"],
    ["gf", "kgf"],
    ["N", "lbf"],
    ["N", "ozf"],
];
const TORQUE: [[&str; 2]; 6] = [
    ["N m", "N cm"],
    ["N m", "mN m"],
    ["N m", "kgf cm"],
    ["N m", "gf cm"],
    ["N m", "lbf in"],
    ["N m", "ozf in"],
];

/// A ratio this far from that of two units, as a logarithm, is not of them.
const NEAR: f64 = 0.15;

/// What is wrong with rows.
#[derive(Debug, Clone, PartialEq)]
pub enum Mistake {
    /// One of them, by its place.
    Row(usize),
    /// Rows of equal throttles are of one rotor alone.
    Alone,
    /// Upper and lower rotor are exchanged.
    Exchanged,
    /// Thrust times this, and why.
    Thrust(f64, String),
    /// Torque times this, and why.
    Torque(f64, String),
    /// Thrust and torque times these: another voltage or propeller.
    Other([f64; 2]),
}

/// How rows agree.
#[derive(Debug, Clone)]
pub struct Agreement {
    /// The best constants.
    pub posterior: Posterior,
    /// Chi squared over what it may be: about 1.
    pub misfit: f64,
    /// What the runs alone predict is missed by, rms, % of full scale; NaN where nothing was measured.
    pub missed_percent: [f64; 2],
    /// Mistakes that explain it, and what is then missed.
    pub cause: Option<(Vec<Mistake>, [f64; 2])>,
}

/// How the rows of a case agree with its rotors.
pub fn judge(start: Interaction, case: &Case) -> Agreement {
    let (posterior, misfit) = chi(start, case);
    let own = posterior.chi_squared;
    let limit = DOUBTED.max(0.25 * misfit);
    let mut best: Option<(f64, Vec<Mistake>, Case)> = None;
    for mistakes in candidates(start, case) {
        let mut mended = case.clone();
        mistakes.iter().for_each(|mistake| mistake.undo(&mut mended));
        let (of, misfit) = chi(start, &mended);
        let cost = of.chi_squared + mistakes.iter().map(Mistake::cost).sum::<f64>();
        if misfit < limit && cost < best.as_ref().map_or(own, |(least, ..)| *least) {
            best = Some((cost, mistakes, mended));
        }
    }
    Agreement {
        posterior,
        misfit,
        missed_percent: missed(start, case),
        cause: best.map(|(_, mistakes, mended)| (mistakes, missed(start, &mended))),
    }
}

/// Why rows do not agree.
pub struct Explained {
    /// To follow what they miss.
    pub reason: String,
    /// What to do.
    pub mend: String,
}

/// Shares of full scale in words.
pub fn told([thrust, torque]: [f64; 2]) -> String {
    match torque.is_nan() {
        true => format!("{thrust:.1} % of thrust"),
        false => format!("{thrust:.1} % of thrust and {torque:.1} % of torque"),
    }
}

impl Agreement {
    /// The likeliest mistake and its mend; rows have these places.
    pub fn explained(&self, places: &[String]) -> Explained {
        let Some((mistakes, left)) = &self.cause else {
            return Explained {
                reason: ", and no single mistake explains it".into(),
                mend: "whether rows and run are of one propeller, motor and voltage, in which units, and which rotor is the upper".into(),
            };
        };
        let (reasons, mends): (Vec<String>, Vec<String>) =
            mistakes.iter().map(|mistake| mistake.words(places)).unzip();
        Explained {
            reason: format!("; {}, by {}", reasons.join(" and "), told(*left)),
            mend: mends.join("; "),
        }
    }
}

fn chi(start: Interaction, case: &Case) -> (Posterior, f64) {
    let posterior = fit(start, BETWEEN_SYSTEMS, std::slice::from_ref(case));
    let numbers = case
        .rows
        .iter()
        .flat_map(|row| &row[2..])
        .filter(|x| x.is_finite());
    let misfit = posterior.chi_squared / (numbers.count() + SHARED) as f64;
    (posterior, misfit)
}

/// What the rotors alone predict for each row: thrust and torque of the row over it.
fn pairs(start: Interaction, case: &Case) -> Vec<[[f64; 2]; 2]> {
    let of = |&[u, l, thrust, torque]: &[f64; 4]| {
        let predicted = start.pair(&case.rotors, case.spacing_ratio, [u, l]);
        [[thrust, predicted[0]], [torque, predicted[1]]]
    };
    case.rows.iter().map(of).collect()
}

fn missed(start: Interaction, case: &Case) -> [f64; 2] {
    let pairs = pairs(start, case);
    [0, 1].map(|k| {
        let missed = pairs.iter().map(|pair| pair[k][0] - pair[k][1]);
        100.0 * rms(missed.filter(|x| x.is_finite())) / case.full_scale[k]
    })
}

/// Mistakes to try.
fn candidates(start: Interaction, case: &Case) -> Vec<Vec<Mistake>> {
    let mut all: Vec<Vec<Mistake>> = match case.rows.len() {
        0..4 => Vec::new(),
        // One row of the wrong sign may have turned all others when they were read.
        rows => (0..rows)
            .flat_map(|k| {
                [
                    vec![Mistake::Row(k)],
                    vec![Mistake::Row(k), Mistake::Torque(-1.0, "the other sign".into())],
                ]
            })
            .collect(),
    };
    if case.rows.iter().all(|[u, l, ..]| u == l) {
        all.push(vec![Mistake::Alone]);
    }
    for exchanged in [vec![], vec![Mistake::Exchanged]] {
        let mut turned = case.clone();
        exchanged.iter().for_each(|mistake| mistake.undo(&mut turned));
        let ratios = ratios(start, &turned);
        let [thrust, torque] = [(Quantity::Thrust, ratios[0]), (Quantity::Torque, ratios[1])]
            .map(|(quantity, ratio)| named(quantity, ratio));
        let thrust = thrust.map(|(by, why)| Mistake::Thrust(by, why));
        let torque = torque.map(|(by, why)| Mistake::Torque(by, why));
        for used in 0..4 {
            let chosen = [
                thrust.clone().filter(|_| used & 1 > 0),
                torque.clone().filter(|_| used & 2 > 0),
            ];
            all.push(
                exchanged
                    .iter()
                    .cloned()
                    .chain(chosen.into_iter().flatten())
                    .collect(),
            );
        }
        // Rows of equal throttles say too little of the torque for a ratio of it.
        for of in [ratios, [ratios[0], f64::NAN]] {
            if of.iter().all(|x| (1.0 / ANY..ANY).contains(x) || x.is_nan()) {
                all.push([exchanged.clone(), vec![Mistake::Other(of)]].concat());
            }
        }
    }
    all.retain(|mistakes| !mistakes.is_empty());
    all
}

/// Thrust and torque of rows over what is predicted: the median, and by least squares, as torque has
/// both signs.
fn ratios(start: Interaction, case: &Case) -> [f64; 2] {
    let pairs = pairs(start, case);
    let mut thrust: Vec<f64> = pairs
        .iter()
        .map(|[[row, predicted], _]| row / predicted)
        .collect();
    thrust.sort_by(f64::total_cmp);
    let torque = pairs
        .iter()
        .map(|pair| pair[1])
        .filter(|[row, _]| row.is_finite());
    let (product, square) = torque.fold((0.0, 0.0), |(product, square), [row, predicted]| {
        (product + row * predicted, square + predicted * predicted)
    });
    [
        thrust.get(thrust.len() / 2).copied().unwrap_or(f64::NAN),
        product / square,
    ]
}

/// The factor that is nearest to a ratio, and what it comes of.
fn named(quantity: Quantity, ratio: f64) -> Option<(f64, String)> {
    let halves = [
        (0.5, "half of the pair's"),
        (2.0, "twice the pair's"),
        (1.0, "the other sign"),
    ];
    let halves = halves.map(|(by, why)| (by, why.to_owned()));
    let units: &[[&str; 2]] = if quantity == Quantity::Thrust {
        &THRUST
    } else {
        &TORQUE
    };
    let both_ways = units.iter().flat_map(|[a, b]| [[a, b], [b, a]]);
    let units = both_ways.filter_map(
        |[of, read]| match (scale(quantity, of)?, scale(quantity, read)?) {
            (Scale::Factor(own), Scale::Factor(taken)) => Some((taken / own, format!("{of} read as {read}"))),
            _ => None,
        },
    );
    let all = halves.into_iter().chain(units);
    let far = |by: f64| libm::log(ratio.abs() / by).abs();
    let (by, why) = all.min_by(|a, b| far(a.0).total_cmp(&far(b.0)))?;
    let by = by * ratio.signum();
    (far(by.abs()) < NEAR && by != 1.0).then_some((by, why))
}

impl Mistake {
    fn cost(&self) -> f64 {
        if matches!(self, Mistake::Other(_)) {
            COST_OF_ANY
        } else {
            COST
        }
    }

    /// What undoes it, and the mend.
    fn words(&self, places: &[String]) -> (String, String) {
        let of_unit = |name: &str, by: f64, why: &str| {
            let reason = format!("with {name} divided by {} ({why})", (1e4 * by).round() / 1e4);
            (
                reason,
                format!("the unit and the sign of {name} in both files (--unit {name}=UNIT, --{name}-sign)"),
            )
        };
        match self {
            Mistake::Row(k) => {
                let place = places.get(*k).map_or("", String::as_str);
                (format!("without {place}"), format!("that row: {place}"))
            }
            Mistake::Alone => (
                "as rows of one rotor alone".into(),
                "rows in which both rotors turn".into(),
            ),
            Mistake::Exchanged => (
                "with the rotors exchanged".into(),
                "which rotor is the upper (--swap)".into(),
            ),
            Mistake::Thrust(by, why) => of_unit("thrust", *by, why),
            Mistake::Torque(by, why) => of_unit("torque", *by, why),
            Mistake::Other([thrust, torque]) => {
                let volts = libm::pow(*thrust, 1.0 / EXPONENT);
                let torque = match torque.is_nan() {
                    true => String::new(),
                    false => format!(" and torque by {torque:.2}"),
                };
                let reason = format!(
                    "with thrust divided by {thrust:.2}{torque} ({volts:.2} times the voltage, or another propeller)"
                );
                (
                    reason,
                    "the voltage of both (a column, or --run-voltage VOLT) and the propeller".into(),
                )
            }
        }
    }

    fn undo(&self, case: &mut Case) {
        let rows = &mut case.rows;
        let mut divide = |[thrust, torque]: [f64; 2]| {
            for row in rows.iter_mut() {
                row[2] /= thrust;
                row[3] /= torque;
            }
        };
        match self {
            Mistake::Row(k) => drop(case.rows.remove(*k)),
            Mistake::Thrust(by, _) => divide([*by, 1.0]),
            Mistake::Torque(by, _) => divide([1.0, *by]),
            Mistake::Other(by) => divide(by.map(|by| if by.is_nan() { 1.0 } else { by })),
            // A torque that rises with the lower throttle was made of it when it was read.
            Mistake::Alone => rows
                .iter_mut()
                .for_each(|row| *row = [row[0], 1e-6, row[2], -row[3].abs()]),
            Mistake::Exchanged => rows
                .iter_mut()
                .for_each(|row| *row = [row[1], row[0], row[2], -row[3]]),
        }
    }
}
