//! The map of a pair from bench points: choice of the basis, fit, outliers, fold.

use mixer_compiler::airframe::{Basis, Uncertainty, by_voltage};
use mixer_compiler::model::injectivity::EnclosedPairMap;
use serde::Serialize;

use self::drift::Shown;
use self::placed::{Placed, at_reference, channels, confirmed, places, suspects, without};
use crate::bench::sign::AUTO;
use crate::bench::{Bench, BenchKind, mean_voltage};
use crate::fit::basis::ThrottleBox;
use crate::fit::cross::{self, Candidate};
use crate::fit::fold::{self, CLEAR, Fold};
use crate::fit::robust::{self, Outlier};
use crate::fit::voltage::Voltage;
use crate::fit::wishes::FitOptions;
use crate::fit::{Deficient, Design, Fit, fit, range};
use crate::numbers::Anomaly;
use crate::refusal::Refusal;
use crate::rotor::Alone;

mod doubts;
pub mod drift;
mod placed;

/// The identified map, as in `[throttle]` and `[pair]`.
#[derive(Debug, Clone, Serialize)]
pub struct Pair {
    /// Basis of both channels.
    pub basis: Basis,
    /// Terms in the order of the coefficients.
    pub terms: Vec<String>,
    /// Coefficients of thrust, N.
    pub thrust_n: Vec<f64>,
    /// Coefficients of torque, N m, positive where the lower rotor outweighs the upper.
    pub torque_nm: Vec<f64>,
    /// `cw`: the spin of the upper rotor for which that sign of torque is clockwise on the
    /// airframe.
    pub upper_spin: &'static str,
    /// Whether the lower rotor is the stronger one, as the user said of the columns.
    pub lower_is_stronger: bool,
    /// The upper rotor alone, from `--lower-out`.
    pub lower_out: Option<Alone>,
    /// The lower rotor alone, from `--upper-out`.
    pub upper_out: Option<Alone>,
    /// Statistics of thrust.
    pub thrust: Fit,
    /// Statistics of torque.
    pub torque: Fit,
    /// The box that the file commands.
    pub throttle: ThrottleBox,
    /// Measured range of throttle, of the upper and of the lower rotor.
    pub measured: [[f64; 2]; 2],
    /// The error on throttle levels that were left out; none where too few were measured.
    pub uncertainty: Option<Uncertainty>,
    /// Cross-validation, one entry per basis; one basis only if it was given.
    pub cross_validation: Vec<Candidate>,
    /// Rows that stand out.
    pub outliers: Vec<Outlier>,
    /// Whether they were left out.
    pub outliers_left_out: bool,
    /// Drifts by the order of the rows, of every file.
    pub drift: Vec<Shown>,
    /// The fold of the map before `throttle.min` was raised.
    pub fold: Fold,
    /// Reference voltage, V, to which the points were brought by the exponents.
    pub normalised_to_v: Option<f64>,
    /// Mean voltage of the rows, V.
    pub mean_v: Option<f64>,
    /// What the user should know.
    pub warnings: Vec<String>,
}

