//! One affine piece of a path.

use crate::attainable::{Crossing, Face};
use crate::homotopy::{Homotopy, significant};
use crate::linear::{Factors, Gram, Moments, Solution};
use crate::rows::{Bounds, RowState};

/// Velocities below this share of the multipliers' are rounding errors.
const NOISE: f32 = 3e-7;

/// What the efforts may miss of the way, as a share of it and beside that. Slack rows that move by less stand still.
const MISSED: f32 = 2e-6;

/// Efforts on edges that move by less stand still, in the same measure: more, since edges are almost dependent at times.
const STANDING_ON_EDGE: f32 = 6e-5;

/// Corrections of velocities that miss the way by more. Each takes the angle between almost dependent directions, over
/// the rounding error, off what is missed.
const REFINEMENTS: u32 = 3;

/// The size of rows.
const ROWS: f32 = 1.0;

/// What ends a piece.
enum Event {
    /// The path's end.
    Arrival,
    Face(usize, Crossing),
    Row(usize, RowState),
}

/// How a piece sets out.
struct Motion {
    /// 1, or 0 where only the multipliers move.
    moving: f32,
    /// Velocities of the multipliers, ..
    multipliers: [f32; 4],
    /// .. and of the rows.
    speeds: [f32; 4],
    /// The size of the way.
    measure: f32,
}

