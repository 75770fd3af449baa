//! Allocation in closed form where all thrust axes are vertical and there are at
//! most four units.
//!
//! Roll, pitch and thrust then depend on the units' thrusts alone, w = C f with w = (roll, pitch,
//! thrust), and yaw on their torques alone, yaw = sum s_i Q_i with s_i = 1 or -1. So the order of
//! priority falls apart into small problems:
//!
//! ```text
//! 1. w within the zonotope of the thrusts in [a, b]^n                       closed_form/facets.rs
//! 2. f = C+ w + z N, N the null space of C, with z as near zero as can be   closed_form/thrusts.rs
//! 3. z towards where yaw reaches furthest, if it does not reach the request closed_form/extend_yaw.rs
//!    thrust given up for the reserve, all three for zero yaw                closed_form/keep_yaw.rs
//! 4. the torques within [Q_min(f), Q_max(f)]                                closed_form/torques.rs
//! ```
//!
//! Step 3 uses a coarse concave approximation of Q_max and -Q_min ([`Outline`]). All other steps
//! use a fine one that lies inside the attainable set ([`Border`]).
//!
//! Near a corner of the zonotope even zero yaw may be out of range: with all rotors at full
//! throttle every unit has the torque Q(1, 1). There the thrusts are drawn towards the middle of
//! the set until zero yaw is in range, which cuts thrust, roll and pitch together. For a reserve of
//! yaw they are drawn to a thrust with more room for it, which keeps roll and pitch.
//!
//! Every loop is over units, facets, or knots, or has a fixed number of steps. Where all of yaw
//! comes before thrust the problems cannot be separated, and the interior point method serves the airframe.

mod border;
mod extend_yaw;
mod facets;
mod keep_yaw;
mod thrusts;
mod torques;

pub use border::{Border, Cell, Grid, Knot, Outline};

use core::hint::black_box;

use crate::Wrench;
use crate::allocate::priorities::Airmode;
use crate::{larger, smaller};

/// The largest number of units.
const MOST_CLOSED_FORM_UNITS: usize = 4;

/// One unit's share of M and M+ where the axes are vertical.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosedFormUnit {
    /// Row of C+: this unit's thrust in N per `[roll, pitch, thrust]`.
    pub allocation: [f32; 3],
    /// Column of C but for thrust, which is 1: `[roll, pitch]` in N m per N of this unit's thrust.
    pub arms: [f32; 2],
    /// s: yaw per torque, 1 or -1.
    pub spin: f32,
    /// N, the thrusts that give neither roll nor pitch nor thrust; 0 where there are none.
    pub null: f32,
    /// 1 / N; 0 where N is.
    pub per_null: f32,
    /// The ends of the range of thrust, N: first the one at the least z, then the one at the
    /// largest, so descending where `null` is negative.
    pub ends: [f32; 2],
    /// Channels of the upper and of the lower rotor.
    pub channels: [u8; 2],
}

/// Two facets of the attainable (roll, pitch, thrust): `low <= roll d[0] + pitch d[1] + thrust <=
/// high` for a slope, without the thrust for a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facets {
    /// The normal's components along roll and pitch.
    pub normal: [f32; 2],
    /// `[low, high]`: N, or N m of a wall.
    pub bounds: [f32; 2],
}

/// Facets so steep that a little of roll and pitch is worth much thrust, beside their place among the slopes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steep {
    /// Among the slopes, too.
    pub facets: Facets,
    /// The ranges of thrust of the lower and of the upper one, N.
    pub thrusts_n: [[f32; 2]; 2],
}

/// What a frame with vertical axes and up to four units needs. All at the reference voltage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosedForm<'a> {
    /// The units, in the order of the airframe file.
    pub units: &'a [ClosedFormUnit],
    /// True where the airframe serves all axes: then an attainable request is what the efforts
    /// give.
    pub complete: bool,
    /// Least and largest thrust of a unit, N.
    pub thrust_n: [f32; 2],
    /// The attainable torques of a unit.
    pub border: Border<'a>,
    /// Facets of the attainable (roll, pitch, thrust) whose normals have the thrust component 1.
    pub slopes: &'a [Facets],
    /// Facets whose normals have no thrust component.
    pub walls: &'a [Facets],
    /// Slopes that are walls at the thrust asked.
    pub steep: &'a [Steep],
    /// Least-norm torque of a unit, N m per N m of yaw, but for its sign: 1 / n.
    pub torque_share: f32,
    /// Least thrust without torque, N.
    pub thrust_floor_n: f32,
    /// A thrust well inside the attainable set, N.
    pub thrust_middle_n: f32,
    /// Yaw that counts as none where the attainable torques shrink to a point, N m.
    pub yaw_rounding_nm: f32,
}

/// Whether an airframe's tables have a closed form of allocation, or the interior point method serves
/// what least norm cannot.
pub trait AllocationMethod {
    /// The closed form, where there is one.
    fn closed_form(&self) -> Option<&ClosedForm<'_>>;
}

/// No closed form: tilted axes, more than four units, unlike ones, or priorities that couple thrust and yaw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoClosedForm;

impl AllocationMethod for NoClosedForm {
    #[inline(always)]
    fn closed_form(&self) -> Option<&ClosedForm<'_>> {
        None
    }
}

