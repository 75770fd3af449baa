//! An independent oracle of allocation: the same lexicographic problem as linear programmes, in
//! f64.
//!
//! A unit's attainable set is cut into pieces, each stood for by the convex hull of points of it:
//!
//! * Both rotors, three units or more: one piece, from points of the border. The programmes range
//!   over the convex hull: what they attain is at least what is physically attainable. (The sum of
//!   several sets is nearly convex, whatever each of them is.)
//! * Both rotors, one unit or two, or any number in [`Oracle::exact`]: the images of small cells of
//!   the throttle box, since on the convex hull a single unit would have 1.3 % more torque than it
//!   has, the paper's pair.
//! * One rotor: a curve is left, which is anything but convex, as short arcs.
//!
//! The optimum over all choices of one piece per unit is found by branch and bound: a run of pieces
//! is relaxed to the convex hull of all of them; the choice of runs that promises most is halved
//! until single pieces are left.

mod programme;

use microlp::Error;
use mixer_compiler::model::PairMap;
use mixer_rt::{Health, tables::Airmode};

use crate::physics::{NONE, Physics};
use programme::{Goal, Point, Programme, Quantity, Ranges};

/// Border points per edge of the throttle box.
const SAMPLES: usize = 12;

/// Arcs that a curve is cut into. The hull of one is 1e-4 N m wide for the paper's pair.
const ARCS: usize = 16;

/// The throttle box is halved this often in both directions, if both need it.
const HALVINGS: u32 = 2;

/// Units up to which the box is cut.
const FEW: usize = 2;

/// Room for the solver's own tolerance between one programme and the next. Where edges are all but
/// dependent the next priority gains a million times as much by it.
const SLACK: f64 = 1e-9;

/// Share of its authority by which a thrust may be off that counts as attained.
const LEVEL: f64 = 1e-6;

/// Share of the authority beyond which the mixer takes no yaw.
const YAW_LIMIT: f64 = 1.2;

/// More torque (N m) or thrust (N) than any frame has.
const FREE: (f64, f64) = (-1e4, 1e4);

/// What a request is worth: the optimum of each step, in the order of priority.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Optimum {
    /// Share of roll and pitch.
    pub share: f64,
    /// Yaw, N m.
    pub yaw_nm: f64,
    /// Thrust, N.
    pub thrust_n: f64,
}

/// What a unit can contribute to `[roll, pitch, yaw, thrust]`: the convex hulls of these points,
/// neighbours in order.
type Pieces<T> = Vec<Vec<T>>;

/// The lexicographic programmes of one frame at one voltage, with some rotors out.
pub struct Oracle {
    sets: Vec<Pieces<[f64; 4]>>,
    served: [bool; 4],
    /// The frame's authority, N m and N.
    size: [f64; 4],
    airmode: Airmode,
    reserve: f64,
    /// With rotors out: the largest yaw that the mixer takes for a request, N m.
    yaw_limit: Option<f64>,
}

/// A run of pieces `[from, to)` per unit, with its relaxed optimum.
struct Node {
    runs: Vec<[usize; 2]>,
    point: Point,
}

impl Oracle {
    /// The programmes of a frame with correction `[k_f, k_Q]`.
    pub fn new(
        physics: &Physics,
        allocation: &mixer_compiler::airframe::Allocation,
        factors: [f64; 2],
        health: Health,
    ) -> Self {
        Oracle::cut(physics, allocation, factors, health, physics.units() <= FEW)
    }

    /// As [`Oracle::new`], with the sets of units with both rotors cut into pieces, however many
    /// units there are. An optimum takes seconds.
    pub fn exact(
        physics: &Physics,
        allocation: &mixer_compiler::airframe::Allocation,
        factors: [f64; 2],
        health: Health,
    ) -> Self {
        Oracle::cut(physics, allocation, factors, health, true)
    }

