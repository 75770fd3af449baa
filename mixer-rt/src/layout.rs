//! The tables of one airframe as a whole.

use crate::allocate::closed_form::NoClosedForm;
use crate::allocate::priorities::Priorities;
use crate::conditions::Law;
use crate::pair::rotors::Rotors;
use crate::pair::{Expansion, Inverse, Kinds, PairKind, RotorAlone, ThrottleRange};

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
    /// Its kind: see [`Kinds`].
    pub kind: u8,
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

impl Tolerance {
    /// Whether a unit that gives these efforts serves those that are asked of it.
    #[inline(always)]
    pub(crate) fn allows(&self, given: [f32; 2], asked: [f32; 2]) -> bool {
        let [thrust, torque] = self.efforts;
        (given[0] - asked[0]).abs() <= thrust && (given[1] - asked[1]).abs() <= torque
    }
}

/// All that the mixer of one airframe needs. `K` is what its units give, `S` says whether there is a closed form:
/// `&ClosedForm`, or [`NoClosedForm`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tables<'a, K, S = NoClosedForm> {
    /// The units, in the order of the airframe file.
    pub units: &'a [Unit],
    /// What the units give.
    pub kinds: K,
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

/// What a unit, by index, gives. Where all are alike, these fold to the one kind.
impl<K: Kinds, S> Tables<'_, K, S> {
    #[inline(always)]
    fn kind(&self, unit: usize) -> u8 {
        self.units.get(unit).map_or(0, |unit| unit.kind)
    }

    /// The pair of a unit; `None` of a single rotor.
    #[inline(always)]
    pub(crate) fn pair_of(&self, unit: usize) -> Option<&PairKind<K::Quantity, K::Inverse>> {
        self.kinds.pair(self.kind(unit))
    }

    /// The upper (0) or the lower (1) rotor of a unit alone.
    #[inline(always)]
    pub(crate) fn alone(&self, unit: usize, side: usize) -> &RotorAlone {
        self.kinds.alone(self.kind(unit), side)
    }

    /// Whether a unit is a single rotor.
    #[inline(always)]
    pub(crate) fn is_single(&self, unit: usize) -> bool {
        K::MAY_BE_SINGLE && self.pair_of(unit).is_none()
    }

    /// Efforts `[f, Q]` of a unit at throttles `[u, l]`, N and N m at the reference voltage, where `rotors` turn.
    #[inline(always)]
    pub(crate) fn efforts(&self, unit: usize, rotors: Rotors, [u, l]: [f32; 2]) -> [f32; 2] {
        match rotors.turning() {
            [true, true] => self.pair_of(unit).map_or([0.0; 2], |of| of.pair.efforts([u, l])),
            [true, false] => self.alone(unit, 0).efforts(u),
            [false, true] => self.alone(unit, 1).efforts(l),
            [false, false] => [0.0; 2],
        }
    }

    /// The same with the derivatives by the throttles of those that turn.
    #[inline(always)]
    pub(crate) fn expansion(&self, unit: usize, rotors: Rotors, [u, l]: [f32; 2]) -> Expansion {
        let (side, throttle) = match rotors.turning() {
            [true, true] => {
                let pair = self.pair_of(unit);
                return pair.map_or(Expansion::NOTHING, |of| of.pair.expansion([u, l]));
            }
            [true, false] => (0, u),
            [false, true] => (1, l),
            [false, false] => return Expansion::NOTHING,
        };
        let [value, slope, curvature] = self.alone(unit, side).expansion(throttle);
        let mut expansion = Expansion {
            value,
            ..Expansion::NOTHING
        };
        (expansion.slopes[side], expansion.curvatures[side]) = (slope, curvature);
        expansion
    }

    /// Efforts `[f, Q]` of a unit all of whose rotors turn.
    #[inline(always)]
    pub fn efforts_of(&self, unit: usize, throttles: [f32; 2]) -> [f32; 2] {
        self.efforts(unit, Rotors::all(self.is_single(unit)), throttles)
    }

    /// Throttles for `efforts`, N and N m at the reference voltage. A single rotor has about those of the thrust.
    #[inline(always)]
    pub fn throttles_of(&self, unit: usize, efforts: [f32; 2]) -> [f32; 2] {
        match self.pair_of(unit) {
            Some(of) => of.inverse.throttles(&of.pair, &self.throttle, efforts),
            None => [self.alone(unit, 0).throttle(&self.throttle, efforts[0]), 0.0],
        }
    }
}