/// Identifies the pair that the benches of [`BenchKind::Pair`] describe.
///
/// `anomalies` are the numbers of the files that are outside; of their shape a drift is the better reason.
///
/// # Errors
/// Files that do not give a map of one pair.
pub(crate) fn identify(
    benches: &[Bench],
    voltage: Option<&Voltage>,
    wishes: &FitOptions,
    anomalies: &[Anomaly],
) -> Result<Pair, Refusal> {
    let benches: Vec<&Bench> = benches.iter().filter(|b| b.kind == BenchKind::Pair).collect();
    let files = names(benches.iter().copied());
    let mut warnings = Vec::new();
    let (mut points, normalised_to_v) = at_reference(&benches, voltage, wishes)?;
    let measured = range(&places(&points));
    let throttle_box = to_command(wishes.throttle, measured, &files, &mut warnings)?;

    let (cross_validation, outliers) =
        choose(&points, throttle_box, wishes).map_err(|reason| deficient(&files, reason))?;
    let basis = cross::chosen(&cross_validation).map_or(Basis::Biquadratic, |c| c.basis);
    let all = points.len();
    if wishes.robust {
        points = without_outliers(&points, &outliers);
    }
    warnings.extend(standing_out(outliers.len(), all, wishes.robust));

    let design =
        Design::new(basis, &places(&points), throttle_box).map_err(|reason| deficient(&files, reason))?;
    let fits = channels(&points).map(|values| fit(&design, &values, throttle_box));
    one_pair(basis, &points, throttle_box, &fits, &mut warnings)?;
    let explained = |refusal: Refusal| Anomaly::explains(anomalies, refusal);
    doubts::unexplained(&files, fits.each_ref(), &mut warnings).map_err(explained)?;
    let [thrust, torque] = fits.each_ref().map(|fit| fit.coefficients.as_slice());
    let fold = fold::examine(basis, thrust, torque, throttle_box);
    let idle = idle(basis, &fits, &fold, &files, &mut warnings).map_err(explained)?;

    let [thrust, torque] = fits;
    let sign_is_found = benches.iter().any(|bench| bench.signs.torque_policy == AUTO);
    // Other causes are judged by what a drift leaves: it looks like them.
    let drift = drift::examine(basis, &mut points, &mut warnings);
    let judged = fit(&design, &channels(&points)[1], throttle_box);
    let drifts = |file: &str| {
        drift
            .iter()
            .any(|shown| shown.file == file && shown.is_significant())
    };
    let explains = |anomaly: &&Anomaly| !(anomaly.of_shape() && drifts(&anomaly.file));
    let anomalies: Vec<&Anomaly> = anomalies.iter().filter(explains).collect();
    // A constant in the torque, and rows that stand out, look as exchanged rotors do.
    let (mut asked, by_hand) = (Vec::new(), benches.iter().all(|bench| bench.sides_by_hand));
    let torque_drifts = drift
        .iter()
        .any(|shown| shown.of == "torque" && shown.is_significant());
    let asks = sign_is_found && !torque_drifts;
    let is_above = doubts::lower_is_stronger(basis, &judged, throttle_box, by_hand, asks, &mut asked);
    let at_rest = anomalies.iter().any(|anomaly| anomaly.is_torque_at_rest());
    if !at_rest && (wishes.robust || outliers.is_empty()) {
        warnings.extend(asked);
    }
    let lower_is_stronger = is_above && !at_rest;
    // A short report has room for the first ones.
    warnings.splice(0..0, anomalies.into_iter().map(Anomaly::sentence));
    let mean_v = mean_voltage(points.iter().map(|p| p.point)).map(|(mean, _)| mean);
    let brought = normalised_to_v.zip(mean_v).zip(voltage);
    let brought = brought.map_or([0.0; 2], |((to, from), voltage)| {
        [&voltage.thrust, &voltage.torque].map(|exponent| by_voltage(exponent.deviation(), from, to))
    });
    let uncertainty = cross::chosen(&cross_validation).and_then(Candidate::uncertainty);
    Ok(Pair {
        basis,
        terms: basis.term_names(),
        thrust_n: thrust.coefficients.clone(),
        torque_nm: torque.coefficients.clone(),
        upper_spin: "cw",
        lower_is_stronger,
        lower_out: None,
        upper_out: None,
        thrust,
        torque,
        throttle: ThrottleBox {
            min: idle,
            ..throttle_box
        },
        measured,
        uncertainty: uncertainty.map(|own| own.with(brought)),
        cross_validation,
        outliers_left_out: wishes.robust,
        outliers,
        drift,
        fold,
        normalised_to_v,
        mean_v,
        warnings,
    })
}

/// The files, by their names.
pub(crate) fn names<'a>(benches: impl IntoIterator<Item = &'a Bench>) -> String {
    let names = benches.into_iter().map(|b| b.file.as_str());
    itertools::join(names, ", ")
}

/// The box to command: the user's, or the measured one.
fn to_command(
    wished: Option<ThrottleBox>,
    measured: [[f64; 2]; 2],
    files: &str,
    warnings: &mut Vec<String>,
) -> Result<ThrottleBox, Refusal> {
    let (known, throttle) = (inside(measured), wished.unwrap_or(inside(measured)));
    if throttle.min < known.min - 1e-9 || throttle.max > known.max + 1e-9 {
        warnings.push(format!(
            "throttle {}..{} goes beyond the measured {}..{}: the map is extrapolated there",
            throttle.min, throttle.max, known.min, known.max
        ));
    }
    doubts::coverage(throttle, warnings);
    if throttle.min >= throttle.max {
        return Err(Refusal::of(
            files,
            format!("the measured throttles {measured:.3?} of both rotors share no range"),
            "a sweep of both rotors over one range of throttle, each from idle to full",
        ));
    }
    Ok(throttle)
}

/// Judges the bases by cross-validation, one where the user named it, and the rows that stand out of
/// the fit of the chosen one.
fn choose(
    points: &[Placed],
    throttle_box: ThrottleBox,
    wishes: &FitOptions,
) -> Result<(Vec<Candidate>, Vec<Outlier>), Deficient> {
    let suspects = suspects(wishes.basis.unwrap_or(robust::JUDGING), points, throttle_box);
    let clean = without(points, &suspects);
    let chosen_on = if wishes.robust { &clean } else { points };
    let [thrust, torque] = channels(chosen_on);
    let bases = wishes.basis.map_or(Basis::ALL.to_vec(), |basis| vec![basis]);
    let candidates = cross::choose(&bases, &places(chosen_on), &thrust, &torque, throttle_box)?;
    let basis = cross::chosen(&candidates).map_or(Basis::Biquadratic, |c| c.basis);
    let outliers = confirmed(basis, points, &suspects, &clean, throttle_box);
    Ok((candidates, outliers))
}

