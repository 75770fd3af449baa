//! What is counted: mixers of airframes.

use crate::firmware::Variant;

/// [`Subject::mixer`] that is called from C.
pub(super) const C_INTERFACE: &str = "c-interface";
/// [`Subject::mixer`] with rotors under way.
const DYNAMIC: &str = "dynamic";
/// [`Subject::mixer`] with rotors out.
const ONE_OUT: &str = "one-rotor-out";
const TWO_OUT: &str = "two-rotors-out";

/// A mixer of an airframe.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Subject {
    /// `coaxial`; the same as a library for C: `c-interface`; with rotors under way: `dynamic`; with one or two rotors out, at random
    /// channels: `one-rotor-out`, `two-rotors-out`; or a baseline: `conventional`, `sequential`,
    /// `wls`.
    pub mixer: String,
    /// A file of `airframes/`, or one of `tests/src/frames/counted.rs`.
    pub airframe: String,
}

impl Subject {
    pub(super) fn new(mixer: &str, airframe: &str) -> Self {
        Subject {
            mixer: mixer.to_owned(),
            airframe: airframe.to_owned(),
        }
    }

    /// How many rotors are out.
    pub fn rotors_out(&self) -> u32 {
        match self.mixer.as_str() {
            ONE_OUT => 1,
            TWO_OUT => 2,
            _ => 0,
        }
    }

    /// True for this project's mixer, called from Rust.
    pub fn is_ours(&self) -> bool {
        self.mixer == "coaxial" || self.rotors_out() > 0
    }

    pub(super) fn variant(&self) -> Variant {
        let rotors_out = self.rotors_out();
        let mut variant = Variant::of_airframe(&self.airframe, rotors_out);
        if rotors_out == 0 && self.mixer != "coaxial" {
            variant
                .cfgs
                .extend(["baseline".into(), format!("baseline={:?}", self.mixer)]);
        }
        if self.mixer == "wls" {
            variant.features.push("wls-alloc");
        }
        variant
    }
}

/// The subjects that every run of the tests compares: all airframes, and on the X8 the mixers of
/// isolated rotors, one rotor out, the library for C, and rotors under way.
pub fn compared(airframes: &[String]) -> Vec<Subject> {
    let airframes = airframes.iter().map(|airframe| Subject::new("coaxial", airframe));
    let others = ["conventional", "sequential", ONE_OUT, C_INTERFACE, DYNAMIC]
        .map(|mixer| Subject::new(mixer, "isae-x8"));
    airframes.chain(others).collect()
}

/// Pairs of real rotors that are counted with rotors out, on an X8 and on a Y6: one of each bench
/// map.
const REAL: [&str; 3] = ["11in-cubic", "16in-quartic", "22in-cubic"];

/// All subjects: those compared, two rotors out, the baselines and rotors out on other frames,
/// regular frames of 1 to 8 units, the X8 with five tolerances, the X8 and the X12 with other
/// priorities, an X8 whose spins do not alternate, a Y6 and an X8 whose attainable sets are not
/// convex, and Y6s with the pairs of the X8s.
pub fn all(airframes: &[String]) -> Vec<Subject> {
    let mut subjects = compared(airframes);
    subjects.push(Subject::new("wls", "isae-x8"));
    for airframe in ["px4-y6", "px4-x12"] {
        subjects.extend(
            ["conventional", "sequential", "wls", DYNAMIC].map(|mixer| Subject::new(mixer, airframe)),
        );
    }
    subjects.push(Subject::new(TWO_OUT, "isae-x8"));
    for airframe in ["px4-y6", "px4-x12", "regular-8", "tilted-6", "tilted-8"] {
        subjects.extend([ONE_OUT, TWO_OUT].map(|mixer| Subject::new(mixer, airframe)));
    }
    for airframe in REAL
        .iter()
        .flat_map(|pair| [format!("x8-{pair}"), format!("y6-{pair}")])
    {
        subjects.extend([ONE_OUT, TWO_OUT].map(|mixer| Subject::new(mixer, &airframe)));
    }
    subjects.extend((1..=8).map(|units| Subject::new("coaxial", &format!("regular-{units}"))));
    let tolerances = ["0.1", "0.01", "0.004", "2e-4", "5e-5"];
    subjects.extend(tolerances.map(|tolerance| Subject::new("coaxial", &format!("tolerance-{tolerance}"))));
    let priorities = ["roll-pitch-yaw", "reserve-0.1", "roll-pitch-yaw-reserve-0.1"];
    let six = ["regular-6-roll-pitch-yaw", "regular-6-reserve-0.15"];
    let others = priorities
        .into_iter()
        .chain(six)
        .chain(["regular-4-like-spins"])
        .chain(["bent-3", "bent-4", "tilted-4", "tilted-6", "tilted-8"]);
    subjects.extend(others.map(|airframe| Subject::new("coaxial", airframe)));
    let pairs = airframes.iter().filter_map(|name| name.strip_prefix("x8-"));
    subjects.extend(pairs.map(|pair| Subject::new("coaxial", &format!("y6-{pair}"))));
    subjects
}
