//! What a frame of many units gives of a real pair is what one of few gives, unit by unit: a method
//! ranges over the whole attainable set or it loses yaw and thrust on maps that bend.
//!
//! With `MIXER_BENCH_DATA` its maps are looked at, too.

use std::path::PathBuf;

use mixer_rt::Health;
use mixer_tests::frames::{self, Options};
use mixer_tests::request::{Frame, Request};

use crate::{REFERENCE_V, compile_with_pair};

/// Shares of the largest level thrust at which all yaw is asked for.
const THRUSTS: [f64; 3] = [0.7, 0.8, 0.9];

/// Least yaw of an X12 over that of an X8, per unit: in the median over the pairs, and of each.
const MEDIAN: f64 = 0.99;
const LEAST: f64 = 0.97;

/// The same of the largest level thrust.
const LEAST_THRUST: f64 = 0.995;

/// What is given of a request in airmode "disabled", per unit.
fn given(frame: &Frame, wrench: [f32; 4]) -> [f64; 4] {
    let request = Request {
        wrench,
        volts: REFERENCE_V,
        density: None,
        health: Health::GOOD,
    };
    let answer = request.mix(frame).expect("finite");
    answer.achieved.map(|axis| axis / frame.physics.units() as f64)
}

#[test]
fn an_x12_gives_as_much_per_unit_as_an_x8() {
    let data = std::env::var_os("MIXER_BENCH_DATA").map(PathBuf::from);
    let pairs = frames::real_pairs(data.as_deref()).expect("pairs");
    let mut ratios: [Vec<f64>; 4] = Default::default();
    for pair in &pairs {
        let text = frames::text_of_pair(pair);
        let [four, six] = [(4, 45.0), (6, 30.0)].map(|(units, first)| {
            compile_with_pair(&text, &frames::regular(units, first), Options::default())
        });
        let thrust = |frame: &Frame| {
            let most = 2.0 * frame.authority[3] as f32;
            given(frame, [0.0, 0.0, 0.0, most])[3]
        };
        let most = thrust(&four);
        ratios[3].push(thrust(&six) / most);
        for (ratios, share) in ratios.iter_mut().zip(THRUSTS) {
            let yaw = |frame: &Frame| {
                let units = frame.physics.units() as f64;
                let asked = 2.0 * frame.authority[2] as f32;
                given(frame, [0.0, 0.0, asked, (share * units * most) as f32])[2]
            };
            ratios.push(yaw(&six) / yaw(&four));
        }
    }
    let names = ["yaw at 70 %", "yaw at 80 %", "yaw at 90 %", "largest thrust"];
    for (name, ratios) in names.into_iter().zip(&mut ratios) {
        ratios.sort_by(f64::total_cmp);
        let (least, median) = (ratios[0], ratios[ratios.len() / 2]);
        println!(
            "{name}: {} pairs, median {median:.4}, least {least:.4}",
            ratios.len()
        );
        if name == "largest thrust" {
            assert!(least >= LEAST_THRUST, "{name}: {least}");
        } else {
            assert!(median >= MEDIAN && least >= LEAST, "{name}: {median}, {least}");
        }
    }
}
