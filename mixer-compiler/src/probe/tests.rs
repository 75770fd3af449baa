use super::*;
use crate::tables::MixerTables;
use crate::{Source, compile};

fn compiled(name: &str) -> Compiled {
    let path = format!("{}/airframes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    compile(&Source::new(name, std::fs::read_to_string(path).unwrap())).unwrap()
}

/// What the probes say of an airframe with a fault planted in its tables.
fn judged(compiled: &Compiled, plant: impl Fn(&mut MixerTables)) -> Result<(), String> {
    let mut planted = compiled.clone();
    plant(&mut planted.tables);
    run(&planted).map_err(|faults| faults[0].message.clone())
}

#[track_caller]
fn refused(compiled: &Compiled, words: &str, plant: impl Fn(&mut MixerTables)) {
    let message = judged(compiled, plant).expect_err("the planted fault passes");
    assert!(message.contains(words), "{message}");
}

/// An X8 in closed form and an X12, which has none: as they are, and with a fault of each kind.
#[test]
fn planted_faults_are_refused() {
    for name in ["isae-x8", "px4-x12"] {
        let compiled = compiled(name);
        let has_closed_form = compiled.tables.closed_form.is_some();
        assert_eq!(has_closed_form, name == "isae-x8");
        assert_eq!(judged(&compiled, |_| ()), Ok(()), "{name}");
        // M+, as an SVD that stops early gave it: a few percent off in one entry.
        refused(&compiled, "fails a probe", |tables| {
            tables.units[2].allocation[0][1] *= 1.05;
            if let Some(closed_form) = &mut tables.closed_form {
                closed_form.units[2].allocation[1] *= 1.05;
            }
        });
        // A spin.
        refused(&compiled, "fails a probe", |tables| {
            tables.units[2].effectiveness[1][2] *= -1.0;
            if let Some(closed_form) = &mut tables.closed_form {
                closed_form.units[2].spin *= -1.0;
            }
        });
        // Two channels of one unit exchanged, and two of different units.
        refused(&compiled, "fails a probe", |tables| {
            tables.units[0].channels.swap(0, 1);
            if let Some(closed_form) = &mut tables.closed_form {
                closed_form.units[0].channels.swap(0, 1);
            }
        });
        refused(&compiled, "fails a probe", |tables| {
            let channel = tables.units[0].channels[0];
            tables.units[0].channels[0] = tables.units[1].channels[0];
            tables.units[1].channels[0] = channel;
            if let Some(closed_form) = &mut tables.closed_form {
                closed_form.units[0].channels[0] = closed_form.units[1].channels[0];
                closed_form.units[1].channels[0] = channel;
            }
        });
    }
}

/// Sides of the closed form too far out and too far in, and facets that do not bound the thrusts.
#[test]
fn planted_sides_are_refused() {
    let compiled = compiled("isae-x8");
    let sides = |by: f32| {
        move |tables: &mut MixerTables| {
            let closed_form = tables.closed_form.as_mut().unwrap();
            let middle = closed_form.cells.len() / 2;
            for k in [middle, middle + 1, middle + 2] {
                closed_form.cells[k].half = closed_form.cells[k].half.map(|half| by * half);
            }
        }
    };
    refused(&compiled, "side is not attainable", sides(1.03));
    refused(&compiled, "lose 1.84 %", sides(0.7));
    refused(&compiled, "fails a probe", |tables| {
        let closed_form = tables.closed_form.as_mut().unwrap();
        closed_form.slopes[0].bounds = closed_form.slopes[0].bounds.map(|bound| 3.0 * bound);
        closed_form.walls.clear();
    });
}
