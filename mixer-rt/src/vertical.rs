//! Allocation and desaturation in closed form where all thrust axes are vertical and there are at most four units.
//!
//! Roll, pitch and thrust then depend on the units' thrusts alone, w = C f with w = (roll, pitch, thrust), and yaw
//! on their torques alone, yaw = sum s_i Q_i with s_i = 1 or -1. So the order of priority falls apart into small
//! problems:
//!
//! ```text
//! 1. w within the zonotope of the thrusts in [a, b]^n                          vertical/facets.rs
//! 2. f = C+ w + z N, N the null space of C, with z as near zero as can be      vertical/thrusts.rs
//! 3. z where yaw reaches furthest, if it does not reach the request            vertical/reach.rs, polyline.rs
//! 4. the torques within [Q_min(f), Q_max(f)]                                   vertical/torques.rs
//! ```
//!
//! Near a corner of the zonotope yaw may not even reach zero (with all rotors at the ceiling every unit has the
//! torque Q(1, 1)). There the thrusts are drawn towards the middle until it does: thrust, roll and pitch give way
//! together, by less than the corner's torque is worth.
//!
//! Where yaw comes before thrust, or a reserve of it before roll and pitch, the problems are not apart, and linear
//! programs take the place of 2 and 3: vertical/coupled.rs. An airframe's tables hold what these need or do not, and then
//! their code is not linked.

mod coupled;
mod facets;
mod polyline;
mod program;
mod reach;
mod thrusts;
mod torques;

pub use coupled::{Coupled, Coupling};
pub use facets::Facets;
pub use polyline::{Knot, Polyline};
pub use reach::{Arc, Border, Side, Steepness, TorqueLimit};

use core::hint::black_box;

use crate::{Airmode, Wrench};

/// The largest number of units.
const MOST_UNITS: usize = 4;

/// One unit's share of M and M+ where the axes are vertical.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VerticalUnit {
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
    /// The ends of the range of thrust, N: where the least and the largest multiple of N would lead.
    pub ends: [f32; 2],
    /// Output indices of the upper and of the lower rotor.
    pub channels: [u8; 2],
}

/// What a frame with vertical axes and up to four units needs. All at the reference voltage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertical<'a, S = Side> {
    /// The units, in the order of the airframe file.
    pub units: &'a [VerticalUnit],
    /// True where the airframe serves all axes: then an attainable request is what the efforts give.
    pub complete: bool,
    /// Least and largest thrust of a unit, N.
    pub thrust_n: [f32; 2],
    /// The attainable torques of a unit.
    pub border: Border<S>,
    /// Facets of the attainable (roll, pitch, thrust) whose normals have the thrust component 1.
    pub slopes: &'a [Facets],
    /// Facets whose normals have no thrust component.
    pub walls: &'a [Facets],
    /// Least-norm torque of a unit, N m per N m of yaw, but for its sign: 1 / n.
    pub torque_share: f32,
    /// Least thrust without torque, N.
    pub thrust_floor_n: f32,
    /// A thrust well inside the attainable set, N.
    pub thrust_middle_n: f32,
    /// Yaw that counts as none where the attainable torques shrink to a point, N m.
    pub yaw_rounding_nm: f32,
}

/// What an airframe's tables know about a shorter way than the homotopy.
pub trait Shortcut {
    /// What the sides of its attainable set are.
    type Side: TorqueLimit;

    /// The shorter way, where there is one.
    fn vertical(&self) -> Option<&Vertical<'_, Self::Side>>;

    /// What it needs where the priorities couple thrust and yaw.
    #[inline(always)]
    fn coupling(&self) -> Option<&Coupling> {
        None
    }
}

/// No shorter way: tilted axes or more than four units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoShortcut;

impl Shortcut for NoShortcut {
    type Side = Side;

    #[inline(always)]
    fn vertical(&self) -> Option<&Vertical<'_>> {
        None
    }
}

/// By reference, so that an image whose rotors never fail holds this table and not the rest.
impl<S: TorqueLimit> Shortcut for &Vertical<'_, S> {
    type Side = S;

    #[inline(always)]
    fn vertical(&self) -> Option<&Vertical<'_, S>> {
        Some(self)
    }
}

