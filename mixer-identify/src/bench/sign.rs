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

use serde::Serialize;

use crate::bench::header::Columns;
use crate::bench::read::Sample;
use crate::refusal::Refusal;

/// How to find a sign.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SignChoice {
    /// From the data, reported.
    Auto,
    /// These factors, for the upper and the lower rotor's column; the first for a total.
    Given([f64; 2]),
}

/// Signs of both channels.
#[derive(Debug, Clone, Copy, PartialEq)]
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
    if values.filter(|x| !x.is_nan()).sum::<f64>() < 0.0 {
        -1.0
    } else {
        1.0
    }
}

/// Values of a channel, one column or one per rotor, times signs.
fn signed(
    samples: &[Sample],
    of: impl Fn(&Sample) -> (f64, [f64; 2]),
    total: bool,
    signs: &[f64],
) -> Vec<f64> {
    let value = |s: &Sample| match of(s) {
        (whole, _) if total => signs[0] * whole,
        (_, [upper, lower]) => signs[0] * upper + signs[1] * lower,
    };
    samples.iter().map(value).collect()
}

/// Sums of a pair, (thrust, torque) per sample.
pub fn pair(
    file: &str,
    columns: &Columns,
    samples: &[Sample],
    policy: &SignPolicy,
    torque_may_lack: bool,
    notes: &mut Vec<String>,
) -> Result<(Signs, Vec<(f64, f64)>), Refusal> {
    let lacks = torque_may_lack && !has_torque(columns, samples);
    thrust_measured(file, columns)?;
    let torque = if lacks {
        Channel {
            signs: Vec::new(),
            sums: vec![f64::NAN; samples.len()],
        }
    } else {
        torque_measured(file, columns)?;
        pair_torque(file, columns, samples, policy.torque, notes)?
    };
    let thrust = pair_thrust(columns, samples, policy.thrust, notes);
    let signs = Signs {
        thrust: thrust.signs,
        torque: torque.signs,
        thrust_policy: policy_word(policy.thrust),
        torque_policy: policy_word(policy.torque),
    };
    Ok((signs, thrust.sums.into_iter().zip(torque.sums).collect()))
}

/// Whether any row has the torque of the whole pair.
fn has_torque(columns: &Columns, samples: &[Sample]) -> bool {
    let measured = |s: &Sample| match columns.torque {
        Some(_) => s.torque.is_finite(),
        None => s.rotor_torque.iter().all(|q| q.is_finite()),
    };
    samples.iter().any(measured)
}

/// Refuses a pair without thrust of the whole or of each rotor.
fn thrust_measured(file: &str, columns: &Columns) -> Result<(), Refusal> {
    if columns.thrust.is_none() && columns.rotor_thrust.iter().any(Option::is_none) {
        return Err(Refusal::of(
            file,
            "thrust of one rotor only, though both turn",
            "a column of total thrust, or one per rotor",
        ));
    }
    Ok(())
}

/// Refuses a pair without torque of the whole or of each rotor.
fn torque_measured(file: &str, columns: &Columns) -> Result<(), Refusal> {
    if columns.torque.is_none() && columns.rotor_torque.iter().any(Option::is_none) {
        return Err(Refusal::of(
            format!("{file}:1"),
            match columns.rotor_torque.iter().flatten().next() {
                Some(column) => format!("torque of one rotor only ({:?})", column.name),
                None => "no torque column".to_string(),
            },
            "the torque of the whole pair, or of each rotor (--column torque=HEADER)",
        ));
    }
    Ok(())
}

/// A channel of a pair: the factors of its columns, and the sum per sample.
struct Channel {
    signs: Vec<f64>,
    sums: Vec<f64>,
}

fn pair_thrust(
    columns: &Columns,
    samples: &[Sample],
    choice: SignChoice,
    notes: &mut Vec<String>,
) -> Channel {
    let total = columns.thrust.is_some();
    let signs = match choice {
        SignChoice::Given(signs) => signs,
        SignChoice::Auto if total => [sign_of_sum(samples.iter().map(|s| s.thrust)); 2],
        SignChoice::Auto => [0, 1].map(|r| sign_of_sum(samples.iter().map(|s| s.rotor_thrust[r]))),
    };
    if !total {
        compare_sides(samples, signs, notes);
    }
    let sums = signed(samples, |s| (s.thrust, s.rotor_thrust), total, &signs);
    if total {
        compare_sum("thrust", &sums, samples.iter().map(|s| s.rotor_thrust), notes);
    }
    Channel {
        sums,
        signs: signs[..if total { 1 } else { 2 }].to_vec(),
    }
}

/// What a total may differ by from the sum of the rotors' columns, rms, in shares of the greatest
/// total.
const SUM: f64 = 0.02;

/// A total that is not the sum of the rotors' columns, whatever their signs: says so.
fn compare_sum(
    what: &str,
    totals: &[f64],
    rotors: impl Iterator<Item = [f64; 2]> + Clone,
    notes: &mut Vec<String>,
) {
    let largest = totals
        .iter()
        .filter(|x| x.is_finite())
        .fold(0.0_f64, |most, x| most.max(x.abs()));
    let differs = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]].map(|[a, b]| {
        let differences = totals
            .iter()
            .zip(rotors.clone())
            .map(|(x, [upper, lower])| x - a * upper - b * lower);
        let (sum, count) = differences
            .filter(|d| d.is_finite())
            .fold((0.0, 0), |(sum, count), d| (sum + d * d, count + 1));
        if count > 0 {
            (sum / f64::from(count)).sqrt()
        } else {
            0.0
        }
    });
    let least = differs.into_iter().fold(f64::INFINITY, f64::min);
    if least > SUM * largest {
        notes.push(format!(
            "the total {what} differs from the sum of the rotors' columns by {:.1} % of its greatest value, rms: the total is taken; \
             --column {what}=HEADER names another",
            100.0 * least / largest
        ));
    }
}

