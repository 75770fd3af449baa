//! The golden vectors of every airframe, as `cargo mixer golden` writes them.

use std::fmt::Write as _;
use std::fs;

use crate::{AIRFRAMES, module};

/// Relative to this package's folder; each airframe needs `<airframe>.vectors.rs` there.
const GOLDEN: &str = "../../tests/golden";

/// Airframes and vectors of the `golden` image.
pub(crate) fn image(airframes: &[String]) -> Result<String, String> {
    let (mut items, mut calls) = (String::new(), String::new());
    for airframe in airframes {
        let module = module(airframe);
        let path = format!("{GOLDEN}/{airframe}.vectors.rs");
        println!("cargo::rerun-if-changed={path}");
        let path = fs::canonicalize(&path).map_err(|e| {
            format!("cannot read the golden vectors {path}: {e}; write them first, see the README")
        })?;
        write!(
            items,
            "mixer_macros::airframe!(\"{AIRFRAMES}/{airframe}.toml\");\n\
             mod {module}_vectors {{\n    include!({path:?});\n}}\n"
        )
        .map_err(|e| e.to_string())?;
        writeln!(
            calls,
            "    check!(check, \"{airframe}\", {module}, {module}_vectors);"
        )
        .map_err(|e| e.to_string())?;
    }
    Ok(format!(
        "{items}fn for_each_airframe(check: &mut Check) {{\n{calls}}}\n"
    ))
}
