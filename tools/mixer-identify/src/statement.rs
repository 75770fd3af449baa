//! What there is to say of a result, once: the report prints it, and the tables have it as comments.

use mixer_compiler::atmosphere::altitude_of;
use mixer_compiler::model::PairMap;

use super::air::{Air, THIN_M};
use super::bench::{Bench, BenchKind, equal_commands};
use super::fit::Fit;
use super::fit::pair::Pair;
use super::fit::pair::drift::Shown;
use super::fit::power::{LeastPower, Power};
use super::fit::voltage::{Estimate, Exponent, Voltage};
use super::identified::Identified;
use super::rotor::predict::Predicted;
use super::rotor::single::exponents_in_words;
use super::rotor::{Alone, Turning};

/// Where a statement stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detail {
    /// In every report and in the tables.
    Always,
    /// In the long report and in the tables.
    Long,
    /// In reports only.
    Reported,
}

/// One of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Statement {
    /// The table that it is about, as `pair.power`; empty for the whole file.
    pub table: &'static str,
    /// What it is; empty where it goes on with the one before.
    pub name: &'static str,
    /// The words.
    pub text: String,
    /// Where it stands.
    pub detail: Detail,
}

/// A list in the making, of one table at a time.
#[derive(Default)]
struct Statements {
    table: &'static str,
    all: Vec<Statement>,
}

impl Statements {
    fn add(&mut self, detail: Detail, name: &'static str, text: impl Into<String>) {
        let (table, text) = (self.table, text.into());
        self.all.push(Statement {
            table,
            name,
            text,
            detail,
        });
    }

    fn always(&mut self, name: &'static str, text: impl Into<String>) {
        self.add(Detail::Always, name, text);
    }

    /// A detail of what was said before.
    fn more(&mut self, text: impl Into<String>) {
        self.add(Detail::Long, "", text);
    }
}

/// Sag of a supply, as a share, that is stated.
const SAG: f64 = 0.01;

/// Files that are named one by one in every report.
const MOST_FILES: usize = 4;

/// What was identified.
pub fn of_identified(identified: &Identified) -> Vec<Statement> {
    let mut statements = Statements::default();
    for (k, file) in identified.files.iter().enumerate() {
        let detail = if k < MOST_FILES {
            Detail::Always
        } else {
            Detail::Long
        };
        statements.add(detail, "read", format!("{}: {}", file.file, provenance(file)));
        statements.more(signs(file));
        file.tare
            .iter()
            .for_each(|tare| statements.add(detail, "tare", tare));
    }
    let more = identified.files.len().saturating_sub(MOST_FILES);
    if more > 0 {
        statements.add(Detail::Reported, "read", format!("and {more} files more"));
    }
    if let Some(pair) = &identified.pair {
        of_pair(&mut statements, pair);
    }
    if let Some(rotor) = &identified.rotor {
        statements.table = "rotor";
        let (run, [from, to], of) = (&rotor.run, rotor.run.measured, rotor.uncertainty);
        let text = format!(
            "{} points, throttle {from:.2} to {to:.2}, within {} % of the largest thrust and {} % of the largest torque; \
             cargo mixer predict makes a pair of it; if this signal drives both rotors, {}",
            run.points,
            of.thrust_percent,
            of.torque_percent,
            equal_commands(&[&run.file])
        );
        statements.always("single rotor", text);
    }
    statements.table = "voltage";
    match &identified.voltage {
        Some(voltage) => of_voltage(&mut statements, voltage),
        None if identified.closed_loop => {
            statements.always("voltage", "no matter: the controllers hold a speed")
        }
        None => statements.always("voltage", "not corrected for: no file has a voltage column"),
    }
    of_air(&mut statements, &identified.air);
    statements.table = "pair.power";
    match &identified.power {
        Some(Power::Identified(found)) => of_power(&mut statements, found),
        Some(Power::Refused { reason }) => statements.always("least power", format!("none: {reason}")),
        None => {}
    }
    statements.all
}

/// One line on a file: format, rows.
fn provenance(file: &Bench) -> String {
    let kind = ["", ", single rotor"][usize::from(file.kind == BenchKind::SingleRotor)];
    let refused = file.refused_rows.len();
    let used = file
        .rows
        .saturating_sub(file.start_stop_rows + file.settling_rows + refused);
    let parts = [
        (file.start_stop_rows, "start and stop rows dropped"),
        (file.settling_rows, "settling"),
        (if file.streaming { file.points_used } else { 0 }, "plateaus"),
        (refused, "refused"),
    ];
    let parts = parts.iter().filter(|(count, _)| *count > 0);
    let parts: String = parts.map(|(count, what)| format!(", {count} {what}")).collect();
    format!("{}{kind}: {used} of {} rows used{parts}", file.format, file.rows)
}

