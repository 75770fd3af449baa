//! Regular frames, written as the rest of an airframe file: name, `[layout]`, and what else there
//! is to fill in.

use std::fmt::Write as _;

use mixer_compiler::Source;
use mixer_compiler::airframe::{Spin, name_of_file};
use mixer_facts::hover;
use mixer_identify::air::Air;

use crate::schema::DIRECTIVE;
use crate::stacks::stack::Stack;

/// A frame of coaxial pairs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// Four pairs in an X.
    X8,
    /// Three pairs, two in front.
    Y6,
    /// Six pairs, two in front.
    X12,
    /// Two pairs abreast; pitch is left to servos or a tail.
    Bicopter,
    /// One pair on a stand.
    Single,
}

impl Frame {
    /// All in their order, each with its word on the command line and what it is.
    #[rustfmt::skip]
    pub const ALL: [(Frame, &'static str, &'static str); 5] = [
        (Frame::X8, "x8", "Four pairs in an X"),
        (Frame::Y6, "y6", "Three pairs, two in front"),
        (Frame::X12, "x12", "Six pairs, two in front"),
        (Frame::Bicopter, "bicopter", "Two pairs abreast; pitch is left to servos or a tail"),
        (Frame::Single, "single", "One pair on a stand"),
    ];

    /// Outputs of the upper and of the lower rotor of each unit, clockwise from the first, in a
    /// stack's motor order, and how the first upper rotor turns there: PX4's geometries octa_cox,
    /// hexa_cox, dodeca_top_cox and dodeca_bottom_cox; ArduPilot's octaquad X, Y6B and dodecahexa X;
    /// Betaflight's OCTOX8, and the places of its Y6.
    fn outputs(self, stack: Stack) -> Option<(Vec<[usize; 2]>, Spin)> {
        let pairs = |n: usize| (0..n).map(|k| [2 * k, 2 * k + 1]).collect();
        match (self, stack) {
            (Frame::X8, Stack::Betaflight) => Some((vec![[1, 5], [0, 4], [2, 6], [3, 7]], Spin::Ccw)),
            (Frame::Y6, Stack::Betaflight) => Some((vec![[1, 4], [0, 3], [2, 5]], Spin::Cw)),
            (Frame::X8, _) => Some((vec![[0, 5], [3, 6], [2, 7], [1, 4]], Spin::Ccw)),
            (Frame::Y6, _) => Some((pairs(3), Spin::Cw)),
            (Frame::X12, Stack::Ardupilot) => Some((pairs(6), Spin::Ccw)),
            (Frame::X12, Stack::Px4) => Some((
                [4, 0, 3, 5, 1, 2].into_iter().map(|top| [top, top + 6]).collect(),
                Spin::Ccw,
            )),
            (Frame::X12, Stack::Betaflight) | (Frame::Bicopter | Frame::Single, _) => None,
        }
    }
}

/// A regular frame to write an airframe file of.
#[derive(Clone, Debug)]
pub struct NewFrame<'a> {
    /// The frame.
    pub frame: Frame,
    /// Distance of every pair from the centre of gravity, m; not for a single pair.
    pub arm_m: Option<f64>,
    /// Name of the airframe; without it that of the file, else that of the frame.
    pub name: Option<&'a str>,
    /// Name of the file that it will be, without folder and ending.
    pub file: Option<&'a str>,
    /// The stack in whose motor order the outputs are; else the upper rotors first, clockwise.
    pub outputs: Option<Stack>,
    /// The pair's name of every unit, where they differ.
    pub pairs: Vec<String>,
}

impl NewFrame<'_> {
    /// A frame of which nothing else is known.
    pub fn of(frame: Frame) -> Self {
        NewFrame {
            frame,
            arm_m: None,
            name: None,
            file: None,
            outputs: None,
            pairs: Vec::new(),
        }
    }

    /// Where each unit is, degrees clockwise from the nose.
    pub fn angles_deg(&self) -> Vec<f64> {
        let Shape {
            units,
            first_angle_deg,
            ..
        } = self.frame.shape();
        (0..units)
            .map(|k| first_angle_deg + 360.0 * k as f64 / units as f64)
            .collect()
    }
}

