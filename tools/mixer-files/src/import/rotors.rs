//! Rotors and units as a flight stack's files say them.

use mixer_compiler::airframe::Spin;

/// The axis of a rotor that is not tilted.
pub(crate) const UPWARD: [f64; 3] = [0.0, 0.0, -1.0];

/// A rotor of a flight stack.
#[derive(Clone, Debug, PartialEq)]
pub struct Rotor {
    /// Output, from 0.
    pub channel: usize,
    /// Where it is said: `file:line`.
    pub(crate) place: String,
    /// Forward, right, down, m.
    pub position_m: [f64; 3],
    /// Direction of the thrust, a unit vector.
    pub axis: [f64; 3],
    /// Seen from above.
    pub spin: Spin,
    /// What the stack has of it and the mixer does not use.
    pub(crate) own: Own,
}

/// What a flight stack's parameters state of the vehicle that has them.
#[derive(Clone, Debug)]
pub struct Stated {
    /// The rotors; places of ArduPilot's are those of arms of 1 m. `None` with the frame class of
    /// this mixer, whose motors are those of the airframe that it was compiled of.
    pub rotors: Option<Vec<Rotor>>,
    /// Pins of ArduPilot's board, from 1, each with the motor, from 0, that it drives.
    pub pins: Vec<(usize, usize)>,
    /// Pulse widths of throttle 0 and 1, microseconds; DShot has none.
    pub pulses_us: Option<[f64; 2]>,
    /// Whether the motors are driven by DShot.
    pub is_dshot: bool,
}

/// Settings of one rotor: the file has one pair for all units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Own {
    /// Thrust per command, of any unit: PX4's `CA_ROTORn_CT`, the throttle factor of a `mmix`. 0 leaves a rotor out.
    pub(crate) thrust: f64,
    /// Yaw per command or per thrust, without its sign: `CA_ROTORn_KM`, the yaw factor of a `mmix`.
    pub(crate) yaw: f64,
    /// Pulse widths of throttle 0 and 1, us, where the rotor has its own.
    pub(crate) pulses_us: Option<[f64; 2]>,
    /// Whether it turns both ways.
    pub(crate) is_reversible: bool,
}

impl Own {
    /// Of a stack that has none of it.
    pub(crate) const NONE: Own = Own {
        thrust: 1.0,
        yaw: 1.0,
        pulses_us: None,
        is_reversible: false,
    };
}

/// A motor that is no rotor.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LeftOut {
    /// Its number in the stack, from 0.
    pub(crate) channel: usize,
    /// Where it is said: `file:line`.
    pub(crate) place: String,
    /// `is missing`.
    pub(crate) why: &'static str,
}

/// Two rotors in one place, or a single one.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Unit {
    pub(crate) position_m: [f64; 3],
    pub(crate) axis: [f64; 3],
    pub(crate) upper_spin: Spin,
    /// Of the upper rotor, and of the lower one where there is one.
    pub(crate) channels: (usize, Option<usize>),
}

/// Pulse widths of throttle 0 and 1.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Pulses {
    /// Microseconds.
    pub(crate) us: [f64; 2],
    /// What the file says of them: `MOT_PWM_MAX is 1940`.
    pub(crate) said: Vec<String>,
}

/// Rotors and settings of a flight stack's files.
#[derive(Clone, Debug, Default)]
pub(crate) struct Imported {
    /// The stack and the frame, for people.
    pub(crate) origin: String,
    pub(crate) rotors: Vec<Rotor>,
    /// Whether the file has the place of each rotor, so that no arm counts.
    pub(crate) has_places: bool,
    /// The other motors of the stack.
    pub(crate) left_out: Vec<LeftOut>,
    /// What makes the rotors the stack's first motors.
    pub(crate) first_motors: &'static str,
    /// Least and largest throttle, with the names of what says them.
    pub(crate) throttle: Option<([f64; 2], [String; 2])>,
    /// What the motors' outputs send.
    pub(crate) pulses: Option<Pulses>,
    /// The battery's range, V.
    pub(crate) range_v: Option<[f64; 2]>,
    /// The airmode with which the stack's controllers work, and why.
    pub(crate) airmode: Option<(&'static str, &'static str)>,
    /// What the vehicle may differ in from the airframe file.
    pub(crate) warnings: Vec<String>,
    /// Assumptions, and settings that the files lack.
    pub(crate) notes: Vec<String>,
}

impl Imported {
    /// Notes on the motors that are no rotors.
    ///
    /// # Errors
    /// One that has rotors behind it: those would get other outputs.
    pub(crate) fn without_gap(&self) -> Result<Vec<String>, String> {
        let told = self.left_out.iter().map(|LeftOut { channel, place, why }| {
            match self.rotors.iter().find(|rotor| rotor.channel > *channel) {
                Some(rotor) => Err(format!(
                    "{place}: motor {channel} {why}, and motor {} behind it is a rotor: the channels of an airframe are the motors \
                     from 0 on without a gap; {}",
                    rotor.channel, self.first_motors
                )),
                None => Ok(format!("motor {channel} {why}: it is left out, and its output stays the stack's")),
            }
        });
        told.collect()
    }
}
