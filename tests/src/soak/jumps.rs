//! How often throttles step where the request moves on by little: along straight lines of requests through frames drawn
//! class by class, which shows jumps that pairs of neighbours meet only now and then. `cargo jumps` prints the table.
//!
//! Lines between drawn requests cross the limits; lines along them graze the limit of one row while another is cut, where the
//! interior point method converges worst.

use std::fmt;

use mixer_rt::Health;
use mixer_setpoints::Random;

use super::draw::Draw;
use super::draw_health;
use crate::frames::pairs::Pair;
use crate::frames::{self, AIRMODES, Options, Place};
use crate::request::{Frame, Request};

/// Frames of each class, and requests of a line.
pub const FRAMES: usize = 12;
const REQUESTS: usize = 1200;

/// From one request to the next, as a share of the larger of the two that a line is drawn through, by authorities.
const NEXT: f64 = 1e-4;

/// Share of all thrust at which level flight has to be there with the rotors that are out.
const LEVEL: f64 = 0.4;

/// Of a line along the limits: how far its ends are apart, by authorities, and how far off the limits it is at most.
const APART: f64 = 0.1;
const OFF: f64 = 0.01;

/// A step that amplifies a controller's noise.
const STEP: f32 = 0.02;

/// Parts of the way between two requests by which a jump is told from a steep answer, which divides as the way does.
const PARTS: u16 = 16;

/// Frames of some kind, in some state of health.
#[derive(Clone, Copy, Debug)]
pub struct Class {
    /// As it is printed.
    pub name: &'static str,
    /// Numbers of units.
    units: &'static [usize],
    /// Whether axes lean.
    is_tilted: bool,
    airmodes: &'static [&'static str],
    rotors_out: usize,
}

const THRUST_FIRST: &[&str] = &[AIRMODES[0], AIRMODES[1]];
const YAW_FIRST: &[&str] = &[AIRMODES[2]];

const fn class(
    name: &'static str,
    units: &'static [usize],
    airmodes: &'static [&'static str],
    rotors_out: usize,
) -> Class {
    Class {
        name,
        units,
        is_tilted: false,
        airmodes,
        rotors_out,
    }
}

const fn tilted(class: Class) -> Class {
    Class {
        is_tilted: true,
        ..class
    }
}

/// All classes.
pub const CLASSES: [Class; 9] = [
    class("closed form", &[3, 4, 4], THRUST_FIRST, 0),
    class("five to eight units", &[5, 6, 6, 8], &AIRMODES, 0),
    class("X8, Y6, roll-pitch-yaw", &[3, 4, 4], YAW_FIRST, 0),
    tilted(class("tilted", &[4, 6, 8], &AIRMODES, 0)),
    class("one out", &[3, 4, 4, 6], THRUST_FIRST, 1),
    class("one out, roll-pitch-yaw", &[3, 4, 4, 6], YAW_FIRST, 1),
    tilted(class("one out, tilted", &[4, 6, 8], &AIRMODES, 1)),
    class("two out", &[3, 4, 4, 6], &AIRMODES, 2),
    class("bicopter, one out", &[2], THRUST_FIRST, 1),
];

impl Class {
    /// Draws a frame and rotors that are out of it.
    pub fn draw(&self, random: &mut Random, pairs: &[Pair]) -> (Frame, Health) {
        loop {
            let pair = &pairs[random.below(pairs.len())];
            let places = self.places(random);
            let [_, torque_nm] = pair.largest();
            let reserve = random.uniform(0.0, 0.2) * torque_nm * places.len() as f64;
            let options = Options {
                airmode: self.airmodes[random.below(self.airmodes.len())],
                yaw_reserve_nm: if random.below(3) == 0 { reserve } else { 0.0 },
                ..Options::default()
            };
            let channels: Vec<usize> = (0..2 * places.len()).collect();
            let text = frames::toml_with_pair(&frames::text_of_pair(pair), &places, &channels, options);
            let health = draw_health(random, channels.len(), self.rotors_out);
            if let Ok(frame) = frames::compile_text(&text).map(Frame::new)
                && has_level(&frame, health)
            {
                return (frame, health);
            }
        }
    }

    /// Units at equal angles, the same about a centre of gravity of their own, or with arms and spins of their own.
    fn places(&self, random: &mut Random) -> Vec<Place> {
        let units = self.units[random.below(self.units.len())];
        let tilt = if self.is_tilted {
            random.uniform(0.05, 0.25)
        } else {
            0.0
        };
        let spacing = 360.0 / units as f64;
        let kind = random.below(3);
        if units > 2 && kind == 0 {
            return frames::irregular(random, units, tilt);
        }
        let first_deg = if units == 2 { 90.0 } else { 0.5 * spacing };
        let mut places = frames::regular(units, first_deg);
        let off = [(); 2].map(|()| random.uniform(-0.05, 0.05));
        for place in &mut places {
            if units > 2 && kind == 1 {
                place.position[0] += off[0];
                place.position[1] += off[1];
            }
            if self.is_tilted {
                place.axis = [random.uniform(-tilt, tilt), random.uniform(-tilt, tilt), -1.0];
            }
        }
        places
    }
}

