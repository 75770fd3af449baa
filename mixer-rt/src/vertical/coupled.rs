//! Thrusts where yaw comes before thrust, or where some yaw comes before roll and pitch.
//!
//! At a share of (roll, pitch) that the facets allow, Y, the furthest yaw, is a concave function of z and of the thrust.
//!
//! 1. z is moved to where Y is largest at the thrust nearest the request.
//! 2. If that is short of what comes before the thrust, the thrust moves as well, no further than needed.
//! 3. If that is short of what comes before roll and pitch, their share is the largest that leaves as much.
//!
//! Each is a linear program with the limits of the thrusts and the tangents of Y as rows, and starts where the one
//! before ends. A last step keeps its end near those of neighbouring requests: coupled/average.rs.

mod average;

use core::hint::black_box;

use super::program::{Corner, PARALLEL, Row};
use super::{Efforts, MOST_UNITS, Request, Search, TorqueLimit, Vertical};
use crate::rolled;
use crate::{Airmode, clamp};

/// Segments of [`Coupling::floors_n`].
const SEGMENTS: usize = 16;

/// What a frame with vertical axes needs beside [`Vertical`] where its priorities couple thrust and yaw. At the
/// reference voltage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coupling {
    /// Newtons that count as much as a newton metre of yaw: about the largest thrust of a unit over its largest torque.
    pub scale: f32,
    /// The largest yaw without roll and pitch, N m, clockwise and anticlockwise.
    pub most_yaw_nm: [f32; 2],
    /// Least thrust without roll and pitch, N, at 0, 1, .. 16 sixteenths of either of these.
    pub floors_n: [[f32; SEGMENTS + 1]; 2],
}

/// [`Vertical`] where yaw comes before thrust, or a reserve of yaw before roll and pitch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coupled<'a> {
    /// The frame.
    pub vertical: Vertical<'a>,
    /// What the priorities need.
    pub coupling: Coupling,
}

/// Y and its slopes by lean, thrust and z, N as in [`Coupling::scale`].
#[derive(Clone, Copy)]
struct Tangent {
    yaw: f32,
    slopes: [f32; 3],
}

/// What comes before what, in the direction of yaw, N as in [`Coupling::scale`].
#[derive(Clone, Copy)]
struct Needs {
    /// The yaw asked.
    wanted: f32,
    /// The yaw that comes before thrust.
    goal: f32,
    /// The yaw that comes before roll and pitch.
    reserved: f32,
}

/// Yaw that a newton of thrust must bring to be moved, as in [`Coupling::scale`]: where Y is flat the thrust stays near the
/// request, and moves continuously with it. Costs a few tenths of a percent of yaw at most.
const PRICE: f32 = 2.5e-2;
/// Share of the largest thrust by which a thrust may be out of its range.
const ROUNDING: f32 = 1e-5;
/// Y is known where it is within so many N, as in [`Coupling::scale`], of its tangents.
const CLOSE: f32 = 2e-3;
/// Rows that the programs take in at most, all together.
const ROWS: u32 = 20;
/// .. and the first of them, which moves z alone.
const FIRST_ROWS: u32 = 5;
/// Thrusts for roll and pitch that count as none, N: their reciprocal is to be finite.
const FAINT: f32 = 1e-20;
/// Further than thrust or z ever move, in largest thrusts of a unit.
const FAR: f32 = 8.0;

/// The thrusts on their way, `state.from` and this much per lean, per thrust and per z.
struct Climb<'s, 'a, S> {
    search: &'s mut [Search<'a, S>],
    ways: [[f32; 3]; MOST_UNITS],
    range: [f32; 2],
    scale: f32,
    /// How far the thrust may rise, N.
    limit: f32,
    /// Rows that may still be taken in.
    rows: u32,
}

/// A linear program of the climb.
#[derive(Clone, Copy)]
struct Program {
    /// Rows of the corner that are held.
    held: usize,
    /// Of the thrust, see [`PRICE`].
    price: f32,
    /// The yaw where it is not an unknown.
    level: Option<f32>,
    /// The yaw beyond which there is nothing to gain.
    cap: f32,
    /// The yaw without which the program need not be solved.
    least: f32,
}

impl<S: TorqueLimit> Climb<'_, '_, S> {
    /// Goes to a point, within the limits of the thrusts. Returns the one that is broken most.
    #[inline(always)]
    fn go(&mut self, [lean, thrust, z]: [f32; 3]) -> Option<Row> {
        let [least, most] = self.range;
        let mut worst = None;
        let mut excess = ROUNDING * most;
        for (state, way) in self.search.iter_mut().zip(&self.ways) {
            rolled();
            let mut f = ((state.from + lean * way[0]) + thrust * way[1]) + z * way[2];
            let (over, sign, end) = if f > most {
                (f - most, 1.0, most)
            } else {
                (least - f, -1.0, least)
            };
            if over > 0.0 {
                f = end;
                if over > excess {
                    excess = over;
                    worst = Some((sign, way));
                }
            }
            state.limit = f;
        }
        worst.map(|(sign, [lean, thrust, z])| Row {
            lean: sign * lean,
            rest: [sign * thrust, sign * z],
            excess,
            ..Row::default()
        })
    }