    fn cut(
        physics: &Physics,
        allocation: &mixer_compiler::airframe::Allocation,
        factors: [f64; 2],
        health: Health,
        is_cut: bool,
    ) -> Self {
        // The lower rotor that a single one does not have is out, too.
        let failed = |channel| channel == NONE || is_out(health, channel);
        let sets = physics.channels.iter().enumerate().map(|(i, channels)| {
            let pair = &physics.pairs[i];
            let efforts = match channels.map(failed) {
                [false, false] if is_cut => cells(pair),
                [false, false] => vec![bulging(pair, pair.border(SAMPLES))],
                [false, true] => arcs(pair, |upper| [upper, 0.0]),
                [true, false] => arcs(pair, |lower| [0.0, lower]),
                [true, true] => vec![vec![[0.0; 2]]],
            };
            let contribution = |throttles| physics.contribution(i, physics.given(i, throttles), factors);
            let pieces = efforts.into_iter();
            pieces
                .map(|piece| piece.into_iter().map(contribution).collect())
                .collect()
        });
        Oracle {
            sets: sets.collect(),
            served: mixer_rt::Axis::ALL.map(|axis| allocation.controls(axis)),
            // An axis that no unit has any part in is not served either.
            size: physics
                .authority()
                .map(|authority| if authority > 0.0 { authority } else { 1.0 }),
            airmode: allocation.airmode,
            reserve: allocation.yaw_reserve_nm,
            yaw_limit: (health != Health::GOOD)
                .then(|| YAW_LIMIT * physics.authority()[2] * factors[0].max(factors[1])),
        }
    }

    /// The optimum over all choices of pieces.
    fn best(&self, goal: Goal, direction: [f64; 2], ranges: Ranges) -> Result<Option<Point>, Error> {
        let solve = |runs: Vec<[usize; 2]>| -> Result<Option<Node>, Error> {
            let sets = self.sets.iter().zip(&runs);
            let programme = Programme {
                sets: sets
                    .map(|(pieces, &[from, to])| pieces[from..to].iter().flatten().copied().collect())
                    .collect(),
                served: self.served,
                direction,
                size: self.size,
            };
            Ok(programme.solve(goal, ranges)?.map(|point| Node { runs, point }))
        };
        let all = self.sets.iter().map(|pieces| [0, pieces.len()]).collect();
        let mut open: Vec<Node> = solve(all)?.into_iter().collect();
        loop {
            let Some(most) =
                (0..open.len()).max_by(|&a, &b| open[a].point.score.total_cmp(&open[b].point.score))
            else {
                return Ok(None);
            };
            let Node { runs, point } = open.swap_remove(most);
            let Some(widest) = (0..runs.len())
                .filter(|&k| runs[k][1] - runs[k][0] > 1)
                .max_by_key(|&k| runs[k][1] - runs[k][0])
            else {
                return Ok(Some(point));
            };
            let [from, to] = runs[widest];
            let middle = from.midpoint(to);
            for half in [[from, middle], [middle, to]] {
                let mut runs = runs.clone();
                runs[widest] = half;
                open.extend(solve(runs)?);
            }
        }
    }

    /// Yaw from zero to the request, with rotors out any; roll = pitch = 0, any thrust.
    fn level(&self, yaw: f64) -> Ranges {
        Ranges {
            share: (0.0, 0.0),
            yaw: match self.yaw_limit {
                None => (yaw.min(0.0), yaw.max(0.0)),
                Some(_) => FREE,
            },
            thrust: FREE,
        }
    }

    /// The least thrust (N) at which roll = pitch = 0 is attainable with a yaw between zero and the
    /// one asked, with rotors out with any; `None` where there is none. Airmode "disabled" never gives more than this or the
    /// thrust asked.
    ///
    /// # Errors
    /// The solver gave up.
    pub fn thrust_floor(&self, yaw: f64) -> Result<Option<f64>, Error> {
        let least = self.best(Goal::Lowest(Quantity::Thrust), [0.0; 2], self.level(yaw))?;
        Ok(least.map(|point| point.thrust))
    }

    /// True where roll = pitch = 0 is attainable at this thrust (N) with a yaw between zero and the one
    /// asked, with rotors out with any.
    ///
    /// # Errors
    /// The solver gave up.
    pub fn has_level(&self, yaw: f64, thrust: f64) -> Result<bool, Error> {
        let nearest = self.best(Goal::Nearest(Quantity::Thrust, thrust), [0.0; 2], self.level(yaw))?;
        Ok(nearest.is_some_and(|point| (point.thrust - thrust).abs() <= LEVEL * self.size[3]))
    }

