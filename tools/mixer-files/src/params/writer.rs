//! How the parameters of a stack are written: what each folder of `stacks` gives.

use mixer_compiler::Compiled;
use mixer_rt::Wrench;

use crate::params::parameter::{Parameter, Parameters};
use crate::stacks::stack::Stack;

/// Which parameters, and in which form.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// The flight stack.
    pub stack: Stack,
    /// The form of the file.
    pub format: Format,
    /// Whether they are for the stack's own mixer instead of this one.
    pub own: bool,
    /// Pulse widths of throttle 0 and 1 on the bench, microseconds; without them those that the
    /// airframe remembers.
    pub pulses_us: Option<[f64; 2]>,
    /// Whose names of settings and whose curve are Betaflight's.
    pub betaflight: Betaflight,
}

impl Options {
    /// For this mixer, as a ground station loads them, without pulse widths.
    pub fn of(stack: Stack) -> Self {
        Options {
            stack,
            format: Format::GroundStation,
            own: false,
            pulses_us: None,
            betaflight: Betaflight::V2026_6,
        }
    }
}

/// A version of Betaflight, up to the next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Betaflight {
    /// 4.5.
    V4_5,
    /// 2025.12, which renamed settings.
    V2025_12,
    /// 2026.6, which changed the curve of `thrust_linear`.
    V2026_6,
}

impl Betaflight {
    /// All, each with its word on the command line and what it is.
    #[rustfmt::skip]
    pub const ALL: [(Betaflight, &'static str, &'static str); 3] = [
        (Betaflight::V4_5, "4.5", "`dshot_idle_value`, `gps_rescue_throttle_hover`"),
        (Betaflight::V2025_12, "2025.12", "`motor_idle`, `ap_hover_throttle`"),
        (Betaflight::V2026_6, "2026.6", "the same, another curve of `thrust_linear`"),
    ];

    /// The setting of the idle.
    pub(crate) fn idle(self) -> &'static str {
        match self {
            Betaflight::V4_5 => "dshot_idle_value",
            _ => "motor_idle",
        }
    }

    /// The setting of the throttle in hover.
    pub(crate) fn hover(self) -> &'static str {
        match self {
            Betaflight::V4_5 => "gps_rescue_throttle_hover",
            _ => "ap_hover_throttle",
        }
    }
}

/// The form of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// For a ground station: QGroundControl's .params, ArduPilot's .parm, lines of Betaflight's CLI.
    GroundStation,
    /// A start script of PX4's simulator.
    Simulator,
}

impl Format {
    /// All, each with its word on the command line and what it is.
    #[rustfmt::skip]
    pub const ALL: [(Format, &'static str, &'static str); 2] = [
        (Format::GroundStation, "parameters", "A file for a ground station: QGroundControl's .params, ArduPilot's .parm, lines of Betaflight's CLI"),
        (Format::Simulator, "airframe", "A start script of PX4's simulator"),
    ];
}

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

/// Parameters, `#` standing for a number, `*` for any beginning.
pub(crate) type Read = (Back, &'static [&'static str]);

/// How the parameters of a stack are written.
pub(crate) struct Writer {
    /// The rotors.
    ///
    /// # Errors
    /// More rotors than the stack has parameters for.
    pub geometry: fn(&Compiled, &Options, &mut Parameters) -> Result<(), String>,
    /// What else this mixer needs.
    pub settings: fn(&Compiled, &Options, &mut Parameters),
    /// What else the stack's own mixer needs.
    pub own: fn(&Compiled, &Options, &mut Parameters),
    /// Pulse widths of throttle 0 and 1, microseconds.
    pub pulses: fn(&Compiled, [f64; 2], &mut Parameters),
    /// The names of those.
    pub pulse_names: &'static str,
    /// What stands before and behind the lines.
    pub frame: [&'static str; 2],
    /// A line.
    pub line: fn(&Parameter) -> String,
    /// What the stack's unit is of, and its wrench.
    pub unit: (&'static str, fn(&Compiled) -> Wrench),
    /// What becomes of the parameters that `import` reads.
    pub read: &'static [Read],
}
