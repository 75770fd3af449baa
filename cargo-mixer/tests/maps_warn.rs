//! Fits of the coaxial maps of `MIXER_BENCH_DATA` are what a careful user has: none may warn, and
//! the mistakes that the rules on rotors are for must.

mod maps;

use cargo_mixer::bench_files::read_one;
use std::path::Path;

use mixer_compiler::airframe::Basis;
use mixer_compiler::diagnostic::Code;
use mixer_compiler::{Compiled, Source};
use mixer_identify::bench::Bench;
use mixer_identify::fragment;
use mixer_identify::identified::{Identified, Settings, from_benches};

const BASES: [&str; 3] = ["biquadratic", "cubic", "quartic"];

/// An X8 of the identified pair, arms by its thrust as frames have them.
fn source(tables: &str) -> Source {
    let text = format!("name = \"x8\"\n{tables}\n[layout]\narm_m = 0.45\nunits = 4\nfirst_angle_deg = 45\n");
    Source::new("x8.toml", text)
}

/// Whether nothing is told; of maps that begin at a throttle of 0.4 their idle alone.
fn is_quiet(compiled: &Compiled, map: &Path) -> bool {
    let begins_high = !map.to_string_lossy().contains("full_range");
    let told = compiled.warnings.faults().iter().map(|warning| warning.code);
    told.eq(begins_high.then_some(Code::HighIdle))
}

#[test]
fn no_real_map_warns() {
    let Some(files) = maps::files("no_real_map_warns") else {
        return;
    };
    let (mut fits, mut warned, mut refused) = (0, 0, 0);
    for map in &files {
        for basis in BASES {
            fits += 1;
            match mixer_compiler::compile(&source(&fragment::text(&maps::identified(map, basis)))) {
                Ok(compiled) if is_quiet(&compiled, map) => {}
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
    assert_eq!(warned, 0, "of {fits}");
    assert!(10 * refused <= fits, "{refused} of {fits}");
}

/// The tables of a pair with these coefficients and the throttles that were identified.
fn tables(identified: &Identified, basis: Basis, [thrust, torque]: [&[f64]; 2]) -> String {
    let pair = identified.pair.as_ref().expect("a map");
    format!(
        "[throttle]\nmin = {:?}\nmax = {:?}\n[pair]\nbasis = \"{}\"\nthrust_n = {thrust:?}\ntorque_nm = {torque:?}\nupper_spin = \"cw\"",
        pair.throttle.min,
        pair.throttle.max,
        basis.name()
    )
}

/// What the compiler says of these tables: the codes of faults and warnings.
fn codes(tables: &str) -> Vec<Code> {
    let told = match mixer_compiler::compile(&source(tables)) {
        Ok(compiled) => compiled.warnings,
        Err(faults) => faults,
    };
    told.faults().iter().map(|fault| fault.code).collect()
}

#[test]
fn mistakes_in_real_maps_are_told() {
    let Some(files) = maps::files("mistakes_in_real_maps_are_told") else {
        return;
    };
    let (mut exchanged, mut fits) = (0, 0);
    let (mut off, mut coefficients) = (0, 0);
    for map in &files {
        for word in BASES {
            let identified = maps::identified(map, word);
            let pair = identified.pair.as_ref().expect("a map");
            let (basis, thrust, torque) = (pair.basis, &pair.thrust_n, &pair.torque_nm);
            fits += 1;
            // u and l exchanged, and the torque turned so that det J stays positive.
            let at = |k: usize| {
                let (i, j) = basis.exponents()[k];
                let other = basis.exponents().iter().position(|term| *term == (j, i));
                other.expect("a symmetric basis")
            };
            let turned: Vec<f64> = (0..thrust.len()).map(|k| thrust[at(k)]).collect();
            let mirrored: Vec<f64> = (0..thrust.len()).map(|k| -torque[at(k)]).collect();
            let told = codes(&tables(&identified, basis, [&turned, &mirrored]));
            exchanged += usize::from(told.contains(&Code::RotorsExchanged));
            for k in 0..thrust.len() {
                for channel in 0..2 {
                    let mut both = [thrust.clone(), torque.clone()];
                    both[channel][k] *= 10.0;
                    let told = codes(&tables(&identified, basis, [&both[0], &both[1]]));
                    coefficients += 1;
                    off += usize::from(told.iter().any(|code| *code != Code::HighIdle));
                }
            }
        }
    }
    println!(
        "{exchanged} of {fits} exchanged fits are told, {off} of {coefficients} coefficients ten times off"
    );
    assert_eq!(exchanged, fits);
    assert!(10 * off >= 9 * coefficients, "{off} of {coefficients}");
}

/// What `identify` says of a bench.
fn warnings(bench: Bench) -> String {
    let notes = bench.notes.join("\n");
    let told = match from_benches(vec![bench], &Settings::default().wishes) {
        Ok(identified) => identified.warnings.join("\n"),
        Err(refusal) => refusal.to_string(),
    };
    format!("{notes}\n{told}")
}

/// The same rows with something done to each.
fn changed(bench: &Bench, change: impl Fn(&mut mixer_identify::bench::Point)) -> Bench {
    let mut bench = bench.clone();
    bench.points.iter_mut().for_each(change);
    bench
}

#[test]
fn mistakes_in_real_benches_are_told() {
    let Some(files) = maps::files("mistakes_in_real_benches_are_told") else {
        return;
    };
    let (exchanged, tare) = ("look exchanged", "set the load cell to zero");
    let (mut full_range, mut tares) = (0, 0);
    for map in &files {
        let name = map.display();
        let bench = read_one(map, &Settings::default()).unwrap_or_else(|refusal| panic!("{refusal}"));
        let told = warnings(bench.clone());
        for wrong in [
            exchanged,
            tare,
            "right way round",
            "differs from the sum",
            "in disorder",
            "voltage is",
        ] {
            assert!(!told.contains(wrong), "{name}: {wrong}\n{told}");
        }
        let swapped = changed(&bench, |p| (p.u, p.l, p.torque) = (p.l, p.u, -p.torque));
        assert!(warnings(swapped).contains(exchanged), "{name}");
        let lowest = bench.points.iter().map(|p| p.u).fold(1.0, f64::min);
        let greatest = bench.points.iter().map(|p| p.thrust).fold(0.0, f64::max);
        if lowest < 0.15 {
            full_range += 1;
            let offset = changed(&bench, |p| p.thrust += 0.02 * greatest);
            tares += usize::from(warnings(offset).contains(tare));
        }
        // Each row with what the row before it gave.
        let mut late = bench.clone();
        for (point, before) in late.points.iter_mut().skip(1).zip(&bench.points) {
            (point.thrust, point.torque) = (before.thrust, before.torque);
        }
        assert!(warnings(late).contains("in disorder"), "{name}");
    }
    println!("a missing tare is told of {tares} of {full_range} full-range maps");
    assert_eq!(tares, full_range);
}
