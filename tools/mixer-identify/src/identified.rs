//! From bench files to what was identified.

use mixer_compiler::airframe::{Uncertainty, by_voltage};
use serde::Serialize;

use crate::air::{Air, DENSITY_EXPONENT};
use crate::bench::read::Reading;
use crate::bench::{Bench, BenchKind, Point, Preparation, equal_commands, is_one_signal};
use crate::fit::balance::balanced;
use crate::fit::basis::ThrottleBox;
use crate::fit::hundredths;
use crate::fit::pair::{self, Pair, names};
use crate::fit::power::{self, Power};
use crate::fit::voltage::{self, Exponent, Voltage, bench_range, in_pack};
use crate::fit::wishes::FitOptions;
use crate::numbers;
use crate::refusal::Refusal;
use crate::rotor::Turning;
use crate::rotor::alone;
use crate::rotor::single::{Out, RunFacts, Single, UNMEASURED_TORQUE};
use crate::statistics::extent;

/// Everything that decides an identification, besides the files.
#[derive(Debug, Clone, Default)]
pub struct Settings {
    /// How files are read.
    pub reading: Reading,
    /// How rows become points.
    pub preparation: Preparation,
    /// How points are fitted.
    pub wishes: FitOptions,
    /// `reading` and `preparation` as options of `cargo mixer identify`, which the tables remember.
    pub options: Vec<String>,
}

/// `[[rotor]]`: a rotor alone, of its run.
#[derive(Debug, Clone, Serialize)]
pub struct SingleRotor {
    /// The name by which units have it.
    pub name: String,
    /// Its thrust and torque.
    #[serde(flatten)]
    pub curves: Out,
    /// The throttles to command.
    pub throttle: ThrottleBox,
    /// One standard deviation.
    pub uncertainty: Uncertainty,
    /// The run.
    pub run: Single,
}

/// All that `--json` prints.
#[derive(Debug, Clone, Serialize)]
pub struct Identified {
    /// Program and version.
    pub generator: String,
    /// The map; none where all files are of single rotors.
    pub pair: Option<Pair>,
    /// The single rotor; none where there is a map.
    pub rotor: Option<SingleRotor>,
    /// The effect of the voltage; none where no file has a voltage.
    pub voltage: Option<Voltage>,
    /// The air.
    pub air: Air,
    /// The torque of least power; none where all files are of single rotors.
    pub power: Option<Power>,
    /// What was read.
    pub files: Vec<Bench>,
    /// The options that the files needed to be read: [`Settings::options`].
    pub options: Vec<String>,
    /// Reference voltage of the fragment, V; none where the map's rows have no voltage and none was
    /// given.
    pub reference_v: Option<f64>,
    /// Whether the controllers hold a speed, so that nothing follows the voltage.
    pub closed_loop: bool,
    /// Voltage of the empty and of the full pack, V, where the user said so.
    pub pack_v: Option<[f64; 2]>,
    /// What the user should know.
    pub warnings: Vec<String>,
}

impl Identified {
    /// The torque of least power, N m per N, where power is saved by one.
    pub fn power_bias(&self) -> Option<f64> {
        match &self.power {
            Some(Power::Identified(found)) => Some(found.bias_nm_per_n),
            _ => None,
        }
    }
}

/// Identifies a pair, its voltage law and its power from benches that have been read.
///
/// # Errors
/// Two files of one name, copies, columns that are one signal, or points that do not determine the pair.
pub fn from_benches(benches: Vec<Bench>, wishes: &FitOptions) -> Result<Identified, Refusal> {
    with_runs(benches, [None, None], wishes)
}

