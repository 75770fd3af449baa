//! The vehicle in hover.

use mixer_compiler::airframe::GRAVITY;
use mixer_compiler::{Compiled, Source, compile};
use mixer_facts::hover::Hover;
use mixer_facts::report::{Report, Summary};

fn x8(vehicle: &str) -> Compiled {
    let text = format!("{}\n{vehicle}", include_str!("../../airframes/isae-x8.toml"));
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
    let pair = &compiled.pair;
    let voltage = compiled.airframe.voltage.as_ref().unwrap();
    for at in &hover.at {
        let [f, q] = pair.efforts([at.upper_throttle.unwrap(), at.lower_throttle.unwrap()]);
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
    let text = Report(&compiled).to_string();
    assert!(
        text.contains("\nhover           3.2 kg, 31.38 N; largest thrust over weight 3.1"),
        "{text}"
    );
    assert!(text.contains("\n  at 12.8 V     throttle 0."), "{text}");
}

#[test]
fn hover_is_only_there_with_a_mass() {
    let compiled = x8("");
    assert!(Hover::new(&compiled).is_none());
    let json = serde_json::to_value(Summary::new(&compiled)).unwrap();
    assert!(json["hover"].is_null());
    let json = serde_json::to_value(Summary::new(&x8("[vehicle]\nmass_kg = 9\n"))).unwrap();
    assert!(json["hover"]["at"][0]["upper_throttle"].is_null(), "{json}");
    assert!(json["hover"]["at"][1]["upper_throttle"].is_number(), "{json}");
}
