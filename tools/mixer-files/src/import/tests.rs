//! Parameter files as people have them, and what becomes of each.

use mixer_compiler::Source;

use std::collections::BTreeMap;

use mixer_compiler::Compiled;
use mixer_compiler::airframe::{Airframe, Spin};
use mixer_compiler::diagnostic::content::{self, Content};

use super::{Import, Options, import};
use crate::params::{self, Stack, params};

/// What becomes of a file.
enum Outcome {
    /// Its notes have this.
    Noted(&'static str),
    /// It is read without this in its notes.
    Silent(&'static str),
    /// It is refused, the message having this.
    Refused(&'static str),
}
use Outcome::{Noted, Refused, Silent};

/// PX4's parameters of an X8 of this place of the first pair, in this form.
fn px4(first: [f64; 2], line: impl Fn(&str, f64) -> String) -> String {
    let [x, y] = first;
    let places = [[x, y], [0.35, -0.3], [-0.35, -0.3], [-0.35, 0.3]];
    let mut text = line("CA_ROTOR_COUNT", 8.0);
    for (index, layer) in [(0, -0.05), (4, 0.05)] {
        for (unit, [px, py]) in places.into_iter().enumerate() {
            let rotor = format!("CA_ROTOR{}", index + unit);
            let spin = if (unit % 2 == 0) == (index == 0) {
                0.05
            } else {
                -0.05
            };
            for (key, value) in [("PX", px), ("PY", py), ("PZ", layer), ("KM", spin)] {
                text += &line(&format!("{rotor}_{key}"), value);
            }
        }
    }
    text
}

const X8: [f64; 2] = [0.35, 0.3];
const FRAME: &str = "the frame is front right: outputs 0 and 4 (upper ccw); front left: outputs 1 and 5 (upper cw); rear left: \
                     outputs 2 and 6 (upper ccw); rear right: outputs 3 and 7 (upper cw)";

/// Of ArduPilot's X8.
const ARDUPILOT: &str = "front right: outputs 0 and 5 (upper ccw)";

fn comma(name: &str, value: f64) -> String {
    format!("{name},{value}\n")
}

/// Files, and what becomes of each; of an arm of 0.4 m.
fn cases() -> Vec<(&'static str, String, Outcome)> {
    let qgc = |name: &str, value: f64| format!("1\t1\t{name}\t{value:.18}\t9\n");
    let script = |name: &str, value: f64| format!("\tparam set-default {name}\t{value} # of the drawing\n");
    let with = |line: &str| px4(X8, comma) + line;
    let without = |start: &str| {
        let text = px4(X8, comma);
        text.lines()
            .filter(|line| !line.starts_with(start))
            .map(|line| format!("{line}\n"))
            .collect::<String>()
    };
    let instead = |from: &str, to: &str| px4(X8, comma).replace(from, to);
    let ardupilot = |line: &str| format!("FRAME_CLASS,4\nFRAME_TYPE,1\n{line}\n");
    let quadplane = |line: &str| format!("Q_ENABLE,1\nQ_FRAME_CLASS,4\nQ_FRAME_TYPE,1\n{line}\n");
    let dump = |lines: &str| format!("# diff all\nbatch start\nboard_name X\n{lines}\nsave\n");
    let many: String = (0..1500).map(|k| format!("SR{k}_PARAM,{k}\n")).collect();
    let octox8 = "mmix 0 1.000 -1.000 1.000 -1.000\nmmix 1 1.000 -1.000 -1.000 1.000\nmmix 2 1.000 1.000 1.000 1.000\n\
                  mmix 3 1.000 1.000 -1.000 -1.000\nmmix 4 1.000 -1.000 1.000 1.000\nmmix 5 1.000 -1.000 -1.000 -1.000\n\
                  mmix 6 1.000 1.000 1.000 -1.000\nmmix 7 1.000 1.000 -1.000 1.000";
    let half_yaw = |line: &str| {
        let (rest, yaw) = line.rsplit_once(' ').unwrap();
        format!("{rest} {}\n", 0.5 * yaw.parse::<f64>().unwrap())
    };
    let half_yaw: String = octox8.lines().map(half_yaw).collect();
    let bf = "rear right: outputs 0 and 4 (upper cw); front right: outputs 1 and 5 (upper ccw)";
    vec![
        // Forms of a file.
        ("commas", px4(X8, comma), Noted(FRAME)),
        (
            "QGroundControl",
            format!(
                "# Onboard parameters for Vehicle 1\n#\n# Vehicle-Id Component-Id Name Value Type\n{}",
                px4(X8, qgc)
            ),
            Noted(FRAME),
        ),
        (
            "spaces, CRLF, BOM",
            format!(
                "\u{feff}{}",
                px4(X8, |name, value| format!("{name}     {value}\r\n"))
            ),
            Noted(FRAME),
        ),
        (
            "comments behind",
            px4(X8, |name, value| format!("{name} = {value}   # was 1\n")),
            Noted(FRAME),
        ),
        (
            "start script",
            format!(
                "#!/bin/sh\n. ${{R}}etc/init.d/rc.mc_defaults\nset MIXER skip\nif [ $A = 1 ]\nthen\n{}fi\n",
                px4(X8, script)
            ),
            Noted(FRAME),
        ),
        (
            "MAVProxy's script",
            px4(X8, |name, value| format!("param set {name} \"{value}\"\n")),
            Noted(FRAME),
        ),
        (
            "a script's arithmetic",
            format!("param set MAV_SYS_ID $((i+1))\n{}", px4(X8, script)),
            Noted(FRAME),
        ),
        (
            "a rotor by a variable",
            px4(X8, script) + "param set CA_ROTOR0_PX $ARM\n",
            Refused("`param set CA_ROTOR0_PX $ARM` is no parameter"),
        ),
        ("a whole dump", many + &ardupilot(""), Noted(ARDUPILOT)),
        (
            "read-only lines",
            ardupilot("MOT_SPIN_MIN 0.15 @READONLY"),
            Noted(ARDUPILOT),
        ),
        (
            "an include",
            ardupilot("@include other.parm x y"),
            Refused("a:3: `@include other.parm x y` is no parameter"),
        ),
        ("prose", with("these are mine\n"), Refused("is no parameter")),
        ("twice the same", with("CA_ROTOR0_PX,0.35\n"), Noted(FRAME)),
        (
            "twice another",
            with("CA_ROTOR0_PX,0.3\n"),
            Refused("CA_ROTOR0_PX is there twice, first in line 2"),
        ),
        (
            "decimal comma",
            "CA_ROTOR_COUNT 2\nCA_ROTOR0_PX 0,35\n".to_owned(),
            Refused("is no parameter"),
        ),
        (
            "not a number",
            with("CA_ROTOR0_AX,nan\n"),
            Refused("CA_ROTOR0_AX is NaN"),
        ),
        ("empty", String::new(), Refused("no rotors")),
        // PX4.
        (
            "too few rotors",
            instead("COUNT,8", "COUNT,10"),
            Refused("nothing is said of rotor 8"),
        ),
        (
            "too many rotors",
            instead("COUNT,8", "COUNT,16"),
            Refused("not a number from 1 to 12"),
        ),
        (
            "an odd count",
            instead("COUNT,8", "COUNT,7"),
            Noted("rotor 3 has no partner"),
        ),
        (
            "rotors left out",
            with("CA_ROTOR8_PX,0.5\n"),
            Noted("rotor 8 and what follows it are left out"),
        ),
        (
            "defaults beyond the count",
            with("CA_ROTOR8_PX,0\nCA_ROTOR8_KM,0.05\n"),
            Silent("left out"),
        ),
        (
            "no spin",
            instead("CA_ROTOR3_KM,-0.05", "CA_ROTOR3_KM,0"),
            Refused("CA_ROTOR3_KM is 0"),
        ),
        (
            "both one way",
            instead("CA_ROTOR4_KM,-0.05", "CA_ROTOR4_KM,0.05"),
            Refused("both turn ccw"),
        ),
        (
            "z upwards",
            with("CA_ROTOR0_AZ,1\n"),
            Refused("the thrust points down"),
        ),
        (
            "one height",
            without("CA_ROTOR0_PZ") + "CA_ROTOR0_PZ,0.05\n",
            Refused("at one height"),
        ),
        (
            "one rotor of a pair displaced",
            instead("CA_ROTOR0_PX,0.35", "CA_ROTOR0_PX,0.3"),
            Refused("is alone"),
        ),
        (
            "a pair displaced",
            px4([0.35, 0.25], comma),
            Noted("unit[0] at y = 0.3 in place of 0.25"),
        ),
        (
            "a VTOL",
            with("CA_AIRFRAME,2\n"),
            Noted("CA_AIRFRAME is 2, no multirotor"),
        ),
        ("a multirotor", with("CA_AIRFRAME,0\n"), Silent("CA_AIRFRAME")),
        (
            "a rotor that tilts",
            with("CA_AIRFRAME,8\nCA_ROTOR0_TILT,1\n"),
            Refused("a servo tilts"),
        ),
        (
            "a tilt that a multirotor has not",
            with("CA_ROTOR0_TILT,1\n"),
            Noted(FRAME),
        ),
        (
            "a pusher",
            instead("COUNT,8", "COUNT,9")
                + "CA_AIRFRAME,2\nCA_ROTOR8_PX,-0.8\nCA_ROTOR8_AX,1\nCA_ROTOR8_AZ,0\nCA_ROTOR8_KM,0\n",
            Noted("motor 8 pushes, its axis lying flat: it is left out"),
        ),
        (
            "a pusher before the rotors",
            with("CA_ROTOR0_AX,1\nCA_ROTOR0_AZ,0\n"),
            Refused("motor 0 pushes, its axis lying flat, and motor 1 behind it is a rotor"),
        ),
        ("no axis", with("CA_ROTOR0_AZ,0\n"), Refused("are all 0")),
        (
            "metres",
            px4(X8, comma),
            Noted("places are taken as metres: compare position_m with the vehicle"),
        ),
        (
            "places over the arm",
            px4([0.5f64.sqrt(); 2], comma)
                .replace("0.35", "0.707107")
                .replace("0.3\n", "0.707107\n"),
            Noted("the outermost places are at 1 m, as where they were divided by the arm"),
        ),
        (
            "places of the stock file",
            px4([0.35; 2], comma).replace("0.3\n", "0.35\n"),
            Noted("the arms are those of PX4's own airframe files"),
        ),
        (
            "another order of outputs on a bus",
            with("UAVCAN_EC_FUNC1,102\nUAVCAN_EC_FUNC2,101\nUAVCAN_EC_MAX1,8191\nPWM_MAIN_MAX1,1900\n"),
            Noted("UAVCAN_EC_FUNC1 has motor 2, which is channel 1"),
        ),
        (
            "pulses beside a bus",
            with("VOXL_ESC_FUNC1,101\nVOXL_ESC_FUNC2,102\nPWM_MAIN_MAX1,1900\n"),
            Silent("PWM"),
        ),
        (
            "PX4 before 1.13",
            "MAV_TYPE 14\nPWM_MAIN_MIN 1075\n".to_owned(),
            Refused("no rotors"),
        ),
        (
            "pulses of PX4",
            with("PWM_MAIN_FUNC1,101\nPWM_MAIN_MIN1,1100\nPWM_MAIN_MAX1,1900\n"),
            Noted("PWM_MAIN_MIN1 is 1100, PWM_MAIN_MAX1 is 1900: throttle 0 to 1 is 0.100 to 0.900"),
        ),
        (
            "pulses on AUX",
            with("PWM_AUX_FUNC3,101\nPWM_AUX_MAX3,1950\nPWM_MAIN_MAX1,1800\n"),
            Noted("PWM_AUX_MAX3 is 1950"),
        ),
        ("older pulses", with("PWM_MAX,1950\n"), Noted("PWM_MAX is 1950")),
        // Of single rotors.
        (
            "thrust of one rotor",
            with("CA_ROTOR2_CT,4.5\n"),
            Noted(
                "the upper rotors 0 and 2 have thrusts of 6.5 and 4.5, and the file gives all of them one map",
            ),
        ),
        (
            "a rotor without thrust",
            with("CA_ROTOR6_CT,0\n"),
            Refused("rotor 6 has no thrust, and the stack leaves it out"),
        ),
        (
            "thrusts of the layers",
            (4..8).fold(px4(X8, comma), |text, k| {
                text + &comma(&format!("CA_ROTOR{k}_CT"), 5.5)
            }),
            Noted("differ (6.5, 0.05 and 5.5, 0.05) and are not used"),
        ),
        (
            "yaw of one unit",
            instead("CA_ROTOR1_KM,-0.05", "CA_ROTOR1_KM,-0.02"),
            Noted("the upper rotors 0 and 1 have yaw factors of 0.05 and 0.02"),
        ),
        (
            "reversible",
            with("CA_R_REV,3\n"),
            Noted("rotors 0, 1 may turn backwards"),
        ),
        (
            "pulses of the layers",
            (1..=8).fold(px4(X8, comma), |text, k| {
                let [low, high] = if k > 4 { [1100.0, 1900.0] } else { [1000.0, 2000.0] };
                let lines = [("FUNC", 100.0 + f64::from(k)), ("MIN", low), ("MAX", high)];
                lines.iter().fold(text, |text, (key, value)| {
                    text + &comma(&format!("PWM_MAIN_{key}{k}"), *value)
                })
            }),
            Noted("1000 to 2000 us of channels 0, 1, 2, 3; 1100 to 1900 us of channels 4, 5, 6, 7"),
        ),
        ("alike", px4(X8, comma), Silent("not used")),
        (
            "pulses of DShot",
            with("PWM_MAIN_TIM0,-4\nPWM_MAIN_MAX1,1900\n"),
            Silent("PWM"),
        ),
        (
            "a servo's pulses",
            with("PWM_MAIN_FUNC1,101\nPWM_MAIN_MAX1,2000\nPWM_MAIN_FUNC9,201\nPWM_MAIN_MAX9,1800\n"),
            Silent("PWM"),
        ),
        (
            "another order of pins",
            with("PWM_MAIN_FUNC1,103\nPWM_MAIN_FUNC3,101\n"),
            Noted("PWM_MAIN_FUNC1 has motor 3, which is channel 2"),
        ),
        // ArduPilot.
        ("octaquad", ardupilot(""), Noted(ARDUPILOT)),
        (
            "a quad",
            "FRAME_CLASS,1\nFRAME_TYPE,1\n".to_owned(),
            Refused("no frame of coaxial pairs"),
        ),
        (
            "an octa",
            "FRAME_CLASS,3\nFRAME_TYPE,1\n".to_owned(),
            Refused("no frame of coaxial pairs"),
        ),
        (
            "no type",
            "FRAME_CLASS,4\n".to_owned(),
            Refused("FRAME_TYPE is not a whole number, or is missing"),
        ),
        (
            "co-rotating",
            "FRAME_CLASS,4\nFRAME_TYPE,20\n".to_owned(),
            Refused("turn the same way"),
        ),
        (
            "short pulses",
            ardupilot("MOT_PWM_MIN,1000\nMOT_PWM_MAX,1940"),
            Noted("MOT_PWM_MAX is 1940: throttle 0 to 1 is 0.000 to 0.940"),
        ),
        (
            "usual pulses",
            ardupilot("MOT_PWM_MIN,1000\nMOT_PWM_MAX,2000"),
            Silent("PWM"),
        ),
        (
            "the stick's pulses",
            ardupilot("MOT_PWM_MIN,0\nMOT_PWM_MAX,0\nRC3_MIN,1100\nRC3_MAX,1900"),
            Noted("MOT_PWM_MAX is 0: the pulses are those of other parameters"),
        ),
        (
            "an older script of PX4",
            px4(X8, script) + "mixer load /dev/pwm_output0 /etc/mixers/octo_cox.main.mix\n",
            Noted(FRAME),
        ),
        (
            "DShot",
            ardupilot("MOT_PWM_TYPE,6\nMOT_PWM_MAX,1940"),
            Silent("PWM"),
        ),
        (
            "the servos' pulses",
            ardupilot("MOT_PWM_TYPE,8\nSERVO1_FUNCTION,33\nSERVO1_MIN,1100"),
            Noted("MOT_PWM_TYPE is 8: the pulses are those of other parameters"),
        ),
        (
            "another order of servos",
            ardupilot("SERVO1_FUNCTION,34\nSERVO2_FUNCTION,33"),
            Noted("SERVO1_FUNCTION has motor 2, which is channel 1"),
        ),
        (
            "motors 9 to 12",
            ardupilot("SERVO1_FUNCTION,33\nSERVO9_FUNCTION,82"),
            Silent("SERVO"),
        ),
        (
            "a QuadPlane",
            quadplane("Q_M_SPIN_MIN,0.2\nQ_M_PWM_MAX,1900"),
            Noted("Q_M_PWM_MAX is 1900"),
        ),
        (
            "names of a QuadPlane",
            quadplane(""),
            Noted("Q_FRAME_CLASS, Q_FRAME_TYPE and Q_M_* there"),
        ),
        (
            "one that tilts",
            quadplane("Q_TILT_ENABLE,1"),
            Noted("rotors that tilt are not in the model"),
        ),
        (
            "a tailsitter",
            quadplane("Q_TAILSIT_ENABLE,1"),
            Noted("Q_TAILSIT_ENABLE is on: the airframe is that of hover"),
        ),
        // Betaflight and INAV.
        ("OCTOX8", dump("mixer OCTOX8"), Noted(bf)),
        (
            "a throttle of one motor",
            dump(&octox8.replace("mmix 3 1.000", "mmix 3 0.900")),
            Noted(
                "the upper rotors 0 and 3 have thrusts of 1 and 0.9, and the file gives all of them one map",
            ),
        ),
        (
            "3D",
            dump("feature 3D\nmixer OCTOX8"),
            Noted("may turn backwards in the stack"),
        ),
        (
            "Y4",
            dump("mmix 0 1 0 1 -1\nmmix 1 1 -1 -1 0\nmmix 2 1 0 1 1\nmmix 3 1 1 -1 0"),
            Noted(
                "rear: outputs 0 and 2 (upper cw); front right: output 1 (single ccw); front left: output 3 (single cw)",
            ),
        ),
        (
            "OCTOX8 reversed",
            dump("mixer octox8\nset yaw_motors_reversed = ON"),
            Noted("rear right: outputs 0 and 4 (upper ccw)"),
        ),
        (
            "Betaflight 3.1 reversed",
            dump("mixer OCTOX8\nset yaw_motor_direction = -1"),
            Noted("rear right: outputs 0 and 4 (upper ccw)"),
        ),
        (
            "Betaflight 3.1 reversed, told",
            dump("mixer OCTOX8\nset yaw_motor_direction = -1"),
            Noted("yaw_motor_direction is -1: upper_spin has it"),
        ),
        (
            "Betaflight 3.1 as usual",
            dump("mixer OCTOX8\nset yaw_motor_direction = 1"),
            Noted(bf),
        ),
        (
            "Cleanflight",
            dump("mixer OCTOX8\nset yaw_direction = -1"),
            Noted("rear right: outputs 0 and 4 (upper ccw)"),
        ),
        (
            "direction not said",
            dump("mixer OCTOX8"),
            Noted("the file does not say yaw_motors_reversed"),
        ),
        (
            "direction said",
            dump("mixer OCTOX8\nset yaw_motors_reversed = OFF"),
            Silent("yaw_motors_reversed"),
        ),
        (
            "OCTOX8P",
            dump("mixer OCTOX8P"),
            Noted("rear: outputs 0 and 4 (upper cw); right: outputs 1 and 5 (upper ccw)"),
        ),
        ("mmix load", dump("mixer CUSTOM\nmmix load octox8"), Noted(bf)),
        (
            "mmix load, and a motor anew",
            dump("mixer CUSTOM\nmmix load Y6\nmmix 0 1.0 0.0 1.333 -1.0\nmmix 3 1.0 0.0 1.333 1.0"),
            Noted("rear: outputs 0 and 3 (upper cw)"),
        ),
        (
            "mmix load of a quad",
            dump("mixer CUSTOM\nmmix load QUADX"),
            Refused("no coaxial pairs"),
        ),
        (
            "an output that is kept free",
            dump(
                "mmix load Y6\nmmix 3 1 0 0 0\nmmix 4 1 0 1.333 -1\nmmix 5 1 -1 -0.667 1\nmmix 6 1 1 -0.667 1",
            ),
            Refused(
                "motor 3 has no part in roll, pitch and yaw, so it is no rotor, and motor 4 behind it is a rotor",
            ),
        ),
        (
            "one behind the rotors",
            dump("mmix load Y6\nmmix 6 1 0 0 0"),
            Noted("motor 6 has no part in roll, pitch and yaw, so it is no rotor: it is left out"),
        ),
        (
            "a place holder of INAV",
            format!("{octox8}\nmmix 8 -1.200 0.000 0.000 0.000"),
            Noted("motor 8 has no part in roll, pitch and yaw"),
        ),
        (
            "reordered outputs",
            dump("mixer OCTOX8\nset motor_output_reordering = 0,1,2,3,4,5,7,6"),
            Noted("motor_output_reordering is 0,1,2,3,4,5,7,6"),
        ),
        (
            "outputs in order",
            dump("mixer OCTOX8\nset motor_output_reordering = 0,1,2,3,4,5,6,7"),
            Silent("motor_output_reordering"),
        ),
        (
            "gains of other factors",
            dump(&half_yaw),
            Noted("are multiplied, those of yaw by 0.500"),
        ),
        (
            "gains of these",
            dump(&format!("mixer CUSTOM\n{octox8}")),
            Silent("PID gains"),
        ),
        (
            "a VTOL of INAV",
            format!(
                "# INAV/X 7\nmixer_profile 1\nset platform_type = AIRPLANE\nmmix 0 1 0 0 0\nmixer_profile 2\n{octox8}\nmixer_profile 1"
            ),
            Noted(
                "the rotors are those of mixer_profile 2; mixer_profile 1, of a vehicle of type AIRPLANE, is left out",
            ),
        ),
        (
            "its second profile alone, reversed",
            format!(
                "mixer_profile 2\nset platform_type = MULTIROTOR\n{octox8}\nset motor_direction_inverted = ON"
            ),
            Noted("rear right: outputs 0 and 4 (upper ccw)"),
        ),
        (
            "reversed in the other profile",
            format!(
                "mixer_profile 1\nset platform_type = AIRPLANE\nset motor_direction_inverted = ON\nmixer_profile 2\n{octox8}"
            ),
            Noted(bf),
        ),
        (
            "a twin of INAV",
            "mixer_profile 1\nset platform_type = AIRPLANE\nmmix 0 1 0 0 .3\nmmix 1 1 0 0 -.3".to_owned(),
            Refused("a:2: platform_type is AIRPLANE, no MULTIROTOR"),
        ),
        (
            "a boat",
            "set platform_type = BOAT\nmmix 0 1 0 0 1\nmmix 1 1 0 0 -1".to_owned(),
            Refused("platform_type is BOAT"),
        ),
        (
            "engines side by side",
            dump("mixer CUSTOM\nmmix 0 1 0 0 .3\nmmix 1 1 0 0 -.3"),
            Refused("no motor has a factor of roll or pitch: those are engines side by side"),
        ),
        (
            "Y6",
            dump("mixer Y6"),
            Noted("rear: outputs 0 and 3 (upper ccw); front right: outputs 1 and 4 (upper cw)"),
        ),
        (
            "INAV",
            format!("mmix reset\n{octox8}\nset motor_direction_inverted = ON"),
            Noted("rear right: outputs 0 and 4 (upper ccw)"),
        ),
        (
            "mmix of Betaflight",
            dump(&format!("mixer CUSTOM\nmmix reset\n{octox8}")),
            Noted(bf),
        ),
        (
            "with commas and comments",
            octox8.replace(" -1.000", ", -1.0").replace('\n', "   // one\n"),
            Noted(bf),
        ),
        (
            "a table in a whole dump",
            dump("mixer OCTOX8\nmmix reset"),
            Noted(bf),
        ),
        (
            "a second profile",
            format!("mixer_profile 1\n{octox8}\nmixer_profile 2\nmmix reset\nmmix 0 1 0 0 0"),
            Noted(bf),
        ),
        (
            "a quad of Betaflight",
            dump("mixer QUADX"),
            Refused("no coaxial pairs"),
        ),
        ("its default", dump(""), Refused("no coaxial pairs")),
        (
            "a broken line",
            dump("mmix 0 1 0 0"),
            Refused("`mmix 0 1 0 0` is not `mmix MOTOR THROTTLE"),
        ),
        (
            "a motor missing",
            octox8.replace("mmix 3", "mmix 9"),
            Refused("motor 3 is missing, and motor 4 behind it is a rotor"),
        ),
        (
            "alternate layers",
            "mmix 0 1 0 1 1\nmmix 1 1 0 1 -1\nmmix 2 1 0 -1 1\nmmix 3 1 0 -1 -1".to_owned(),
            Noted("front: outputs 2 and 3 (upper ccw)"),
        ),
        (
            "no yaw",
            octox8.replace("-1.000\nmmix 1", "0\nmmix 1"),
            Refused("the yaw of motor 0 is 0"),
        ),
        (
            "a rectangle",
            octox8
                .replace("mmix 0 1.000 -1.000 1.000", "mmix 0 1 -1 0.7")
                .replace("mmix 4 1.000 -1.000 1.000", "mmix 4 1 -1 0.7"),
            Noted("shorter where the factors of roll and pitch say so"),
        ),
    ]
}

fn outcome(text: &str, options: &Options<'_>, expected: &Outcome) -> Result<(), String> {
    let made =
        import(&Source::new("a", text), None, options).map(|made| [made.warnings, made.notes].concat());
    let (is_so, got) = match (made, expected) {
        (Ok(made), Noted(words)) => (made.iter().any(|note| note.contains(words)), made.join("\n")),
        (Ok(made), Silent(words)) => (!made.iter().any(|note| note.contains(words)), made.join("\n")),
        (Err(message), Refused(words)) => (message.contains(words), message),
        (Ok(made), Refused(_)) => (false, made.join("\n")),
        (Err(message), _) => (false, message),
    };
    is_so.then_some(()).ok_or(got)
}

#[test]
fn files_as_people_have_them() {
    let options = Options {
        arm_m: Some(0.4),
        ..Options::default()
    };
    let wrong: Vec<String> = cases()
        .iter()
        .filter_map(|(name, text, expected)| {
            Some(format!("{name}: {}", outcome(text, &options, expected).err()?))
        })
        .collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
    // What has no metres needs an arm.
    for text in ["FRAME_CLASS,4\nFRAME_TYPE,1\n", "mixer Y6"] {
        assert_eq!(
            outcome(text, &Options::default(), &Refused("--arm METRES")),
            Ok(())
        );
    }
}

/// The stack of a file.
fn stack(text: &str) -> Stack {
    match content::of(text) {
        Content::Ardupilot => Stack::Ardupilot,
        Content::Betaflight => Stack::Betaflight,
        _ => Stack::Px4,
    }
}

/// An airframe of a file, with the paper's pair and a rotor of it alone, and the airframe that it is.
fn airframe_of(text: &str) -> (Import, Airframe) {
    let pair = std::fs::read_to_string("../../airframes/isae-x8.toml").unwrap();
    let alone = "[pair.lower_out]\nthrust_n = [2.764, 12.3604, 0.0]\ntorque_nm = [-0.0907, -0.1312, 0.0]\n\n[voltage]";
    let pair = pair.replacen("[voltage]", alone, 1);
    let options = Options {
        arm_m: Some(0.4),
        ..Options::default()
    };
    let made = import(
        &Source::new("a", text),
        Some(&Source::new("pair.toml", pair)),
        &options,
    );
    let made = made.unwrap_or_else(|error| panic!("{error}\n{text}"));
    let airframe = Airframe::read(&Source::new("a.toml", made.text.as_str()));
    (made, airframe.unwrap_or_else(|faults| panic!("{faults}\n{text}")))
}

/// What a stack's files say of a frame: outputs, spins and places; of Betaflight's factors, which have no metres and a scale
/// of their own per axis, places over the longest.
fn frame(airframe: &Airframe, stack: Stack) -> Vec<(mixer_facts::checklist::Outputs, Spin, [f64; 3])> {
    let units = || airframe.units.iter();
    let longest = |axis: usize| units().fold(1e-9, |most: f64, unit| most.max(unit.position_m[axis].abs()));
    let scales = match stack {
        Stack::Betaflight => [longest(0), longest(1), 1.0],
        _ => [1.0; 3],
    };
    let unit = |unit: &mixer_compiler::airframe::Unit| {
        let place = std::array::from_fn(|axis| unit.position_m[axis] / scales[axis]);
        let outputs = (unit.upper_channel, unit.lower_channel);
        (outputs, unit.upper_spin, place)
    };
    units().map(unit).collect()
}

/// Places that are one: parameters have four digits, factors three.
const SAME_PLACE: f64 = 3e-3;

#[track_caller]
fn assert_same(a: &Airframe, b: &Airframe, stack: Stack, what: &str) {
    let (a, b) = (frame(a, stack), frame(b, stack));
    let is_same = a.len() == b.len()
        && a.iter().zip(&b).all(|(a, b)| {
            let apart = a.2.iter().zip(&b.2).map(|(a, b)| (a - b).abs());
            a.0 == b.0 && a.1 == b.1 && apart.fold(0.0, f64::max) < SAME_PLACE
        });
    assert!(is_same, "{what}:\n{a:?}\n{b:?}");
}

/// A file with parameters set over its own, as a ground station or a command line sets them.
fn set_over(base: &str, set: &str, stack: Stack) -> String {
    if stack == Stack::Betaflight {
        return format!("{base}\n{set}");
    }
    let mut values: BTreeMap<String, String> = BTreeMap::new();
    for line in base.lines().chain(set.lines()) {
        let content = line.split('#').next().unwrap_or_default();
        for statement in content.split(';') {
            let words = super::parameters::words(statement);
            let is_name = |word: &str| word.starts_with(|c: char| c.is_ascii_uppercase());
            if let Some(at) = words.iter().position(|word| is_name(word))
                && let Some(value) = words.get(at + 1).filter(|value| value.parse::<f64>().is_ok())
            {
                values.insert(words[at].to_owned(), (*value).to_owned());
            }
        }
    }
    values
        .iter()
        .map(|(name, value)| format!("{name},{value}\n"))
        .collect()
}

/// Every file that is read: its parameters give its frame again, and set over those of any other vehicle of the stack,
/// too, so that none is left that contradicts.
#[test]
fn what_is_read_is_written_back() {
    let bicopter = std::fs::read_to_string("../cargo-mixer/tests/cases/files/bicopter.params").unwrap();
    let mut files: Vec<(&str, String)> = cases()
        .into_iter()
        .filter(|(.., expected)| !matches!(expected, Refused(_)))
        .map(|(name, text, _)| (name, text))
        .collect();
    files.push(("bicopter", bicopter));
    let mut compiled: BTreeMap<String, Option<Compiled>> = BTreeMap::new();
    let mut sets: BTreeMap<String, (Stack, Airframe)> = BTreeMap::new();
    let mut uncompiled = Vec::new();
    for (name, text) in &files {
        let (made, airframe) = airframe_of(text);
        let tables = made
            .text
            .lines()
            .filter(|line| !line.starts_with(['#', 'd']))
            .collect::<String>();
        let compiled = compiled
            .entry(tables)
            .or_insert_with(|| mixer_compiler::compile(&Source::new("a.toml", made.text)).ok());
        let Some(compiled) = compiled else {
            uncompiled.push(*name);
            continue;
        };
        let stack = stack(text);
        for own in [false, true] {
            let options = params::Options {
                own,
                ..params::Options::of(stack)
            };
            let set = params(compiled, "a.toml", &options).unwrap().text;
            if stack == Stack::Ardupilot && !own {
                assert!(set.contains("FRAME_CLASS,100\n"), "{name}: {set}");
                continue;
            }
            assert_same(&airframe, &airframe_of(&set).1, stack, name);
            sets.insert(set, (stack, airframe.clone()));
        }
    }
    // Frames of two pairs, without roll or pitch.
    assert_eq!(uncompiled, ["alternate layers", "bicopter"]);
    let mut merged = 0;
    // Profiles are INAV's, for which nothing is written.
    for (base_name, base) in files.iter().filter(|(_, base)| !base.contains("mixer_profile")) {
        for (set, (stack, airframe)) in sets.iter().filter(|(_, (of_set, _))| *of_set == stack(base)) {
            let told = format!("over {base_name}: {set}");
            assert_same(
                airframe,
                &airframe_of(&set_over(base, set, *stack)).1,
                *stack,
                &told,
            );
            merged += 1;
        }
    }
    assert!(files.len() > 60 && merged > 500, "{} {merged}", files.len());
}