/// Share of the rows up to which those that stand out are single ones.
const SINGLE: f64 = 0.1;

/// What is said of rows that stand out.
fn standing_out(count: usize, all: usize, left_out: bool) -> Option<String> {
    match count as f64 > SINGLE * all as f64 {
        true => Some(format!(
            "{count} of {all} rows stand out, too many for single bad rows: look for what they share (a propeller, a voltage, their \
             place in the file), or measure again; to leave them out would hide it"
        )),
        false => {
            (count > 0 && !left_out).then(|| format!("{count} rows stand out: --robust fits without them"))
        }
    }
}

fn without_outliers<'a>(points: &[Placed<'a>], outliers: &[Outlier]) -> Vec<Placed<'a>> {
    let is_out = |p: &Placed| outliers.iter().any(|o| o.is(p.file, p.point.line));
    points.iter().copied().filter(|p| !is_out(p)).collect()
}

fn deficient(files: &str, Deficient(reason): Deficient) -> Refusal {
    let needed = "a sweep of both throttles independently: a grid of 5 x 5 levels or more from idle to full (cargo mixer plan)";
    Refusal::of(files, reason, needed)
}

/// The square that both rotors were measured over, rounded inwards to a ten-thousandth.
fn inside([upper, lower]: [[f64; 2]; 2]) -> ThrottleBox {
    let min = upper[0].max(lower[0]).max(0.0);
    let max = upper[1].min(lower[1]).min(1.0);
    ThrottleBox {
        min: (1e4 * min - 1e-6).ceil() / 1e4,
        max: (1e4 * max + 1e-6).floor() / 1e4,
    }
}

/// Refuses files that each fit well but not together, and warns of those that do not fit as well.
fn one_pair(
    basis: Basis,
    points: &[Placed],
    throttle_box: ThrottleBox,
    fits: &[Fit; 2],
    warnings: &mut Vec<String>,
) -> Result<(), Refusal> {
    let mut files: Vec<&str> = points.iter().map(|p| p.file).collect();
    files.dedup();
    if files.len() < 2 {
        return Ok(());
    }
    let (mut sse, mut n) = (0.0, 0);
    for file in &files {
        let own: Vec<Placed> = points.iter().copied().filter(|p| p.file == *file).collect();
        let at = places(&own);
        let Ok(design) = Design::new(basis, &at, inside(range(&at))) else {
            continue;
        };
        let [thrust, _] = channels(&own);
        let alone = fit(&design, &thrust, throttle_box);
        sse += alone.residuals.iter().map(|e| e * e).sum::<f64>();
        n += own.len();
    }
    if n < points.len() {
        return Ok(());
    }
    let (apart, together, full) = ((sse / n as f64).sqrt(), fits[0].residual_rms, fits[0].full_scale);
    if together > 2.0 * apart && together > 0.02 * full {
        return Err(Refusal::general(
            format!(
                "the files do not describe one pair: together their thrust leaves a residual of {together:.3} N \
                 rms, each by itself {apart:.3} N ({})",
                files.join(", ")
            ),
            "files of one pair at one spacing; run each pair by itself",
        ));
    }
    doubts::joined_files(&files, [together, apart], full, warnings);
    Ok(())
}

/// The idle of the identified map: the box's, or where the map folds in it or next to it a little
/// over the least one without a fold, rounded up to 0.005.
fn idle(
    basis: Basis,
    [thrust, torque]: &[Fit; 2],
    fold: &Fold,
    files: &str,
    warnings: &mut Vec<String>,
) -> Result<f64, Refusal> {
    let map = EnclosedPairMap::of(basis, &thrust.coefficients, &torque.coefficients);
    let ThrottleBox { min: from, max } = fold.commanded;
    let raised = |least: f64| Some((least, fold::round_idle(&map, CLEAR * least, max)?));
    let [u, l] = fold.least_det_at;
    let least = match fold.injective {
        true => map.least_idle(max).filter(|least| from < CLEAR * least),
        false => fold.least_idle,
    };
    match least.and_then(raised) {
        Some((least, min)) => {
            warnings.push(format!(
                "throttle.min is raised from {from} to {min}: below {least:.4} the map of this pair cannot be inverted"
            ));
            Ok(min)
        }
        None if fold.injective => Ok(from),
        None => Err(Refusal::of(
            files,
            format!("the map of this pair folds whatever the idle, at throttles ({u:.3}, {l:.3})"),
            match fold::within(&map, fold.commanded) {
                Some(ThrottleBox { min, max }) => {
                    format!("--throttle {min},{max}, over which it can be inverted")
                }
                None => {
                    "a map of which the torque falls with the upper throttle and rises with the lower one"
                        .to_owned()
                }
            },
        )),
    }
}
