//! Airframes that are measured and nothing else: how cost grows with units and with tolerance, and
//! what other priorities cost. The build script of `tests/firmware` includes this file.

use std::fmt::Write as _;

/// Name of all of them, hence of their modules.
const NAME: &str = "measured";

/// The paper's `[throttle]` and `[pair]`, as in `airframes/isae-x8.toml`.
pub const PAPER: &str = r#"
[throttle]
min = 0.1
max = 1.0
[pair]
basis = "biquadratic"
thrust_n  = [5.2075, -2.1892, 12.3604, -10.2432, 4.4427, 2.7640, 12.2092, 0.2363]
torque_nm = [-0.0673, -0.0606, -0.1312, 0.0953, 0.0364, -0.0907, 0.1441, 0.0720]
upper_spin = "cw"
"#;

/// A made-up pair, whose lower rotor hardly adds thrust while the upper one is at full throttle:
/// its attainable set bends inwards.
pub const BENT: &str = r#"
[throttle]
min = 0.25
max = 1.0
[pair]
basis = "cubic"
thrust_n  = [1.5, 0.4, -0.6, 0.8, 12.5, -4.9, 9.4, 0.3, 0.2]
torque_nm = [-0.012, 0.004, 0.003, 0.011, -0.135, 0.002, 0.128, -0.004, 0.003]
upper_spin = "cw"
"#;

/// The voltage of `airframes/isae-x8.toml`.
const VOLTAGE: &str = r#"[voltage]
reference_v = 14.8
range_v = [12.8, 16.8]
thrust_exponent = 1.75
torque_exponent = 1.75
"#;

/// Regular frames of 1 to 8 units on arms of 0.45 m; the X8 with tolerances of 0.1 N to 5e-5 N,
/// with yaw before thrust, with a reserve of yaw, and with upper rotors that all turn alike; the X12
/// with yaw before thrust, and with a reserve; a Y6 and an X8 with a made-up pair whose
/// attainable set bends inwards; frames of 4, 6 and 8 units whose axes lean by 6 degrees along
/// their circle, to and fro. The Y6s with the pairs of `airframes/x8-*.toml` are those of [`y6`].
pub fn all() -> Vec<(String, String)> {
    let sizes = (1..=8).map(|units| (format!("regular-{units}"), regular(PAPER, units, "")));
    let tolerances = [
        ("0.1", "9e-4"),
        ("0.01", "1e-4"),
        ("0.004", "5e-5"),
        ("2e-4", "2.5e-6"),
        ("5e-5", "8e-7"),
    ];
    let tolerances = tolerances.into_iter().map(|(thrust_n, torque_nm)| {
        let inverse =
            format!("[inverse]\nthrust_tolerance_n = {thrust_n}\ntorque_tolerance_nm = {torque_nm}\n");
        (format!("tolerance-{thrust_n}"), regular(PAPER, 4, &inverse))
    });
    let priorities = [
        ("roll-pitch-yaw", "airmode = \"roll-pitch-yaw\""),
        ("reserve-0.1", "yaw_reserve_nm = 0.1"),
        (
            "roll-pitch-yaw-reserve-0.1",
            "airmode = \"roll-pitch-yaw\"\nyaw_reserve_nm = 0.1",
        ),
    ];
    let priorities = priorities.map(|(name, allocation)| {
        (
            name.to_owned(),
            regular(PAPER, 4, &format!("[allocation]\n{allocation}\n")),
        )
    });
    let six = [
        (
            "regular-6-roll-pitch-yaw",
            "[allocation]\nairmode = \"roll-pitch-yaw\"\n",
        ),
        ("regular-6-reserve-0.15", "[allocation]\nyaw_reserve_nm = 0.15\n"),
    ];
    let six = six.map(|(name, options)| (name.to_owned(), regular(PAPER, 6, options)));
    let like_spins = regular(PAPER, 4, "") + "spins = [\"cw\", \"cw\", \"cw\", \"cw\"]\n";
    let like_spins = ("regular-4-like-spins".to_owned(), like_spins);
    let bent = [3, 4].map(|units| (format!("bent-{units}"), regular(BENT, units, "")));
    let tilted = [4, 6, 8].map(|units| (format!("tilted-{units}"), tilted(units)));
    let priorities = priorities.into_iter().chain(six).chain([like_spins]);
    let others = priorities.chain(bent).chain(tilted);
    sizes.chain(tolerances).chain(others).collect()
}

/// A Y6 with the pair of an X8 with a short `[layout]`, and its name; `None` for other airframes.
pub fn y6(name: &str, text: &str) -> Option<(String, String)> {
    let pair = name.strip_prefix("x8-")?;
    let text = text.replace(
        "units = 4\nfirst_angle_deg = 45.0",
        "units = 3\nfirst_angle_deg = 60.0",
    );
    // Of several pairs the one behind has its own.
    let text = text.replace("\"rear\", \"rear\", ", "\"rear\", ");
    Some((format!("y6-{pair}"), text.replace(name, NAME)))
}

/// One unit lies ahead, two lie abreast.
fn regular(pair: &str, units: u32, options: &str) -> String {
    let first_angle_deg = match units {
        1 => 0.0,
        2 => 90.0,
        _ => 180.0 / f64::from(units),
    };
    let mut text = format!("name = {NAME:?}\n{pair}{VOLTAGE}{options}");
    let _ = write!(
        text,
        "[layout]\narm_m = 0.45\nunits = {units}\nfirst_angle_deg = {first_angle_deg:?}\n"
    );
    match units {
        1 => text.push_str("[allocation]\naxes = [\"yaw\", \"thrust\"]\n"),
        2 => text.push_str("[allocation]\naxes = [\"roll\", \"yaw\", \"thrust\"]\n"),
        _ => {}
    }
    text
}

/// Units on a circle of 0.45 m radius whose thrust axes lean along it, by turns to either side.
#[allow(
    clippy::disallowed_methods,
    reason = "positions are written to a micrometre, which hides the last bits"
)]
fn tilted(units: u32) -> String {
    const LEAN: f64 = 0.1;
    let mut text = format!("name = {NAME:?}\n{PAPER}{VOLTAGE}");
    for k in 0..units {
        let angle = std::f64::consts::TAU * (f64::from(k) + 0.5) / f64::from(units);
        let (side, spin) = if k % 2 == 0 { (LEAN, "cw") } else { (-LEAN, "ccw") };
        let (x, y) = (angle.cos(), angle.sin());
        let _ = write!(
            text,
            "[[unit]]\nposition_m = [{:.6}, {:.6}, 0.0]\naxis = [{:.6}, {:.6}, -1.0]\nupper_spin = {spin:?}\nchannels = [{}, {}]\n",
            0.45 * x,
            0.45 * y,
            -side * y,
            side * x,
            2 * k,
            2 * k + 1
        );
    }
    text
}
