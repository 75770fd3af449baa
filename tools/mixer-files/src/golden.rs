//! What an airframe compiles to, to be held in files and compared.
//!
//! An airframe has four: `NAME.rs`, the generated Rust; `NAME.report.txt`, the report;
//! `NAME.vectors.csv`, setpoints with the bits that the mixer gives; `NAME.rotors-out.csv`, the
//! same with rotors out.

use mixer_compiler::Compiled;
use mixer_facts::Checked;

use crate::vectors;

mod table;

/// The golden outputs of one airframe: file name and content.
pub fn outputs(compiled: &Compiled) -> [(String, String); 4] {
    let vectors = vectors::healthy(compiled);
    let rotors_out = vectors::rotors_out(compiled, &vectors);
    let file = |ending: &str| format!("{}.{ending}", compiled.airframe.name);
    [
        (file("rs"), compiled.rust()),
        (file("report.txt"), Checked::new(compiled.clone()).report()),
        (file("vectors.csv"), table::healthy(compiled, &vectors)),
        (file("rotors-out.csv"), table::rotors_out(compiled, &rotors_out)),
    ]
}