/// Torque is turned to that of an upper rotor that turns clockwise.
fn pair_torque(
    file: &str,
    columns: &Columns,
    samples: &[Sample],
    choice: SignChoice,
    notes: &mut Vec<String>,
) -> Result<Channel, Refusal> {
    let total = columns.torque.is_some();
    let mut signs = match choice {
        SignChoice::Given(signs) => signs,
        SignChoice::Auto if total => [1.0; 2],
        SignChoice::Auto => {
            let signs = [0, 1].map(|r| sign_of_sum(samples.iter().map(|s| s.rotor_torque[r])));
            [-signs[0], signs[1]]
        }
    };
    let mut sums = signed(samples, |s| (s.torque, s.rotor_torque), total, &signs);
    if total {
        compare_sum("torque", &sums, samples.iter().map(|s| s.rotor_torque), notes);
    }
    constant(file, &sums)?;
    let [by_upper, by_lower] = slopes(samples, &sums);
    no_magnitudes(file, by_upper, by_lower)?;
    if by_lower < by_upper {
        sums.iter_mut().for_each(|q| *q = -*q);
        signs = signs.map(|s| -s);
        if choice != SignChoice::Auto {
            notes.push(
                "by the signs given the upper rotor turned counter-clockwise on the bench; the map is written \
                 mirrored, for one that turns clockwise"
                    .into(),
            );
        } else if total && columns.sides_named {
            notes.push(
                "torque is turned, as of an upper rotor that turned counter-clockwise or a sensor mounted that way"
                    .into(),
            );
        }
    }
    Ok(Channel {
        sums,
        signs: signs[..if total { 1 } else { 2 }].to_vec(),
    })
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
    own_columns: bool,
    samples: &[Sample],
    policy: &SignPolicy,
) -> (Signs, Vec<(f64, f64)>) {
    // The whole where it is measured: a rotor at rest in the wake has a drag of its own.
    let whole = |total: bool, own: bool| total && !(own_columns && own);
    let whole_thrust = whole(columns.thrust.is_some(), columns.rotor_thrust[rotor].is_some());
    let whole_torque = whole(columns.torque.is_some(), columns.rotor_torque[rotor].is_some());
    let thrust = |s: &Sample| {
        if whole_thrust {
            s.thrust
        } else {
            s.rotor_thrust[rotor]
        }
    };
    let torque = |s: &Sample| {
        if whole_torque {
            s.torque
        } else {
            s.rotor_torque[rotor]
        }
    };
    let sign = |choice: SignChoice, automatic: f64| match choice {
        SignChoice::Auto => automatic,
        SignChoice::Given(signs) => signs[rotor],
    };
    let thrust_sign = sign(policy.thrust, sign_of_sum(samples.iter().map(thrust)));
    let torque_sign = sign_of_sum(samples.iter().map(torque));
    let has_torque = whole_torque || columns.rotor_torque[rotor].is_some();
    let signs = Signs {
        thrust: vec![thrust_sign],
        torque: if has_torque { vec![torque_sign] } else { Vec::new() },
        thrust_policy: policy_word(policy.thrust),
        torque_policy: "auto",
    };
    (
        signs,
        samples
            .iter()
            .map(|s| (thrust_sign * thrust(s), torque_sign * torque(s)))
            .collect(),
    )
}

fn constant(file: &str, torque: &[f64]) -> Result<(), Refusal> {
    let measured = || torque.iter().copied().filter(|q| !q.is_nan());
    let (low, high) = measured().fold((f64::MAX, f64::MIN), |(a, b), q| (a.min(q), b.max(q)));
    let needed = "torque measured at every point: without it yaw cannot be modelled";
    if low > high {
        return Err(Refusal::of(file, "the torque is empty in every row", needed));
    }
    if high - low <= 1e-6 * high.abs().max(low.abs()) {
        return Err(Refusal::of(
            file,
            format!("the torque is constant at {low} N m in every row"),
            needed,
        ));
    }
    Ok(())
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
        return [-1.0, 1.0]; // nearly proportional throttles: the design is refused later, with its own reason
    }
    [(uq * ll - lq * ul) / det, (lq * uu - uq * ul) / det]
}

/// The rotor in the wake gives clearly less at equal commands: says so when that is the first one.
fn compare_sides(samples: &[Sample], signs: [f64; 2], notes: &mut Vec<String>) {
    let level = samples
        .iter()
        .filter(|s| (s.throttle[0] - s.throttle[1]).abs() < 0.05);
    let (upper, lower) = level.fold((0.0, 0.0), |(a, b), s| {
        (a + signs[0] * s.rotor_thrust[0], b + signs[1] * s.rotor_thrust[1])
    });
    if upper < 0.9 * lower {
        notes.push(format!(
            "at equal commands the rotor taken as upper gives {:.2} of the other's thrust: \
             it is probably the one in the wake (--swap exchanges them)",
            upper / lower
        ));
    }
}

#[cfg(test)]
mod tests;