fn signs(file: &Bench) -> String {
    let of = |name: &str, signs: &[f64], policy: &str| {
        let signs: Vec<&str> = signs.iter().map(|s| if *s < 0.0 { "-" } else { "+" }).collect();
        format!("{name} {} ({policy})", signs.join(","))
    };
    let s = &file.signs;
    let thrust = of("thrust", &s.thrust, s.thrust_policy);
    let torque = of(", torque", &s.torque, s.torque_policy);
    let torque = if s.torque.is_empty() { "" } else { &torque };
    format!("signs applied: {thrust}{torque}")
}

fn of_pair(statements: &mut Statements, pair: &Pair) {
    let (min, max) = (pair.throttle.min, pair.throttle.max);
    let map = PairMap::of(pair.basis, &pair.thrust_n, &pair.torque_nm, [min, max]);
    let [floor, full] = [min, max].map(|t| map.efforts([t, t])[0]);
    let [least, most] = [[max, min], [min, max]].map(|t| map.efforts(t)[1]);
    statements.table = "throttle";
    let text = format!("{floor:.1} to {full:.1} N of one pair; torque {least:+.3} N m to {most:+.3} N m");
    statements.always("thrust", text);
    let fold = match pair.fold.least_idle {
        _ if pair.fold.injective => "the map has no fold".to_owned(),
        Some(least) => format!("the map folds below {least:.4}"),
        None => "the map folds".to_owned(),
    };
    let idle = 100.0 * floor / full;
    let text = format!("{min} to {max}; at idle {idle:.1} % of the largest thrust; {fold}");
    statements.always("throttle", text);
    let (least, [u, l]) = (pair.fold.least_det, pair.fold.least_det_at);
    let proven = if pair.fold.folds { "" } else { ", proven > 0" };
    statements.more(format!(
        "the least det J is {least:.4}, at ({u:.3}, {l:.3}){proven}"
    ));

    statements.table = "pair";
    let (thrust, torque) = (&pair.thrust, &pair.torque);
    let (basis, left_out) = (pair.basis.name(), "of the largest torque at");
    let [f, q] = [thrust, torque].map(|fit| 100.0 * fit.leave_one_out_rms / fit.full_scale);
    let errors = match pair.uncertainty.map(|u| (u.thrust_percent, u.torque_percent)) {
        Some((f, q)) => format!("{f} % of the largest thrust and {q} % {left_out} throttles left out"),
        None => format!("{f:.1} % of the largest thrust and {q:.1} % {left_out} rows left out"),
    };
    statements.always("model error", format!("{errors}; {basis} basis"));
    let standing_out = match (pair.outliers.len(), pair.outliers_left_out) {
        (0, _) => "no row stands out".to_owned(),
        (count, true) => format!("{count} rows stand out and are left out"),
        (count, false) => format!("{count} rows stand out"),
    };
    let [(f, of_f), (q, of_q)] =
        [thrust, torque].map(|fit| (fit.residual_max, 100.0 * fit.residual_max / fit.full_scale));
    let text = format!("{f:.2} N ({of_f:.1} %) and {q:.4} N m ({of_q:.1} %) off; {standing_out}");
    statements.always("worst row", text);
    of_drift(statements, pair);
    for o in &pair.outliers {
        let (f, of_f) = (o.thrust_residual, o.thrust_deviations);
        let (q, of_q) = (o.torque_residual, o.torque_deviations);
        let text = format!(
            "{}:{} at ({:.3}, {:.3}): thrust {f:+.3} N ({of_f:+.0} sigma), torque {q:+.4} N m ({of_q:+.0} sigma)",
            o.file, o.line, o.u, o.l
        );
        statements.more(text);
    }
    statements.add(Detail::Long, "fit of thrust", of_fit(thrust, "N"));
    statements.add(Detail::Long, "fit of torque", of_fit(torque, "N m"));
    let [u, l] = thrust.prediction.greatest_at;
    let text = format!(
        "{} points, {} degrees of freedom, condition number {:.1}; prediction widest at ({u:.2}, {l:.2})",
        thrust.points, thrust.degrees_of_freedom, thrust.condition_number
    );
    statements.more(text);
    if let Some(volts) = pair.normalised_to_v {
        statements.more(format!(
            "all points are brought to {volts} V by the exponents of voltage"
        ));
    }
    if runs(pair).next().is_none() {
        let text = "by the map, extrapolated to a throttle of 0 (--lower-out, --upper-out take runs)";
        statements.add(Detail::Reported, "rotor out", text);
    }
    runs(pair).for_each(|(turning, alone)| of_alone(statements, turning, alone));
}

