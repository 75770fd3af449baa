//! A run of one rotor, or the table of its data sheet, as thrust and torque over throttle.

use mixer_compiler::airframe::TYPICAL_EXPONENT;
use serde::Serialize;

use crate::bench::{Bench, BenchKind, Point, equal_commands, mean_voltage};
use crate::fit::{distinct_pairs, ten_digits};
use crate::numbers::{self, Anomaly};
use crate::refusal::Refusal;
use crate::rotor::curve::{Curve, Rotor};
use crate::statistics::{extent, rms};

/// Distinct throttles that a curve of three terms takes, to be judged as well.
const FEWEST: usize = 5;
/// Throttle below which a run says too little of the upper half.
const REACHES: f64 = 0.7;
/// Throttle from which on the end of a run counts as full throttle.
const FULL: f64 = 0.95;
/// Misfit of a curve, rms of the greatest value, that real runs keep below; and one that no rotor
/// has. Ten real runs have up to 0.013; two propellers that differ by a fifth, in one table,
/// 0.05.
const MISFIT: [f64; 2] = [0.02, 0.06];
/// Throttles within this are one.
const SAME: f64 = 0.002;
/// Torque per thrust over diameter, where torque was not measured. Six runs of 11 to 22 inch.
pub const KAPPA_PER_DIAMETER: f64 = 0.048;

/// A torque that was not measured, % of full scale.
pub(crate) const UNMEASURED_TORQUE: f64 = 2.0;

/// One rotor alone, with the signs of the airframe file.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Out {
    /// Of thrust, N.
    pub thrust_n: [f64; 3],
    /// Of torque, N m.
    pub torque_nm: [f64; 3],
}

impl Out {
    /// Thrust and torque.
    pub(crate) fn both(self) -> [[f64; 3]; 2] {
        [self.thrust_n, self.torque_nm]
    }

    /// Of a rotor with this sign of its torque, in ten digits.
    pub(crate) fn of(rotor: Rotor, sign: f64) -> Out {
        Out {
            thrust_n: rotor.thrust.0.map(ten_digits),
            torque_nm: rotor.torque.0.map(|c| ten_digits(sign * c)),
        }
    }
}

/// What the user knows of a run beside its file.
#[derive(Debug, Clone, Copy)]
pub struct RunFacts {
    /// Torque per thrust, m, for a run without torque.
    pub kappa_m: Option<f64>,
    /// Diameter of the propeller, m.
    pub diameter_m: Option<f64>,
    /// Voltage of the run, V, where it has no column for it.
    pub run_v: Option<f64>,
    /// Voltage to which the rows of the run are brought, V; their mean where it is none.
    pub reference_v: Option<f64>,
    /// Exponents of thrust and of torque by which they are.
    pub exponents: [f64; 2],
}

impl Default for RunFacts {
    fn default() -> Self {
        RunFacts {
            kappa_m: None,
            diameter_m: None,
            run_v: None,
            reference_v: None,
            exponents: [TYPICAL_EXPONENT; 2],
        }
    }
}

/// A rotor alone.
#[derive(Debug, Clone, Serialize)]
pub struct Single {
    /// The run.
    pub file: String,
    /// Points.
    pub points: usize,
    /// Range of throttle.
    pub measured: [f64; 2],
    /// Misfit of thrust and of torque, rms, % of the greatest.
    pub misfit_percent: [Option<f64>; 2],
    /// Torque per thrust that stands for the torque, m; none where torque was measured.
    pub kappa_m: Option<f64>,
    /// Voltage at which the curves hold, V, where it is known.
    pub voltage_v: Option<f64>,
    /// Voltage at which the rows were run, in the mean, V, where it is known.
    pub run_v: Option<f64>,
    /// Least and greatest voltage of the rows, V.
    pub range_v: Option<[f64; 2]>,
    /// Exponents of thrust and of torque that brought the rows from there to that voltage.
    pub exponents: [f64; 2],
    /// Thrust and torque.
    #[serde(skip)]
    pub rotor: Rotor,
}

