//! Desaturation: what is given up when the least-norm efforts are not attainable, in this order.
//!
//! ```text
//! 1. roll and pitch      the largest rho in [0, 1] such that rho (roll, pitch) is attainable
//! 2. thrust, then yaw    each the attainable value nearest the request
//!    (airmode roll-pitch-yaw: yaw, then thrust)
//! ```
//!
//! Throughout, yaw stays between the reserve and the request, so it is never reversed or exceeded, and with
//! airmode disabled the thrust stays below the request, or below the least thrust that the rotors at idle and
//! the yaw allow.
//!
//! Where the least-norm efforts, each limited to the attainable set, miss the request by little, a path straight from
//! there to the request comes first: most attainable requests are a few pieces away. It ends in the same efforts as the
//! steps do, so nothing jumps where it is or is not tried.
//!
//! What is delivered in full near the end of what is attainable is eased into what is given up there ([`Homotopy::ease`]).
//!
//! Each step is a straight path in the space of wrenches that [`Homotopy`] follows to its exact end. The result
//! is a continuous function of the request: the attainable wrenches are a polytope, on which the nearest points
//! above move continuously, and the efforts are the only ones nearest to a reference that give the wrench reached. How
//! steep it is depends on the priorities: where a little less of one allows much more of the next, throttles are as
//! steep. Of sets that bend inwards there may be several optima: see [`crate::hollows`], and [`crate::search`] with rotors
//! out.

use crate::chord::{Rotors, Sets};
use crate::homotopy::Homotopy;
use crate::rows::{ACROSS, ALONG, Bounds, THRUST, YAW};
use crate::scratch::Scratch;
use crate::{Quantity, Tables, clamp};

/// What desaturation may do to the thrust, with PX4's meaning of the word (`MC_AIRMODE`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Airmode {
    /// Roll and pitch may lower the thrust, nothing may raise it.
    Disabled,
    /// Roll and pitch may lower or raise the thrust; yaw may not.
    RollPitch,
    /// Roll, pitch and yaw may lower or raise the thrust.
    RollPitchYaw,
}

/// Priorities of desaturation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Desaturation {
    /// What may happen to the thrust.
    pub airmode: Airmode,
    /// The yaw torque that is kept available before roll and pitch, N m, >= 0.
    pub yaw_reserve_nm: f32,
}

/// Largest torque (N m) and thrust (N) that is looked at: far beyond any rotor, and small enough that no product
/// overflows.
pub(crate) const REQUEST_LIMIT: f32 = 1e5;

/// True where `request` is finite and within [`REQUEST_LIMIT`].
#[inline(always)]
pub(crate) fn is_bounded(request: &[f32; 4]) -> bool {
    // The sign shifted out, numbers are ordered as their bits are.
    let limit = REQUEST_LIMIT.to_bits() << 1;
    request.iter().all(|value| value.to_bits() << 1 <= limit)
}

/// `request` within [`REQUEST_LIMIT`], with the direction of (roll, pitch) kept.
#[cold]
pub(crate) fn limited([roll, pitch, yaw, thrust]: [f32; 4]) -> [f32; 4] {
    let largest = if roll.abs() > pitch.abs() {
        roll.abs()
    } else {
        pitch.abs()
    };
    let share = if largest > REQUEST_LIMIT {
        REQUEST_LIMIT / largest
    } else {
        1.0
    };
    let limit = |value| clamp(value, -REQUEST_LIMIT, REQUEST_LIMIT);
    [roll * share, pitch * share, limit(yaw), limit(thrust)]
}

/// Ends that differ by less, in rows, beside what one is further out of bounds, are equally good.
const MARGIN: f32 = 3e-6;

/// What the steps came to, in rows.
#[derive(Clone, Copy)]
pub(crate) struct Outcome {
    /// How far out of bounds: roll and pitch across the request or against it, yaw, thrust. More than rounding only where
    /// not even roll = pitch = 0 is attainable.
    pub(crate) beyond: f32,
    /// How far from the request, in the order of priority.
    pub(crate) short: [f32; 3],
    /// The largest thrust that was allowed.
    pub(crate) ceiling: f32,
    /// What was asked for.
    pub(crate) wanted: [f32; 4],
    /// The thrust reached.
    pub(crate) thrust: f32,
}

