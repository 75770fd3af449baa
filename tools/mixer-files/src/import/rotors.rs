//! Rotors and units as a flight stack's files say them.

use mixer_compiler::airframe::Spin;

/// The axis of a rotor that is not tilted.
pub(super) const UPWARD: [f64; 3] = [0.0, 0.0, -1.0];

/// A rotor of a flight stack.
#[derive(Clone, Debug, PartialEq)]
pub struct Rotor {
    /// Output, from 0.
    pub channel: usize,
    /// Where it is said: `file:line`.
    pub(super) place: String,
    /// Forward, right, down, m.
    pub position_m: [f64; 3],
    /// Direction of the thrust, a unit vector.
    pub axis: [f64; 3],
    /// Seen from above.
    pub spin: Spin,
    /// What the stack has of it and the mixer does not use.
    pub(super) own: Own,
}

/// Settings of single rotors: the mixer has one pair for all units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Own {
    /// Thrust per command, of any unit: PX4's `CA_ROTORn_CT`, the throttle factor of a `mmix`. 0 leaves a rotor out.
    pub(super) thrust: f64,
    /// Yaw per command or per thrust, without its sign: `CA_ROTORn_KM`, the yaw factor of a `mmix`.
    pub(super) yaw: f64,
    /// Pulse widths of throttle 0 and 1, us, where the rotor has its own.
    pub(super) pulses_us: Option<[f64; 2]>,
    /// Whether it turns both ways.
    pub(super) is_reversible: bool,
}

impl Own {
    /// Of a stack that has none of it.
    pub(super) const NONE: Own = Own {
        thrust: 1.0,
        yaw: 1.0,
        pulses_us: None,
        is_reversible: false,
    };
}

/// A motor that is no rotor of a pair.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LeftOut {
    /// Its number in the stack, from 0.
    pub(super) channel: usize,
    /// Where it is said: `file:line`.
    pub(super) place: String,
    /// `is missing`.
    pub(super) why: &'static str,
}

/// Two rotors in one place.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Unit {
    pub(super) position_m: [f64; 3],
    pub(super) axis: [f64; 3],
    pub(super) upper_spin: Spin,
    /// Of the upper and of the lower rotor.
    pub(super) channels: [usize; 2],
}

/// Pulse widths of throttle 0 and 1.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Pulses {
    /// Microseconds.
    pub(super) us: [f64; 2],
    /// What the file says of them: `MOT_PWM_MAX is 1940`.
    pub(super) said: Vec<String>,
}

/// Rotors and settings of a flight stack's files.
#[derive(Clone, Debug, Default)]
pub(super) struct Imported {
    /// The stack and the frame, for people.
    pub(super) origin: String,
    pub(super) rotors: Vec<Rotor>,
    /// The other motors of the stack.
    pub(super) left_out: Vec<LeftOut>,
    /// What makes the rotors the stack's first motors.
    pub(super) first_motors: &'static str,
    /// Least and largest throttle, with the names of what says them.
    pub(super) throttle: Option<([f64; 2], [String; 2])>,
    /// What the motors' outputs send.
    pub(super) pulses: Option<Pulses>,
    /// The battery's range, V.
    pub(super) range_v: Option<[f64; 2]>,
    /// The airmode with which the stack's controllers work, and why.
    pub(super) airmode: Option<(&'static str, &'static str)>,
    /// Assumptions, and settings that the files lack.
    pub(super) notes: Vec<String>,
}

impl Imported {
    /// Notes on the motors that are no rotors.
    ///
    /// # Errors
    /// One that has rotors behind it: those would get other outputs.
    pub(super) fn without_gap(&self) -> Result<Vec<String>, String> {
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