    /// Where z comes to the first limit in the direction of `sign`, and how much of it one of lean and of thrust take.
    #[inline(always)]
    fn end(&self, sign: f32) -> (f32, [f32; 2]) {
        let [least, most] = self.range;
        let mut end = FAR * most;
        let mut binding = &[0.0, 0.0, 1.0];
        for (state, way) in self.search.iter().zip(&self.ways) {
            rolled();
            let speed = sign * way[2];
            let limit = if speed > 0.0 { most } else { least };
            let room = (limit - state.from) / speed;
            let binds = speed.abs() > PARALLEL && room < end;
            end = if binds { room } else { end };
            binding = if binds { way } else { binding };
        }
        let [lean, thrust, z] = *binding;
        (sign * end, [lean / z, thrust / z])
    }

    /// Y at the point that [`Climb::go`] has gone to; leaves the largest torques.
    #[inline(always)]
    fn tangent(&mut self) -> Tangent {
        let mut yaw = 0.0;
        let mut slopes = [0.0; 3];
        for (state, way) in self.search.iter_mut().zip(&self.ways) {
            rolled();
            let f = state.limit;
            let (torque, slope) = state.side.tangent(f);
            state.limit = torque;
            yaw += torque;
            for (sum, way) in slopes.iter_mut().zip(way) {
                *sum += slope * way;
            }
        }
        Tangent {
            yaw: self.scale * yaw,
            slopes: slopes.map(|slope| self.scale * slope),
        }
    }

    /// Adds rows until the corner keeps all, or there are too many. Moves `best` to the point and its yaw.
    #[inline(never)]
    fn solve(&mut self, corner: &mut Corner, program: &Program, best: &mut ([f32; 3], f32)) {
        let Program {
            held,
            price,
            level,
            cap,
            least,
        } = *program;
        while self.rows > 0 {
            self.rows -= 1;
            let [first, thrust, z] = corner.at;
            let (yaw, lean) = level.map_or((first, 0.0), |level| (level, first));
            let point = [lean, thrust, z];
            if yaw < least {
                break;
            }
            let mut row = Row::default();
            if yaw - cap > CLOSE {
                (row.yaw, row.excess) = (1.0, yaw - cap);
            } else if thrust - self.limit > ROUNDING * self.range[1] {
                (row.rest[0], row.excess) = (1.0, thrust - self.limit);
            } else {
                if let Some(limit) = self.go(point)
                    && corner.keep(&limit, held, price)
                {
                    continue;
                }
                // Where no corner keeps the limits, by rounding alone, this point is next to them.
                let tangent = self.tangent();
                row.excess = yaw - tangent.yaw;
                // No number where rows are as good as parallel.
                if row.excess.is_nan() {
                    break;
                }
                *best = (point, tangent.yaw);
                if row.excess <= CLOSE || self.rows == 0 {
                    self.approach_average(corner, program, &tangent, row.excess, best);
                }
                if row.excess <= CLOSE {
                    break;
                }
                row.point = Some(point);
                let [by_lean, by_thrust, by_z] = tangent.slopes;
                row.yaw = 1.0;
                row.lean = -by_lean;
                row.rest = [-by_thrust, -by_z];
            }
            if !corner.keep(&row, held, price) {
                break;
            }
        }
    }
}

