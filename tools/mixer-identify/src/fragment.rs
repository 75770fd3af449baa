//! The tables of an airframe file as TOML, with what there is to say of each in comments.

use mixer_compiler::airframe::TYPICAL_EXPONENT;
use std::fmt::Write as _;

use mixer_compiler::diagnostic::{self, printable};
use toml_edit::{DocumentMut, value};

use super::bench::{Bench, BenchKind};
use super::fit::power::{LeastPower, Power};
use super::fit::{Fit, hundredths};
use super::identified::Identified;
use super::rotor::predict::Predicted;
use super::statement::{Detail, Statement, of_identified, of_predicted, runs};
use super::statistics::extent;
use super::table::{commented, curves, model, numbers, pair, table};

/// The key of the torque of least power. Which airframe it is decides whether that saves anything,
/// so that it stands in a comment.
pub const POWER_BIAS: &str = "power_bias_nm_per_n";

/// Columns of a comment.
const WIDTH: usize = 104;

/// `[throttle]` and `[pair]` where a pair was identified, `[voltage]` where its exponents are sound;
/// the torque of least power in a comment at the end.
pub fn text(identified: &Identified) -> String {
    let mut text = tables(identified);
    if let Some(bias) = identified.power_bias() {
        let _ = writeln!(
            text,
            "\n# {POWER_BIAS} = {bias:?}    # for [allocation], if wanted: one rotor of a unit then carries more, and its stop costs more; cargo mixer new keeps it in a comment"
        );
    }
    text
}

/// The same without the torque of least power.
pub fn tables(id: &Identified) -> String {
    let statements = of_identified(id);
    let about = |table: &str| comments(&statements, table);
    let mut tail = String::new();
    let volts = rows_v(id).filter(|_| !id.closed_loop);
    let bench_v = |is_brought: bool| Some(("bench_v", numbers(volts.filter(|_| !is_brought)?)));
    let mut document = DocumentMut::new();
    if let Some(found) = &id.pair {
        let of = |fit: &Fit| {
            let terms = found.terms.iter().zip(&fit.ci95);
            commented(
                &fit.coefficients,
                terms.map(|(term, ci)| format!("{term:<4} +- {ci:.3e}")),
            )
        };
        let about = |table: &str| about(table) + if table == "pair" { SIGN } else { "" };
        let terms = [of(&found.thrust), of(&found.torque)];
        let alone = runs(found).map(|(turning, alone)| (turning, [alone.thrust_n, alone.torque_nm]));
        let mut entries = pair(&about, found.basis, terms, found.lower_is_stronger, alone);
        match &id.power {
            Some(Power::Identified(LeastPower {
                power_w: Some(power_w),
                ..
            })) => {
                let map = [("power_w", numbers(power_w.iter().copied()))];
                entries.push(("power", table(&about("pair.power"), map)));
            }
            _ => tail = format!("\n{}", about("pair.power")),
        }
        entries.extend(bench_v(found.normalised_to_v.is_some()));
        document = model(
            &about,
            found.throttle,
            "pair",
            entries,
            found.uncertainty.as_ref(),
            &id.options,
        );
    }
    if let Some(found) = &id.rotor {
        let mut entries = vec![("name", value(&found.name))];
        entries.extend(curves(found.curves.both()));
        entries.extend(bench_v(found.run.exponents != [0.0; 2]));
        document = model(
            &about,
            found.throttle,
            "rotor",
            entries,
            Some(&found.uncertainty),
            &[],
        );
    }
    let of = id.voltage.as_ref();
    let supply = Supply {
        reference_v: id.reference_v,
        range_v: of.map(|v| v.range_v),
        pack_v: id.pack_v,
        exponents: of.map_or([None; 2], |v| [v.thrust.value(), v.torque.value()]),
        closed_loop: id.closed_loop,
    };
    voltage(&mut document, &mut tail, &about("voltage"), &supply);
    let mut head = format!("# Identified by {}.\n{}", id.generator, about(""));
    for warning in &id.warnings {
        head += &comment("! ", warning);
    }
    let air = id.air.table(document.contains_key("voltage"));
    format!("{head}{document}{tail}{air}")
}

const SIGN: &str = "# Torque is positive where the lower rotor outweighs the upper, which is clockwise on the airframe for an upper\n\
                    # rotor that turns clockwise, and the mirror image for the other. Behind each coefficient its 95 % interval.\n";

const MEASURED: &str = "# The voltage of the flight must be measured where the bench's was: at the same point of the wiring, under load.\n\
                        # Behind other leads, or at no load, k is wrong by what the voltage drops in between.\n";

/// Least and greatest voltage of the rows of the model, V.
fn rows_v(id: &Identified) -> Option<[f64; 2]> {
    let is_pair = |file: &&Bench| (file.kind == BenchKind::Pair) == id.pair.is_some();
    let [low, high] = extent(
        id.files
            .iter()
            .filter(is_pair)
            .flat_map(|file| &file.points)
            .map(|p| p.voltage),
    );
    (low <= high).then(|| [low, high].map(hundredths))
}

/// The supply that `[voltage]` describes.
struct Supply {
    reference_v: Option<f64>,
    /// Of the rows.
    range_v: Option<[f64; 2]>,
    pack_v: Option<[f64; 2]>,
    exponents: [Option<f64>; 2],
    closed_loop: bool,
}