impl Outcome {
    /// True where this end is better in the order of priority.
    pub(crate) fn is_better_than(&self, other: &Outcome) -> bool {
        self.is_better_by(MARGIN, other)
    }

    /// True where the first priority in which this end and another differ by more than `margin` is served better by this
    /// one.
    pub(crate) fn is_better_by(&self, margin: f32, other: &Outcome) -> bool {
        if self.is_within() != other.is_within() {
            return self.is_within();
        }
        // What was gained by being further out of bounds was not gained.
        let further = self.beyond - other.beyond;
        let (better, worse) = if further > 0.0 {
            (margin + further, margin)
        } else {
            (margin, margin - further)
        };
        let pairs = self.short.iter().zip(other.short);
        let mut gains = pairs.map(|(own, other)| other - own);
        gains
            .find(|gain| *gain > better || *gain < -worse)
            .is_some_and(|gain| gain > 0.0)
    }
}

/// Another end of the steps, to be bettered with a unit starting elsewhere.
#[derive(Clone, Copy)]
pub(crate) struct Rival {
    /// The unit that starts elsewhere, ..
    pub(crate) unit: usize,
    /// .. at this corner of its set.
    pub(crate) corner: u8,
    /// Whether it stays there.
    pub(crate) stays: bool,
    /// How far from the request the end is, as in [`Outcome`]. Steps that come to be worse stop there.
    pub(crate) short: [f32; 3],
}

/// The steps of the module's head, with straight lines for the curves of single rotors. `ceiling` is the largest thrust
/// that is allowed beside the one asked, in its row; `None` where that is to be found.
#[inline(never)]
pub(crate) fn prioritise<P, I, S>(
    tables: &Tables<'_, P, I, S>,
    sets: &Sets<'_>,
    request: [f32; 4],
    factors: [f32; 2],
    ceiling: Option<f32>,
    rival: Option<Rival>,
    scratch: &mut [Scratch],
) -> Outcome {
    let Desaturation {
        airmode,
        yaw_reserve_nm,
    } = tables.desaturation;
    let reserved = clamp(request[YAW], -yaw_reserve_nm, yaw_reserve_nm);
    let mut homotopy = Homotopy::new(tables, sets, factors, request, scratch);
    homotopy.prepare(&request);
    if let Some(Rival { unit, corner, .. }) = rival {
        homotopy.refer_beside_best(unit, corner);
    } else {
        homotopy.look_for_hollows();
    }
    let wanted = homotopy.rows_of(request);
    let yaw = homotopy.bounds_of(YAW, Bounds::at(reserved).including(request[YAW]));
    let asked = if airmode == Airmode::Disabled {
        wanted[THRUST]
    } else {
        REQUEST_LIMIT
    };
    let mut thrust = Bounds {
        low: -REQUEST_LIMIT,
        high: match ceiling {
            Some(ceiling) if ceiling > asked => ceiling,
            _ => asked,
        },
    };
    // With a ceiling that has been found lines may miss roll = pitch = 0, where they need not touch the curves.
    let level = Bounds {
        low: 0.0,
        high: if ceiling.is_some() { wanted[ALONG] } else { 0.0 },
    };
    let descent = descend(&mut homotopy, wanted, [level, yaw, thrust], airmode, rival);
    if ceiling.is_none() {
        thrust.high = descent.ceiling;
    }
    homotopy.keep_efforts();
    let reached = homotopy.actual();
    if descent.delivered {
        homotopy.ease(&request);
    }
    homotopy.unscale_efforts();
    let short = |row: usize| match (wanted.get(row), reached.get(row)) {
        (Some(wanted), Some(reached)) => (wanted - reached).abs(),
        _ => 0.0,
    };
    Outcome {
        beyond: short(ACROSS)
            + Bounds::at(0.0).including(wanted[ALONG]).distance(reached[ALONG])
            + yaw.distance(reached[YAW])
            + thrust.distance(reached[THRUST]),
        short: order(airmode).map(short),
        ceiling: thrust.high,
        wanted,
        thrust: reached[THRUST],
    }
}

