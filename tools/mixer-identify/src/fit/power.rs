//! Least power: the torque at which a pair gives its thrust for the least electrical power.
//!
//! A unit whose torque is not asked for can give its thrust f at any torque that the other units
//! cancel. Q = 0 is not the cheapest: the lower rotor works in air that already moves. Electrical
//! power (voltage times current, of both rotors) is fitted as a quartic of both throttles with a
//! constant, as standby takes some; along Q = c f the throttles follow from the pair's map, and c
//! is the number with the greatest mean saving against Q = 0 over 0.3 to 0.7 of full thrust. A
//! frame can cancel these torques where its upper rotors turn both ways: with spins s of n
//! units the share of the saving that is left is 1 - (sum s / n)^2, none where all turn alike.

use faer::Mat;
use faer::linalg::solvers::SolveLstsq;
use mixer_compiler::airframe::{self, Basis};
use mixer_compiler::model::PairMap;
use serde::Serialize;

use crate::bench::{Bench, BenchKind, Point};
use crate::fit::basis::{ThrottleBox, monomials};
use crate::fit::pair::Pair;
use crate::fit::voltage::Voltage;
use crate::fit::{distinct_pairs, ten_digits};
use crate::statistics::{dot, median, rms, times};

/// Shares of full thrust at which vehicles hover.
const SHARES: [f64; 9] = [0.30, 0.35, 0.40, 0.45, 0.50, 0.55, 0.60, 0.65, 0.70];
/// Share of the greatest torque over thrust that a pair must be able to give either way at a thrust
/// that counts.
const ROOM: f64 = 0.1;
/// How many of them must count.
const MOST_OF_THEM: usize = 5;
/// Distinct throttle pairs that a power map of 15 terms takes, to judge itself as well.
const FEWEST: usize = 19;
/// Power over thrust, W/N, of propellers that fly: 2 (large ones at idle) to 200 (small ones at
/// full throttle).
const PLAUSIBLE_W_PER_N: [f64; 2] = [2.0, 200.0];
/// Residual rms of the power map, share of the greatest power, above which a saving of a few
/// percent is no finding.
const POOR: f64 = 0.03;

/// The torque of least power that the files give, or the reason why they give none.
#[derive(Debug, Clone, Serialize)]
#[serde(rename_all = "snake_case", tag = "status")]
pub enum Power {
    /// A power map.
    Identified(LeastPower),
    /// None, and why.
    Refused {
        /// With the numbers that matter.
        reason: String,
    },
}

/// The torque of least power.
#[derive(Debug, Clone, Serialize)]
pub struct LeastPower {
    /// c in Q = c f, N m per N; positive where the lower rotor takes more.
    pub bias_nm_per_n: f64,
    /// Mean saving against Q = 0 over 0.3 to 0.7 of full thrust where upper rotors turn both ways
    /// in equal number, percent.
    pub saving_percent: f64,
    /// Electrical power of one pair at Q = 0 and at Q = c f, W, by share of full thrust.
    pub at: Vec<AtThrust>,
    /// Residual rms of the power map, W.
    pub residual_rms_w: f64,
    /// Greatest power of the rows, W.
    pub full_scale_w: f64,
    /// Rows with power.
    pub points: usize,
    /// Coefficients of the power map, W: the quartic's in their order and a constant; none where no
    /// airframe file takes it, as it is not positive or does not grow over the throttles to
    /// command.
    pub power_w: Option<Vec<f64>>,
}

/// Power at one thrust.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct AtThrust {
    /// Thrust of the pair, N.
    pub thrust_n: f64,
    /// Power without torque, W.
    pub power_w: f64,
    /// Power at Q = c f, W.
    pub least_power_w: f64,
}

/// The electrical power of a pair over its throttles.
struct PowerMap {
    coefficients: Vec<f64>,
    residual_rms: f64,
    full_scale: f64,
}