/// `[voltage]`. Beside a pair it must be complete, or `check` would refuse the airframe: with one
/// exponent only, or without the voltage of the map, it is a comment for the user to complete.
fn voltage(document: &mut DocumentMut, tail: &mut String, about: &str, of: &Supply) {
    // A speed that is held does not follow the voltage.
    if of.closed_loop {
        return;
    }
    let thousandths = |x: f64| (1000.0 * x).round() / 1000.0;
    let exponents = of.exponents.map(|e| e.map(thousandths));
    let known = exponents.iter().flatten().count();
    let measured = of.range_v.filter(|_| known > 0);
    // Outwards to hundredths, and around the reference.
    let range = of.pack_v.or(measured).map(|[low, high]| {
        let at = of.reference_v.filter(|_| known > 0);
        let low = at.map_or(low, |v| v.min(low));
        let high = at.map_or(high, |v| v.max(high));
        [(100.0 * low).floor() / 100.0, (100.0 * high).ceil() / 100.0]
    });
    // One voltage is no range.
    let range = range.filter(|[low, high]| low < high);
    let about = if known > 0 {
        format!("{about}{MEASURED}")
    } else {
        about.to_owned()
    };
    match (of.reference_v, range) {
        (Some(reference), Some(range)) if known == 2 => {
            let mut entries = vec![("reference_v", value(reference)), ("range_v", numbers(range))];
            for (key, exponent) in ["thrust_exponent", "torque_exponent"].into_iter().zip(exponents) {
                entries.extend(exponent.map(|exponent| (key, value(exponent))));
            }
            document.insert("voltage", table(&about, entries));
        }
        (reference, range) => {
            let text = match of.range_v.filter(|_| known == 0) {
                Some(_) => BRING.to_owned(),
                None => to_fill_in(reference, range, exponents),
            };
            *tail += &format!("\n{about}{text}");
        }
    }
}

const BRING: &str = "# No [voltage]: the mixer takes k = 1 at any voltage. The map has the sag of the bench's supply, which a [voltage] written\n\
                     # by hand counts twice. To follow the battery, identify again with --voltage-exponent 1.75 --cells N: that brings the\n\
                     # rows to one voltage; 1.75 is the median of 104 motors with propellers.\n";

/// `[voltage]` in comments.
fn to_fill_in(reference: Option<f64>, range: Option<[f64; 2]>, exponents: [Option<f64>; 2]) -> String {
    let reference = reference.map_or("?".to_owned(), |volts| format!("{volts:?}"));
    let range = range.map_or("[?, ?]".to_owned(), |range| format!("{range:?}"));
    let [thrust, torque] = match exponents {
        [None, None] => [TYPICAL_EXPONENT.to_string(), TYPICAL_EXPONENT.to_string()],
        known => known.map(|e| e.map_or("?".to_owned(), |e| format!("{e:?}"))),
    };
    let [reference, range] = [format!("reference_v = {reference}"), format!("range_v = {range}")];
    format!(
        "# No [voltage]: the mixer takes k = 1 at any voltage. To follow the battery, fill in what is open and uncomment;\n\
         # {TYPICAL_EXPONENT} is the median of 104 motors with propellers:\n\
         # [voltage]\n\
         # {reference:<34} # supply of the bench, under load\n\
         # {range:<34} # pack in flight, empty and full: 3.2 and 4.2 V a LiPo cell\n\
         # thrust_exponent = {thrust}\n\
         # torque_exponent = {torque}\n"
    )
}

/// The tables of a prediction.
pub fn of_prediction(predicted: &Predicted) -> String {
    let statements = of_predicted(predicted);
    let mut head = format!(
        "# Predicted by {}, not measured.\n{}",
        predicted.generator,
        comments(&statements, "")
    );
    for warning in &predicted.warnings {
        head += &comment("! ", warning);
    }
    let about = |table: &str| comments(&statements, table);
    let mut document = predicted.pair.tables(&about, &predicted.options);
    let run = &predicted.runs[0];
    let reference_v = predicted.reference_v.map(hundredths);
    let supply = Supply {
        reference_v,
        range_v: run.range_v,
        pack_v: predicted.pack_v,
        exponents: run.exponents.map(|exponent| reference_v.map(|_| exponent)),
        closed_loop: run.exponents == [0.0; 2],
    };
    let mut tail = String::new();
    voltage(&mut document, &mut tail, &about("voltage"), &supply);
    let air = predicted.air.table(document.contains_key("voltage"));
    format!("{head}{document}{tail}{air}")
}

/// The statements about a table.
fn comments(statements: &[Statement], table: &str) -> String {
    let is_stated = |statement: &&Statement| statement.table == table && statement.detail != Detail::Reported;
    let line = |statement: &Statement| match statement.name {
        "" => comment("  ", &statement.text),
        name => comment("", &format!("{name}: {}", statement.text)),
    };
    statements.iter().filter(is_stated).map(line).collect()
}

/// A comment with `mark` before its first line. TOML has no control characters in comments.
fn comment(mark: &str, text: &str) -> String {
    diagnostic::commented(mark, &printable(text), WIDTH)
}