/// The rows in the order of priority.
fn order(airmode: Airmode) -> [usize; 3] {
    if airmode == Airmode::RollPitchYaw {
        [ALONG, YAW, THRUST]
    } else {
        [ALONG, THRUST, YAW]
    }
}

/// Where the steps have led.
struct Descent {
    /// The largest thrust that was allowed: more than asked for where roll = pitch = 0 needs more.
    ceiling: f32,
    /// True where all that was wanted has been reached.
    delivered: bool,
}

/// The steps of the module's head, one path each. `wanted` in rows; `level` is where roll and pitch along the request
/// are at first, `yaw` and `thrust` are where these rows may be.
#[inline(always)]
fn descend(
    homotopy: &mut Homotopy<'_>,
    wanted: [f32; 4],
    [level, yaw, thrust]: [Bounds; 3],
    airmode: Airmode,
    rival: Option<Rival>,
) -> Descent {
    const LEVEL: Bounds = Bounds::at(0.0);
    const WIDE: Bounds = Bounds {
        low: -REQUEST_LIMIT,
        high: REQUEST_LIMIT,
    };
    if rival.is_none() && homotopy.follow_straight(&wanted) {
        return Descent {
            ceiling: thrust.high,
            delivered: true,
        };
    }
    homotopy.start();
    if let Some(Rival {
        unit,
        corner,
        stays: true,
        ..
    }) = rival
    {
        homotopy.pin(unit, corner);
    }
    homotopy.bound(ALONG, level);
    homotopy.bound(YAW, yaw);
    homotopy.bound(THRUST, WIDE);
    if homotopy.follow([level, LEVEL, yaw, WIDE], false) < 1.0 {
        homotopy.follow([level, LEVEL, WIDE, WIDE], false);
        homotopy.bound(YAW, yaw);
        homotopy.follow([level, LEVEL, yaw, WIDE], false);
    }
    let [.., yaw, _] = homotopy.bounds();
    homotopy.bound(THRUST, thrust);
    homotopy.follow([level, LEVEL, yaw, thrust], false);
    let [.., thrust] = homotopy.bounds();
    let limits = rival.map_or([f32::INFINITY; 3], |rival| rival.short);
    let mut delivered = true;
    for (row, limit) in order(airmode).into_iter().zip(limits) {
        homotopy.hold(row);
        let mut target = homotopy.bounds();
        if row == ALONG {
            target[ACROSS] = LEVEL;
        }
        if let (Some(target), Some(wanted)) = (target.get_mut(row), wanted.get(row)) {
            *target = Bounds::at(*wanted);
        }
        delivered &= homotopy.follow(target, true) >= 1.0;
        if let (Some(reached), Some(wanted)) = (homotopy.bounds().get(row), wanted.get(row))
            && reached.distance(*wanted) > limit + MARGIN
        {
            break;
        }
    }
    Descent {
        ceiling: thrust.high,
        delivered,
    }
}

/// Halvings of the throttle range that find a single rotor's throttle: to the last bit of a float.
const HALVINGS: u32 = 24;

/// The throttle at which a unit with one rotor gives the thrust `f` (N at the reference voltage); `None` with
/// both or no rotor.
pub(crate) fn single_rotor<P: Quantity, I, S>(
    tables: &Tables<'_, P, I, S>,
    rotors: Rotors,
    f: f32,
) -> Option<f32> {
    let (mut low, mut high) = (tables.throttle.min, tables.throttle.max);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        let [u, l] = rotors.throttles(middle)?;
        if tables.pair.thrust.value(u, l) < f {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(0.5 * (low + high))
}