impl Single {
    /// The rotor of a run.
    ///
    /// # Errors
    /// A file that is no run of one rotor, or too little of one.
    pub fn of(bench: &Bench, known: &RunFacts, warnings: &mut Vec<String>) -> Result<Single, Refusal> {
        let file = &bench.file;
        if bench.kind == BenchKind::Pair {
            return Err(Refusal::of(
                file,
                "both rotors turn in it: it is a map of the pair",
                format!(
                    "{}; of unequal throttles, cargo mixer identify {file} finds the pair itself",
                    equal_commands(&[file])
                ),
            ));
        }
        let anomalies = numbers::anomalies(bench, known.diameter_m)?;
        warnings.extend(anomalies.iter().map(Anomaly::sentence));
        let run_v = known.run_v.or(mean_voltage(&bench.points).map(|(mean, _)| mean));
        let (points, voltage_v) = at_one_voltage(bench, known, run_v, warnings)?;
        let points = &points;
        let measured = extent(points.iter().map(|p| p.u));
        enough(file, points, measured)?;
        let thrust = channel(file, "thrust", points, |p| p.thrust, warnings)?;
        let with_torque: Vec<Point> = points.iter().copied().filter(|p| p.torque.is_finite()).collect();
        let (torque, kappa_m) = if distinct(&with_torque) >= FEWEST {
            let torque = channel(file, "torque", &with_torque, |p| p.torque, warnings)?;
            (torque, None)
        } else {
            let (kappa, why) = stand_in(file, known)?;
            let of_one = match points.iter().any(|p| p.power_w.is_finite()) {
                true => "",
                false => "; of ONE rotor: thrust alone does not tell one from two",
            };
            warnings.push(format!(
                "torque was not measured in {file}: {kappa:.4} N m per N stands for it, {why}{of_one}"
            ));
            let torque = Channel {
                curve: thrust.curve.times(kappa),
                misfit_percent: None,
            };
            (torque, Some(kappa))
        };
        Ok(Single {
            file: file.clone(),
            points: points.len(),
            measured,
            misfit_percent: [thrust.misfit_percent, torque.misfit_percent],
            kappa_m,
            voltage_v,
            run_v,
            range_v: mean_voltage(&bench.points)
                .filter(|_| known.run_v.is_none())
                .map(|_| {
                    let volts = bench.points.iter().map(|p| p.voltage);
                    extent(volts.filter(|v| v.is_finite()))
                }),
            exponents: known.exponents,
            rotor: Rotor {
                thrust: thrust.curve,
                torque: torque.curve,
            },
        })
    }

    /// The throttle at which the run ends, 1 where that is next to it.
    pub(crate) fn end(&self) -> f64 {
        match self.measured[1] < FULL - SAME {
            true => (1e4 * self.measured[1] + 1e-6).floor() / 1e4,
            false => 1.0,
        }
    }

    /// Whether a table of few rows is behind the curves.
    pub fn is_sparse(&self) -> bool {
        self.points < 10
    }
}

fn distinct(points: &[Point]) -> usize {
    let places: Vec<[f64; 2]> = points.iter().map(|p| [p.u, 0.0]).collect();
    distinct_pairs(&places)
}

fn enough(file: &str, points: &[Point], [_, highest]: [f64; 2]) -> Result<(), Refusal> {
    let count = distinct(points);
    let reason = match count < FEWEST {
        true => format!("{count} distinct throttles, at least {FEWEST} are needed"),
        false if highest < REACHES - SAME => {
            format!("the run stops at a throttle of {highest:.2}, below {REACHES}")
        }
        false => return Ok(()),
    };
    let needed = format!("{FEWEST} throttles or more, up to full throttle or near it");
    Err(Refusal::of(file, reason, needed))
}

struct Channel {
    curve: Curve,
    misfit_percent: Option<f64>,
}

fn channel(
    file: &str,
    name: &str,
    points: &[Point],
    of: fn(&Point) -> f64,
    warnings: &mut Vec<String>,
) -> Result<Channel, Refusal> {
    let places: Vec<[f64; 2]> = points.iter().map(|p| [p.u, of(p)]).collect();
    let greatest = places.iter().fold(0.0_f64, |m, [_, y]| m.max(*y));
    let curve = Curve::fit(&places).filter(|curve| greatest > 0.0 && curve.at(1.0) > 0.0);
    let Some(curve) = curve else {
        return Err(Refusal::of(
            file,
            format!("the {name} does not grow with the throttle"),
            "a run of one rotor, whose thrust (its sign by --thrust-sign) and torque grow with the throttle",
        ));
    };
    let share = rms(places.iter().map(|[x, y]| y - curve.at(*x))) / greatest;
    let percent = 100.0 * share;
    if share > MISFIT[0] {
        let told = format!(
            "the {name} misses a growing curve over the throttle by {percent:.1} % rms of its greatest value, good runs by 1 %: a \
             kink, a wrong row, two propellers or voltages in one table, or a supply that sags"
        );
        let needed =
            "one run of one rotor and propeller, at a supply that holds or with a voltage in each row";
        if share > MISFIT[1] {
            return Err(Refusal::of(file, told, needed));
        }
        warnings.push(format!("{file}: {told}; needed: {needed}"));
    }
    Ok(Channel {
        curve,
        misfit_percent: Some(percent),
    })
}

