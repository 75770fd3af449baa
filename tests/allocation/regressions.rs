//! Requests that an earlier mixer answered badly: `regressions.toml` has each with its frame and
//! what is expected.

use mixer_tests::frames::{AIRMODES, Place};
use mixer_tests::optimum::Oracle;
use toml::{Table, Value};

use crate::compile;
use crate::continuity::{all_rotors, is_sound, place, stays_from};
use crate::polygons::assert_is_optimal;

const CASES: &str = include_str!("regressions.toml");

fn tables<'a>(table: &'a Table, key: &str) -> impl Iterator<Item = &'a Table> {
    let list = table[key].as_array().expect("a list");
    list.iter().map(|item| item.as_table().expect("a table"))
}

fn word<'a>(table: &'a Table, key: &str) -> &'a str {
    table[key].as_str().expect("a word")
}

fn numbers<const N: usize>(value: &Value) -> [f64; N] {
    let list = value.as_array().expect("a list").iter();
    let numbers: Vec<f64> = list.map(|item| item.as_float().expect("a number")).collect();
    numbers.try_into().expect("as many numbers")
}

fn unit(unit: &Table) -> Place {
    let clockwise = match word(unit, "upper_spin") {
        "cw" => true,
        "ccw" => false,
        other => panic!("no spin: {other}"),
    };
    place(numbers(&unit["position_m"]), numbers(&unit["tilt"]), clockwise)
}

#[test]
fn what_was_answered_badly_once_is_answered_well() {
    let file: Table = CASES.parse().expect("TOML");
    let mut count = 0;
    for case in tables(&file, "case") {
        println!("{}: {}", word(case, "name"), word(case, "why"));
        let units: Vec<Place> = tables(case, "units").map(unit).collect();
        let airmode = AIRMODES.into_iter().find(|mode| *mode == word(case, "airmode"));
        let reserve = case["yaw_reserve_nm"].as_float().expect("a number");
        let frame = compile(&units, airmode.expect("an airmode"), reserve);
        let volts = case["voltage_v"].as_float().expect("a number") as f32;
        let requests = case["requests"].as_array().expect("a list").iter();
        let requests: Vec<[f32; 4]> = requests
            .map(|request| numbers::<4>(request).map(|x| x as f32))
            .collect();
        match word(case, "expect") {
            "steady" => {
                assert!(requests.len() > 1, "a neighbour is missing");
                for pair in requests.windows(2) {
                    stays_from(&frame, [pair[0], pair[1]], volts);
                }
            }
            "sound" => requests
                .iter()
                .for_each(|&request| is_sound(&frame, request, volts)),
            "optimal" => requests.iter().for_each(|&request| {
                assert_is_optimal(&frame, &all_rotors(request, volts), Oracle::of_exact_polygons);
            }),
            other => panic!("nothing is {other}"),
        }
        count += 1;
    }
    assert!(count >= 12, "{count} cases");
}