impl Homotopy<'_> {
    /// J and the rows of the present efforts.
    #[inline]
    pub(crate) fn survey(&self) -> (Moments, [f32; 4]) {
        let mut moments = Moments::default();
        let mut rows = [0.0; 4];
        for scratch in self.scratch.iter() {
            let Some(set) = self.sets.of(scratch.rotors, &scratch.chord) else {
                continue;
            };
            scratch.add(set.project(&scratch.point), &mut rows);
            match scratch.point.face {
                Face::Interior => {
                    for column in &scratch.columns {
                        moments.add(column);
                    }
                }
                Face::Edge => moments.add(&scratch.effect(set.direction(&scratch.point))),
                Face::Corner => {}
            }
        }
        (moments, rows)
    }

    /// Solves `J x = b` for the rows that are not slack. `drift` is that of the bounds where `b` is to follow it.
    #[inline]
    fn solve(&self, factors: Option<&Factors>, b: &[f32; 4], drift: Option<&[Bounds; 4]>) -> Solution {
        match factors {
            Some(factors) => Solution::Regular(factors.solve(*b)),
            None => self.solve_exactly(b, drift),
        }
    }

    /// [`Homotopy::solve`] where J is singular or nearly so.
    #[inline(never)]
    fn solve_exactly(&self, b: &[f32; 4], drift: Option<&[Bounds; 4]>) -> Solution {
        let active = self.active();
        let mut gram = Gram::new();
        for scratch in self.scratch.iter() {
            let Some(set) = self.sets.of(scratch.rotors, &scratch.chord) else {
                continue;
            };
            let free: &[[f32; 2]] = match scratch.point.face {
                Face::Interior => &[[1.0, 0.0], [0.0, 1.0]],
                Face::Edge => &[set.direction(&scratch.point)],
                Face::Corner => &[],
            };
            for direction in free {
                let mut effect = scratch.effect(*direction);
                for (effect, active) in effect.iter_mut().zip(active) {
                    if !active {
                        *effect = 0.0;
                    }
                }
                gram.add(effect);
            }
        }
        gram.solve(*b, || {
            // Where there is nothing to make up for the way is exact, however short.
            let is_drift = drift.is_some_and(|drift| {
                let mut rows = self.rows.iter().zip(drift).zip(b);
                rows.all(|((row, drift), b)| row.state == RowState::Between || *b == row.followed(drift))
            });
            if is_drift { 0.0 } else { ROWS }
        })
    }

    /// Which rows are not slack.
    #[inline]
    fn active(&self) -> [bool; 4] {
        self.rows.map(|row| row.state != RowState::Between)
    }

    /// Adds the velocities that multipliers changing by `multipliers` give, and to `speeds` those of the rows. At rest
    /// (`moving` 0) no effort moves.
    #[inline(never)]
    fn accelerate(&mut self, multipliers: &[f32; 4], moving: f32, speeds: &mut [f32; 4]) {
        for scratch in self.scratch.iter_mut() {
            let Some(set) = self.sets.of(scratch.rotors, &scratch.chord) else {
                continue;
            };
            let mut velocity = set.velocity(&scratch.point, scratch.step(multipliers));
            match scratch.point.face {
                Face::Interior => {
                    velocity = velocity.map(|speed| moving * speed);
                    scratch.add(velocity, speeds);
                }
                Face::Edge => {
                    velocity[0] *= moving;
                    let along = set.direction(&scratch.point).map(|part| part * velocity[0]);
                    scratch.add(along, speeds);
                }
                Face::Corner => {}
            }
            scratch.pair = [scratch.pair[0] + velocity[0], scratch.pair[1] + velocity[1]];
        }
    }

    /// What `speeds` miss of `way` in the rows that are not slack, and the largest of it.
    #[inline]
    fn missed(&self, way: &[f32; 4], speeds: &[f32; 4]) -> ([f32; 4], f32) {
        let (mut missed, mut largest) = ([0.0; 4], 0.0);
        for (((missed, row), way), speed) in missed.iter_mut().zip(&self.rows).zip(way).zip(speeds) {
            if row.state != RowState::Between {
                *missed = way - speed;
                if missed.abs() > largest {
                    largest = missed.abs();
                }
            }
        }
        (missed, largest)
    }

    /// The share of a motion after which it ends, and what ends it; nothing may. The velocities of the efforts are in the scratch.
    #[inline(always)]
    fn first_event(&mut self, drift: &[Bounds; 4], motion: &Motion) -> (f32, Option<Event>) {
        let Motion {
            moving,
            multipliers,
            speeds,
            measure,
        } = *motion;
        let noise = NOISE * multipliers.iter().fold(0.0, |sum, v| sum + v.abs());
        let (still, bearable) = ([STANDING_ON_EDGE * measure, noise], MISSED * measure);
        let (mut limit, mut event) = if moving > 0.0 {
            (1.0, Some(Event::Arrival))
        } else {
            (f32::MAX, None)
        };
        // Of the faces, those outside first, which leave the ways inside shorter to look at.
        for outside in [true, false] {
            for (index, scratch) in self.scratch.iter_mut().enumerate() {
                if (scratch.point.face != Face::Interior) != outside {
                    continue;
                }
                let Some(set) = self.sets.of(scratch.rotors, &scratch.chord) else {
                    continue;
                };
                let velocity = scratch.pair;
                let barred = match self.left {
                    Some((left, region)) if left == index && outside => Some(region),
                    _ => None,
                };
                if let Some(crossing) = set.crossing(&mut scratch.point, velocity, limit, still, barred) {
                    limit = crossing.share;
                    event = Some(Event::Face(index, crossing));
                }
            }
        }
        // .. of the slack rows.
        for (index, (((row, drift), speed), pull)) in self
            .rows
            .iter()
            .zip(drift)
            .zip(speeds)
            .zip(multipliers)
            .enumerate()
        {
            let mut falls = |height: f32, speed: f32, noise: f32, state: RowState| {
                if speed < -noise {
                    let share = if height > 0.0 { height / -speed } else { 0.0 };
                    if share < limit {
                        limit = share;
                        event = Some(Event::Row(index, state));
                    }
                }
            };
            // Between equal bounds there is nowhere to go, whichever sign the multiplier takes.
            let is_fixed = row.bounds.low == row.bounds.high && drift.low == drift.high;
            match row.state {
                RowState::Held => {}
                RowState::AtLow | RowState::AtHigh if is_fixed => {}
                RowState::AtLow => falls(row.multiplier, pull, noise, RowState::Between),
                RowState::AtHigh => falls(-row.multiplier, -pull, noise, RowState::Between),
                RowState::Between => {
                    falls(
                        row.value - row.bounds.low,
                        speed - moving * drift.low,
                        bearable,
                        RowState::AtLow,
                    );
                    falls(
                        row.bounds.high - row.value,
                        moving * drift.high - speed,
                        bearable,
                        RowState::AtHigh,
                    );
                }
            }
        }
        (limit, event)
    }

    /// One piece of the path towards `drift` from the present bounds. Returns the share made, `None` where there is
    /// no way on; `presses`: what comes next then stays there.
    pub(crate) fn piece(&mut self, drift: &[Bounds; 4], presses: bool) -> Option<f32> {
        let (moments, wrench) = self.survey();
        // What rounding has done so far is made up for on the way.
        let mut way = [0.0; 4];
        for (((way, row), drift), wrench) in way.iter_mut().zip(&mut self.rows).zip(drift).zip(wrench) {
            *way = match row.state {
                RowState::Between => {
                    row.value = wrench;
                    0.0
                }
                RowState::AtHigh => drift.high + significant(row.value - wrench),
                RowState::AtLow | RowState::Held => drift.low + significant(row.value - wrench),
            };
        }
        let factors = moments.factors(self.active());
        let (multipliers, moving) = match self.solve(factors.as_ref(), &way, Some(drift)) {
            Solution::Regular(velocity) => (velocity, 1.0),
            Solution::Inconsistent(direction) => (direction, 0.0),
        };
        for scratch in self.scratch.iter_mut() {
            scratch.pair = [0.0; 2];
        }
        let mut speeds = [0.0; 4];
        self.accelerate(&multipliers, moving, &mut speeds);
        let measure = way.iter().fold(1.0, |sum, way| sum + way.abs());
        if moving > 0.0 {
            // Multipliers that are large hide, in rounding, what the efforts miss of the way.
            let mut worst = f32::MAX;
            for _ in 0..REFINEMENTS {
                let (missed, size) = self.missed(&way, &speeds);
                if size <= MISSED * measure || size > 0.5 * worst {
                    break;
                }
                worst = size;
                let Solution::Regular(correction) = self.solve(factors.as_ref(), &missed, None) else {
                    break;
                };
                self.accelerate(&correction, moving, &mut speeds);
            }
        }
        let motion = Motion {
            moving,
            multipliers,
            speeds,
            measure,
        };
        let (limit, event) = self.first_event(drift, &motion);
        let Some(event) = event else {
            if presses {
                self.press(&multipliers);
            }
            return None;
        };

        let made = moving * limit;
        for (((row, drift), pull), speed) in self.rows.iter_mut().zip(drift).zip(multipliers).zip(speeds) {
            row.multiplier += limit * pull;
            row.bounds.low += made * drift.low;
            row.bounds.high += made * drift.high;
            row.value = match row.state {
                RowState::Between => row.value + limit * speed,
                RowState::AtHigh => row.bounds.high,
                RowState::AtLow | RowState::Held => row.bounds.low,
            };
        }
        for scratch in self.scratch.iter_mut() {
            if let Some(set) = self.sets.of(scratch.rotors, &scratch.chord) {
                let velocity = scratch.pair;
                set.shift(&mut scratch.point, [limit * velocity[0], limit * velocity[1]]);
            }
        }
        self.left = None;
        match event {
            Event::Arrival => return Some(1.0),
            Event::Face(index, crossing) => {
                if let Some(scratch) = self.scratch.get_mut(index)
                    && let Some(set) = self.sets.of(scratch.rotors, &scratch.chord)
                {
                    self.left = Some((index, scratch.point.region()));
                    set.cross(&mut scratch.point, crossing);
                }
            }
            Event::Row(index, state) => {
                if let Some(row) = self.rows.get_mut(index) {
                    row.state = state;
                    if state == RowState::Between {
                        row.multiplier = 0.0;
                    }
                }
            }
        }
        Some(made)
    }
}
