//! The airframe file.

use mixer_compiler::airframe::TYPICAL_EXPONENT;
use std::path::Path;

use mixer_compiler::Source;
use mixer_compiler::diagnostic::commented;
use mixer_identify::air::Air;
use mixer_identify::pair_file::PairFile;
use toml::Value;

use super::rotors::{Imported, UPWARD, Unit};
use mixer_compiler::diagnostic::printable_lines;

/// Characters of a line of comment.
const COMMENT: usize = 110;

/// The name of the single rotors.
const SINGLE: &str = "single";

/// Idle where nothing says one.
const IDLE: f64 = 0.1;

/// Tables of a pair's file that an airframe takes over; `[throttle]` is made of both files. The others
/// describe another vehicle.
const TAKEN: &[&str] = &["pair", "voltage", "air"];

/// The tables, with the notes on them in `imported`.
pub(super) fn tables(imported: &mut Imported, units: &[Unit], pair: Option<&PairFile>) -> String {
    let [min, max] = throttle(imported, pair);
    let voltage = voltage(imported, pair);
    if pair.is_none() {
        imported.notes.push(
            "no parameter describes the pair: `cargo mixer identify` makes [pair] of bench data; --pair takes it in".to_owned(),
        );
    }
    let mut out = format!("[throttle]\nmin = {min:?}\nmax = {max:?}\n\n{voltage}\n");
    match pair {
        Some(pair) => out += &pair.tables(TAKEN).0,
        None => out += "# [pair]                               # basis, thrust_n, torque_nm, upper_spin\n\n",
    }
    if units.iter().any(|unit| unit.channels.1.is_none()) {
        out += &single_rotor(imported, pair);
    }
    if !out.contains("[air]") {
        out += Air::default().table(out.contains("\n[voltage]")).trim_start();
        out.push('\n');
    }
    if let Some((airmode, reason)) = imported.airmode {
        out += &format!("[allocation]\nairmode = \"{airmode}\"                 # {reason}\n\n");
    }
    let unit = |(index, unit): (usize, &Unit)| {
        let axis = match unit.axis == UPWARD {
            true => String::new(),
            false => format!("axis = {:?}\n", unit.axis),
        };
        let channels = match unit.channels {
            (upper, Some(lower)) => format!("[{upper}, {lower}]"),
            (single, None) => format!("[{single}]\nrotor = \"{SINGLE}\""),
        };
        format!(
            "[[unit]]                               # {index}\nposition_m = {:?}\n{axis}upper_spin = \"{}\"\nchannels = {channels}\n",
            unit.position_m,
            unit.upper_spin.name()
        )
    };
    let units = units.iter().enumerate().map(unit);
    out += &itertools::join(units, "\n");
    out
}

/// `[[rotor]]` of the single rotors: a rotor of the pair alone, where the pair's file has that, else in comments.
fn single_rotor(imported: &mut Imported, pair: Option<&PairFile>) -> String {
    let Some([thrust_n, torque_nm]) = pair.and_then(|pair| pair.curve("lower_out")) else {
        imported.notes.push(
            "nothing describes the single rotors: [[rotor]] has thrust and torque over the throttle, of a run of one alone"
                .to_owned(),
        );
        return format!(
            "# [[rotor]]                            # name = \"{SINGLE}\", thrust_n, torque_nm\n\n"
        );
    };
    imported.notes.push(
        "[[rotor]] is the upper rotor of the pair alone, [pair.lower_out]: if the single rotors are others, put a run of theirs there"
            .to_owned(),
    );
    let torque_nm = torque_nm.map(|term| -term);
    format!("[[rotor]]\nname = \"{SINGLE}\"\nthrust_n = {thrust_n:?}\ntorque_nm = {torque_nm:?}\n\n")
}

/// The file of these tables.
pub(super) fn airframe(name: &str, file: &Source, imported: &Imported, tables: &str) -> String {
    let mut out = format!(
        "name = {}\ndescription = {}\n\n# Imported by cargo mixer {} from {}.\n",
        Value::from(name),
        Value::from(&*imported.origin),
        env!("CARGO_PKG_VERSION"),
        Path::new(&file.name).file_name().unwrap_or_default().display()
    );
    let warnings = imported.warnings.iter().map(|told| format!("Warning: {told}"));
    for note in warnings.chain(imported.notes.iter().cloned()) {
        out += &commented("* ", &format!("{note}."), COMMENT);
    }
    // Names of files and comments of the pair's file are in it.
    printable_lines(&format!("{out}\n{tables}"))
}

/// Both files' ranges: the pair's model is known in its own alone.
fn throttle(imported: &mut Imported, pair: Option<&PairFile>) -> [f64; 2] {
    let number = |key| pair.and_then(|pair| pair.number("throttle", key));
    match (&imported.throttle, number("min"), number("max")) {
        (&Some(([min, max], ref names)), low, high) => {
            let [lowest, highest] = names;
            let (least, most) = (low.unwrap_or(min).max(min), high.unwrap_or(max).min(max));
            if [least, most] != [min, max] {
                imported.warnings.push(format!(
                    "the stack's throttles {min} to {max} are narrowed to the pair's: set {lowest} to {least}, {highest} to {most}"
                ));
            }
            [least, most]
        }
        (None, low, high) => [low.unwrap_or(IDLE), high.unwrap_or(1.0)],
    }
}

/// `[voltage]` where the pair's file has none: in comments, since the bench's voltage is not known.
fn voltage(imported: &mut Imported, pair: Option<&PairFile>) -> String {
    let Some([low, high]) = imported.range_v else {
        return String::new();
    };
    let range: [f64; 2] = [low, high].map(|volts| (volts * 100.0).round() / 100.0);
    if pair.is_some_and(|pair| pair.has("voltage")) {
        imported.notes.push(format!(
            "the stack's battery is {:?} to {:?} V: compare with range_v of [voltage]",
            range[0], range[1]
        ));
        return String::new();
    }
    imported.notes.push(
        "[voltage] is in comments: the voltage at which the pair was measured is not among the parameters"
            .to_owned(),
    );
    format!(
        "# [voltage]                            # reference_v: of the bench; exponents: a median\n# reference_v = \n\
         # range_v = {range:?}\n# thrust_exponent = {TYPICAL_EXPONENT}\n# torque_exponent = {TYPICAL_EXPONENT}\n\n"
    )
}

pub(super) fn default_name(units: &[Unit]) -> String {
    let single = units.iter().filter(|unit| unit.channels.1.is_none()).count();
    match (units.len() - single, single) {
        (3, 0) => "imported-y6".to_owned(),
        (1, 2) => "imported-y4".to_owned(),
        (pairs, 0) => format!("imported-x{}", 2 * pairs),
        (pairs, single) => format!("imported-{}-rotors", 2 * pairs + single),
    }
}
