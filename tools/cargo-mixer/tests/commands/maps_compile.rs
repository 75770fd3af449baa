//! Every coaxial map of `MIXER_BENCH_DATA` in every basis compiles close to its fold, within the
//! default tolerance.

use std::time::Instant;

use mixer_compiler::Source;
use mixer_compiler::airframe::Airframe;
use mixer_compiler::model::injectivity::EnclosedPairMap;
use mixer_identify::fragment;
use mixer_identify::identified::Identified;

use crate::maps;

/// The idle over the least one at which the map can be inverted.
const IDLE: f64 = 1.03;

/// A single pair on a stand, with these throttles instead of the identified.
fn source(identified: &Identified, throttle: [f64; 2]) -> Source {
    let text = format!(
        "name = \"bench\"\n{}\n[[unit]]\nposition_m = [0.0, 0.0, 0.0]\nupper_spin = \"cw\"\nchannels = [0, 1]\n\
         [allocation]\naxes = [\"yaw\", \"thrust\"]\n",
        maps::with_throttle(identified, throttle)
    );
    Source::new("bench.toml", text)
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn every_map_compiles_close_to_its_fold() {
    let files = maps::files();

    println!(
        "{:<19} {:<11} {:>4} {:>7} {:>5}  {:<22} {:>8} {:>8}",
        "map", "basis", "max", "min", "ms", "evaluator", "f (N)", "Q (N m)"
    );
    let mut refused = 0;
    for map in &files {
        for basis in ["biquadratic", "cubic", "quartic"] {
            let identified = maps::identified(map, basis);
            let own = Airframe::read(&source(&identified, [0.1, 1.0])).unwrap_or_else(|e| panic!("{e}"));
            let measured = fragment::text(&identified)
                .lines()
                .find_map(|line| line.strip_prefix("max = ")?.parse().ok());
            for max in [1.0, measured.unwrap_or(1.0)] {
                let name = map.file_name().unwrap_or_default().to_string_lossy();
                let what = format!("{} {basis:<11} {max:>4}", &name[4..23]);
                let least = EnclosedPairMap::new(&own.pairs[0]).least_idle(max);
                let least = least.unwrap_or_else(|| panic!("{what}: folds at every idle"));
                // Upwards to 1e-4, as the compiler offers it.
                let min = (1e4 * IDLE * least).ceil() / 1e4;
                let started = Instant::now();
                let compiled = match mixer_compiler::compile(&source(&identified, [min, max])) {
                    Ok(compiled) => compiled,
                    Err(faults) => {
                        println!("{what}, from {min}: {faults}");
                        // Beyond the throttles of its bench a map may all but fold at full
                        // throttle.
                        let is_told = faults.to_string().contains("lower throttle.max");
                        assert!(max > measured.unwrap_or(1.0) && is_told, "{what}");
                        refused += 1;
                        continue;
                    }
                };
                let [f, q] = compiled.of_pairs[0].certificate.stated;
                println!(
                    "{what} {min:>7.5} {:>5}  {:<22} {f:>8.2e} {q:>8.2e}",
                    started.elapsed().as_millis(),
                    compiled.of_pairs[0].evaluator.name(),
                );
                assert!(
                    compiled.of_pairs[0].certificate.holds()
                        && compiled.of_pairs[0]
                            .certificate
                            .agrees(&compiled.of_pairs[0].residual),
                    "{what}"
                );
            }
        }
    }
    assert!(
        refused <= 1,
        "{refused} maps are refused beyond their bench's throttles"
    );
}