/// Drifts by the order of the rows, or that it shows none.
fn of_drift(statements: &mut Statements, pair: &Pair) {
    let wholes = pair
        .drift
        .iter()
        .filter(|shown| ["thrust", "torque"].contains(&shown.of));
    let (seen, hidden): (Vec<&Shown>, Vec<&Shown>) = wholes.partition(|shown| shown.drift.is_some());
    let of = |shown: &&Shown| Some(format!("{} t = {:.1}", shown.of, shown.drift?.t));
    let told: Vec<String> = seen.iter().filter_map(of).collect();
    if !told.is_empty() {
        let all = pair.drift.iter().filter_map(|shown| shown.drift);
        let what = if all.clone().any(|drift| drift.significant) {
            "seen"
        } else {
            "none"
        };
        statements.always(
            "drift",
            format!("{what} in the order of the rows: {}", told.join(", ")),
        );
    }
    if !hidden.is_empty() {
        let text =
            "cannot be told from throttle in the order of the rows; cargo mixer plan draws one that shows it";
        statements.always("drift", text);
    }
}

fn of_fit(fit: &Fit, unit: &str) -> String {
    let (left_out, full) = (fit.leave_one_out_rms, fit.full_scale);
    let (share, within) = (100.0 * left_out / full, &fit.prediction);
    format!(
        "R2 {:.5}; residual {:.5} {unit} rms, {:.5} at most; leave-one-out {left_out:.5} {unit} rms, {share:.2} % of \
         {full:.5}; prediction +- {:.5} to {:.5} {unit}",
        fit.r2, fit.residual_rms, fit.residual_max, within.least, within.greatest
    )
}

/// The rotors of a pair that were run alone.
pub fn runs(pair: &Pair) -> impl Iterator<Item = (Turning, &Alone)> {
    let both = [Turning::Upper, Turning::Lower].into_iter();
    let both = both.zip([&pair.lower_out, &pair.upper_out]);
    both.filter_map(|(turning, alone)| Some((turning, alone.as_ref()?)))
}

fn of_alone(statements: &mut Statements, turning: Turning, alone: &Alone) {
    statements.table = turning.table();
    let (table, [from, to]) = (turning.table(), alone.measured);
    let text = format!(
        "[{table}] from {}: {} points, throttle {from:.2} to {to:.2}",
        alone.file, alone.points
    );
    statements.always("rotor out", text);
    for (name, unit, fit) in [("thrust", "N", &alone.thrust), ("torque", "N m", &alone.torque)] {
        let full = fit.full_scale;
        let [own, pair] = [fit.leave_one_out_rms, fit.of_the_pair_rms].map(|rms| 100.0 * rms / full);
        let text = format!(
            "{name}: leave-one-out {own:.2} % of {full:.4} {unit}; the pair's \
             polynomial at zero misses this run by {pair:.2} %"
        );
        statements.more(text);
    }
}

fn of_voltage(statements: &mut Statements, voltage: &Voltage) {
    let channels = voltage.channels();
    let one = channels.len() == 1;
    for (name, exponent) in channels {
        let (told, more) = match exponent {
            Exponent::Identified(e) => (of_estimate(e), ""),
            Exponent::Declared { exponent, .. } => (format!("exponent {exponent} as declared"), ""),
            // Where voltages differ, a warning has the reason and what is needed.
            Exponent::Refused { .. } if voltage.varies() => ("not corrected for: no exponent".to_owned(), ""),
            Exponent::Refused { reason, needed } => (format!("not corrected for: {reason}"), needed.as_str()),
            Exponent::NotMeasured => (
                "not measured".to_owned(),
                "both channels' exponents: thrust and torque follow the square of rotor speed, so that the other's is the \
                 usual stand-in",
            ),
        };
        let text = if one { told } else { format!("{name} {told}") };
        statements.always("voltage", text);
        if !more.is_empty() {
            statements.more(format!("needed: {more}"));
        }
    }
}

