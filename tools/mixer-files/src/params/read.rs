//! What `import` reads of a vehicle, and what `params` makes of it: every parameter that is read is written as the airframe
//! file needs it now, or named as one that stays.

use crate::params::stack::Stack;

/// What becomes of parameters that are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Back {
    /// They are written.
    Written,
    /// They are written where the airframe file has what they need, and a note names them where it has not.
    WrittenOrNoted,
    /// They say nothing beside what is written.
    Moot,
    /// Of versions and vehicles that `params` does not write for: `import` says what to set there.
    ToldByImport,
    /// They describe what is on the vehicle, and no airframe file has it.
    Stays,
}
use Back::{Moot, Stays, ToldByImport, Written, WrittenOrNoted};

/// Parameters, `#` standing for a number, `*` for any beginning.
type Read = (Back, &'static [&'static str]);

#[rustfmt::skip]
const PX4: [Read; 4] = [
    (Written, &[
        "CA_AIRFRAME", "CA_ROTOR_COUNT", "CA_R_REV", "CA_ROTOR#_PX", "CA_ROTOR#_PY", "CA_ROTOR#_PZ", "CA_ROTOR#_AX", "CA_ROTOR#_AY",
        "CA_ROTOR#_AZ", "CA_ROTOR#_CT", "CA_ROTOR#_KM",
    ]),
    (WrittenOrNoted, &["PWM_MAIN_MIN#", "PWM_MAIN_MAX#", "PWM_AUX_MIN#", "PWM_AUX_MAX#"]),
    // Tilts, which a multirotor has none of; pulses before 1.13.
    (Moot, &["CA_ROTOR#_TILT", "PWM_MIN", "PWM_MAX", "PWM_MAIN_MIN", "PWM_MAIN_MAX", "PWM_AUX_MIN", "PWM_AUX_MAX"]),
    (Stays, &["*_FUNC#", "PWM_MAIN_TIM#", "PWM_AUX_TIM#", "BAT1_N_CELLS", "BAT1_V_EMPTY", "BAT1_V_CHARGED"]),
];

#[rustfmt::skip]
const ARDUPILOT: [Read; 4] = [
    (Written, &["FRAME_CLASS", "FRAME_TYPE", "MOT_SPIN_MIN", "MOT_SPIN_MAX"]),
    (WrittenOrNoted, &["MOT_PWM_MIN", "MOT_PWM_MAX", "MOT_BAT_VOLT_MAX", "MOT_BAT_VOLT_MIN"]),
    (ToldByImport, &[
        "Q_FRAME_CLASS", "Q_FRAME_TYPE", "Q_M_SPIN_MIN", "Q_M_SPIN_MAX", "Q_M_PWM_MIN", "Q_M_PWM_MAX", "Q_M_PWM_TYPE",
        "Q_M_BAT_VOLT_MAX", "Q_M_BAT_VOLT_MIN", "Q_TILT_ENABLE", "Q_TILT_MASK", "Q_TAILSIT_ENABLE",
    ]),
    (Stays, &["SERVO#_FUNCTION", "MOT_PWM_TYPE"]),
];

/// Words of Betaflight's and INAV's command line.
#[rustfmt::skip]
const BETAFLIGHT: [Read; 3] = [
    (Written, &["mixer", "mmix", "yaw_motors_reversed", "feature 3D"]),
    (ToldByImport, &["mixer_profile", "platform_type", "motor_direction_inverted", "yaw_motor_direction", "yaw_direction"]),
    (Stays, &["motor_output_reordering"]),
];

fn of(stack: Stack) -> &'static [Read] {
    match stack {
        Stack::Px4 => &PX4,
        Stack::Ardupilot => &ARDUPILOT,
        Stack::Betaflight => &BETAFLIGHT,
    }
}

/// What becomes of a parameter that `import` reads; `None` of one that no table has.
#[cfg(test)]
pub(crate) fn back(name: &str) -> Option<Back> {
    let mut numbered = String::new();
    for c in name.chars() {
        match c.is_ascii_digit() {
            false => numbered.push(c),
            true if numbered.ends_with('#') => {}
            true => numbered.push('#'),
        }
    }
    let is = |pattern: &str| match pattern.strip_prefix('*') {
        Some(end) => numbered.ends_with(end),
        None => pattern == name || pattern == numbered,
    };
    let all = Stack::ALL.into_iter().flat_map(|(stack, ..)| of(stack));
    let mut found = all.filter(|(_, names)| names.iter().any(|pattern| is(pattern)));
    found.next().map(|(back, _)| *back)
}

/// The parameters of a stack that stay as they are.
pub(crate) fn stays(stack: Stack) -> String {
    let stay = of(stack).iter().filter(|(back, _)| *back == Stays);
    let names: Vec<&str> = stay.flat_map(|(_, names)| names.iter().copied()).collect();
    names.join(", ").replace('*', "PWM_MAIN").replace('#', "n")
}

#[cfg(test)]
mod tests {
    use mixer_compiler::Source;

    use super::*;
    use crate::frame::{Frame, NewFrame};
    use crate::params::{Options, params};

    /// Of every stack's mixer and of this one: what a table says is written is there, and what stays is named.
    #[test]
    fn what_is_read_is_written_or_named() {
        for (stack, ..) in Stack::ALL {
            let frame = NewFrame {
                arm_m: Some(0.45),
                outputs: Some(stack),
                ..NewFrame::of(Frame::X8)
            };
            let text = crate::new::new(&frame, None).unwrap();
            let compiled = mixer_compiler::compile(&Source::new("a.toml", text)).unwrap();
            for own in [false, true] {
                let options = Options {
                    own,
                    ..Options::of(stack)
                };
                let made = params(&compiled, "a.toml", &options).unwrap();
                let lines = || made.text.lines().filter(|line| !line.starts_with('#'));
                for (back, names) in of(stack) {
                    for name in *names {
                        let name = name.replace('#', "0");
                        // `feature -3D` takes it away, the mixer's table has its `mmix`, the class has no types.
                        let name = match &*name {
                            "feature 3D" => "feature -3D",
                            "mmix" => continue,
                            "FRAME_TYPE" if !own => continue,
                            name => name,
                        };
                        let is_written = lines().any(|line| line.contains(name));
                        let in_words = name.replace('0', "n");
                        let is_noted = made.notes.iter().any(|note| note.contains(&in_words));
                        let is_so = match back {
                            Written => is_written,
                            WrittenOrNoted => is_written || is_noted,
                            Moot | ToldByImport => !is_written,
                            Stays => !is_written && (is_noted || name.starts_with('*')),
                        };
                        assert!(
                            is_so,
                            "{stack:?} {own} {name} {back:?} {:?}\n{}",
                            made.notes, made.text
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn names_are_found_by_their_numbers() {
        for (name, expected) in [
            ("CA_ROTOR11_PX", Some(Written)),
            ("BAT1_N_CELLS", Some(Stays)),
            ("BAT2_N_CELLS", None),
            ("UAVCAN_EC_FUNC3", Some(Stays)),
            ("SERVO12_FUNCTION", Some(Stays)),
            ("MOT_THST_EXPO", None),
        ] {
            assert_eq!(back(name), expected, "{name}");
        }
    }
}
