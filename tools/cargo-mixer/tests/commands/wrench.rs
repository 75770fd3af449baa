//! `cargo mixer wrench`: what the throttles of `mix` give by the airframe's physics.

use std::fmt::Write as _;
use std::fs;

use mixer_compiler::{Compiled, Source};

use crate::{HEADER, printed, root};

/// A table's rows of numbers.
fn numbers(table: &str) -> Vec<Vec<f64>> {
    let row = |line: &str| line.split(',').map(|field| field.parse().unwrap()).collect();
    table.lines().skip(1).map(row).collect()
}

/// Setpoints from faint to far beyond what is attainable, over the ranges of voltage and density.
fn setpoints(compiled: &Compiled) -> String {
    let airframe = &compiled.airframe;
    let [volts, density] = [&airframe.voltage, &airframe.air].map(|correction| {
        correction
            .as_ref()
            .map_or([10.0, 11.0], |correction| correction.range)
    });
    let scale = compiled.scale().to_array().map(f64::from);
    let mut table = format!("{HEADER},voltage_v,density_kg_m3\n");
    for k in 0..400u16 {
        let x = f64::from(k) / 400.0;
        let [roll, pitch, yaw] = [17.0, 29.0, 41.0].map(|turns: f64| (turns * x) % 1.0 - 0.5);
        // Inside the range in f32, too.
        let between = |[low, high]: [f64; 2], share: f64| low + (high - low) * (0.01 + 0.98 * share);
        let _ = writeln!(
            table,
            "{:.4},{:.4},{:.4},{:.4},{:.4},{:.4}",
            0.2 * roll * scale[0],
            0.2 * pitch * scale[1],
            0.2 * yaw * scale[2],
            0.7 * x * scale[3],
            between(volts, (53.0 * x) % 1.0),
            between(density, (71.0 * x) % 1.0),
        );
    }
    table
}

/// On every airframe, with all rotors and with one out: throttles give what is achieved and, where nothing
/// saturates, what is asked, within the proven bound.
#[test]
fn throttles_of_mix_give_what_it_says() {
    let (mut count, mut delivered) = (0, 0);
    for entry in fs::read_dir(root().join("airframes")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.to_str().unwrap();
        let compiled =
            mixer_compiler::compile(&Source::new(name, fs::read_to_string(&path).unwrap())).unwrap();
        let (rotors, bound) = (
            compiled.airframe.rotors(),
            compiled.tables.view().tolerance.wrench,
        );
        let asked = setpoints(&compiled);
        for out in [&[][..], &["--failed", "1"]] {
            let mixed = printed(&[&["mix", name], out].concat(), asked.as_bytes());
            // Throttles of `mix` with the conditions of the setpoints.
            let rows = mixed.lines().zip(asked.lines()).map(|(mixed, asked)| {
                let throttles = mixed.split(',').take(rotors);
                throttles
                    .chain(asked.split(',').skip(4))
                    .collect::<Vec<_>>()
                    .join(",")
                    + "\n"
            });
            let throttles: String = rows.collect();
            let given = printed(&[&["wrench", name], out].concat(), throttles.as_bytes());
            assert!(given.starts_with(HEADER), "{given}");
            let [asked, mixed, given] = [&asked, &mixed, &given].map(|table| numbers(table));
            assert_eq!([mixed.len(), given.len()], [asked.len(); 2]);
            for ((asked, mixed), given) in asked.iter().zip(&mixed).zip(&given) {
                let is_delivered = mixed[rotors + 4] == 0.0;
                for axis in 0..4 {
                    let bound = f64::from(bound[axis]);
                    let untrue = (given[axis] - mixed[rotors + axis]).abs();
                    let missed = (given[axis] - asked[axis]).abs();
                    assert!(
                        untrue <= bound && (missed <= bound || !is_delivered),
                        "{name} {out:?} {asked:?}: axis {axis}: {untrue} {missed} over {bound}"
                    );
                }
                count += 1;
                delivered += u32::from(is_delivered);
            }
        }
    }
    println!("{delivered} of {count} delivered");
    assert!(
        delivered > count / 10 && delivered < count,
        "{delivered} of {count}"
    );
}
