//! Thrust as asked while rotors are on their way from one speed to another.
//!
//! The throttles of [`mix`](crate::tables::mix) are those of steady speeds. Thrust is convex in them, so a pair that goes from
//! one point to another of equal thrust gives less in between. The *worth* of a rotor is the throttle that would hold its
//! present speed: thrust and torque of the air are f(u, l), Q(u, l) of it. With x the worth, d the throttle, w the speed over
//! that of full throttle, s the share of the voltage that the motor's resistance takes there, t its time constant:
//!
//! ```text
//! x = (1 - s) w + s w^2,   t dw/dt = d - x   ->   dx/dt = (d - x) / lag,   1/lag = sqrt((1 - s)^2 + 4 s x) / t
//! ```
//!
//! With f_k the slopes of thrust at the worth (u, l), r_k = 1/lag_k, and (u*, l*) the throttles of `mix`, whose thrust is f*,
//! both throttles of a unit are shifted alike by
//!
//! ```text
//! shift = (f* - f) / (f_u + f_l) - (r_u f_u (u* - u) + r_l f_l (l* - l)) / (r_u f_u + r_l f_l)
//! ```
//!
//! Then df/dt = sum r_k f_k (u*_k + shift - u_k) = r (f* - f) with r = (r_u f_u + r_l f_l) / (f_u + f_l): thrust follows the
//! request with one lag, the mean one of the unit, whatever yaw does. The difference of the throttles, which yaws, stays. The
//! compiler proves both divisors positive.
//!
//! * By (f* - f) = sum f_k (u*_k - u_k) + O(2), the shift of the first order is that of lags that differ: it vanishes where both
//!   throttles change alike, and is at most half of |r_u - r_l| / r of the distance. So about a steady state the mixer is `mix`,
//!   less what unequal lags make of yaw in the thrust.
//! * At rest it goes to zero by the square of the lag's exponential, but for that part, which has the exponential itself.
//! * Held throttles let thrust go on as the rotors do. So the worth is taken in the middle of the time that they are held, which
//!   leaves an error of the second order of time over lag, and no shift where they are held for many lags.
//! * The worth follows the throttles that were *given*, so nothing winds up.
//!
//! A rotor alone is the same with one slope: d = x + (f* - f) / f'.
//!
//! A controller that does not brake lets a rotor coast: its throttle acts as at least that of the back-EMF,
//! (1 - s) w = (1 - s) / (2 s) (t / lag - (1 - s)).

use crate::allocate::closed_form::AllocationMethod;
use crate::allocate::unit::UnitState;
use crate::layout::Tables;
use crate::mix::{by_channel, mix_into};
use crate::pair::alone::LEAST_RISE;
use crate::pair::rotors::Rotors;
use crate::pair::{Kinds, Quantity};
use crate::{Conditions, Health, Mix, SetpointError, Wrench};
use crate::{clamp, divided, larger, rolled, sqrt};

/// What a mixer remembers between the calls of `mix_dynamic`: how fast its rotors turn, by what they were commanded. Plain
/// data; the default is of rotors at rest. A vehicle that was disarmed, or a mixer that was not called for a time that
/// nobody knows, begins with it anew.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[repr(transparent)]
pub struct RotorState<const CHANNELS: usize> {
    /// Per output channel the throttle that would hold the rotor's present speed, 0 to 1. What is outside is taken as the
    /// nearest within, NaN as either end.
    #[cfg_attr(feature = "serde", serde(with = "crate::array"))]
    pub worth: [f32; CHANNELS],
}

/// Rotors at rest.
impl<const CHANNELS: usize> Default for RotorState<CHANNELS> {
    #[inline]
    fn default() -> Self {
        RotorState {
            worth: [0.0; CHANNELS],
        }
    }
}

/// How rotors of one kind of unit follow their throttles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lag {
    /// 1 / lag, 1/s, is the root of `base + rise x` at a worth x; both 1/s2, positive.
    pub base: f32,
    /// See `base`.
    pub rise: f32,
    /// Where controllers do not brake: the back-EMF over the voltage is `a / lag - b`; (a, b), s and 1.
    pub coast: Option<[f32; 2]>,
}

/// Longest time that throttles are taken to be held, s: far beyond all lags.
const LONGEST_S: f32 = 100.0;

/// Share of a unit's slopes below which a rotor's own is next to nothing: in corners of the range that of a lower rotor can be
/// negative.
const NEXT_TO_NOTHING: f32 = 0.1;

