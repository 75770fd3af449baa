//! The vehicle in thin air.

use mixer_compiler::atmosphere::density_at;
use mixer_compiler::{Compiled, Source, compile};
use mixer_facts::Checked;
use mixer_facts::air::Air;
use mixer_rt::{Conditions, Health, Wrench};

/// The X8 of 11 inch pairs with another table `[air]` and 3.6 kg.
fn x8(air: &str) -> Compiled {
    let file = include_str!("../../../airframes/x8-11in-least-power.toml");
    let (before, after) = file.split_once("[air]").unwrap();
    let (_, after) = after.split_once("[layout]").unwrap();
    let text = format!("{before}{air}\n[layout]{after}");
    compile(&Source::new("x8.toml", text)).unwrap_or_else(|faults| panic!("{faults}"))
}

const AIR: &str = "[air]\nreference_density_kg_m3 = 1.225\nrange_kg_m3 = [0.75, 1.4]\n";

/// Of an independent program, from the same map and mass.
const KNOWN: [(f64, f64, f64); 3] = [
    (0.0, 0.5735, 2.29),
    (1500.0, 0.6109, 2.05),
    (3000.0, 0.6512, 1.83),
];

#[test]
fn hover_takes_more_throttle_where_the_air_is_thin() {
    for (text, is_corrected) in [(AIR, true), ("", false)] {
        let compiled = x8(text);
        let air = Air::new(&compiled).unwrap();
        assert_eq!(air.range_kg_m3.is_some(), is_corrected);
        assert_eq!(air.exponents, [0.75; 2]);
        assert_eq!(air.altitudes.len(), KNOWN.len());
        for (at, (altitude, throttle, over_weight)) in air.altitudes.iter().zip(KNOWN) {
            assert_eq!(at.altitude_m, altitude);
            assert!((at.hover_throttle.unwrap() - throttle).abs() < 6e-4, "{at:?}");
            assert!((at.thrust_over_weight - over_weight).abs() < 6e-3, "{at:?}");
        }
        let most = air.altitudes[0].thrust_over_weight;
        let at_ceiling = most * air.thrust_factor(density_at(air.ceiling_m.unwrap()));
        assert!((at_ceiling - 1.3).abs() < 1e-6, "{air:?}");
    }
}

/// The mixer, asked for the weight in that air, gives that throttle.
#[test]
fn the_mixer_hovers_at_the_throttle_that_is_stated() {
    let compiled = x8(AIR);
    for at in Air::new(&compiled).unwrap().altitudes {
        let weight = Wrench {
            thrust_n: compiled.airframe.weight_n().unwrap() as f32,
            ..Wrench::default()
        };
        let conditions =
            Conditions::at_voltage(compiled.airframe.reference_v() as f32).in_air(at.density_kg_m3 as f32);
        let mixed = compiled.tables.mix_with_health(&weight, conditions, Health::GOOD);
        let (throttle, ..) = mixed.unwrap();
        let mean = f64::from(throttle.iter().sum::<f32>()) / 8.0;
        assert!((mean - at.hover_throttle.unwrap()).abs() < 2e-5, "{mean} {at:?}");
    }
}

#[test]
fn exponents_say_where_they_come_from() {
    let governed = format!("{AIR}thrust_exponent = 1\n");
    let air = Air::new(&x8(&governed)).unwrap();
    assert_eq!(air.exponents, [1.0, 0.75]);
    assert_eq!(air.exponents_from, ["declared", "the voltage's less 1"]);
    let sigma = density_at(3000.0) / 1.225;
    let [at_sea, .., highest] = air.altitudes[..] else {
        panic!("{air:?}")
    };
    assert!((highest.thrust_over_weight / at_sea.thrust_over_weight - sigma).abs() < 1e-4);
}

/// The paper's X8 with another exponent of thrust over voltage.
fn paper(thrust: &str) -> Compiled {
    let file = include_str!("../../../airframes/isae-x8.toml");
    let text = file.replace("thrust_exponent = 1.75", thrust);
    compile(&Source::new("x8.toml", text)).unwrap_or_else(|faults| panic!("{faults}"))
}

#[test]
fn without_air_the_voltage_tells_where_its_exponent_is_a_motor_s() {
    let points = "thrust_points = [[12.8, 0.7837], [14.8, 1.0], [16.8, 1.2341]]";
    let air = Air::new(&paper(points)).unwrap();
    assert!((air.exponents[0] - 0.66).abs() < 0.02, "{air:?}");
    assert!(air.exponents_from[0].starts_with("least squares"));
    assert_eq!(air.reference_density_kg_m3, 1.225);
    assert_eq!(Air::new(&paper("thrust_exponent = 0.0")), None);
}

/// One line of the verdict; without a mass it is that of the density.
#[test]
fn the_verdict_has_a_line() {
    let line = |compiled: Compiled, name: &str| {
        let verdict = Checked::new(compiled).verdict();
        assert!(verdict.lines().count() < 30, "{verdict}");
        let of_air = |line: &&str| line.contains("density") && !line.contains(" error ");
        let mut lines = verdict.lines().filter(of_air);
        let line = lines
            .next()
            .unwrap()
            .strip_prefix(name)
            .unwrap()
            .trim()
            .to_owned();
        assert_eq!(lines.next(), None);
        line
    };
    assert_eq!(
        line(x8(AIR), "ceiling"),
        "7200 m, thrust over weight 1.3; at 0, 1500, 3000 m it is 2.29, 2.05, 1.83, hover throttle 0.574, 0.611, \
         0.651 in the mean of all rotors; density is corrected for from 0.75 to 1.4 kg/m3"
    );
    assert!(line(x8(""), "ceiling").ends_with("; density is not corrected for: no [air]"));
    let paper = paper("thrust_exponent = 1.75");
    let json = Checked::new(paper.clone()).json(());
    assert!(json["air"]["altitudes"].as_array().unwrap().is_empty());
    assert!(line(paper, "air density").starts_with("not corrected for: no [air]"));
}
