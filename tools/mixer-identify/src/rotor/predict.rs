//! The map of a pair, predicted from runs of its rotors alone, with or without rows of the pair.
//!
//! runs -> [`Single`] -> [`interaction`](mod@crate::rotor::interaction), its constants moved by rows of the
//! pair where there are some ([`posterior`](mod@super::posterior)) -> cubic basis over the box -> the
//! idle raised until the compiler takes it -> `[throttle]`, `[pair]`, `[pair.uncertainty]`,
//! `[pair.lower_out]`, `[pair.upper_out]`.

use mixer_compiler::Source;
use mixer_compiler::airframe::{Basis, EXPONENT_DEVIATION, Uncertainty, by_voltage};
use mixer_compiler::model::injectivity::EnclosedPairMap;
use serde::Serialize;
use toml_edit::DocumentMut;

use crate::air::Air;
use crate::bench::{Bench, BenchKind, is_one_signal, mean_voltage};
use crate::fit::balance::throttles;
use crate::fit::basis::ThrottleBox;
use crate::fit::fold::{CLEAR, lower_ends};
use crate::fit::voltage::{bench_range, in_pack};
use crate::fit::{Design, ten_digits};
use crate::refusal::Refusal;
use crate::rotor::Turning;
use crate::rotor::agreement::agreed;
use crate::rotor::curve::Rotor;
use crate::rotor::interaction::{CLOSED_LOOP, Interaction, OPEN_LOOP};
use crate::rotor::posterior::{BETWEEN_SYSTEMS, Case, Posterior, ROW, fit, scaled};
use crate::rotor::single::{Out, Single, UNMEASURED_TORQUE, exponents_in_words};
use crate::statistics::{greatest, rms};
use crate::table::{commented, model, pair};

/// z/D where the user does not say: spacing matters little (docs/no-bench.md).
pub const SPACING_RATIO: f64 = 0.25;
/// The range of z/D that was measured.
const KNOWN_SPACINGS: [f64; 2] = [0.1, 1.0];
/// Least idle of a predicted map: below, a rotor idles under a fast one, which was not measured.
pub const LEAST_IDLE: f64 = 0.20;
/// Greatest idle that is tried.
const MOST_IDLE: f64 = 0.45;
/// Thrust of the two rotors alone at full throttle, as a ratio less 1, above which they are not of
/// one kind.
const UNEQUAL: f64 = 0.1;
/// What rotors add that are not alike, % of full scale for each e-fold of their thrusts. An assumption: no pair of unequal
/// rotors was measured.
const UNEQUAL_PERCENT: f64 = 10.0;
/// What throttles beyond the end of a run add, % of full scale for the root of how far they go: of 208 public runs of one rotor
/// (StrawsonDesign), cut at 0.71 to 0.90 and extrapolated to their ends, 0.95 to 1, no thrust is off by more than two of it.
const BEYOND: f64 = 25.0;
/// Rows of a pair from which on they describe it better by themselves.
pub const ENOUGH_ROWS: usize = 16;

/// One standard deviation of a prediction, % of full scale of thrust and of torque: the root mean
/// square error on 52 maps of five systems, each system left out of the fit of the constants; and
/// what a table of few rows and a torque that was not measured add to it, in squares. Of this the
/// model's own error, [`ROW`], stays when rows of the pair correct it. docs/no-bench.md has the maps
/// that the project can measure.
const PREDICTED: [f64; 2] = [1.5, 3.7];
const FEW_ROWS: [f64; 2] = [1.5, 2.4];
const WITHOUT_TORQUE: [f64; 2] = [0.0, UNMEASURED_TORQUE];
/// Rows with torque that a correction of it takes.
const CORRECTING_ROWS: usize = 4;

/// What the user decides.
#[derive(Debug, Clone, Default)]
pub struct PredictOptions {
    /// z/D.
    pub spacing_ratio: Option<f64>,
    /// Whether a throttle commands a speed that the controller holds.
    pub closed_loop: bool,
    /// The box to command, or nothing for 0.2 to 1; its least idle is raised where the map asks for it.
    pub throttle: Option<ThrottleBox>,
    /// Voltage of the empty and of the full pack, V, or nothing for what the run had.
    pub pack_v: Option<[f64; 2]>,
}

