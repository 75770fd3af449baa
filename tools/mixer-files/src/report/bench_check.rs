//! The check list on the bench: what to see before the first flight, outputs one by one, then the
//! axes, with the lines that drive an output.

use maud::{Markup, html};
use mixer_compiler::airframe::{Axis, Throttle};
use mixer_facts::checklist::{self, Checklist};

use crate::report::study::Study;

/// Above idle, where a rotor certainly turns and still turns slowly.
const ABOVE_IDLE: f64 = 0.05;

/// Every row has its output or its axis as an attribute, for the page's script.
pub(crate) fn bench_check(study: &Study<'_>) -> Markup {
    let airframe = &study.compiled.airframe;
    let checklist = Checklist(study.compiled);
    let units = airframe.units.iter().enumerate();
    let rotors = units.flat_map(|(index, unit)| {
        let place = checklist.place(unit);
        unit.rotors().map(move |rotor| {
            let words = format!("unit {index}, {place}: {} rotor", rotor.layer);
            (rotor.channel, words, rotor.spin)
        })
    });
    let mut rotors: Vec<_> = rotors.collect();
    rotors.sort_by_key(|(output, ..)| *output);
    let axes = Axis::ALL.into_iter();
    let axes = axes.filter_map(|axis| Some((axis, checklist.rises_in_words(axis, 1)?)));
    html! {
        p {
            "Propellers off. Drive the motors one by one, then command each axis; spins are as seen from above. The lines are \
             for PX4\u{2019}s shell, and for MAVProxy with this mixer\u{2019}s frame class of ArduPilot: ArduPilot\u{2019}s own \
             classes test motors in orders of their own."
        }
        div.wide.words {
            table.outputs {
                caption { "Motors" }
                (header(["motor", "drives", "turns", "PX4", "ArduPilot", "seen"]))
                tbody {
                    @for (output, drives, spin) in &rotors {
                        tr.check data-output=(output) {
                            th scope="row" { (output + 1) }
                            td { (drives) }
                            td { (spin.in_words()) }
                            @for line in lines(*output, &airframe.throttle) { td.drive { code.line { (line) } } }
                            (seen())
                        }
                    }
                }
            }
        }
        div.wide.words {
            table {
                caption { "Commands, the strongest outputs first" }
                (header(["command", "raises motors", "moves", "seen"]))
                tbody {
                    @for (axis, rises) in axes {
                        tr.check data-axis=(axis.name()) {
                            th scope="row" { "+" (axis.name()) }
                            td { (rises) }
                            td { (checklist::motion(axis)) }
                            (seen())
                        }
                    }
                }
            }
        }
    }
}

/// Lines that drive an output for two seconds: in PX4's shell, `actuator_test` with the motor from 1 on
/// and the share of the output's range; in MAVProxy, `motortest` with the motor from 1 on, 0 for
/// percent, and the percentage.
fn lines(output: usize, throttle: &Throttle) -> [String; 2] {
    let percent = 100.0 * (throttle.min + ABOVE_IDLE).min(throttle.max);
    let (motor, percent) = (output + 1, libm::round(percent));
    [
        format!("actuator_test set -m {motor} -v {} -t 2", percent / 100.0),
        format!("motortest {motor} 0 {percent} 2"),
    ]
}

fn header<const N: usize>(names: [&str; N]) -> Markup {
    html! { thead { tr { @for name in names { th scope="col" { (name) } } } } }
}

/// A box to be ticked on paper; the page's script makes it one to be ticked on the screen.
fn seen() -> Markup {
    html! { td.seen { "\u{2610}" } }
}