impl PowerMap {
    fn fit(points: &[Point]) -> PowerMap {
        let rows: Vec<Vec<f64>> = points.iter().map(|p| terms(p.u, p.l)).collect();
        let columns = rows.first().map_or(0, Vec::len);
        let matrix = Mat::from_fn(rows.len(), columns, |i, j| rows[i][j]);
        let power = Mat::from_fn(rows.len(), 1, |i, _| points[i].power_w);
        let solved = matrix.qr().solve_lstsq(&power);
        let coefficients: Vec<f64> = (0..columns).map(|k| solved[(k, 0)]).collect();
        let missed = points
            .iter()
            .zip(times(&rows, &coefficients))
            .map(|(p, power)| p.power_w - power);
        PowerMap {
            residual_rms: rms(missed),
            full_scale: points.iter().map(|p| p.power_w).fold(0.0, f64::max),
            coefficients,
        }
    }

    fn at(&self, [u, l]: [f64; 2]) -> f64 {
        dot(&terms(u, l), &self.coefficients)
    }

    /// `[pair.power]`, where an airframe file takes it for the throttles that may be commanded.
    fn of_file(&self, ThrottleBox { min, max }: ThrottleBox) -> Option<Vec<f64>> {
        let rounded = self.coefficients.iter().map(|&c| ten_digits(c)).collect();
        Some(airframe::Power::over(rounded, [min, max]).ok()?.power_w)
    }
}

fn terms(u: f64, l: f64) -> Vec<f64> {
    let mut terms = monomials(Basis::Quartic, u, l);
    terms.push(1.0);
    terms
}

/// Thrust at both throttles at their greatest, N.
fn full_thrust(map: &PairMap) -> f64 {
    let [_, max] = map.range();
    map.efforts([max; 2])[0]
}

/// The throttles of (f, Q) within the range; nothing where there are none.
fn throttles(map: &PairMap, f: f64, q: f64) -> Option<[f64; 2]> {
    let ([min, max], full) = (map.range(), full_thrust(map));
    let equal = (max * (f / full).clamp(0.0, 1.0).sqrt()).clamp(min, max);
    map.inverse([equal; 2], [f, q])
}

/// Examines the pair's files.
pub fn examine(benches: &[Bench], pair: &Pair, voltage: Option<&Voltage>) -> Power {
    match least_power(benches, pair, voltage) {
        Ok(found) => Power::Identified(found),
        Err(reason) => Power::Refused { reason },
    }
}

fn least_power(benches: &[Bench], pair: &Pair, voltage: Option<&Voltage>) -> Result<LeastPower, String> {
    let points = with_power(benches, pair, voltage)?;
    let power = power_map(&points)?;
    let hover = Hover::new(pair, &power)?;
    // A digit more than a bench can tell, towards none, so that it stays attainable.
    let bias_nm_per_n = (1e5 * hover.best_bias()).trunc() / 1e5;
    let at = hover
        .along(bias_nm_per_n)
        .ok_or("no torque near none is attainable at these thrusts")?;
    let saving_percent = 100.0 * hover.saving(bias_nm_per_n);
    if saving_percent <= 0.0 {
        return Err("no torque saves power against none".into());
    }
    Ok(LeastPower {
        bias_nm_per_n,
        saving_percent,
        at,
        residual_rms_w: power.residual_rms,
        full_scale_w: power.full_scale,
        points: points.len(),
        power_w: power.of_file(pair.throttle),
    })
}

/// The points of the pair's files that have power, brought to the voltage of the map.
fn with_power(benches: &[Bench], pair: &Pair, voltage: Option<&Voltage>) -> Result<Vec<Point>, String> {
    let of_pair = || benches.iter().filter(|b| b.kind == BenchKind::Pair);
    // Where the map is brought to a voltage, power is as well.
    let brought = pair.normalised_to_v.zip(voltage.and_then(Voltage::exponents));
    let at_reference = |p: &Point| {
        brought.map_or(*p, |(reference, exponents)| {
            p.at_voltage(p.voltage, reference, exponents)
        })
    };
    let points = of_pair().flat_map(|b| &b.points).map(at_reference);
    let points: Vec<Point> = points.filter(|p| p.power_w.is_finite()).collect();
    if points.is_empty() {
        return Err(of_pair()
            .find_map(|b| b.no_power.clone())
            .unwrap_or_else(|| "voltage or current is empty in every row".into()));
    }
    Ok(points)
}