impl<S: TorqueLimit> Vertical<'_, S> {
    /// As [`Vertical::desaturate`], with the yaw `reserve` (N m) before roll and pitch, and with all of yaw before thrust
    /// where the airmode says so.
    #[inline(never)]
    pub(crate) fn desaturate_coupled(
        &self,
        coupling: &Coupling,
        airmode: Airmode,
        reserve: f32,
        request: &Request,
        efforts: &mut Efforts,
    ) {
        // See [`Vertical::desaturate`].
        let mut search = [Search::new(&self.border); MOST_UNITS];
        let search = search.get_mut(..self.units.len()).unwrap_or_default();
        let (vertical, efforts, search) = black_box((self, efforts.as_mut_slice(), search));
        let direction = if request.yaw < 0.0 { -1.0 } else { 1.0 };
        let wanted = direction * request.yaw;
        let [clockwise, anticlockwise] = coupling.most_yaw_nm;
        let most = if direction < 0.0 { anticlockwise } else { clockwise };
        let reserved = clamp(reserve, 0.0, if wanted < most { wanted } else { most });
        let [clockwise, anticlockwise] = &coupling.floors_n;
        let floors = if direction < 0.0 { anticlockwise } else { clockwise };
        let limits = vertical.thrust_limits(airmode, request.thrust, floor(floors, reserved / most));
        let yaw_first = airmode == Airmode::RollPitchYaw;
        let goal = if yaw_first { wanted } else { reserved };
        let needs = Needs {
            wanted: coupling.scale * wanted,
            goal: coupling.scale * goal,
            reserved: coupling.scale * reserved,
        };
        let found = vertical.coupled_thrusts(coupling, request, limits, search, direction, needs);
        let [_, middle] = limits;
        vertical.torques(search, efforts, wanted, found, middle);
    }

    /// Finds attainable thrusts of at most `ceiling` in all that serve `needs`, the share of (roll, pitch) included. Returns how
    /// far yaw reaches, and where they are on the units' way.
    #[inline(always)]
    fn coupled_thrusts<'a>(
        &'a self,
        coupling: &Coupling,
        request: &Request,
        [ceiling, middle]: [f32; 2],
        search: &mut [Search<'a, S>],
        direction: f32,
        needs: Needs,
    ) -> (f32, f32) {
        let (wrench, range, _) = self.within_facets(request, ceiling, search, direction);
        let mut ways = [[0.0; 3]; MOST_UNITS];
        let mut size = 0.0;
        for ((unit, state), way) in self.units.iter().zip(search.iter()).zip(&mut ways) {
            rolled();
            let lean = unit.thrust(&[wrench[0], wrench[1], 0.0]);
            *way = [lean, unit.allocation[2], state.along];
            size += lean.abs();
        }
        let per_size = if size > FAINT { 1.0 / size } else { 0.0 };
        for way in &mut ways {
            rolled();
            way[0] *= per_size;
        }
        let z = range.nearest();
        let far = FAR * self.thrust_n[1];
        let room = ceiling - wrench[2];
        let mut climb = Climb {
            search,
            ways,
            range: self.thrust_n,
            scale: coupling.scale,
            limit: if room < far { room } else { far },
            rows: FIRST_ROWS,
        };
        let mut found = ([0.0, 0.0, z], 0.0);
        climb.go(found.0);
        let start = climb.tangent();
        found.1 = start.yaw;
        if start.yaw < needs.wanted {
            climb.move_from(&start, &mut found, request.thrust - wrench[2], &needs);
            climb.go(found.0);
            found.1 = climb.tangent().yaw;
        }
        let ([lean, thrust, z], reached) = found;
        for (state, way) in search.iter_mut().zip(&ways) {
            rolled();
            state.from += lean * way[0] + thrust * way[1];
        }
        let reached = reached / coupling.scale;
        if reached < -self.yaw_rounding_nm {
            let (_, z) = self.retreat(search, z, reached, 0.0, middle);
            return (0.0, z);
        }
        (reached, z)
    }
}

impl<S: TorqueLimit> Climb<'_, '_, S> {
    /// The steps of the module's head from `found`, a point and its yaw, where Y has the tangent `start`. The thrust asked is
    /// `off` from there.
    #[inline(always)]
    fn move_from(&mut self, start: &Tangent, found: &mut ([f32; 3], f32), off: f32, needs: &Needs) {
        let far = FAR * self.range[1];
        let ([.., z], reached) = *found;
        let [lean, slopes @ ..] = start.slopes;
        // The loops for both signs as one.
        let sign = black_box(if slopes[1] < 0.0 { -1.0 } else { 1.0 });
        let (end, taken) = self.end(sign);
        let mut corner = Corner::under(reached, lean, slopes, z, (sign, end, taken));
        let mut program = Program {
            held: 1,
            price: 0.0,
            level: None,
            cap: f32::MAX,
            least: -f32::MAX,
        };
        // Where the thrust asked is out of reach, z has no room.
        if off == 0.0 {
            let mut top = *found;
            self.solve(&mut corner, &program, &mut top);
            let ([.., top_z], top) = top;
            if top > reached {
                let part = (needs.wanted - reached) / (top - reached);
                let part = if part < 1.0 { part } else { 1.0 };
                *found = ([0.0, 0.0, z + part * (top_z - z)], top);
            }
        }
        if found.1 >= needs.goal {
            return;
        }
        self.rows += ROWS - FIRST_ROWS;
        program.held = 0;
        let slope = corner.slope();
        // The thrust asked, where it is not the one to start from, is the one to stay near.
        program.price = if off < 0.0 || (off == 0.0 && slope > 0.0) {
            PRICE
        } else {
            -PRICE
        };
        if off == 0.0 && slope.abs() <= PRICE {
            corner.release(if slope > 0.0 { -1.0 } else { 1.0 }, 0.0);
        } else {
            if slope > program.price {
                corner.release(1.0, self.limit);
            } else {
                corner.release(-1.0, far);
            }
            program.cap = needs.goal;
            program.least = needs.reserved - CLOSE;
            self.solve(&mut corner, &program, found);
        }
        if corner.at[0] < needs.reserved - CLOSE && corner.lean(needs.reserved, &mut program.price) {
            program.level = Some(needs.reserved);
            program.cap = f32::MAX;
            self.solve(&mut corner, &program, found);
        }
    }
}

/// The least thrust at a `share` of the largest yaw, between those of `floors`.
fn floor(floors: &[f32; SEGMENTS + 1], share: f32) -> f32 {
    let [mut at, ..] = *floors;
    let mut left = SEGMENTS as f32 * share;
    for (from, to) in floors.iter().zip(floors.iter().skip(1)) {
        at += clamp(left, 0.0, 1.0) * (to - from);
        left -= 1.0;
    }
    at
}