/// [`mix`](crate::tables::mix), its throttles changed so that the thrust of every unit follows while rotors change their
/// speeds. `lags` are those of the kinds. `held_s` is the time, s, that the throttles will be held, which moves `state` on:
/// negative and NaN are 0, and a longer one than 100 s is 100 s. `achieved` and `saturation` are those of `mix`: what
/// the controller can have, and what its anti-windup needs. `HEALTH` tells that `health` may name rotors. A rotor that is out
/// is commanded to stop and is remembered as it does; a unit of which a rotor is starting, below half of idle, has the
/// throttles of `mix`.
///
/// # Errors
/// As [`mix`](crate::tables::mix); `state` is then as it was.
#[inline(always)]
pub fn mix_dynamic<
    const UNITS: usize,
    const CHANNELS: usize,
    const HEALTH: bool,
    K: Kinds,
    S: AllocationMethod,
>(
    tables: &Tables<'_, K, S>,
    lags: &[Lag],
    state: &mut RotorState<CHANNELS>,
    setpoint: &Wrench,
    conditions: Conditions,
    health: Health,
    held_s: f32,
) -> Result<Mix<CHANNELS>, SetpointError> {
    let mut throttle = [tables.throttle.min; CHANNELS];
    // Known zeros would be written by a call of memset, which a bare-metal target may not have.
    let mut thrust_n = [core::hint::black_box(0.0); UNITS];
    let states = || [UnitState::default(); UNITS];
    let (achieved, saturation) = {
        let mut by_channel = by_channel(&mut throttle);
        let mut take = |unit: usize, channels, rotors, throttles, of_unit_n| {
            by_channel(unit, channels, rotors, throttles, of_unit_n);
            if let Some(slot) = thrust_n.get_mut(unit) {
                *slot = of_unit_n;
            }
        };
        mix_into(tables, setpoint, conditions, health, states, &mut take)?
    };
    follow::<CHANNELS, HEALTH, _, _>(tables, lags, &thrust_n, health, state, &mut throttle, held_s);
    Ok(Mix {
        throttle,
        achieved,
        saturation,
    })
}

/// Moves a state on by the time, s, that throttles were held, for a host that gave others than the mixer did: on a copy of the
/// state from before the mix.
#[inline(always)]
pub fn follow_given<const CHANNELS: usize, K: Kinds, S>(
    tables: &Tables<'_, K, S>,
    lags: &[Lag],
    state: &mut RotorState<CHANNELS>,
    given: &[f32; CHANNELS],
    held_s: f32,
) {
    let half_s = half_of(held_s);
    for unit in rolled(tables.units) {
        for channel in unit.channels.map(usize::from) {
            let lag = lags.get(usize::from(unit.kind));
            if let (Some(lag), Some(worth), Some(given)) =
                (lag, state.worth.get_mut(channel), given.get(channel))
            {
                let rotor = Rotor::new(lag, within(*worth), half_s, 0.0);
                *worth = rotor.after(rotor.acting(clamp(*given, 0.0, 1.0)));
            }
        }
    }
}

/// Half of the time, s, that throttles are held.
#[inline(always)]
fn half_of(held_s: f32) -> f32 {
    0.5 * clamp(held_s, 0.0, LONGEST_S)
}

/// A worth as one that a rotor can have.
#[inline(always)]
fn within(worth: f32) -> f32 {
    crate::arithmetic::Scalar::within_positive(worth, 0.0, 1.0)
}

/// A rotor under way.
#[derive(Clone, Copy)]
struct Rotor {
    worth: f32,
    /// 1 / lag, 1/s.
    rate: f32,
    /// Share of the way to the throttle that is done in half of the time.
    half_way: f32,
    /// The least throttle that acts, or that is given.
    least: f32,
    /// Whether the first may be above the second.
    coasts: bool,
}

impl Rotor {
    /// A rotor that is given at least a throttle `least`.
    #[inline(always)]
    fn new(lag: &Lag, worth: f32, half_s: f32, least: f32) -> Rotor {
        let rate = sqrt(lag.base + lag.rise * worth);
        let half = half_s * rate;
        // 1 - exp(-x) as 1 - 1 / (1 + x + x^2/2): within x^3/6, and 1 at last.
        let grown = half * (1.0 + 0.5 * half);
        Rotor {
            worth,
            rate,
            half_way: divided(grown, 1.0 + grown),
            least: lag.coast.map_or(least, |[a, b]| larger(a * rate - b, least)),
            coasts: lag.coast.is_some(),
        }
    }

    /// The throttle that acts where one is given.
    #[inline(always)]
    fn acting(&self, throttle: f32) -> f32 {
        if self.coasts {
            larger(throttle, self.least)
        } else {
            throttle
        }
    }

    /// The worth in the middle of the time, at a throttle that acts.
    #[inline(always)]
    fn middle(&self, throttle: f32) -> f32 {
        self.worth + self.half_way * (throttle - self.worth)
    }

    /// The worth at the end of the time, at a throttle that acts.
    #[inline(always)]
    fn after(&self, throttle: f32) -> f32 {
        let way = self.half_way * (2.0 - self.half_way);
        self.worth + way * (throttle - self.worth)
    }
}

