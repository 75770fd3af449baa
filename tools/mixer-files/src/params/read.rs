//! What `import` reads of a vehicle, and what `params` makes of it: every parameter that is read is written as the airframe
//! file needs it now, or named as one that stays.

use crate::params::writer::Back;
use crate::stacks::stack::Stack;
use crate::stacks::writer;

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
    let all = Stack::ALL.into_iter().flat_map(|(stack, ..)| writer(stack).read);
    let mut found = all.filter(|(_, names)| names.iter().any(|pattern| is(pattern)));
    found.next().map(|(back, _)| *back)
}

/// The parameters of a stack that stay as they are.
pub(crate) fn stays(stack: Stack) -> String {
    let stay = writer(stack).read.iter().filter(|(back, _)| *back == Back::Stays);
    let names = stay.flat_map(|(_, names)| names.iter().copied());
    itertools::join(names, ", ")
        .replace('*', "PWM_MAIN")
        .replace('#', "n")
}

#[cfg(test)]
mod tests {
    use mixer_compiler::Source;

    use super::*;
    use crate::frame::{Frame, NewFrame};
    use crate::params::{Options, params};
    use Back::{Moot, Stays, ToldByImport, Written, WrittenOrNoted};

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
                for (back, names) in writer(stack).read {
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