/// [`from_benches`] with runs of the upper and of the lower rotor alone.
///
/// # Errors
/// Those of [`from_benches`], and a run that is of a pair, of the other rotor or too short to be fitted.
pub fn with_runs(
    mut benches: Vec<Bench>,
    mut runs: [Option<Bench>; 2],
    wishes: &FitOptions,
) -> Result<Identified, Refusal> {
    each_once(&benches)?;
    two_signals(&benches)?;
    let of_air = match wishes.closed_loop {
        true => [1.0; 2],
        false => wishes
            .voltage_exponent
            .map_or([DENSITY_EXPONENT; 2], |k| k.map(|k| k - 1.0)),
    };
    let mut air = Air::of(&benches, of_air);
    benches
        .iter_mut()
        .chain(runs.iter_mut().flatten())
        .for_each(|b| air.bring(b));
    let all = benches.iter().chain(runs.iter().flatten());
    let anomalies: Result<Vec<_>, Refusal> = all.map(|bench| numbers::anomalies(bench, None)).collect();
    let anomalies = anomalies?.concat();
    let balanced: Vec<Bench> = benches.iter().map(balanced).collect();
    let voltage = measured_exponents(&balanced).filter(|_| !wishes.closed_loop);
    let voltage = match wishes.voltage_exponent {
        Some(exponents) => Some(declared(voltage, exponents, &benches)?),
        None => voltage,
    };
    // Without exponents the sag of either supply stays in the map.
    let exponents = voltage.as_ref().and_then(Voltage::exponents);
    let benches = if exponents.is_some() { balanced } else { benches };
    air.exponents = exponents.map_or(of_air, |k| k.map(|k| k - 1.0));
    let has = |kind| benches.iter().any(|b| b.kind == kind);
    let read = benches.iter().chain(runs.iter().flatten());
    let offsets: Vec<String> = read.flat_map(Bench::offset_notes).collect();
    let mut warnings = Vec::new();
    let pair = if has(BenchKind::Pair) {
        let pair = pair::identify(&benches, voltage.as_ref(), wishes, &anomalies)?;
        warnings.extend(pair.warnings.clone());
        let of_runs = with_alone(pair, &runs, voltage.as_ref(), &mut warnings);
        Some(of_runs?)
    } else {
        no_runs(&runs)?;
        None
    };
    warnings.extend(offsets.into_iter().chain(air.doubt()));
    if let Some(v) = &voltage {
        warnings.extend(voltage_warnings(v, wishes.pack_v.is_some()));
        warnings.extend(sag(&benches, v));
    }
    if has(BenchKind::Pair) && has(BenchKind::SingleRotor) {
        warnings.push("single-rotor files serve the voltage exponents only, not the pair's map".into());
    }
    if wishes.pack_v.is_some() && exponents.is_none() && !wishes.closed_loop {
        return Err(Refusal::general(
            "--cells has nothing to work on without an exponent of the voltage",
            "--voltage-exponent 1.75 beside it, which writes [voltage], or no --cells",
        ));
    }
    let reference_v = reference(pair.as_ref(), voltage.as_ref(), wishes.reference_v, &mut warnings)?;
    in_pack(reference_v, wishes.pack_v)?;
    let rotor = match pair {
        Some(_) => None,
        None => Some(single_rotor(
            &benches,
            voltage.as_ref(),
            reference_v,
            wishes,
            &mut warnings,
        )?),
    };
    let power = pair
        .as_ref()
        .map(|pair| power::examine(&benches, pair, voltage.as_ref()));
    Ok(Identified {
        generator: format!("cargo mixer identify {}", env!("CARGO_PKG_VERSION")),
        pair,
        rotor,
        voltage,
        air,
        power,
        files: benches,
        options: Vec::new(),
        reference_v,
        closed_loop: wishes.closed_loop,
        pack_v: wishes.pack_v,
        warnings,
    })
}

/// The pair with its rotors alone, from their runs.
fn with_alone(
    mut pair: Pair,
    runs: &[Option<Bench>; 2],
    voltage: Option<&Voltage>,
    warnings: &mut Vec<String>,
) -> Result<Pair, Refusal> {
    for (run, turning) in runs.iter().zip([Turning::Upper, Turning::Lower]) {
        let found = match run {
            Some(run) => alone::identify(run, turning, &pair, voltage, warnings)?,
            None => continue,
        };
        match turning {
            Turning::Upper => pair.lower_out = Some(found),
            Turning::Lower => pair.upper_out = Some(found),
        }
    }
    warnings.extend(alone::extrapolated(&pair));
    Ok(pair)
}

/// Refuses runs of one rotor alone where there is no map of a pair.
fn no_runs(runs: &[Option<Bench>; 2]) -> Result<(), Refusal> {
    match runs.iter().flatten().next() {
        None => Ok(()),
        Some(run) => Err(Refusal::of(
            &run.file,
            "a run of one rotor alone belongs to a map of the pair, and there is none",
            "the map of the pair as BENCH.csv",
        )),
    }
}

