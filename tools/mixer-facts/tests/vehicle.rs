//! The vehicle in hover.

use std::collections::BTreeSet;

use mixer_compiler::airframe::GRAVITY;
use mixer_compiler::{Compiled, Source, compile};
use mixer_facts::Checked;
use mixer_facts::hover::Hover;

fn x8(vehicle: &str) -> Compiled {
    let text = format!("{}\n{vehicle}", include_str!("../../../airframes/isae-x8.toml"));
    compile(&Source::new("x8.toml", text)).unwrap_or_else(|faults| panic!("{faults}"))
}

/// The paper's vehicle: 3.2 kg. In hover all pairs give a quarter of the weight and no torque.
#[test]
fn hover_is_that_of_the_pair() {
    let compiled = x8("[vehicle]\nmass_kg = 3.2\n");
    let warnings = mixer_compiler::lint(&compiled);
    assert!(warnings.is_empty(), "{warnings}");
    let hover = Hover::new(&compiled).unwrap();
    assert_eq!(hover.weight_n, GRAVITY * 3.2);
    assert!((hover.thrust_over_weight - 3.159).abs() < 0.01, "{hover:?}");
    let volts: Vec<_> = hover.at.iter().map(|at| at.voltage_v).collect();
    assert_eq!(volts, [Some(12.8), Some(14.8)]);
    let pair = &compiled.maps[0];
    let voltage = compiled.airframe.voltage.as_ref().unwrap();
    for at in &hover.at {
        let [upper, lower] = [&at.layers[0], &at.layers[1]].map(|of| of.throttle);
        assert!(upper[1] - upper[0] < 1e-6 && lower[1] - lower[0] < 1e-6, "{at:?}");
        let [f, q] = pair.efforts([upper[0], lower[0]]);
        let volts = at.voltage_v.unwrap();
        let lift = 4.0 * voltage.thrust_factor(volts) * f;
        assert!((lift - hover.weight_n).abs() < 0.04, "{volts} V: {lift} N");
        assert!(q.abs() < 2e-4, "{volts} V: {q} N m");
        let axes: Vec<_> = at.margins.iter().map(|margin| margin.axis).collect();
        assert_eq!(axes, ["roll", "pitch", "yaw"]);
        for margin in &at.margins {
            let [least, largest] = margin.torque_nm;
            // Not quite a mirror image: the pair's torque reaches further to one side, and units
            // share it.
            assert!(
                least < 0.0 && largest > 0.0 && (least + largest).abs() < 0.2 * largest,
                "{margin:?}"
            );
        }
    }
    // Roll is what the weight gives on one side, less the idle on the other.
    for at in &hover.at {
        let roll = at.margins[0].torque_nm[1];
        assert!((0.7..1.0).contains(&(roll / (0.3182 * hover.weight_n))), "{roll}");
    }
    let text = Checked::new(compiled).verdict();
    for line in [
        "\nmass                3.2 kg, a weight of 31.38 N\n",
        "\nhover               0.5",
        "\nhover, lowest V     0.6",
    ] {
        assert!(text.contains(line), "{text}");
    }
}

/// With the centre of gravity 6 cm aft the rear rotors carry more, which no mean shows.
#[test]
fn hover_has_the_least_and_the_greatest_throttle_of_a_layer() {
    let text = include_str!("../../../airframes/isae-x8.toml")
        .replace("position_m = [0.3182", "position_m = [0.3782");
    let text =
        text.replace("position_m = [-0.3182", "position_m = [-0.2582") + "\n[vehicle]\nmass_kg = 3.2\n";
    let compiled = compile(&Source::new("x8.toml", text)).unwrap_or_else(|faults| panic!("{faults}"));
    let hover = Hover::new(&compiled).unwrap();
    let at = hover.at.last().unwrap();
    let (throttles, ..) = compiled
        .tables
        .mix(
            &mixer_rt::Wrench {
                thrust_n: hover.weight_n as f32,
                ..Default::default()
            },
            14.8,
        )
        .unwrap();
    let layers: Vec<&str> = at.layers.iter().map(|of| of.layer).collect();
    assert_eq!(layers, ["upper", "lower"]);
    for of in &at.layers {
        assert_eq!(of.throttle, of.outputs.map(|output| f64::from(throttles[output])));
        assert!(of.throttle[1] - of.throttle[0] > 0.1, "{at:?}");
    }
    let text = Checked::new(compiled).verdict();
    assert!(text.contains(" (output ") && text.contains("hover"), "{text}");
}