/// What stands for a torque that was not measured: torque per thrust, m, and why.
fn stand_in(file: &str, known: &RunFacts) -> Result<(f64, String), Refusal> {
    match (known.kappa_m, known.diameter_m) {
        (Some(kappa), _) => Ok((kappa, "as given".into())),
        (None, Some(diameter)) => Ok((
            KAPPA_PER_DIAMETER * diameter,
            format!(
                "{KAPPA_PER_DIAMETER} of a diameter of {diameter} m; runs of four propellers have 0.046 to 0.062 of it"
            ),
        )),
        (None, None) => Err(Refusal::of(
            file,
            "torque was not measured, and neither --kappa nor --diameter is given",
            "--diameter METRE of the propeller, or --kappa METRE, its torque per thrust; or a column of torque",
        )),
    }
}

/// The exponents of thrust and of torque in words.
pub(crate) fn exponents_in_words([thrust, torque]: [f64; 2]) -> String {
    match thrust == torque {
        true => format!("an exponent of {thrust}"),
        false => format!("exponents of {thrust} for thrust and {torque} for torque"),
    }
}

/// The points, each brought from its own voltage to the reference, and that voltage where one is
/// known.
fn at_one_voltage(
    bench: &Bench,
    known: &RunFacts,
    run_v: Option<f64>,
    warnings: &mut Vec<String>,
) -> Result<(Vec<Point>, Option<f64>), Refusal> {
    let Some(run_v) = run_v else {
        return match known.reference_v {
            None => Ok((bench.points.clone(), None)),
            Some(_) => Err(Refusal::of(
                &bench.file,
                "--reference-voltage has nothing to start from: the run has no voltage",
                "--run-voltage VOLT, or a column of the voltage",
            )),
        };
    };
    let reference = known.reference_v.unwrap_or(run_v);
    if (run_v / reference - 1.0).abs() > 0.005 {
        warnings.push(format!(
            "{} was run at {run_v:.2} V and is brought to {reference} V by {}",
            bench.file,
            exponents_in_words(known.exponents)
        ));
    }
    let at_reference = |p: &Point| {
        let own = Some(p.voltage).filter(|v| known.run_v.is_none() && v.is_finite());
        p.at_voltage(own.unwrap_or(run_v), reference, known.exponents)
    };
    Ok((bench.points.iter().map(at_reference).collect(), Some(reference)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::{Preparation, prepare, read};

    /// 20 u2 + 2 u N and a torque of 0.02 m of it at 22.2 V, measured at a supply that sags by `sag`
    /// of it at full throttle.
    fn run(sag: f64, known: &RunFacts) -> Single {
        let mut csv = String::from("throttle,thrust_n,torque_nm,voltage_v\n");
        for u in (2..=10).map(|k| 0.1 * f64::from(k)) {
            let volts = 22.2 * (1.0 - sag * u * u);
            let thrust = (20.0 * u * u + 2.0 * u) * libm::pow(volts / 22.2, TYPICAL_EXPONENT);
            csv += &format!("{u},{thrust},{},{volts}\n", 0.02 * thrust);
        }
        let log = read::read("run.csv", csv.as_bytes(), &read::Reading::default()).expect("a log");
        let bench = prepare(log, &Preparation::default()).expect("a bench");
        Single::of(&bench, known, &mut Vec::new()).expect("a rotor")
    }

    #[test]
    fn a_supply_that_sags_gives_the_curves_of_one_that_holds() {
        let known = RunFacts {
            reference_v: Some(22.2),
            ..RunFacts::default()
        };
        for sag in [0.0, 0.06, 0.1] {
            let Rotor { thrust, torque } = run(sag, &known).rotor;
            assert!((thrust.at(0.95) / 19.95 - 1.0).abs() < 1e-6, "{sag}: {thrust:?}");
            assert!((torque.at(0.95) / 0.399 - 1.0).abs() < 1e-6, "{sag}: {torque:?}");
        }
        // Without a reference at the mean voltage.
        let own = run(0.1, &RunFacts::default());
        let volts = own.voltage_v.expect("a voltage");
        let wanted = 19.95 * libm::pow(volts / 22.2, TYPICAL_EXPONENT);
        assert!((own.rotor.thrust.at(0.95) / wanted - 1.0).abs() < 1e-6, "{volts}");
        assert_eq!(own.range_v, Some([22.2 * 0.9, 22.2 * (1.0 - 0.1 * 0.2 * 0.2)]));
    }
}