/// The reference voltage of the fragment, V: the user's, or the mean of the map's rows.
fn reference(
    pair: Option<&Pair>,
    voltage: Option<&Voltage>,
    wished: Option<f64>,
    warnings: &mut Vec<String>,
) -> Result<Option<f64>, Refusal> {
    let mean = match pair {
        Some(pair) => pair.normalised_to_v.or(pair.mean_v),
        None => voltage.map(|v| v.mean_v),
    };
    let reference_v = wished.or(mean.map(hundredths));
    if pair.is_some() && reference_v.is_none() && voltage.is_some() {
        warnings.push("the map's own voltage is not known: give --reference-voltage for [voltage]".into());
    }
    if let (Some(reference), Some([low, high])) = (wished, voltage.map(|v| v.range_v)) {
        if reference < low / FAR || reference > FAR * high {
            return Err(Refusal::general(
                format!("--reference-voltage {reference}: the rows were measured at {low:.2} to {high:.2} V"),
                "a voltage that the bench had, or nothing for the mean of the rows",
            ));
        }
        if !(low..=high).contains(&reference) {
            let told =
                format!("--reference-voltage {reference} is outside the measured {low:.2}..{high:.2} V");
            warnings.push(told);
        }
    }
    Ok(reference_v)
}

/// How many times beyond the measured voltages a reference may be: a pack of twice the cells.
const FAR: f64 = 2.0;

/// Refuses pairs whose rotors have the same throttle throughout.
fn two_signals(benches: &[Bench]) -> Result<(), Refusal> {
    let pairs = benches.iter().filter(|bench| bench.kind == BenchKind::Pair);
    let files: Vec<&str> = pairs.clone().map(|bench| bench.file.as_str()).collect();
    let mut points = pairs.flat_map(|bench| &bench.points);
    match !files.is_empty() && points.all(|p| is_one_signal([p.u, p.l])) {
        false => Ok(()),
        true => Err(Refusal::of(
            files.join(", "),
            "both rotors turn by one signal: equal throttles throughout say nothing of unequal ones",
            format!(
                "{}; a map takes a throttle for each rotor",
                equal_commands(&files)
            ),
        )),
    }
}

/// Refuses a file of another's name, since rows are named by name and line, and a copy of another: it repeats nothing, and
/// narrows every interval.
fn each_once(benches: &[Bench]) -> Result<(), Refusal> {
    let rows = |bench: &Bench| {
        let points = bench.points.iter().map(|p| Point { line: 0, ..*p });
        format!("{:?}", points.collect::<Vec<_>>())
    };
    let all: Vec<[String; 2]> = benches.iter().map(|b| [b.file.clone(), rows(b)]).collect();
    for (k, [name, rows]) in all.iter().enumerate() {
        let reason = match () {
            () if all[..k].iter().any(|other| other[0] == *name) => "the name is given twice",
            () if all[..k].iter().any(|other| other[1] == *rows) => {
                "its rows are those of another file in every digit: a copy is no repeat"
            }
            () => continue,
        };
        return Err(Refusal::of(name, reason, "each file once, under its own name"));
    }
    Ok(())
}

/// The exponents from the pair's own maps if these tell any, else from single rotors.
fn measured_exponents(benches: &[Bench]) -> Option<Voltage> {
    let pair = voltage::examine(benches, BenchKind::Pair);
    let single = voltage::examine(benches, BenchKind::SingleRotor);
    match (pair, single) {
        (Some(p), Some(s)) if p.thrust.estimate().is_none() && s.thrust.estimate().is_some() => Some(s),
        (p, s) => p.or(s),
    }
}

/// The voltage's effect with the user's own exponents, which need a voltage of every row to work on.
fn declared(
    measured: Option<Voltage>,
    [thrust, torque]: [f64; 2],
    benches: &[Bench],
) -> Result<Voltage, Refusal> {
    let refuse = |reason: &str, needed: &str| {
        let reason = format!("--voltage-exponent has nothing to work on: {reason}");
        Err(Refusal::of(names(benches), reason, needed))
    };
    let Some(voltage) = measured else {
        return refuse(
            "no file has a voltage column",
            "the supply voltage of every row, in a column of its own (--column voltage=HEADER)",
        );
    };
    Ok(Voltage {
        thrust: voltage.thrust.declared(thrust),
        torque: voltage.torque.declared(torque),
        ..voltage
    })
}

/// Least throttle that is commanded of a rotor whose run begins lower.
const LEAST_IDLE: f64 = 0.05;

