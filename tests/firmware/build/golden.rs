//! The golden vectors of every airframe as const arrays.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use crate::{AIRFRAMES, module};

/// Relative to this package's folder; each airframe needs `<airframe>.vectors.csv` there.
const GOLDEN: &str = "../../tests/golden";

/// Airframes and vectors of the `golden` image.
pub(crate) fn image(airframes: &[String]) -> Result<String, String> {
    let (mut items, mut calls) = (String::new(), String::new());
    for airframe in airframes {
        let module = module(airframe);
        let path = format!("{GOLDEN}/{airframe}.vectors.csv");
        println!("cargo::rerun-if-changed={path}");
        let vectors = vectors(Path::new(&path))?;
        let channels = vectors.channels;
        let (count, rows, table) = (vectors.rows.len(), vectors.rows.join(""), module.to_uppercase());
        write!(
            items,
            "mixer_macros::airframe!(\"{AIRFRAMES}/{airframe}.toml\");\n\
             static {table}: [Vector<{channels}>; {count}] = [\n{rows}];\n"
        )
        .map_err(|e| e.to_string())?;
        writeln!(calls, "    check!(check, \"{airframe}\", {module}, {table});")
            .map_err(|e| e.to_string())?;
    }
    Ok(format!(
        "{items}fn for_each_airframe(check: &mut Check) {{\n{calls}}}\n"
    ))
}

/// The rows of one CSV as Rust expressions.
struct Vectors {
    channels: usize,
    rows: Vec<String>,
}

/// Header: `roll_nm,pitch_nm,yaw_nm,thrust_n,voltage_v,throttle_0..,achieved_roll_nm,..,achieved_thrust_n,saturation`.
/// A float is the eight hexadecimal digits of its f32 bits after `0x`, saturation is decimal.
fn vectors(path: &Path) -> Result<Vectors, String> {
    let file = path.display();
    let text = fs::read_to_string(path).map_err(|e| {
        format!("cannot read the golden vectors {file}: {e}; `cargo xtask bless` writes them")
    })?;
    let mut lines = text.lines().enumerate();
    let header = lines.next().map_or("", |(_, line)| line);
    let channels = header
        .split(',')
        .filter(|column| column.starts_with("throttle_"))
        .count();
    let expected = columns(channels).join(",");
    if channels == 0 || header != expected {
        return Err(format!(
            "{file}:1: the header is `{header}`, expected `{expected}`"
        ));
    }
    let mut rows = Vec::new();
    for (index, line) in lines {
        let fault = |what: String| format!("{file}:{}: {what}", index + 1);
        let cells: Vec<&str> = line.split(',').collect();
        let Some((saturation, floats)) = cells.split_last().filter(|_| cells.len() == channels + 10) else {
            return Err(fault(format!(
                "{} columns, expected {}",
                cells.len(),
                channels + 10
            )));
        };
        saturation
            .parse::<u16>()
            .map_err(|e| fault(format!("saturation `{saturation}`: {e}")))?;
        for cell in floats {
            let digits = cell.strip_prefix("0x").filter(|digits| digits.len() == 8);
            if digits.is_none_or(|digits| u32::from_str_radix(digits, 16).is_err()) {
                return Err(fault(format!("`{cell}` is not f32 bits such as 0x3f800000")));
            }
        }
        let (inputs, outputs) = floats.split_at(5);
        let (throttle, achieved) = outputs.split_at(channels);
        rows.push(format!(
            "    Vector {{ setpoint: [{}], voltage_v: {}, throttle: [{}], achieved: [{}], saturation: {saturation} }},\n",
            inputs[..4].join(", "),
            inputs[4],
            throttle.join(", "),
            achieved.join(", "),
        ));
    }
    if rows.is_empty() {
        return Err(format!("{file}: no vector"));
    }
    Ok(Vectors { channels, rows })
}

fn columns(channels: usize) -> Vec<String> {
    let axes = ["roll_nm", "pitch_nm", "yaw_nm", "thrust_n"];
    let mut columns: Vec<String> = axes.iter().map(|axis| axis.to_string()).collect();
    columns.push("voltage_v".into());
    columns.extend((0..channels).map(|channel| format!("throttle_{channel}")));
    columns.extend(axes.iter().map(|axis| format!("achieved_{axis}")));
    columns.push("saturation".into());
    columns
}