    /// Where yaw and thrust may be whatever becomes of roll and pitch; `None` where no thrust
    /// leaves them at zero.
    fn allowed(&self, [.., yaw, thrust]: [f64; 4]) -> Result<Option<Ranges>, Error> {
        let mut ranges = self.level(yaw);
        let Some(floor) = self.thrust_floor(yaw)? else {
            return Ok(None);
        };
        if self.airmode == Airmode::Disabled {
            ranges.thrust.1 = thrust.max(floor + SLACK);
        }
        Ok(Some(ranges))
    }

    /// Yaw in the sense of what is asked that comes before thrust, N m. With rotors out it grows with what
    /// is asked, from as much the other way as there may be to the reserve.
    fn kept(&self, yaw: f64) -> f64 {
        let asked = yaw.min(self.reserve);
        asked - self.yaw_limit.unwrap_or(0.0) * (1.0 - asked / self.reserve)
    }

    fn highest_share(&self, direction: [f64; 2], ranges: Ranges) -> Result<Option<f64>, Error> {
        if direction == [0.0; 2] {
            return Ok(Some(0.0));
        }
        let ranges = Ranges {
            share: (0.0, 1.0),
            ..ranges
        };
        let best = self.best(Goal::Highest(Quantity::Share), direction, ranges)?;
        Ok(best.map(|point| point.share))
    }

    /// The ranges with `quantity` as near to `wanted` as they allow, and that value.
    fn nearest(
        &self,
        (quantity, wanted): (Quantity, f64),
        direction: [f64; 2],
        ranges: Ranges,
    ) -> Result<Option<(f64, Ranges)>, Error> {
        let Some(point) = self.best(Goal::Nearest(quantity, wanted), direction, ranges)? else {
            return Ok(None);
        };
        let value = point.get(quantity);
        let about = |(low, high): (f64, f64)| ((value - SLACK).max(low), (value + SLACK).min(high));
        let mut ranges = ranges;
        match quantity {
            Quantity::Share => ranges.share = about(ranges.share),
            Quantity::Yaw => ranges.yaw = about(ranges.yaw),
            Quantity::Thrust => ranges.thrust = about(ranges.thrust),
        }
        Ok(Some((value, ranges)))
    }

    /// Yaw and thrust of a request in the order of priority.
    fn rest(&self, [.., yaw, thrust]: [f64; 4]) -> [(Quantity, f64); 2] {
        let (yaw, thrust) = ((Quantity::Yaw, yaw), (Quantity::Thrust, thrust));
        if self.airmode == Airmode::RollPitchYaw {
            [yaw, thrust]
        } else {
            [thrust, yaw]
        }
    }

    /// The optimum of a request; `None` where not even roll = pitch = 0 is attainable within
    /// the yaw asked.
    ///
    /// # Errors
    /// The solver gave up.
    pub fn optimum(&self, request: [f64; 4]) -> Result<Option<Optimum>, Error> {
        self.optimum_given(request, None)
    }

    /// The optimum with the share of (roll, pitch), if one is given, not above it, and if with it a
    /// value of the next priority is given, that one as near to it as can be.
    ///
    /// # Errors
    /// The solver gave up.
    pub fn optimum_given(
        &self,
        request: [f64; 4],
        given: Option<(f64, Option<f64>)>,
    ) -> Result<Option<Optimum>, Error> {
        match self.allowed(request)? {
            Some(ranges) => self.optimum_within(request, ranges, given),
            None => Ok(None),
        }
    }

    /// [`Oracle::optimum_given`] with yaw and thrust in these ranges: yaw up to the reserve first.
    fn optimum_within(
        &self,
        request: [f64; 4],
        mut ranges: Ranges,
        given: Option<(f64, Option<f64>)>,
    ) -> Result<Option<Optimum>, Error> {
        let direction = [request[0], request[1]];
        let Some(highest) = self.highest_share(direction, ranges)? else {
            return Ok(None);
        };
        let share = given.map_or(highest, |(share, _)| share.clamp(0.0, highest));
        ranges.share = ((share - SLACK).max(0.0), share);
        if self.reserve > 0.0 {
            let yaw = request[2];
            let goal = match yaw < 0.0 {
                true => Goal::Lowest(Quantity::Yaw),
                false => Goal::Highest(Quantity::Yaw),
            };
            let Some(furthest) = self.best(goal, direction, ranges)? else {
                return Ok(None);
            };
            let kept = self.kept(yaw.abs()) - SLACK;
            if yaw < 0.0 {
                ranges.yaw.1 = ranges.yaw.1.min(furthest.yaw.max(-kept) + SLACK);
            } else {
                ranges.yaw.0 = ranges.yaw.0.max(furthest.yaw.min(kept) - SLACK);
            }
        }
        let [mut second, third] = self.rest(request);
        if let Some((_, Some(value))) = given {
            second.1 = value;
        }
        let Some((second_value, ranges)) = self.nearest(second, direction, ranges)? else {
            return Ok(None);
        };
        let Some((third_value, _)) = self.nearest(third, direction, ranges)? else {
            return Ok(None);
        };
        let [yaw_nm, thrust_n] = match second.0 {
            Quantity::Yaw => [second_value, third_value],
            _ => [third_value, second_value],
        };
        Ok(Some(Optimum {
            share,
            yaw_nm,
            thrust_n,
        }))
    }
}