/// The power map of points that are plausible, enough and well described by it.
fn power_map(points: &[Point]) -> Result<PowerMap, String> {
    plausible(points)?;
    let places: Vec<[f64; 2]> = points.iter().map(|p| [p.u, p.l]).collect();
    let distinct = distinct_pairs(&places);
    if distinct < FEWEST {
        return Err(format!(
            "{distinct} distinct throttle pairs with power, at least {FEWEST} are needed (5 x 5 levels)"
        ));
    }
    let power = PowerMap::fit(points);
    if power.residual_rms > POOR * power.full_scale {
        return Err(format!(
            "the power map leaves {:.1} % of the greatest power, more than there is to save",
            100.0 * power.residual_rms / power.full_scale
        ));
    }
    Ok(power)
}

/// The thrusts at which vehicles hover, and the power that torque saves there.
struct Hover<'a> {
    map: PairMap,
    power: &'a PowerMap,
    /// Greatest torque over thrust that is worth trying, N m per N.
    most: f64,
    /// Thrust, N, and power without torque, W.
    without: Vec<(f64, f64)>,
}

impl<'a> Hover<'a> {
    fn new(pair: &Pair, power: &'a PowerMap) -> Result<Self, String> {
        let ThrottleBox { min, max } = pair.throttle;
        let map = PairMap::of(pair.basis, &pair.thrust_n, &pair.torque_nm, [min, max]);
        let full = full_thrust(&map);
        // Torque over thrust with one rotor at its least and the other at full throttle bounds what
        // is worth trying.
        let [f, q] = map.efforts([min, max]);
        let most = q.abs() / f;
        let without = |share: &f64| {
            let f = share * full;
            let has = |room: f64| throttles(&map, f, room * most * f).is_some();
            let has_room = has(-ROOM) && has(ROOM);
            has_room.then_some((f, power.at(throttles(&map, f, 0.0)?)))
        };
        let without: Vec<(f64, f64)> = SHARES.iter().filter_map(without).collect();
        if without.len() < MOST_OF_THEM {
            return Err(format!(
                "the idle leaves room for torque at {} of 9 thrusts from 0.3 to 0.7 of full thrust only",
                without.len()
            ));
        }
        Ok(Self {
            map,
            power,
            most,
            without,
        })
    }

    /// Power along Q = c f; `None` where one of the thrusts has no throttles there.
    fn along(&self, c: f64) -> Option<Vec<AtThrust>> {
        let along = |&(thrust_n, power_w): &(f64, f64)| {
            Some(AtThrust {
                thrust_n,
                power_w,
                least_power_w: self.power.at(throttles(&self.map, thrust_n, c * thrust_n)?),
            })
        };
        self.without.iter().map(along).collect()
    }

    /// Mean saving along Q = c f against Q = 0, as a share.
    fn saving(&self, c: f64) -> f64 {
        self.along(c).map_or(f64::NEG_INFINITY, |at| {
            at.iter().map(|a| 1.0 - a.least_power_w / a.power_w).sum::<f64>() / at.len() as f64
        })
    }

    /// The c of the greatest saving, N m per N.
    fn best_bias(&self) -> f64 {
        let best = |about: f64, most: f64| {
            let tried = (-50..=50).map(|k| about + 0.02 * f64::from(k) * most);
            tried
                .max_by(|a, b| self.saving(*a).total_cmp(&self.saving(*b)))
                .unwrap_or(about)
        };
        best(best(0.0, self.most), 0.02 * self.most)
    }
}

/// Refuses power that no propeller takes.
fn plausible(points: &[Point]) -> Result<(), String> {
    let median = median(points.iter().map(|p| p.power_w / p.thrust)).unwrap_or(f64::NAN);
    let [least, most] = PLAUSIBLE_W_PER_N;
    if !(least..=most).contains(&median) {
        return Err(format!(
            "the rows take {median:.3} W per N of thrust in the median, propellers take {least} to {most}: check the units \
             and signs of voltage and current (mA for A?)"
        ));
    }
    // Power rises with throttle, and steeply.
    let mean = |of: &dyn Fn(&Point) -> f64| points.iter().map(of).sum::<f64>() / points.len() as f64;
    let (load, power) = (mean(&|p| p.u + p.l), mean(&|p| p.power_w));
    let covariance = mean(&|p| (p.u + p.l - load) * (p.power_w - power));
    if covariance <= 0.0 {
        return Err("power falls with throttle: check the sign and the columns of the current".into());
    }
    Ok(())
}
