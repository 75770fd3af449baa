//! Signs of thrust and torque, and the sum over both rotors.
//!
//! The file's thrust is positive upward and its torque positive where the lower rotor outweighs the
//! upper: the upper rotor then turns clockwise seen from above and drags the airframe
//! counter-clockwise, so torque falls with u and rises with l. A bench says neither: signs depend
//! on the mounting of its sensors.
//!
//! * auto (reported): thrust is made positive; a torque column per rotor is made negative above and
//!   positive below; a column of total torque is turned so that it rises with l and falls with u.
//! * given (`--thrust-sign`, `--torque-sign`): the columns are multiplied by the signs given.
//!   Should torque then rise with u, the bench had the upper rotor turning counter-clockwise; the
//!   map is written mirrored, for an upper rotor that turns clockwise, which is the same pair seen
//!   in a mirror.
//!
//! A torque that rises with both throttles is a sum of magnitudes and no torque on the airframe: it
//! is refused.

use std::fmt;

use serde::Serialize;

use crate::bench::header::{Column, Columns, Split};
use crate::bench::read::Sample;
use crate::bench::units::Quantity;
use crate::refusal::Refusal;
use crate::statistics::{extent, mean_of_finite, rms};

/// How to find a sign.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum SignChoice {
    /// From the data, reported.
    #[default]
    Auto,
    /// These factors, for the upper and the lower rotor's column; the first for a total.
    Given([f64; 2]),
}

impl fmt::Display for SignChoice {
    /// As `--thrust-sign` takes it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = |s: f64| if s < 0.0 { '-' } else { '+' };
        match *self {
            SignChoice::Auto => f.write_str(AUTO),
            SignChoice::Given([upper, lower]) => write!(f, "{},{}", sign(upper), sign(lower)),
        }
    }
}

/// Signs of both channels.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SignPolicy {
    /// Of thrust.
    pub thrust: SignChoice,
    /// Of torque.
    pub torque: SignChoice,
}

/// The signs that were applied.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Signs {
    /// Factor of the thrust column(s).
    pub thrust: Vec<f64>,
    /// Factor of the torque column(s); empty where torque is not measured.
    pub torque: Vec<f64>,
    /// `auto` or `given`.
    pub thrust_policy: &'static str,
    /// `auto` or `given`.
    pub torque_policy: &'static str,
}

/// The word for a sign that was found.
pub const AUTO: &str = "auto";

fn policy_word(choice: SignChoice) -> &'static str {
    if choice == SignChoice::Auto { AUTO } else { "given" }
}

/// +1 or -1, the sign of the sum of what is not NaN.
fn sign_of_sum(values: impl Iterator<Item = f64>) -> f64 {
    let sum: f64 = values.filter(|x| !x.is_nan()).sum();
    if sum < 0.0 { -1.0 } else { 1.0 }
}

/// A channel of a pair: what its columns measured.
struct Channel<'a> {
    name: &'static str,
    samples: &'a [Sample],
    of: fn(&Sample) -> Split<f64>,
    /// Whether the whole has a column; else each rotor has one.
    total: bool,
}

impl Channel<'_> {
    fn rotors(&self) -> impl Iterator<Item = [f64; 2]> + Clone {
        self.samples.iter().map(|s| (self.of)(s).rotors)
    }

    /// The signs that make every column positive.
    fn positive(&self) -> [f64; 2] {
        match self.total {
            true => [sign_of_sum(self.samples.iter().map(|s| (self.of)(s).whole)); 2],
            false => [0, 1].map(|r| sign_of_sum(self.rotors().map(|rotors| rotors[r]))),
        }
    }

    /// Values of the whole, of columns times signs.
    fn sums(&self, signs: [f64; 2], notes: &mut Vec<String>) -> Vec<f64> {
        let of = |s: &Sample| match ((self.of)(s), self.total) {
            (Split { whole, .. }, true) => signs[0] * whole,
            (Split { rotors: [a, b], .. }, false) => signs[0] * a + signs[1] * b,
        };
        let sums: Vec<f64> = self.samples.iter().map(of).collect();
        if self.total {
            notes.extend(self.other_sum(&sums));
        }
        sums
    }

    /// Says so where a total is not the sum of the rotors' columns, whatever their signs.
    fn other_sum(&self, totals: &[f64]) -> Option<String> {
        let measured = totals.iter().filter(|x| x.is_finite());
        let largest = measured.fold(0.0_f64, |most, x| most.max(x.abs()));
        let differs = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]].map(|[a, b]| {
            let rows = totals.iter().zip(self.rotors());
            let differences = rows.map(|(x, [upper, lower])| x - a * upper - b * lower);
            let (sum, count) = differences
                .filter(|d| d.is_finite())
                .fold((0.0, 0), |(sum, count), d| (sum + d * d, count + 1));
            (sum / f64::from(count.max(1))).sqrt()
        });
        let (what, least) = (self.name, differs.into_iter().fold(f64::INFINITY, f64::min));
        (least > SUM * largest).then(|| {
            format!(
                "the total {what} differs from the sum of the rotors' columns by {:.1} % of its greatest value, rms: the total is \
                 taken; --column {what}=HEADER names another",
                100.0 * least / largest
            )
        })
    }

    /// One sign per column.
    fn per_column(&self, signs: [f64; 2]) -> Vec<f64> {
        signs[..if self.total { 1 } else { 2 }].to_vec()
    }
}