/// True where the rotor on this channel has failed.
fn is_out(health: Health, channel: usize) -> bool {
    u8::try_from(channel).is_ok_and(|channel| health.has_failed(channel))
}

/// The throttles among `border` (anticlockwise) whose efforts are corners of the convex hull of
/// all.
fn bulging(pair: &PairMap, border: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let mut corners = border;
    loop {
        let efforts: Vec<[f64; 2]> = corners.iter().map(|&throttles| pair.efforts(throttles)).collect();
        let n = efforts.len();
        let inside = (0..n).find(|&k| {
            let (before, at, after) = (efforts[(k + n - 1) % n], efforts[k], efforts[(k + 1) % n]);
            let (f, q) = (after[0] - before[0], after[1] - before[1]);
            f * (at[1] - before[1]) - q * (at[0] - before[0]) >= 0.0
        });
        match inside {
            Some(k) => corners.remove(k),
            None => return corners,
        };
    }
}

/// The curve of one rotor as arcs, three throttles each.
fn arcs(pair: &PairMap, throttles: fn(f64) -> [f64; 2]) -> Pieces<[f64; 2]> {
    let [low, high] = pair.range();
    let at = |k: usize| throttles(low + (high - low) * k as f64 / (2 * ARCS) as f64);
    (0..ARCS).map(|k| (2 * k..=2 * k + 2).map(at).collect()).collect()
}

/// The throttle box as cells, cut only across the edges whose images bend inwards: in both
/// directions [`HALVINGS`] times, in Morton's order, so that runs are compact; in one direction
/// once more.
fn cells(pair: &PairMap) -> Pieces<[f64; 2]> {
    let [low, high] = pair.range();
    let at = |share: f64| low + (high - low) * share;
    // Positive where the image of an edge, followed anticlockwise, bends to the left: det J is
    // positive.
    let bend = |edge: &dyn Fn(f64) -> [f64; 2]| {
        let [from, middle, to] = [0.0, 0.5, 1.0].map(|share| pair.efforts(edge(at(share))));
        (to[0] - from[0]) * (middle[1] - from[1]) - (to[1] - from[1]) * (middle[0] - from[0])
    };
    let is_cut = [
        bend(&|u| [u, low]) > 0.0 || bend(&|u| [u, high]) < 0.0,
        bend(&|l| [high, l]) > 0.0 || bend(&|l| [low, l]) < 0.0,
    ];
    let halvings = match is_cut {
        [true, true] => [HALVINGS; 2],
        one => one.map(|is_cut| if is_cut { HALVINGS + 1 } else { 0 }),
    };
    let place = |index: usize, side: usize| match (is_cut, halvings[side]) {
        ([true, true], halvings) => (0..halvings as usize)
            .map(|bit| (index >> (2 * bit + side) & 1) << bit)
            .sum(),
        (_, 0) => 0,
        _ => index,
    };
    let cell = |index: usize| {
        let [u, l] = [0, 1].map(|side| {
            let (place, parts) = (place(index, side) as f64, f64::from(1u32 << halvings[side]));
            move |share: f64| at((place + share) / parts)
        });
        let border = (0..4 * SAMPLES).map(|k| {
            let share = (k % SAMPLES) as f64 / SAMPLES as f64;
            match k / SAMPLES {
                0 => [u(share), l(0.0)],
                1 => [u(1.0), l(share)],
                2 => [u(1.0 - share), l(1.0)],
                _ => [u(0.0), l(1.0 - share)],
            }
        });
        bulging(pair, border.collect())
    };
    (0..1usize << (halvings[0] + halvings[1])).map(cell).collect()
}
