//! The golden vectors of every airframe, as `cargo mixer golden` writes them.

use std::fs;

use crate::{AIRFRAMES, module};

/// Relative to this package's folder.
const GOLDEN: &str = "../../tests/golden";

/// Airframes and vectors of the `golden` image.
pub(crate) fn image(airframes: &[String]) -> Result<String, String> {
    let (mut items, mut calls) = (String::new(), String::new());
    for airframe in airframes {
        let module = module(airframe);
        let table = |ending: &str| {
            let path = format!("{GOLDEN}/{airframe}.{ending}.csv");
            println!("cargo::rerun-if-changed={path}");
            fs::canonicalize(&path).map_err(|e| {
                format!("cannot read the golden vectors {path}: {e}; write them first, see the README")
            })
        };
        let [vectors, rotors_out] = [table("vectors")?, table("rotors-out")?];
        items += &format!("mixer_macros::airframe!(\"{AIRFRAMES}/{airframe}.toml\");\n");
        calls += &format!(
            "    check!(check, \"{airframe}\", {module}, include_str!({vectors:?}), include_str!({rotors_out:?}));\n"
        );
    }
    Ok(format!(
        "{items}fn for_each_airframe(check: &mut Check) {{\n{calls}}}\n"
    ))
}