/// All that `--json` prints.
#[derive(Debug, Clone, Serialize)]
pub struct Predicted {
    /// Program and version.
    pub generator: String,
    /// The map.
    pub pair: PredictedPair,
    /// The runs of the upper and of the lower rotor alone.
    pub runs: Vec<Single>,
    /// Files with rows of the pair, and the rows used.
    pub corrected_by: Vec<(String, usize)>,
    /// The options that these files needed to be read.
    pub options: Vec<String>,
    /// z/D.
    pub spacing_ratio: f64,
    /// B, m0, m1, n, a, b.
    pub constants: [f64; 6],
    /// Factors of thrust, of the upper and of the lower torque alone that the rows of the pair ask for.
    pub factors: [f64; 3],
    /// Voltage at which the map holds, V, where it is known.
    pub reference_v: Option<f64>,
    /// Voltage of the empty and of the full pack, V, where the user said so.
    pub pack_v: Option<[f64; 2]>,
    /// The air.
    pub air: Air,
    /// What the user should know.
    pub warnings: Vec<String>,
}

/// The predicted map, as in `[throttle]` and `[pair]`.
#[derive(Debug, Clone, Serialize)]
pub struct PredictedPair {
    /// Cubic.
    pub basis: Basis,
    /// Terms in the order of the coefficients.
    pub terms: Vec<String>,
    /// Coefficients of thrust, N.
    pub thrust_n: Vec<f64>,
    /// Coefficients of torque, N m.
    pub torque_nm: Vec<f64>,
    /// `cw`, as `identify` has it.
    pub upper_spin: &'static str,
    /// Whether the lower rotor is the stronger one, by its own run.
    pub lower_is_stronger: bool,
    /// The box that the file commands.
    pub throttle: ThrottleBox,
    /// Its least throttle.
    pub min_idle: f64,
    /// The upper rotor alone.
    pub lower_out: Out,
    /// The lower rotor alone.
    pub upper_out: Out,
    /// One standard deviation.
    pub uncertainty: Uncertainty,
    /// What the basis misses of the model, rms, % of the greatest thrust and torque.
    pub misfit_percent: [f64; 2],
}

/// Predicts the pair of a rotor, or of two that differ; rows of the pair move the constants.
///
/// # Errors
/// Files that are no maps, and a map that the compiler does not take at any idle.
pub fn correct(
    upper: Single,
    lower: Option<Single>,
    maps: &[Bench],
    air: Air,
    wishes: &PredictOptions,
    mut warnings: Vec<String>,
) -> Result<Predicted, Refusal> {
    let runs: Vec<Single> = [Some(upper), lower].into_iter().flatten().collect();
    let end = runs.iter().map(Single::end).fold(1.0, f64::min);
    let throttle = wishes.throttle.unwrap_or(ThrottleBox {
        min: LEAST_IDLE,
        max: end,
    });
    if end < 1.0 {
        let beyond = match throttle.max > end {
            true => "what is above is extrapolated",
            false => "what is above is never commanded; measure up to full throttle",
        };
        warnings.push(format!(
            "throttle.max is {}, a run ends at {end}: {beyond}",
            throttle.max
        ));
    }
    remarks(&runs, wishes, throttle, &mut warnings);
    in_pack(runs[0].voltage_v, wishes.pack_v)?;
    let alone = rotors(&runs);
    let spacing_ratio = wishes.spacing_ratio.unwrap_or(SPACING_RATIO);
    let general = match wishes.closed_loop {
        true => CLOSED_LOOP,
        false => OPEN_LOOP,
    };
    warnings.extend(maps.iter().filter_map(|map| other_voltage(&runs[0], map)));
    let (case, places) = case(&runs, maps, general, spacing_ratio, throttle)?;
    if !maps.is_empty() {
        advise(&case, &mut warnings);
    }
    let names = runs.iter().map(|run| run.file.as_str());
    let found = agreed(
        general,
        &case,
        &itertools::join(names, " and "),
        &places,
        &mut warnings,
    )?;
    let uncertainty = uncertainty(general, &runs, &case, &found, throttle);
    let constants = found.interaction;
    let factors = found.factors.first().copied().unwrap_or([1.0; 3]);
    let rotors = scaled(&alone, factors);
    let map = |throttles| constants.pair(&rotors, spacing_ratio, throttles);
    let mut pair = compiled(&map, rotors, uncertainty, throttle, &runs[0].file)?;
    pair.lower_is_stronger =
        full_thrusts(&runs).is_some_and(|[upper, lower]| lower > (1.0 + UNEQUAL) * upper);
    if pair.min_idle > throttle.min + 1e-9 {
        warnings.push(format!(
            "throttle.min is raised from {} to {}: below, the predicted map folds or is not inverted to its tolerance",
            throttle.min, pair.min_idle
        ));
    }
    Ok(Predicted {
        generator: format!("cargo mixer predict {}", env!("CARGO_PKG_VERSION")),
        pair,
        reference_v: runs[0].voltage_v,
        pack_v: wishes.pack_v,
        air,
        runs,
        corrected_by: maps.iter().map(|m| (m.file.clone(), m.points.len())).collect(),
        options: Vec::new(),
        spacing_ratio,
        constants: constants.constants.map(ten_digits),
        factors: factors.map(ten_digits),
        warnings,
    })
}