impl Shortcut for &Coupled<'_> {
    type Side = Side;

    #[inline(always)]
    fn vertical(&self) -> Option<&Vertical<'_>> {
        Some(&self.vertical)
    }

    #[inline(always)]
    fn coupling(&self) -> Option<&Coupling> {
        Some(&self.coupling)
    }
}

/// Any of these, where it is known at run time only.
impl<S: TorqueLimit> Shortcut for Option<(Vertical<'_, S>, Option<Coupling>)> {
    type Side = S;

    #[inline(always)]
    fn vertical(&self) -> Option<&Vertical<'_, S>> {
        self.as_ref().map(|(vertical, _)| vertical)
    }

    #[inline(always)]
    fn coupling(&self) -> Option<&Coupling> {
        self.as_ref().and_then(|(_, coupling)| coupling.as_ref())
    }
}

/// A request at the reference voltage.
#[derive(Clone, Copy)]
pub(crate) struct Request {
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
pub(crate) type Efforts = [Effort; MOST_UNITS];

/// What is kept of a unit while its efforts are being found.
struct Search<'a, S> {
    /// Yaw per torque in the direction looked at, 1 or -1.
    turn: f32,
    /// The side of the attainable set in that direction.
    side: &'a S,
    /// The largest torque in that direction, N m.
    limit: f32,
    /// A straight way of thrusts: where it starts, N, ..
    from: f32,
    /// .. and where to, N per unit of the way.
    along: f32,
}

impl<S> Clone for Search<'_, S> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<S> Copy for Search<'_, S> {}

impl<'a, S> Search<'a, S> {
    /// Before anything is known.
    #[inline(always)]
    fn new(border: &'a Border<S>) -> Self {
        Search {
            turn: 0.0,
            side: &border.sides[0],
            limit: 0.0,
            from: 0.0,
            along: 0.0,
        }
    }

    /// The thrust at `z` along the way, N.
    #[inline(always)]
    fn thrust(&self, z: f32) -> f32 {
        self.from + z * self.along
    }
}

impl<S: TorqueLimit> Vertical<'_, S> {
    /// Writes the least-norm efforts of `request`; true only where all are attainable.
    #[inline(always)]
    pub(crate) fn least_norm(&self, request: &Request, efforts: &mut Efforts) -> bool {
        let share = self.torque_share * request.yaw;
        let [along, against] = [share, -share].map(|q| self.border.thrusts_at(q));
        let wrench = [request.roll, request.pitch, request.thrust];
        let mut attainable = true;
        for (unit, effort) in self.units.iter().zip(efforts) {
            effort.thrust = unit.thrust(&wrench);
            effort.torque = unit.spin * share;
            let [least, most] = if unit.spin > 0.0 { along } else { against };
            attainable = attainable && effort.thrust >= least && effort.thrust <= most;
        }
        attainable
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

    /// Writes attainable efforts that serve `request` in the order of priority.
    #[inline(never)]
    pub(crate) fn desaturate(&self, airmode: Airmode, request: &Request, efforts: &mut Efforts) {
        // So that nothing is known about how often the loops run: see `rolled`.
        let mut search = [Search::new(&self.border); MOST_UNITS];
        let search = search.get_mut(..self.units.len()).unwrap_or_default();
        let (vertical, efforts, search) = black_box((self, efforts.as_mut_slice(), search));
        let direction = if request.yaw < 0.0 { -1.0 } else { 1.0 };
        let wanted = direction * request.yaw;
        let limits = vertical.thrust_limits(airmode, request.thrust, vertical.thrust_floor_n);
        let found = vertical.attainable_thrusts(request, limits, search, direction, wanted);
        let [_, middle] = limits;
        vertical.torques(search, efforts, wanted, found, middle);
    }

    /// The most thrust that may be given, and a thrust well inside below it, N.
    #[inline(always)]
    fn thrust_limits(&self, airmode: Airmode, asked: f32, floor: f32) -> [f32; 2] {
        let mut ceiling = f32::MAX;
        if airmode == Airmode::Disabled {
            ceiling = if asked > floor { asked } else { floor };
        }
        let middle = self.thrust_middle_n;
        [ceiling, if ceiling < middle { ceiling } else { middle }]
    }
}