/// Single rotors are a layer of their own, in words and in JSON; of a quad nothing is said of a pair.
#[test]
fn hover_of_single_rotors_is_that_of_no_upper_one() {
    let y4 = include_str!("../../../airframes/y4.toml");
    let compiled = compile(&Source::new("y4.toml", y4)).unwrap_or_else(|faults| panic!("{faults}"));
    let checked = Checked::new(compiled);
    assert!(
        checked
            .verdict()
            .contains(" throttle of upper, lower, single rotors"),
        "{}",
        checked.verdict()
    );
    let json = checked.json(());
    for (key, outputs) in [("upper", 1..2), ("lower", 2..3), ("single", 0..4)] {
        let found = json["hover"]["at"][1][format!("{key}_outputs")][0]
            .as_u64()
            .unwrap();
        assert!(outputs.contains(&found), "{key}: {json}");
    }
    let start = y4.split("[[pair]]").next().unwrap();
    let rotor = "[[rotor]]\nname = \"arm\"\nthrust_n = [1.786702, 33.4751, -7.684862]\ntorque_nm = [0.0947581, 0.5109395, -0.06253742]\n";
    let unit = |(channel, (x, y, spin)): (usize, (f64, f64, &str))| {
        format!(
            "[[unit]]\nposition_m = [{x}, {y}, 0.0]\nupper_spin = \"{spin}\"\nrotor = \"arm\"\nchannels = [{channel}]\n"
        )
    };
    let units = [
        (0.3, 0.3, "ccw"),
        (-0.3, -0.3, "ccw"),
        (0.3, -0.3, "cw"),
        (-0.3, 0.3, "cw"),
    ];
    let units: String = units.into_iter().enumerate().map(unit).collect();
    let quad = format!("{start}{rotor}{units}[vehicle]\nmass_kg = 4.2\n")
        .replace("a coaxial pair at the rear, ", "");
    let compiled = compile(&Source::new("quad.toml", quad)).unwrap_or_else(|faults| panic!("{faults}"));
    let checked = Checked::new(compiled);
    let report = checked.report().to_lowercase();
    for word in ["upper", "lower", "pair", "coaxial", "det j"] {
        assert!(!report.contains(word), "{word}: {report}");
    }
    let json = checked.json(());
    let at = &json["hover"]["at"][0];
    assert!(
        at["single_throttle"][0].is_number() && at.get("lower_throttle").is_none(),
        "{at}"
    );
}

#[test]
fn hover_is_only_there_with_a_mass() {
    let compiled = x8("");
    assert!(Hover::new(&compiled).is_none());
    let json = Checked::new(compiled).json(());
    assert!(json["hover"].is_null());
    let json = Checked::new(x8("[vehicle]\nmass_kg = 9\n")).json(());
    assert!(json["hover"]["at"][0]["upper_throttle"].is_null(), "{json}");
    assert!(json["hover"]["at"][1]["upper_throttle"][1].is_number(), "{json}");
}

/// No name and no key is said twice, and facts that one airframe lacks move none of the others'.
#[test]
fn facts_stand_side_by_side() {
    let all = [x8(""), x8("[vehicle]\nmass_kg = 3.2\n")].map(Checked::new);
    for checked in &all {
        let names: Vec<&str> = checked.facts.iter().map(|fact| fact.name).collect();
        let keys: Vec<&str> = checked
            .facts
            .iter()
            .flat_map(|fact| &fact.json)
            .map(|(key, _)| *key)
            .collect();
        for said in [names, keys] {
            assert_eq!(BTreeSet::from_iter(&said).len(), said.len(), "{said:?}");
        }
    }
    let text = mixer_facts::compare(&all);
    let row = |name: &str| -> Vec<&str> {
        let line = text.lines().find_map(|line| line.strip_prefix(name));
        line.unwrap_or_default().split_whitespace().collect()
    };
    assert_eq!(row("mass (kg)"), ["-", "3.2"], "{text}");
    assert_eq!(row("tables (bytes)"), ["1672", "1672"], "{text}");
}