/// Whether `low <= x <= high`, of positive ones: they are ordered as their bits are, and what is negative or NaN is above all.
#[inline(always)]
fn is_between(x: f32, low: f32, high: f32) -> bool {
    x.to_bits().wrapping_sub(low.to_bits()) <= high.to_bits().wrapping_sub(low.to_bits())
}

/// Shifts the throttles of `mix`, with which the units give `thrust_n`, and moves the state on.
#[inline(never)]
fn follow<const CHANNELS: usize, const HEALTH: bool, K: Kinds, S>(
    tables: &Tables<'_, K, S>,
    lags: &[Lag],
    thrust_n: &[f32],
    health: Health,
    state: &mut RotorState<CHANNELS>,
    throttle: &mut [f32; CHANNELS],
    held_s: f32,
) {
    let half_s = half_of(held_s);
    let range = &tables.throttle;
    for (index, (unit, thrust_n)) in rolled(tables.units.iter().zip(thrust_n).enumerate()) {
        let Some(lag) = lags.get(usize::from(unit.kind)) else {
            continue;
        };
        let channels = unit.channels.map(usize::from);
        let of = |all: &[f32; CHANNELS]| channels.map(|channel| all.get(channel).copied().unwrap_or(0.0));
        let (steady, worth) = (of(throttle), of(&state.worth));
        let health = if HEALTH { health } else { Health::GOOD };
        let mut turning = Rotors::of(unit.channels, health);
        if tables.is_single(index) {
            turning = turning.without_lower();
        }
        let is_usual = turning.are_both() && worth.iter().all(|x| is_between(*x, range.min, range.max));
        let worth = if is_usual { worth } else { worth.map(within) };
        let rotors = [0, 1].map(|side| {
            let least = if turning.turns(side) { range.min } else { 0.0 };
            Rotor::new(lag, worth[side], half_s, least)
        });
        let is_starting = |side: usize| turning.turns(side) && worth[side] < 0.5 * range.min;
        let given = if !is_usual && (is_starting(0) || is_starting(1) || turning.turning() == [false; 2]) {
            steady
        } else {
            given(tables, index, turning, is_usual, &rotors, steady, *thrust_n)
        };
        for side in 0..2 {
            if let (Some(throttle), Some(worth)) = (
                throttle.get_mut(channels[side]),
                state.worth.get_mut(channels[side]),
            ) {
                (*throttle, *worth) = (given[side], rotors[side].after(rotors[side].acting(given[side])));
            }
        }
    }
}

/// Throttles of a unit, by index, whose rotors are under way: of those that turn. `is_usual` says that both do, within the range.
#[inline(always)]
fn given<K: Kinds, S>(
    tables: &Tables<'_, K, S>,
    unit: usize,
    turning: Rotors,
    is_usual: bool,
    rotors: &[Rotor; 2],
    steady: [f32; 2],
    steady_n: f32,
) -> [f32; 2] {
    let range = &tables.throttle;
    let middle = [0, 1].map(|side| rotors[side].middle(rotors[side].acting(steady[side])));
    let middle = if is_usual {
        middle
    } else {
        middle.map(|x| range.clamp(x))
    };
    let (thrust_n, slopes) = match tables.pair_of(unit).filter(|_| turning.are_both()) {
        Some(of) => {
            let [f, f_u, f_l, ..] = of.pair.thrust.expansion(middle[0], middle[1]);
            (f, [f_u, f_l])
        }
        None => {
            let of = tables.expansion(unit, turning, middle);
            // What a rotor gives alone is known to rise where the file says it.
            let slope = |side: usize| {
                if turning.turns(side) {
                    larger(of.slopes[side][0], LEAST_RISE)
                } else {
                    0.0
                }
            };
            (of.value[0], [slope(0), slope(1)])
        }
    };
    let weights = [0, 1].map(|side| slopes[side] * rotors[side].rate);
    let total = weights[0] + weights[1];
    let by_steady = weights[0] * (steady[0] - middle[0]) + weights[1] * (steady[1] - middle[1]);
    let shift = divided(steady_n - thrust_n, slopes[0] + slopes[1]) - divided(by_steady, total);
    let mut given = steady.map(|throttle| throttle + shift);
    if is_usual && (0..2).all(|side| is_between(given[side], rotors[side].least, range.max)) {
        return given;
    }
    let limited = |given: [f32; 2], side: usize| {
        if turning.turns(side) {
            clamp(given[side], rotors[side].least, range.max)
        } else {
            0.0
        }
    };
    // At a limit a rotor's partner keeps the thrust, at the cost of yaw, as far as its slope allows.
    for side in 0..2 {
        let within = limited(given, side);
        let (over, own) = (given[side] - within, weights[1 - side]);
        if over != 0.0 {
            let least = NEXT_TO_NOTHING * total;
            given[1 - side] += divided(over * weights[side] * own, own * own + least * least);
            given[side] = within;
        }
    }
    [limited(given, 0), limited(given, 1)]
}