/// The rotor of runs of one alone.
fn single_rotor(
    benches: &[Bench],
    voltage: Option<&Voltage>,
    reference_v: Option<f64>,
    wishes: &FitOptions,
    warnings: &mut Vec<String>,
) -> Result<SingleRotor, Refusal> {
    // Thrust and torque follow the speed alike: the exponent of the one stands in for the other's.
    let brought = voltage.and_then(|voltage| {
        let thrust = voltage.thrust.value()?;
        Some((voltage, [thrust, voltage.torque.value().unwrap_or(thrust)]))
    });
    let bench = Bench {
        file: names(benches),
        points: benches.iter().flat_map(|bench| bench.points.clone()).collect(),
        ..benches[0].clone()
    };
    let known = RunFacts {
        exponents: brought.map_or([0.0; 2], |(_, exponents)| exponents),
        reference_v: reference_v.filter(|_| brought.is_some()),
        ..wishes.run
    };
    let run = Single::of(&bench, &known, warnings)?;
    let freedom = run.points as f64 / (run.points - 3) as f64;
    let deviation = |k: usize| {
        let own = run.misfit_percent[k].unwrap_or(UNMEASURED_TORQUE);
        let law = brought
            .zip(run.run_v.zip(run.voltage_v))
            .map_or(0.0, |((voltage, _), (from, to))| {
                by_voltage([&voltage.thrust, &voltage.torque][k].deviation(), from, to)
            });
        (own * own * freedom + law * law).sqrt()
    };
    Ok(SingleRotor {
        name: wishes.name.clone().unwrap_or_else(|| "rotor".to_owned()),
        curves: Out::of(run.rotor, 1.0),
        throttle: wishes.throttle.unwrap_or(ThrottleBox {
            min: run.measured[0].max(LEAST_IDLE),
            max: run.end(),
        }),
        uncertainty: Uncertainty::rounded(deviation(0), deviation(1)),
        run,
    })
}

/// Sag of the supply within one map, as a share of its highest voltage, above which it matters how
/// the voltage of the flight is measured: thrust then misses by 5 % and more.
const SAG: f64 = 0.03;

/// A warning about a supply that sagged with the load, for the use of `[voltage]`.
fn sag(benches: &[Bench], voltage: &Voltage) -> Option<String> {
    let sag_of = |bench: &Bench| {
        let volts = bench.points.iter().map(|p| p.voltage).filter(|v| v.is_finite());
        let [low, high] = extent(volts);
        if high > 0.0 { 1.0 - low / high } else { 0.0 }
    };
    let maps = benches.iter().filter(|b| b.kind == BenchKind::Pair);
    let sag = maps.map(sag_of).fold(0.0, f64::max);
    if sag <= SAG {
        return None;
    }
    let percent = 100.0 * sag;
    Some(match voltage.exponents() {
        Some([thrust, torque]) => format!(
            "the supply sagged by {percent:.1} % within a map, and its rows are brought to one voltage: measure the voltage \
             of the flight under load where the bench did; at no load thrust errs by up to {:.0} %, torque by {:.0} %",
            100.0 * (1.0 - libm::pow(1.0 - sag, thrust)),
            100.0 * (1.0 - libm::pow(1.0 - sag, torque))
        ),
        None => format!(
            "the supply sagged by {percent:.1} % within a map, which the map includes: --voltage-exponent 1.75 brings the \
             rows to one voltage and writes [voltage]"
        ),
    })
}

fn voltage_warnings(voltage: &Voltage, pack_is_known: bool) -> Vec<String> {
    let channels = voltage.channels().into_iter();
    let mut told: Vec<String> = channels
        .filter_map(|(name, exponent)| match exponent {
            Exponent::Declared {
                exponent,
                measured: Some(e),
            } if (exponent - e.exponent).abs() > e.ci95 => Some(format!(
                "--voltage-exponent declares {exponent} for {name}, the files themselves give {:.3} +- {:.3}",
                e.exponent, e.ci95
            )),
            Exponent::Refused { reason, needed } if voltage.varies() => Some(format!(
                "no {name} exponent of voltage: {reason}; needed: {needed}"
            )),
            Exponent::NotMeasured if voltage.varies() => {
                Some(format!("no {name} exponent of voltage: no file has its column"))
            }
            _ => None,
        })
        .collect();
    if matches!(voltage.thrust, Exponent::Declared { .. }) && !pack_is_known {
        told.push(bench_range(voltage.range_v));
    }
    told
}
