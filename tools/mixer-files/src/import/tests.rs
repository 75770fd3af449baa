//! Parameter files as people have them, and what becomes of each.

use mixer_compiler::Source;

use super::{Options, import};

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

fn outcome(text: &str, options: &Options<'_>, expected: &Outcome) -> Result<(), String> {
    let made = import(&Source::new("a", text), None, options);
    let (is_so, got) = match (made, expected) {
        (Ok(made), Noted(words)) => (
            made.notes.iter().any(|note| note.contains(words)),
            made.notes.join("\n"),
        ),
        (Ok(made), Silent(words)) => (
            !made.notes.iter().any(|note| note.contains(words)),
            made.notes.join("\n"),
        ),
        (Err(message), Refused(words)) => (message.contains(words), message),
        (Ok(made), Refused(_)) => (false, made.notes.join("\n")),
        (Err(message), _) => (false, message),
    };
    is_so.then_some(()).ok_or(got)
}

#[test]
fn files_as_people_have_them() {
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
    let bf = "rear right: outputs 0 and 4 (upper cw); front right: outputs 1 and 5 (upper ccw)";
    let cases: Vec<(&str, String, Outcome)> = vec![
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
        ("an odd count", instead("COUNT,8", "COUNT,7"), Refused("is alone")),
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
            with("CA_ROTOR0_TILT,1\n"),
            Refused("a servo tilts"),
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
            Refused("the upper rotors 0 and 2 have thrusts of 6.5 and 4.5"),
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
            Refused("the upper rotors 0 and 3 have thrusts of 1 and 0.9"),
        ),
        (
            "3D",
            dump("feature 3D\nmixer OCTOX8"),
            Noted("may turn backwards in the stack"),
        ),
        (
            "Y4",
            dump("mmix 0 1 0 1 -1\nmmix 1 1 -1 -1 0\nmmix 2 1 0 1 1\nmmix 3 1 1 -1 0"),
            Refused("a Y4: rotors 1 and 3 are alone"),
        ),
        (
            "OCTOX8 reversed",
            dump("mixer octox8\nset yaw_motors_reversed = ON"),
            Noted("rear right: outputs 0 and 4 (upper ccw)"),
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
            Refused("`mmix 0 1 0 0` is not `mmix 0 THROTTLE"),
        ),
        (
            "a motor missing",
            octox8.replace("mmix 3", "mmix 9"),
            Refused("is not `mmix 3 THROTTLE ROLL PITCH YAW`, the next motor"),
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
    ];
    let options = Options {
        arm_m: Some(0.4),
        ..Options::default()
    };
    let wrong: Vec<String> = cases
        .iter()
        .filter_map(|(name, text, expected)| {
            Some(format!("{name}: {}", outcome(text, &options, expected).err()?))
        })
        .collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
    // What has no metres needs an arm.
    for text in [ardupilot(""), dump("mixer Y6")] {
        assert_eq!(
            outcome(&text, &Options::default(), &Refused("--arm METRES")),
            Ok(())
        );
    }
}