/// Whether roll and pitch stay away at a usual thrust, whatever the yaw.
fn has_level(frame: &Frame, health: Health) -> bool {
    let thrust_n = LEVEL * frame.authority[3];
    let request = Request {
        wrench: [0.0, 0.0, 0.0, thrust_n as f32],
        volts: 0.0,
        density: None,
        health,
    };
    let asked = [0.0, 0.0, thrust_n];
    request.mix(frame).is_ok_and(|answer| {
        let given = [0, 1, 3].map(|axis| answer.achieved[axis] / frame.size(axis));
        let mut missed = given.into_iter().zip(asked).zip([0, 1, 3]);
        missed.all(|((given, asked), axis)| {
            !frame.served()[axis] || (given - asked / frame.size(axis)).abs() < 0.01
        })
    })
}

/// What was counted of a class.
#[derive(Clone, Debug, Default)]
pub struct Jumps {
    /// Pairs of requests, and steps among them.
    pub pairs: usize,
    /// Steps beyond 0.02.
    pub steps: usize,
    /// Those of them that jump: more than half of the step is in a sixteenth of the way.
    pub jumps: usize,
    /// The largest.
    pub most: f32,
}

impl Jumps {
    /// Goes along a drawn line, `along_limits` or across them; tells each step to `seen`, with the requests before and after.
    pub fn follow(
        &mut self,
        frame: &Frame,
        health: Health,
        random: &mut Random,
        along_limits: bool,
        mut seen: impl FnMut(f32, [[f32; 4]; 2]),
    ) {
        let mut draw = Draw {
            frame,
            health,
            random,
        };
        let [from, to] = [draw.moderate(), draw.moderate()].map(|request| request.wrench);
        let mut request = draw.moderate();
        let ends = if along_limits {
            ends_along_limits(frame, &request, draw.random)
        } else {
            Some([from, to])
        };
        let Some([from, to]) = ends else { return };
        let size = |wrench: &[f32; 4]| -> f64 {
            let shares = (0..4).map(|axis| f64::from(wrench[axis]) / frame.size(axis));
            shares.map(|share| share * share).sum::<f64>().sqrt()
        };
        let way: [f32; 4] = std::array::from_fn(|axis| to[axis] - from[axis]);
        let next = (NEXT * size(&from).max(size(&to)) / size(&way)) as f32;
        let mut before = None;
        for k in 0..REQUESTS {
            let last = request.wrench;
            request.wrench = std::array::from_fn(|axis| from[axis] + k as f32 * (next * way[axis]));
            let Ok(answer) = request.mix(frame) else { return };
            if let Some(before) = before.replace(answer.clone()) {
                let step = answer.change(&before);
                self.pairs += 1;
                self.steps += usize::from(step > STEP);
                self.most = self.most.max(step);
                if step > STEP {
                    let way = [last, request.wrench];
                    self.jumps += usize::from(largest_part(frame, &request, way) > 0.5 * step);
                    seen(step, way);
                }
            }
        }
    }
}

/// What the mixer makes of a request and of one beside it, a little more or less, with one row as it was asked, or none: a line
/// through both grazes the limits of the others.
fn ends_along_limits(frame: &Frame, request: &Request, random: &mut Random) -> Option<[[f32; 4]; 2]> {
    let mut moved = *request;
    for (axis, value) in moved.wrench.iter_mut().enumerate() {
        *value += (frame.size(axis) * random.uniform(-APART, APART)) as f32;
    }
    let asked_axis = random.below(5);
    let factor = 1.0 + random.uniform(-OFF, OFF);
    let end = |request: &Request| {
        let achieved = request.mix(frame).ok()?.achieved;
        Some(std::array::from_fn(|axis| match axis == asked_axis {
            true => request.wrench[axis],
            false => (factor * achieved[axis]) as f32,
        }))
    };
    Some([end(request)?, end(&moved)?])
}

/// The largest step of a throttle in a part of the way from one wrench to the next.
fn largest_part(frame: &Frame, request: &Request, [from, to]: [[f32; 4]; 2]) -> f32 {
    let answer = |part: u16| {
        let share = f32::from(part) / f32::from(PARTS);
        let wrench = std::array::from_fn(|axis| from[axis] + share * (to[axis] - from[axis]));
        Request { wrench, ..*request }.mix(frame)
    };
    let steps = (0..PARTS).filter_map(|part| Some(answer(part + 1).ok()?.change(&answer(part).ok()?)));
    steps.fold(0.0, f32::max)
}

impl fmt::Display for Jumps {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{:.2} | {:.2} | {:.3} | {} of {}",
            1e4 * self.steps as f64 / self.pairs as f64,
            1e4 * self.jumps as f64 / self.pairs as f64,
            self.most,
            self.steps,
            self.pairs
        )
    }
}