/// What speaks against the model, for these runs.
fn remarks(runs: &[Single], wishes: &PredictOptions, throttle: ThrottleBox, warnings: &mut Vec<String>) {
    let [least, most] = KNOWN_SPACINGS;
    if let Some(ratio) = wishes.spacing_ratio
        && !(least..=most).contains(&ratio)
    {
        warnings.push(format!(
            "z/D is {ratio:.2}: the interaction was measured from {least} to {most} and is extrapolated"
        ));
    }
    if throttle.min < LEAST_IDLE {
        warnings.push(format!(
            "the idle of {} is below {LEAST_IDLE}, where a prediction was not held against benches",
            throttle.min
        ));
    }
    if let Some([upper, lower]) =
        full_thrusts(runs).filter(|[upper, lower]| (upper / lower - 1.0).abs() > UNEQUAL)
    {
        warnings.push(format!(
            "the rotors alone give {upper:.2} and {lower:.2} N at full throttle: the interaction was measured on equal \
             rotors, so trust this the less, and look whether one run was blocked or at another voltage"
        ));
    }
    if let (Some(range), None, false) = (runs[0].range_v, wishes.pack_v, wishes.closed_loop) {
        warnings.push(bench_range(range));
    }
    let volts: Vec<f64> = runs.iter().filter_map(|run| run.voltage_v).collect();
    if let [a, b] = volts[..]
        && (a / b - 1.0).abs() > 0.03
    {
        warnings.push(format!(
            "the runs are of {a:.2} and {b:.2} V: --reference-voltage brings both to one"
        ));
    }
}

/// Thrusts of two runs at full throttle, N; none of one run for both rotors.
fn full_thrusts(runs: &[Single]) -> Option<[f64; 2]> {
    (runs.len() == 2).then(|| rotors(runs).map(|rotor| rotor.thrust.at(1.0)))
}

/// The upper and the lower rotor, which may be alike.
fn rotors(runs: &[Single]) -> [Rotor; 2] {
    [&runs[0], runs.get(1).unwrap_or(&runs[0])].map(|run| run.rotor)
}

/// The rows of maps at the voltage of the runs, and the place of each.
fn case(
    runs: &[Single],
    maps: &[Bench],
    general: Interaction,
    spacing_ratio: f64,
    ThrottleBox { max, .. }: ThrottleBox,
) -> Result<(Case, Vec<String>), Refusal> {
    let (rotors, mut rows, mut places) = (rotors(runs), Vec::new(), Vec::new());
    for map in maps {
        if map.kind != BenchKind::Pair {
            return Err(Refusal::of(
                &map.file,
                "one rotor stands still in it: it is no row of the pair",
                "rows in which both rotors turn; a run of one rotor alone by --prior",
            ));
        }
        places.extend(map.points.iter().map(|p| format!("{}:{}", map.file, p.line)));
        // As one supply for both rotors at the voltage of the runs.
        rows.extend(map.points.iter().map(|p| {
            let [u, l] = throttles(p);
            let own = runs[0].voltage_v.filter(|_| p.voltage.is_finite());
            let p = own.map_or(*p, |of_run| p.at_voltage(p.voltage, of_run, runs[0].exponents));
            [u, l, p.thrust, p.torque]
        }));
    }
    // The greatest torque is that of one rotor fast and the other slow.
    let [full, _] = general.pair(&rotors, spacing_ratio, [max; 2]);
    let corners =
        [[LEAST_IDLE, max], [max, LEAST_IDLE]].map(|t| general.pair(&rotors, spacing_ratio, t)[1].abs());
    // The model knows no map better than the curves under it know their runs.
    let misfit = |k: usize| {
        let percent = runs.iter().filter_map(|run| run.misfit_percent[k]);
        percent.fold(100.0 * ROW[k], f64::max) / 100.0
    };
    let case = Case {
        rotors,
        spacing_ratio,
        rows,
        full_scale: [full, corners[0].max(corners[1])],
        row: [misfit(0), misfit(1)],
    };
    Ok((case, places))
}