/// What a total may differ by from the sum of the rotors' columns, rms, in shares of the greatest
/// total.
const SUM: f64 = 0.02;

/// Sums of a pair, (thrust, torque) per sample.
pub fn pair(
    file: &str,
    columns: &Columns,
    samples: &[Sample],
    policy: &SignPolicy,
    is_correction: bool,
    notes: &mut Vec<String>,
) -> Result<(Signs, Vec<(f64, f64)>), Refusal> {
    let channel = |name, of: fn(&Sample) -> Split<f64>, columns: &Split<Option<Column>>| Channel {
        name,
        samples,
        of,
        total: columns.whole.is_some(),
    };
    let thrust = channel("thrust", |s| s.thrust, &columns[Quantity::Thrust]);
    let torque = channel("torque", |s| s.torque, &columns[Quantity::Torque]);
    if !columns[Quantity::Thrust].complete() {
        return Err(Refusal::of(
            file,
            "thrust of one rotor only, though both turn",
            "a column of total thrust, or one per rotor",
        ));
    }
    let has_torque = samples.iter().any(|s| match (s.torque, torque.total) {
        (Split { whole, .. }, true) => whole.is_finite(),
        (Split { rotors, .. }, false) => rotors.iter().all(|q| q.is_finite()),
    });
    let (torque_signs, torques) = match is_correction && !has_torque {
        true => (Vec::new(), vec![f64::NAN; samples.len()]),
        false => pair_torque(file, columns, &torque, policy.torque, notes)?,
    };
    let signs = match policy.thrust {
        SignChoice::Given(signs) => signs,
        SignChoice::Auto => thrust.positive(),
    };
    let sums = thrust.sums(signs, notes).into_iter().zip(torques).collect();
    let signs = Signs {
        thrust: thrust.per_column(signs),
        torque: torque_signs,
        thrust_policy: policy_word(policy.thrust),
        torque_policy: policy_word(policy.torque),
    };
    Ok((signs, sums))
}

/// Torque is turned to that of an upper rotor that turns clockwise.
fn pair_torque(
    file: &str,
    columns: &Columns,
    torque: &Channel<'_>,
    choice: SignChoice,
    notes: &mut Vec<String>,
) -> Result<(Vec<f64>, Vec<f64>), Refusal> {
    if !columns[Quantity::Torque].complete() {
        return Err(Refusal::of(
            format!("{file}:1"),
            match columns[Quantity::Torque].rotors.iter().flatten().next() {
                Some(column) => format!("torque of one rotor only ({:?})", column.name),
                None => "no torque column".to_string(),
            },
            "the torque of the whole pair, or of each rotor (--column torque=HEADER)",
        ));
    }
    let mut signs = match (choice, torque.positive()) {
        (SignChoice::Given(signs), _) => signs,
        (SignChoice::Auto, _) if torque.total => [1.0; 2],
        (SignChoice::Auto, [upper, lower]) => [-upper, lower],
    };
    let mut sums = torque.sums(signs, notes);
    constant(file, &sums)?;
    let [by_upper, by_lower] = slopes(torque.samples, &sums);
    if follows(torque.samples, &sums, [by_upper, by_lower]) {
        no_magnitudes(file, by_upper, by_lower)?;
    }
    if by_lower < by_upper {
        sums.iter_mut().for_each(|q| *q = -*q);
        signs = signs.map(|s| -s);
        if choice != SignChoice::Auto {
            notes.push(
                "by the signs given the upper rotor turned counter-clockwise on the bench; the map is written \
                 mirrored, for one that turns clockwise"
                    .into(),
            );
        } else if torque.total && columns.sides_named {
            notes.push(
                "torque is turned, as of an upper rotor that turned counter-clockwise or a sensor mounted that way"
                    .into(),
            );
        }
    }
    Ok((torque.per_column(signs), sums))
}