fn of_estimate(e: &Estimate) -> String {
    let levels = match e.levels {
        0 => String::new(),
        levels => format!(", {levels} levels"),
    };
    let (exponent, ci95, method) = (e.exponent, e.ci95, e.method);
    format!("exponent {exponent:.3} +- {ci95:.3} (95 %), by {method}{levels}")
}

fn of_power(statements: &mut Statements, found: &LeastPower) {
    let (bias, saving, at) = (
        found.bias_nm_per_n,
        found.saving_percent,
        found.at[found.at.len() / 2],
    );
    let text = format!(
        "Q = c f with c = {bias:?} N m per N takes {saving:.1} % less than Q = 0 at 0.3 to 0.7 of full thrust: {:.1} for \
         {:.1} W at {:.2} N",
        at.least_power_w, at.power_w, at.thrust_n
    );
    statements.always("least power", text);
    let (points, rms) = (found.points, found.residual_rms_w);
    let share = 100.0 * rms / found.full_scale_w;
    let refused = match found.power_w {
        Some(_) => "",
        None => "; no [pair.power], as it is not positive, or does not grow, over the throttles to command",
    };
    let text = format!(
        "power map of {points} rows: residual {rms:.2} W rms, {share:.2} % of the greatest power{refused}"
    );
    statements.more(text);
}

/// The air, where it is known.
fn of_air(statements: &mut Statements, air: &Air) {
    let Some((density, [low, high])) = air.density_kg_m3.zip(air.range_kg_m3) else {
        return;
    };
    statements.table = "air";
    let brought = match high - low > 1e-3 {
        true => format!(
            "; rows of {low:.3} to {high:.3} kg/m3 are brought to it by {}",
            exponents_in_words(air.exponents)
        ),
        false => String::new(),
    };
    let altitude_m = altitude_of(density);
    let thin = match altitude_m > THIN_M {
        true => format!(" (density altitude {altitude_m:.0} m)"),
        false => String::new(),
    };
    statements.always(
        "air",
        format!("{density:.3} kg/m3{thin}, of {}{brought}", air.from),
    );
}

/// What was predicted.
pub fn of_predicted(predicted: &Predicted) -> Vec<Statement> {
    let mut statements = Statements::default();
    for run in &predicted.runs {
        let (file, points, [from, to]) = (&run.file, run.points, run.measured);
        let volts = match (run.range_v, run.voltage_v) {
            (Some([low, high]), Some(volts)) if high - low > SAG * volts && run.exponents != [0.0; 2] => {
                format!(
                    "; its rows of {low:.2} to {high:.2} V are brought to {volts:.2} V by {}",
                    exponents_in_words(run.exponents)
                )
            }
            (_, Some(volts)) => format!(", {volts:.2} V"),
            (_, None) => String::new(),
        };
        let text = format!("{file}: {points} points of one rotor, throttle {from:.2} to {to:.2}{volts}");
        statements.always("from", text);
    }
    for (file, rows) in &predicted.corrected_by {
        statements.always("corrected by", format!("{rows} rows of the pair in {file}"));
    }
    let (ratio, [b, m0, m1, n, a, limit]) = (predicted.spacing_ratio, predicted.constants);
    let text = format!("{ratio:.3}; constants B {b}, m0 {m0}, m1 {m1}, n {n}, a {a}, b {limit}");
    statements.always("z/D", text);
    of_air(&mut statements, &predicted.air);
    statements.table = "";
    let pair = &predicted.pair;
    let (f, q) = (pair.uncertainty.thrust_percent, pair.uncertainty.torque_percent);
    let text = format!(
        "thrust within {f} %, torque within {q} % of full scale (one standard deviation), for open, equal rotors that turn \
         against each other, z/D 0.1 to 1; not for ducts, co-rotating or blocked rotors. In the first hover compare the \
         thrust asked with the weight; docs/no-bench.md goes on from there."
    );
    statements.always("to trust", text);
    statements.table = "throttle";
    let (min, max, [f, q]) = (pair.throttle.min, pair.throttle.max, pair.misfit_percent);
    let text = format!(
        "{min} to {max}; the cubic misses the model by {f:.2} % of thrust and {q:.2} % of torque, rms"
    );
    statements.always("throttle", text);
    statements.all
}