/// Voltages of a run and of rows, as a ratio less 1, above which it is told that they are brought together.
const OTHER_VOLTAGE: f64 = 0.03;

/// A remark on rows of another voltage than the run's, or of which it is not known.
fn other_voltage(run: &Single, map: &Bench) -> Option<String> {
    let of_rows = mean_voltage(&map.points).map(|(mean, _)| mean);
    match (run.voltage_v, of_rows) {
        _ if run.exponents == [0.0; 2] => None,
        (Some(of_run), Some(of_rows)) => ((of_rows / of_run - 1.0).abs() > OTHER_VOLTAGE).then(|| {
            format!(
                "{} is of {of_rows:.2} V and is brought to {of_run:.2} V by {}",
                map.file,
                exponents_in_words(run.exponents)
            )
        }),
        (None, None) => None,
        _ => Some(format!(
            "one of {} and {} has no voltage (--run-voltage VOLT is that of the run): both are taken for runs at one",
            run.file, map.file
        )),
    }
}

fn advise(case: &Case, warnings: &mut Vec<String>) {
    let rows = case.rows.len();
    let with_torque = case.rows.iter().filter(|row| row[3].is_finite()).count();
    if case.rows.iter().all(|[u, l, ..]| is_one_signal([*u, *l])) {
        warnings.push(format!(
            "{rows} rows of equal throttles: what unequal ones give is from the model alone; rows at (0.95, 0.4) and (0.4, 0.95) \
             would tell"
        ));
    } else if with_torque >= ENOUGH_ROWS {
        warnings.push(format!(
            "{with_torque} rows of the pair with torque: from {ENOUGH_ROWS} on, spread over both throttles, a plain identify \
             is truer; leave --prior out"
        ));
    } else if with_torque < CORRECTING_ROWS {
        warnings.push(format!(
            "{with_torque} of {rows} rows of the pair have a torque, which is corrected little: four with both, at (0.6, 0.6), \
             (0.95, 0.4), (0.4, 0.95) and (0.95, 0.95), halve the error"
        ));
    }
}

/// What was measured of predictions without rows, in the proportion in which rows narrow the model's
/// own, and widened where they fit it badly.
fn uncertainty(
    general: Interaction,
    runs: &[Single],
    case: &Case,
    found: &Posterior,
    throttle: ThrottleBox,
) -> Uncertainty {
    let few = runs.iter().any(Single::is_sparse);
    let no_torque = runs.iter().any(|run| run.kappa_m.is_some());
    let of_voltage = runs.iter().filter(|run| run.exponents != [0.0; 2]).map(|run| {
        let brought = run.run_v.zip(run.voltage_v);
        brought.map_or(0.0, |(from, to)| by_voltage(EXPONENT_DEVIATION, from, to))
    });
    let of_voltage = of_voltage.fold(0.0, f64::max);
    let beyond = runs
        .iter()
        .map(|run| throttle.max - run.end())
        .fold(0.0, f64::max);
    let unequal =
        UNEQUAL_PERCENT * libm::log(full_thrusts(runs).map_or(1.0, |[upper, lower]| lower / upper)).abs();
    let adding = [
        (true, PREDICTED),
        (few, FEW_ROWS),
        (no_torque, WITHOUT_TORQUE),
        (true, [of_voltage; 2]),
        (true, [unequal; 2]),
        (true, [BEYOND * beyond.sqrt(); 2]),
    ];
    let without = Case {
        rows: Vec::new(),
        ..case.clone()
    };
    let before = fit(general, BETWEEN_SYSTEMS, std::slice::from_ref(&without)).spread(case, throttle);
    let after = found.spread(case, throttle);
    let percent = |k: usize| {
        let squares = adding.iter().filter(|(is, _)| *is).map(|(_, of)| of[k] * of[k]);
        let ([row, own], narrowed) = ([ROW[k], case.row[k]].map(|x| 100.0 * x), after[k] / before[k]);
        let learned = (squares.sum::<f64>() - row * row) * narrowed * narrowed;
        ((own * own + learned) * found.misfit.max(1.0)).sqrt()
    };
    let mut found = Uncertainty::rounded(percent(0), percent(1));
    found.is_predicted = true;
    found
}