/// Whether the torque follows the throttles at all, by half of its variance: in disorder its slopes say nothing.
fn follows(samples: &[Sample], torque: &[f64], [a, b]: [f64; 2]) -> bool {
    let rows = || samples.iter().zip(torque).filter(|(_, q)| q.is_finite());
    let left =
        |(s, q): (&Sample, &f64)| q - a * s.throttle[0] * s.throttle[0] - b * s.throttle[1] * s.throttle[1];
    let mean = mean_of_finite(torque.iter().copied());
    rms(rows().map(left)) < 0.7 * rms(rows().map(|(_, q)| q - mean))
}

/// Refuses a torque that grows with both throttles, by these slopes over their squares.
fn no_magnitudes(file: &str, by_upper: f64, by_lower: f64) -> Result<(), Refusal> {
    if by_upper * by_lower > 0.0
        && by_upper.abs().min(by_lower.abs()) > 0.2 * by_upper.abs().max(by_lower.abs())
    {
        return Err(Refusal::of(
            file,
            format!(
                "torque grows with both throttles ({by_upper:+.3} N m u2, {by_lower:+.3} N m l2): \
                 a sum of magnitudes, not the torque that a contra-rotating pair puts on the airframe"
            ),
            "the net torque, or one column per rotor with --torque-sign=-,+",
        ));
    }
    Ok(())
}

/// (thrust, torque) of a single rotor, torque as a magnitude.
pub fn single(
    columns: &Columns,
    rotor: usize,
    prefers_rotor_cell: bool,
    samples: &[Sample],
    policy: &SignPolicy,
) -> (Signs, Vec<(f64, f64)>) {
    // The whole where it is measured: a rotor at rest in the wake has a drag of its own.
    let whole = |columns: &Split<Option<Column>>| {
        columns.whole.is_some() && !(prefers_rotor_cell && columns.rotors[rotor].is_some())
    };
    let [whole_thrust, whole_torque] = [&columns[Quantity::Thrust], &columns[Quantity::Torque]].map(whole);
    let of = |value: Split<f64>, whole: bool| if whole { value.whole } else { value.rotors[rotor] };
    let thrust = |s: &Sample| of(s.thrust, whole_thrust);
    let torque = |s: &Sample| of(s.torque, whole_torque);
    let thrust_sign = match policy.thrust {
        SignChoice::Auto => sign_of_sum(samples.iter().map(thrust)),
        SignChoice::Given(signs) => signs[rotor],
    };
    let torque_sign = sign_of_sum(samples.iter().map(torque));
    let has_torque = whole_torque || columns[Quantity::Torque].rotors[rotor].is_some();
    let signs = Signs {
        thrust: vec![thrust_sign],
        torque: if has_torque { vec![torque_sign] } else { Vec::new() },
        thrust_policy: policy_word(policy.thrust),
        torque_policy: "auto",
    };
    let signed = |s: &Sample| (thrust_sign * thrust(s), torque_sign * torque(s));
    (signs, samples.iter().map(signed).collect())
}

fn constant(file: &str, torque: &[f64]) -> Result<(), Refusal> {
    let [low, high] = extent(torque.iter().copied().filter(|q| !q.is_nan()));
    let needed = "torque measured at every point: without it yaw cannot be modelled";
    let reason = match low > high {
        true => "the torque is empty in every row".to_owned(),
        false if high - low <= 1e-6 * high.abs().max(low.abs()) => {
            format!("the torque is constant at {low:.4} N m in every row that is left")
        }
        false => return Ok(()),
    };
    Err(Refusal::of(file, reason, needed))
}

/// [a, b] of the least-squares fit Q = a u2 + b l2.
fn slopes(samples: &[Sample], torque: &[f64]) -> [f64; 2] {
    let (mut uu, mut ul, mut ll, mut uq, mut lq) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (s, &q) in samples.iter().zip(torque) {
        let [u, l] = s.throttle.map(|t| t * t);
        if (q + u + l).is_finite() {
            uu += u * u;
            ul += u * l;
            ll += l * l;
            uq += u * q;
            lq += l * q;
        }
    }
    let det = uu * ll - ul * ul;
    if det <= 0.02 * uu * ll {
        // Nearly proportional throttles: the lower rotor, in the wake, has the smaller torque.
        return if uq + lq > 0.0 { [1.0, -1.0] } else { [-1.0, 1.0] };
    }
    [(uq * ll - lq * ul) / det, (lq * uu - uq * ul) / det]
}

#[cfg(test)]
mod tests;
