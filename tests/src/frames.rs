//! Frames to test on: the zoo of what users have, and frames by hand with the paper's pair.

use std::fmt::Write as _;

use mixer_compiler::{Compiled, Source};

use mixer_setpoints::Random;

pub mod counted;
pub mod pairs;
mod places;
mod real;
pub mod zoo;

pub use real::{real_pairs, zoo, zoo_with_bench_data};

/// The voltage of `airframes/isae-x8.toml` with exponents that differ, so that a test sees which
/// factor is applied.
const VOLTAGE: &str = r#"
[voltage]
reference_v = 14.8
range_v = [12.8, 16.8]
thrust_exponent = 1.75
torque_exponent = 1.6
"#;

/// Made-up pairs by name, as `[throttle]` and `[pair]`: the lower rotor hardly adds thrust while the
/// upper one is at full throttle, so that the attainable set bends inwards there.
pub const BENT: [(&str, &str); 2] = [
    (
        "bent, biquadratic",
        r#"
[throttle]
min = 0.25
max = 1.0
[pair]
basis = "biquadratic"
thrust_n = [0.0, 0.0, 14.0, 0.0, -4.8, 0.0, 10.0, 0.0]
torque_nm = [0.0, 0.0, -0.15, 0.0, 0.0, 0.0, 0.14, 0.0]
upper_spin = "cw"
"#,
    ),
    ("bent, cubic", counted::BENT),
];

/// The allocation options of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// As in the airframe file.
    pub airmode: &'static str,
    /// As in the airframe file, N m.
    pub yaw_reserve_nm: f64,
    /// As in the airframe file, N m per N; left out where it is 0.
    pub power_bias_nm_per_n: f64,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            airmode: "disabled",
            yaw_reserve_nm: 0.0,
            power_bias_nm_per_n: 0.0,
        }
    }
}

/// The three airmodes.
pub const AIRMODES: [&str; 3] = ["disabled", "roll-pitch", "roll-pitch-yaw"];

/// One unit of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// x, y, z, m.
    pub position: [f64; 3],
    /// Thrust axis.
    pub axis: [f64; 3],
    /// Upper rotor clockwise.
    pub clockwise: bool,
}

/// Regular frames by name: an X8, a Y6, an X10 and an X12.
pub fn regular_frames() -> [(&'static str, Vec<Place>); 4] {
    [
        ("X8", regular(4, 45.0)),
        ("Y6", regular(3, 60.0)),
        ("X10", regular(5, 0.0)),
        ("X12", regular(6, 30.0)),
    ]
}

/// Units at equal angles on a circle of 0.45 m radius, spins alternating, the first at `first_deg`
/// from the nose.
pub fn regular(units: usize, first_deg: f64) -> Vec<Place> {
    (0..units)
        .map(|k| {
            let angle = (first_deg + 360.0 * k as f64 / units as f64).to_radians();
            Place {
                position: [0.45 * cos(angle), 0.45 * sin(angle), 0.0],
                axis: [0.0, 0.0, -1.0],
                clockwise: k % 2 == 0,
            }
        })
        .collect()
}

#[allow(
    clippy::disallowed_methods,
    reason = "positions of test frames need not have the same bits everywhere"
)]
fn cos(x: f64) -> f64 {
    x.cos()
}

#[allow(clippy::disallowed_methods, reason = "as above")]
fn sin(x: f64) -> f64 {
    x.sin()
}

/// x and y, m, at a distance from the centre and an angle clockwise from the nose.
pub fn polar(arm_m: f64, angle_deg: f64) -> [f64; 2] {
    let angle = angle_deg.to_radians();
    [arm_m * cos(angle), arm_m * sin(angle)]
}

/// An irregular frame: units in about even directions around the centre with arms of 0.2 m to 0.7
/// m, random spins, axes tilted by up to `tilt` (about radians).
pub fn irregular(random: &mut Random, units: usize, tilt: f64) -> Vec<Place> {
    let start = random.uniform(0.0, 360.0);
    (0..units)
        .map(|k| {
            let angle = start + (k as f64 + random.uniform(-0.3, 0.3)) * 360.0 / units as f64;
            let arm = random.uniform(0.2, 0.7);
            Place {
                position: [
                    arm * cos(angle.to_radians()),
                    arm * sin(angle.to_radians()),
                    random.uniform(-0.05, 0.05),
                ],
                axis: [random.uniform(-tilt, tilt), random.uniform(-tilt, tilt), -1.0],
                clockwise: if k < 2 { k == 0 } else { random.below(2) == 0 },
            }
        })
        .collect()
}

/// The airframe file of a frame with the paper's pair; unit k has channels `channels[2 k]` and
/// `channels[2 k + 1]`.
pub fn toml(places: &[Place], channels: &[usize], options: Options) -> String {
    toml_with_pair(&[counted::PAPER, VOLTAGE].concat(), places, channels, options)
}

/// `[throttle]` and `[pair]` of an airframe file.
pub fn text_of_pair(pair: &pairs::Pair) -> String {
    let mut text = String::new();
    zoo::write_pair(&mut text, pair);
    text
}

/// As [`toml()`], with these `[throttle]`, `[pair]` and, if any, `[voltage]`.
pub fn toml_with_pair(pair: &str, places: &[Place], channels: &[usize], options: Options) -> String {
    let mut text = format!("name = \"frame\"\n{pair}\n");
    let Options {
        airmode,
        yaw_reserve_nm,
        power_bias_nm_per_n,
    } = options;
    let _ = write!(
        text,
        "[allocation]\nairmode = \"{airmode}\"\nyaw_reserve_nm = {yaw_reserve_nm:?}\n"
    );
    if power_bias_nm_per_n != 0.0 {
        let _ = writeln!(text, "power_bias_nm_per_n = {power_bias_nm_per_n:?}");
    }
    match places.len() {
        1 => text.push_str("axes = [\"yaw\", \"thrust\"]\n"),
        2 => text.push_str("axes = [\"roll\", \"yaw\", \"thrust\"]\n"),
        _ => {}
    }
    for (place, channels) in places.iter().zip(channels.chunks(2)) {
        let length = place.axis.iter().map(|a| a * a).sum::<f64>().sqrt();
        let axis = place.axis.map(|a| a / length);
        let spin = if place.clockwise { "cw" } else { "ccw" };
        let _ = write!(
            text,
            "[[unit]]\nposition_m = {:?}\naxis = {axis:?}\nupper_spin = \"{spin}\"\nchannels = {channels:?}\n",
            place.position
        );
    }
    text
}

/// Compiles a frame with channels in order.
///
/// # Errors
/// The diagnostics, as text.
pub fn compile(places: &[Place], options: Options) -> Result<Compiled, String> {
    let channels: Vec<usize> = (0..2 * places.len()).collect();
    compile_text(&toml(places, &channels, options))
}

/// Compiles the text of an airframe file.
///
/// # Errors
/// The diagnostics, as text.
pub fn compile_text(text: &str) -> Result<Compiled, String> {
    mixer_compiler::compile(&Source::new("frame.toml", text)).map_err(|faults| faults.to_string())
}