/// Where the first pair is, how many there are, and what they serve.
struct Shape {
    units: usize,
    first_angle_deg: f64,
    first: &'static str,
    /// Whether half of the upper rotors turn each way, so that they can cancel torques.
    alternates: bool,
    description: &'static str,
    /// A line on the axes that are served; empty where all are.
    axes: &'static str,
}

impl Frame {
    #[rustfmt::skip]
    fn shape(self) -> Shape {
        let (units, first_angle_deg, first, alternates, description, axes) = match self {
            Frame::X8 => (4, 45.0, "front right", true, "X8: four coaxial pairs", ""),
            Frame::Y6 => (3, 60.0, "front right", false, "Y6: three coaxial pairs", ""),
            Frame::X12 => (6, 30.0, "front right", true, "X12: six coaxial pairs", ""),
            Frame::Bicopter => (
                2, 90.0, "right", true, "Two coaxial pairs abreast, pitch left to servos or a tail",
                "axes = [\"roll\", \"yaw\", \"thrust\"]  # two units have no lever arm in pitch\n",
            ),
            Frame::Single => (
                1, 0.0, "", false, "One coaxial pair on a stand",
                "axes = [\"yaw\", \"thrust\"]          # one unit has no lever arms\n",
            ),
        };
        Shape { units, first_angle_deg, first, alternates, description, axes }
    }
}

/// The lines of the yaw reserve at the end of `[allocation]`, where the airframe so far compiles
/// and has yaw to keep.
fn yaw_reserve(text: &str) -> String {
    let compiled = mixer_compiler::compile(&Source::new("new.toml", text));
    let Some(reserve) = compiled.ok().as_ref().and_then(hover::yaw_reserve) else {
        return String::new();
    };
    let line = format!("yaw_reserve_nm = {}", rounded(reserve));
    let indent = " ".repeat(38);
    format!(
        "{line:<38} # a fifth of the yaw at half of full thrust, kept up to full thrust:\n\
         {indent} # when yaw is asked there, thrust yields for it; roll and pitch do not\n"
    )
}

/// With two digits.
fn rounded(value: f64) -> String {
    let digits = (1.0 - value.log10().floor()).max(0.0) as usize;
    format!("{value:.digits$}")
}