/// The cubic of the map over the box, or the refusal with the box in which there is one.
fn compiled(
    map: &dyn Fn([f64; 2]) -> [f64; 2],
    rotors: [Rotor; 2],
    uncertainty: Uncertainty,
    wished: ThrottleBox,
    file: &str,
) -> Result<PredictedPair, Refusal> {
    let within = |throttle| at_an_idle(map, rotors, uncertainty, throttle);
    let narrower = || lower_ends(wished).find_map(|max| within(ThrottleBox { max, ..wished }));
    within(wished).ok_or_else(|| {
        let (from, to) = (wished.min, MOST_IDLE.max(wished.min));
        let reason = format!("the predicted map cannot be inverted at any idle from {from} to {to}");
        let needed = match narrower() {
            Some(PredictedPair { throttle, .. }) => {
                format!(
                    "--throttle {},{}, over which it can be",
                    throttle.min, throttle.max
                )
            }
            None => "a run of a rotor whose thrust and torque grow over all throttles, or a bench".to_owned(),
        };
        Refusal::of(file, reason, needed)
    })
}

/// The cubic of the map over the box whose idle the compiler takes: the least from the wished one
/// on, in steps of a hundredth.
fn at_an_idle(
    map: &dyn Fn([f64; 2]) -> [f64; 2],
    [upper, lower]: [Rotor; 2],
    uncertainty: Uncertainty,
    wished: ThrottleBox,
) -> Option<PredictedPair> {
    let basis = Basis::Cubic;
    let idles = (0..).map(|step| (1e4 * (wished.min + 0.01 * f64::from(step))).round() / 1e4);
    for min in idles.take_while(|min| *min <= MOST_IDLE.max(wished.min)) {
        let throttle = ThrottleBox { min, ..wished };
        let points: Vec<[f64; 2]> = throttle.square(20).collect();
        let design = Design::new(basis, &points, throttle).ok()?;
        let values: Vec<[f64; 2]> = points.iter().map(|&t| map(t)).collect();
        let channel = |k: usize| {
            let y: Vec<f64> = values.iter().map(|v| v[k]).collect();
            let z = design.coordinates(&y);
            let missed = rms(design.residuals(&y, &z)) / greatest(&y);
            let coefficients: Vec<f64> = design.coefficients(&z).into_iter().map(ten_digits).collect();
            (coefficients, 100.0 * missed)
        };
        let ((thrust_n, f), (torque_nm, q)) = (channel(0), channel(1));
        let enclosed = EnclosedPairMap::of(basis, &thrust_n, &torque_nm);
        let clear = ThrottleBox {
            min: throttle.min / CLEAR,
            ..throttle
        };
        if enclosed.prove_injective(clear.into()).is_err() {
            continue;
        }
        let pair = PredictedPair {
            basis,
            terms: basis.term_names(),
            thrust_n,
            torque_nm,
            upper_spin: "cw",
            lower_is_stronger: false,
            throttle,
            min_idle: throttle.min,
            lower_out: Out::of(upper, -1.0),
            upper_out: Out::of(lower, 1.0),
            uncertainty,
            misfit_percent: [f, q].map(ten_digits),
        };
        if mixer_compiler::compile(&Source::new("predicted.toml", one_pair(&pair))).is_ok() {
            return Some(pair);
        }
    }
    None
}

/// An airframe of one such pair, for the compiler to judge.
fn one_pair(pair: &PredictedPair) -> String {
    format!(
        "name = \"predicted\"\n{}[[unit]]\nposition_m = [0.0, 0.0, 0.0]\nupper_spin = \"cw\"\nchannels = [0, 1]\n\
         [allocation]\naxes = [\"yaw\", \"thrust\"]\n",
        pair.tables(&|_| String::new(), &[])
    )
}

impl PredictedPair {
    /// `[throttle]` and `[pair]`, with what stands above a table by its name.
    pub(crate) fn tables(&self, about: &dyn Fn(&str) -> String, options: &[String]) -> DocumentMut {
        let terms = [&self.thrust_n, &self.torque_nm].map(|of| commented(of, self.terms.iter().cloned()));
        let alone = [
            (Turning::Upper, self.lower_out.both()),
            (Turning::Lower, self.upper_out.both()),
        ];
        let entries = pair(
            about,
            self.basis,
            terms,
            self.lower_is_stronger,
            alone.into_iter(),
        );
        model(
            about,
            self.throttle,
            "pair",
            entries,
            Some(&self.uncertainty),
            options,
        )
    }
}
