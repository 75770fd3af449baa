//! The tables of one airframe as a whole.

use crate::allocate::closed_form::{AllocationMethod, NoClosedForm};
use crate::allocate::priorities::Priorities;
use crate::conditions::Law;
use crate::pair::{Inverse, Kind, Pair, Quantity, SingleRotor, ThrottleRange};

/// One coaxial unit's share of M and M+.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// Rows of the pseudo-inverse M+ (2n x 4, eq. (8)): thrust in N and torque in N m of this unit
    /// per `[roll, pitch, yaw, thrust]` asked.
    pub allocation: [[f32; 4]; 2],
    /// Columns of the effectiveness M (4 x 2n, eq. (5)): `[roll, pitch, yaw, thrust]` per N of this
    /// unit's thrust and per N m of its torque.
    pub effectiveness: [[f32; 4]; 2],
    /// Channels of the upper and of the lower rotor; the lower one of a single rotor is [`NO_CHANNEL`].
    pub channels: [u8; 2],
}

/// The channel of a rotor that does not exist, beyond those of any frame.
pub const NO_CHANNEL: u8 = 255;

impl Unit {
    /// This unit's least-norm efforts `[f, Q]` for a wrench `[roll, pitch, yaw, thrust]`: two rows
    /// of M+ u.
    #[inline(always)]
    pub(crate) fn efforts(&self, wrench: &[f32; 4]) -> [f32; 2] {
        self.allocation.map(|[roll, pitch, yaw, thrust]| {
            (roll * wrench[0] + pitch * wrench[1]) + (yaw * wrench[2] + thrust * wrench[3])
        })
    }

    /// Adds what `efforts` `[f, Q]` give to a wrench `[roll, pitch, yaw, thrust]` times the
    /// correction's `factors`.
    #[inline(always)]
    pub(crate) fn add_wrench(&self, efforts: [f32; 2], factors: [f32; 2], wrench: &mut [f32; 4]) {
        for ((effect, factor), effort) in self.effectiveness.iter().zip(factors).zip(efforts) {
            let effort = factor * effort;
            for (wrench, effect) in wrench.iter_mut().zip(effect) {
                *wrench += effect * effort;
            }
        }
    }
}

/// Largest error of a request that is delivered. A larger one means that something was given up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Of one unit's efforts `[f, Q]` at the reference voltage, N and N m.
    pub efforts: [f32; 2],
    /// Of the wrench `[roll, pitch, yaw, thrust]`, N m and N: what those errors add up to, with rounding.
    pub wrench: [f32; 4],
}

/// All that the mixer of one airframe needs. `P` is the basis of the pair model, `I` the evaluator
/// of its inverse, `S` says whether there is a closed form: `&ClosedForm`, or [`NoClosedForm`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tables<'a, P, I, S = NoClosedForm> {
    /// The units, in the order of the airframe file.
    pub units: &'a [Unit],
    /// The forward map of every unit.
    pub pair: Pair<P>,
    /// Thrust and torque of the upper and of the lower rotor of a unit, the other one out.
    pub singles: [SingleRotor; 2],
    /// The inverse map of every unit.
    pub inverse: I,
    /// The allowed throttles.
    pub throttle: ThrottleRange,
    /// How thrust and torque follow the battery's voltage, V; without it they do not.
    pub voltage: Option<Law<'a>>,
    /// How they follow the air's density, kg/m3; without it they do not.
    pub air: Option<Law<'a>>,
    /// Factors from roll, pitch, yaw (N m) and thrust (N) to the rows of the interior point method:
    /// number of units over the vehicle's authority on the axis at the reference voltage; 0 on axes
    /// that the airframe does not serve.
    pub row_scale: [f32; 4],
    /// Means over the throttles of f_u^2 + f_l^2 (N^2) and of Q_u^2 + Q_l^2 (N^2 m^2).
    pub mean_square_slopes: [f32; 2],
    /// Least and largest thrust (N) that least norm delivers without torques, at the reference voltage.
    pub level_n: [f32; 2],
    /// True where thrusts give no yaw, and torques nothing else.
    pub is_vertical: bool,
    /// Priorities where a request is not attainable.
    pub priorities: Priorities,
    /// Least power: every unit's torque per thrust (N m per N at the reference voltage) while no
    /// unit is near its limits.
    pub power_bias_nm_per_n: f32,
    /// The closed form of allocation, used while all rotors turn.
    pub closed_form: S,
    /// Largest errors of the mixer.
    pub tolerance: Tolerance,
}

/// What a unit, by index, has of its own. Where all are alike, these fold to the tables' one map.
impl<P: Quantity, I: Inverse, S: AllocationMethod<P>> Tables<'_, P, I, S> {
    #[inline(always)]
    fn kind(&self, unit: usize) -> Option<&Kind<P, S::Inverse>> {
        let unlike = self.closed_form.unlike()?;
        unlike.kinds.get(usize::from(*unlike.of.get(unit)?))
    }

    /// The rows of a unit that is a single rotor.
    #[inline(always)]
    fn single_rotor(&self, unit: usize) -> Option<&[SingleRotor; 2]> {
        if !S::MAY_HAVE_SINGLE_ROTORS {
            return None;
        }
        let unlike = self.closed_form.unlike()?;
        let place = usize::from(*unlike.of.get(unit)?).checked_sub(unlike.kinds.len())?;
        self.closed_form.single_rotors().get(place)
    }

    /// Thrust and torque of a unit that is a single rotor, over its throttle; `None` of a pair.
    #[inline(always)]
    pub fn curve_of(&self, unit: usize) -> Option<&SingleRotor> {
        self.single_rotor(unit).map(|[curve, _]| curve)
    }

    /// The forward map of a unit.
    #[inline(always)]
    pub fn pair_of(&self, unit: usize) -> &Pair<P> {
        self.kind(unit).map_or(&self.pair, |kind| &kind.pair)
    }

    /// The rotors alone.
    #[inline(always)]
    pub(crate) fn singles_of(&self, unit: usize) -> &[SingleRotor; 2] {
        if let Some(rows) = self.single_rotor(unit) {
            return rows;
        }
        self.kind(unit).map_or(&self.singles, |kind| &kind.singles)
    }

    /// The mean squares of the slopes.
    #[inline(always)]
    pub(crate) fn slopes_of(&self, unit: usize) -> [f32; 2] {
        self.kind(unit)
            .map_or(self.mean_square_slopes, |kind| kind.mean_square_slopes)
    }

    /// Efforts of a unit all of whose rotors turn.
    #[inline(always)]
    pub fn efforts_of(&self, unit: usize, throttles: [f32; 2]) -> [f32; 2] {
        match self.curve_of(unit) {
            Some(curve) => curve.efforts(throttles[0]),
            None => self.pair_of(unit).efforts(throttles),
        }
    }

    /// Throttles for `efforts`, N and N m at the reference voltage. A single rotor has those of the thrust.
    #[inline(always)]
    pub fn throttles_of(&self, unit: usize, efforts: [f32; 2]) -> [f32; 2] {
        if let Some(curve) = self.curve_of(unit) {
            return [curve.throttle(&self.throttle, efforts[0]), 0.0];
        }
        match self.kind(unit) {
            None => self.inverse.throttles(&self.pair, &self.throttle, efforts),
            Some(kind) => kind.inverse.throttles(&kind.pair, &self.throttle, efforts),
        }
    }
}