/// By reference, so that an image whose rotors never fail holds this table and not the rest.
impl AllocationMethod for &ClosedForm<'_> {
    #[inline(always)]
    fn closed_form(&self) -> Option<&ClosedForm<'_>> {
        Some(self)
    }
}

/// Known at run time alone.
impl AllocationMethod for Option<ClosedForm<'_>> {
    fn closed_form(&self) -> Option<&ClosedForm<'_>> {
        self.as_ref()
    }
}

/// A request at the reference voltage.
#[derive(Clone, Copy)]
pub(crate) struct Asked {
    pub(crate) roll: f32,
    pub(crate) pitch: f32,
    pub(crate) yaw: f32,
    pub(crate) thrust: f32,
}

/// A unit's efforts at the reference voltage.
#[derive(Clone, Copy, Default)]
pub(crate) struct Effort {
    /// N.
    pub(crate) thrust: f32,
    /// N m.
    pub(crate) torque: f32,
}

/// The efforts of all units.
pub(crate) type Efforts = [Effort; MOST_CLOSED_FORM_UNITS];

/// Whether efforts are attainable.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Attained {
    Yes,
    /// They are nearer the border than the error of the tables: the inverse map decides.
    Perhaps,
    No,
}

/// A unit's thrust along a line of all units' thrusts, which runs through the null space or towards
/// the middle, by the coordinate z; and its yaw at one z.
#[derive(Clone, Copy, Default)]
struct ThrustLine {
    /// At z = 0, N.
    from: f32,
    /// N per unit of z.
    along: f32,
    /// Least and most yaw that the unit gives at the z looked at, N m.
    least: f32,
    most: f32,
}

impl ThrustLine {
    /// The thrust at `z`, N.
    #[inline(always)]
    fn thrust(&self, z: f32) -> f32 {
        self.from + z * self.along
    }
}

impl ClosedForm<'_> {
    /// Writes the least-norm efforts of `request`. Tells whether all are attainable, and the least
    /// distance of their torques from the sides, N m; negative beyond.
    #[inline(always)]
    pub(crate) fn least_norm(&self, request: &Asked, efforts: &mut Efforts) -> (Attained, f32) {
        let share = self.torque_share * request.yaw;
        let wrench = [request.roll, request.pitch, request.thrust];
        let (mut attained, mut room) = (Attained::Yes, f32::MAX);
        for (unit, effort) in self.units.iter().zip(efforts) {
            effort.thrust = unit.thrust(&wrench);
            effort.torque = unit.spin * share;
            let [middle, half] = self.border.torques(effort.thrust);
            let outside = (effort.torque - middle).abs() - half;
            if outside > self.border.lost_nm {
                return (Attained::No, -outside);
            }
            if outside > 0.0 {
                attained = Attained::Perhaps;
            }
            if -outside < room {
                room = -outside;
            }
        }
        (attained, room)
    }

    /// The wrench of attainable efforts at the voltage's `[k_f, k_Q]`.
    #[inline(always)]
    pub(crate) fn wrench(&self, efforts: &Efforts, [per_thrust, per_torque]: [f32; 2]) -> Wrench {
        let mut wrench = Wrench::default();
        for (unit, effort) in self.units.iter().zip(efforts) {
            wrench.roll_nm += unit.arms[0] * effort.thrust;
            wrench.pitch_nm += unit.arms[1] * effort.thrust;
            wrench.yaw_nm += unit.spin * effort.torque;
            wrench.thrust_n += effort.thrust;
        }
        Wrench {
            roll_nm: per_thrust * wrench.roll_nm,
            pitch_nm: per_thrust * wrench.pitch_nm,
            yaw_nm: per_torque * wrench.yaw_nm,
            thrust_n: per_thrust * wrench.thrust_n,
        }
    }

    /// Writes attainable efforts that serve `request` in the order of priority. With `KEEPS_YAW`
    /// the `reserve` of yaw, N m, comes before thrust: what that takes is left out of images without it.
    #[inline(never)]
    pub(crate) fn desaturate<const KEEPS_YAW: bool>(
        &self,
        airmode: Airmode,
        request: &Asked,
        reserve: f32,
        efforts: &mut Efforts,
    ) {
        // Hides the number of units, so that the compiler does not unroll the loops: see `rolled`.
        let mut lines = [ThrustLine::default(); MOST_CLOSED_FORM_UNITS];
        let lines = lines.get_mut(..self.units.len()).unwrap_or_default();
        let (closed_form, efforts, lines) = black_box((self, efforts.as_mut_slice(), lines));
        let limits = closed_form.thrust_limits(airmode, request.thrust);
        let found = closed_form.attainable_thrusts::<KEEPS_YAW>(request, reserve, limits, lines);
        closed_form.torques(lines, efforts, request.yaw, found);
    }

    /// The most thrust that may be given, and a thrust well inside below it, N.
    #[inline(always)]
    fn thrust_limits(&self, airmode: Airmode, asked: f32) -> [f32; 2] {
        let ceiling = match airmode {
            Airmode::Disabled => larger(asked, self.thrust_floor_n),
            _ => f32::MAX,
        };
        [ceiling, smaller(ceiling, self.thrust_middle_n)]
    }
}