impl NewFrame<'_> {
    /// A whole airframe file around `tables`, which are `[throttle]`, `[pair]` and, if there is
    /// one, `[voltage]`. `power_bias` is the torque of least power, N m per N, if it is known; it
    /// stands in a comment where the frame gains by it, as one rotor of a unit then carries more and its stop costs more.
    ///
    /// # Errors
    /// An arm that is missing, or one too many.
    pub fn airframe(&self, tables: &str, power_bias: Option<f64>) -> Result<String, String> {
        let Shape {
            description,
            axes,
            alternates,
            ..
        } = self.frame.shape();
        let mut text = format!(
            "{DIRECTIVE}\nname = \"{}\"\ndescription = \"{description}\"\n\n",
            self.name()
        );
        text.push_str(tables.trim());
        if !tables.contains("[air]") {
            text += "\n";
            text += Air::default().table(tables.contains("\n[voltage]")).trim_end();
        }
        text.push_str("\n\n");
        text.push_str(&self.layout()?);
        let _ = write!(
            text,
            "\n# [vehicle]                            # then `check` says the throttles in hover and what is left there\n\
             # mass_kg = 3.2                        # take-off mass, battery and payload included\n\
             \n[inverse]                              # what one unit may miss, at any voltage\n\
             thrust_tolerance_n = 0.01\n\
             torque_tolerance_nm = 1e-4\n\
             \n[allocation]\n"
        );
        text.push_str(match self.outputs {
            Some(Stack::Ardupilot | Stack::Betaflight) => {
                "airmode = \"roll-pitch\"                 # the stack asks for roll and pitch at any throttle\n"
            }
            _ => "airmode = \"disabled\"                   # or \"roll-pitch\": the thrust may rise for roll and pitch; PX4's words\n",
        });
        text += axes;
        if let Some(bias) = power_bias {
            let line = format!("# power_bias_nm_per_n = {bias:?}");
            text += &match alternates {
                true => {
                    format!("{line:<38} # least power, if wanted: one rotor of a unit then carries more, and its stop costs more; `check` says both\n")
                }
                false => {
                    "# no power_bias_nm_per_n: it saves nothing where no upper rotors turn against each other\n"
                        .to_owned()
                }
            };
        }
        text.push_str(&yaw_reserve(&text));
        Ok(text)
    }

    /// The name that is given, or that of the file, or that of the frame.
    fn name(&self) -> String {
        if let Some(name) = self.name.map(str::to_owned).or(self.file.map(name_of_file)) {
            return name;
        }
        let (_, word, _) = Frame::ALL[self.frame as usize];
        format!("my-{word}")
    }

    /// `[layout]`, of a single pair its `[[unit]]`.
    fn layout(&self) -> Result<String, String> {
        let Shape {
            units,
            first_angle_deg,
            first,
            alternates,
            ..
        } = self.frame.shape();
        let arm = match (units, self.arm_m) {
            (1, Some(_)) => return Err("--arm: a single pair has none".to_owned()),
            (1, None) if self.outputs.is_some() => {
                return Err("--outputs: no flight stack has a frame of one pair".to_owned());
            }
            (1, None) => {
                return Ok("[[unit]]\n\
                           position_m = [0.0, 0.0, 0.0]           # forward, right, down from the centre of gravity\n\
                           upper_spin = \"cw\"                      # seen from above\n\
                           channels = [0, 1]                      # outputs of the upper and of the lower rotor\n"
                    .to_owned());
            }
            (_, None) => {
                let missing = "--arm METRE is missing: the distance of every pair from the centre of gravity";
                return Err(missing.to_owned());
            }
            (_, Some(arm)) => arm,
        };
        let mut order = String::new();
        let (channels, spin) = match self.outputs {
            None => ((0..units).map(|k| [k, units + k]).collect(), Spin::Cw),
            Some(stack) => {
                let name = stack.name();
                order = format!(", in {name}'s motor order");
                let outputs = self.frame.outputs(stack);
                outputs.ok_or_else(|| format!("--outputs: {name} has no such frame of coaxial pairs"))?
            }
        };
        let spins = ["all turn alike", "they alternate"][usize::from(alternates)];
        let mut text =
            String::from("# The units in a circle, clockwise from the first as seen from above.\n[layout]\n");
        for (value, comment) in [
            (
                // To a micrometre: without the digits of a script's arithmetic.
                format!("arm_m = {:?}", (arm * 1e6).round() / 1e6),
                "from the centre of gravity to each mast",
            ),
            (format!("units = {units}"), "pairs of rotors"),
            (
                format!("first_angle_deg = {first_angle_deg:?}"),
                &format!("of the first unit, clockwise from the nose: {first}"),
            ),
            (
                format!("first_spin = \"{}\"", spin.name()),
                &format!("of the first unit's upper rotor, seen from above; {spins}"),
            ),
        ] {
            let _ = writeln!(text, "{value:<38} # {comment}");
        }
        let _ = writeln!(
            text,
            "channels = {channels:?}\n{:<38} # outputs of the upper and of the lower rotor of each{order}",
            ""
        );
        if !self.pairs.is_empty() {
            let _ = writeln!(
                text,
                "pairs = {:?}\n{:<38} # the name of each unit's pair, in the same order: check it",
                self.pairs, ""
            );
        }
        Ok(text)
    }
}
