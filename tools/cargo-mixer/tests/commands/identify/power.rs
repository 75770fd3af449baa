//! The torque of least power, against a pair whose optimum is known in closed form.
//!
//! With f = A (u2 + l2), Q = B (l2 - u2) and P = E (u3 + g l3) + P0, Q = c f at k = c A / B has
//! P - P0 ~ (1 - k)^1.5 + g (1 + k)^1.5, least at k = (1 - g2) / (1 + g2) whatever the thrust.

use std::fmt::Write as _;

use mixer_compiler::airframe::Basis;
use mixer_files::frame::{Frame, NewFrame};
use mixer_identify::fit::power::Power;
use mixer_identify::fragment;
use mixer_identify::identified::{Identified, from_benches};

use super::sweep::{Normal, bench, settings};

const A: f64 = 10.0;
const B: f64 = 0.2;
const E: f64 = 150.0;
const G: f64 = 0.8;

/// Electrical columns behind `upper,lower,thrust_n,torque_nm`, for the power of the upper and of
/// the lower rotor.
struct Electrical {
    header: &'static str,
    row: fn([f64; 2]) -> String,
}

fn identified(electrical: &Electrical, noise: f64) -> Identified {
    let mut normal = Normal::new(7);
    let mut text = format!("upper,lower,thrust_n,torque_nm{}\n", electrical.header);
    for k in 0..100 {
        let (u, l) = (0.1 + 0.1 * f64::from(k / 10), 0.1 + 0.1 * f64::from(k % 10));
        let power = [u * u * u, G * l * l * l].map(|p| E * p * (1.0 + noise * normal.next()));
        let (f, q) = (A * (u * u + l * l), B * (l * l - u * u));
        writeln!(text, "{u},{l},{f},{q}{}", (electrical.row)(power)).expect("a string");
    }
    let settings = settings(Some(Basis::Biquadratic));
    let bench = bench("map.csv", text.as_bytes(), &settings).expect("a bench");
    from_benches(vec![bench], &settings.wishes).expect("a pair")
}

const BOTH: Electrical = Electrical {
    header: ",upper_voltage_v,lower_voltage_v,upper_current_a,lower_current_a",
    row: |[upper, lower]| format!(",14.8,14.4,{},{}", upper / 14.8, lower / 14.4),
};

#[test]
fn the_bias_of_least_power_is_recovered() {
    let k = (1.0 - G * G) / (1.0 + G * G);
    let share = |k: f64| libm::pow(1.0 - k, 1.5) + G * libm::pow(1.0 + k, 1.5);
    let saving = 100.0 * (1.0 - share(k) / share(0.0));
    for (noise, wide) in [(0.0, 4e-5), (0.01, 4e-4)] {
        let found = identified(&BOTH, noise);
        let Some(Power::Identified(least)) = &found.power else {
            panic!("{:?}", found.power)
        };
        assert!(
            (least.bias_nm_per_n - k * B / A).abs() < wide,
            "{} {}",
            least.bias_nm_per_n,
            k * B / A
        );
        assert!(
            (least.saving_percent - saving).abs() < 0.3,
            "{} {saving}",
            least.saving_percent
        );
        let text = fragment::text(&found);
        assert!(
            text.contains("# least power:") && text.contains("N m per N"),
            "{text}"
        );
    }
}

#[test]
fn one_supply_current_of_the_whole_serves() {
    let whole = Electrical {
        header: ",Voltage (V),Current (mA)",
        row: |[upper, lower]| format!(",14.8,{}", 1000.0 * (upper + lower) / 14.8),
    };
    assert!(matches!(
        identified(&whole, 0.0).power,
        Some(Power::Identified(_))
    ));
}

#[test]
fn an_airframe_offers_the_bias_where_it_gains_by_it() {
    let found = identified(&BOTH, 0.0);
    let airframe = |frame| {
        let frame = NewFrame {
            arm_m: Some(0.45),
            name: Some("written"),
            ..NewFrame::of(frame)
        };
        let text = frame.airframe(&fragment::tables(&found), found.power_bias());
        text.expect("an airframe")
    };
    let x8 = airframe(Frame::X8);
    let wanted = x8.replace("# power_bias_nm_per_n", "power_bias_nm_per_n");
    for (text, bias) in [(x8, Some(0.0)), (wanted, found.power_bias())] {
        let compiled = mixer_compiler::compile(&mixer_compiler::Source::new("x8.toml", text));
        let compiled = compiled.unwrap_or_else(|faults| panic!("{faults}"));
        assert_eq!(Some(compiled.airframe.allocation.power_bias_nm_per_n), bias);
        assert!(compiled.airframe.pairs[0].power.is_some());
    }
    let y6 = airframe(Frame::Y6);
    assert!(
        !y6.contains("power_bias_nm_per_n = ") && y6.contains("it saves nothing"),
        "{y6}"
    );
}
