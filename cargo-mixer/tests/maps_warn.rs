//! Fits of the coaxial maps of `MIXER_BENCH_DATA` are what a careful user has: hardly one may warn.

mod maps;

use mixer_compiler::Source;
use mixer_identify::fragment;
use mixer_identify::identified::Identified;

/// An X8 of the identified pair, arms by its thrust as frames have them.
fn source(identified: &Identified) -> Source {
    let text = format!(
        "name = \"x8\"\n{}\n[layout]\narm_m = 0.45\nunits = 4\nfirst_angle_deg = 45\n",
        fragment::text(identified)
    );
    Source::new("x8.toml", text)
}

#[test]
fn at_most_three_of_a_hundred_maps_warn() {
    let Some(files) = maps::files("at_most_three_of_a_hundred_maps_warn") else {
        return;
    };
    let (mut fits, mut warned, mut refused) = (0, 0, 0);
    for map in &files {
        for basis in ["biquadratic", "cubic", "quartic"] {
            fits += 1;
            match mixer_compiler::compile(&source(&maps::identified(map, basis))) {
                Ok(compiled) if compiled.warnings.is_empty() => {}
                Ok(compiled) => {
                    warned += 1;
                    println!("{} {basis}\n{}", map.display(), compiled.warnings);
                }
                // An idle right at the fold: another test's business.
                Err(_) => refused += 1,
            }
        }
    }
    println!("{warned} of {fits} fits warn, {refused} are refused");
    assert!(100 * warned <= 3 * fits, "{warned} of {fits}");
    assert!(10 * refused <= fits, "{refused} of {fits}");
}
