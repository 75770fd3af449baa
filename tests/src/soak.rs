//! Frames of the zoo and requests without end, each answer held to the physics of the airframe file
//! in f64. `cargo xtask soak` runs it for minutes or hours, `tests/soak.rs` for some seconds.

mod draw;
mod failure;
pub mod limits;

use std::collections::BTreeMap;
use std::fmt;

use microlp::Error;
use mixer_compiler::Source;
use mixer_compiler::diagnostic::Severity;
use mixer_rt::Health;
use mixer_setpoints::{Kind, Random, Requests};

use crate::frames::zoo::{Class, REFUSALS, Specimen, Zoo};
use crate::motion::{JUMP, Motion};
use crate::optimum::Oracle;
use crate::request::{Answer, Frame, Request};
use crate::shortfall::Shortfall;
use crate::soundness::{self, Allowed};
use draw::Draw;
pub use failure::Failure;
use limits::{Check, LIMITS};

/// Requests of every kind per frame, wrenches of throttles, and pairs of neighbours.
const REQUESTS: usize = 800;
const ATTAINABLE: usize = 1000;
const NEIGHBOURS: usize = 400;

/// States of health with one rotor out and with two per frame, and requests of each kind to each.
const HEALTHS: usize = 2;
const WITH_ROTORS_OUT: usize = 50;

/// Requests per state of health that are judged by linear programmes, and of how many frames one is.
const JUDGED: usize = 2;
const JUDGED_FRAMES: u64 = 4;

/// Units beyond which they are not: a programme takes seconds.
const MOST_JUDGED_UNITS: usize = 8;

/// Pairs of neighbours per frame and health that linear programmes judge, of those that move
/// throttles: the frame's further ones are left out.
const MOST_MOVED: usize = 3;

/// Misses of one check that are kept with what reproduces them, per class.
const KEPT: usize = 3;

/// How often something was looked at and missed.
#[derive(Clone, Debug, Default)]
struct Count {
    looked: usize,
    missed: usize,
    worst: f64,
    kept: Vec<Failure>,
}

/// A soak under way.
pub struct Soak {
    zoo: Zoo,
    seed: u64,
    counts: BTreeMap<(usize, Check, Class), Count>,
    frames: usize,
    mixes: usize,
}

impl Soak {
    /// Of the frames of `zoo`, with requests of `seed`.
    pub fn new(zoo: Zoo, seed: u64) -> Soak {
        Soak {
            zoo,
            seed,
            counts: BTreeMap::new(),
            frames: 0,
            mixes: 0,
        }
    }

    /// Frames so far.
    pub fn frames(&self) -> usize {
        self.frames
    }

    /// Mixes so far.
    pub fn mixes(&self) -> usize {
        self.mixes
    }

    /// Draws the frame of this index and asks it requests. Returns the first failure of each check
    /// that allows none, all rotors turning.
    ///
    /// # Errors
    /// The oracle's solver gave up.
    pub fn frame(&mut self, index: u64) -> Result<Vec<Failure>, Error> {
        let specimen = self.zoo.specimen(index);
        self.frames += 1;
        let source = Source::new(format!("{index}.toml"), specimen.text.as_str());
        match mixer_compiler::compile(&source) {
            Ok(compiled) => self.mix(&specimen, index, &Frame::new(compiled)),
            Err(faults) => {
                let mut visit = Visit::new(&specimen, index, 0);
                let mut faults = faults.faults().iter();
                let fault = faults.find(|fault| fault.code.severity() == Severity::Error);
                let said = fault.map_or(String::new(), |fault| {
                    format!("{}: {}", fault.code, fault.message)
                });
                visit.look(Check::Compiled, f64::INFINITY, &[], || said.clone());
                let is_expected = fault.is_some_and(|fault| REFUSALS.contains(&fault.code));
                visit.look(
                    Check::Reason,
                    if is_expected { 0.0 } else { f64::INFINITY },
                    &[],
                    || said,
                );
                Ok(self.add(visit))
            }
        }
    }

    /// Asks a compiled frame requests, as [`Soak::frame`] does.
    ///
    /// # Errors
    /// The oracle's solver gave up.
    pub fn mix(&mut self, specimen: &Specimen, index: u64, frame: &Frame) -> Result<Vec<Failure>, Error> {
        let mut random = Random::new(Random::new(self.seed).bits() ^ index);
        let mut visit = Visit::new(specimen, index, 0);
        visit.look(Check::Compiled, 0.0, &[], String::new);
        let off = (&frame.physics.matrix - &frame.compiled.effectiveness.matrix).amax();
        visit.look(Check::Effectiveness, off, &[], || "M is not the file's".into());
        let off = off_identity(frame);
        visit.look(Check::PseudoInverse, off, &[], || {
            "M M+ is not the identity".into()
        });
        let view = frame.compiled.tables.view();
        for setpoint in Requests::new(&view, Kind::Saturated, random.bits()).take(REQUESTS) {
            visit.sound(
                frame,
                &Request {
                    wrench: setpoint.wrench,
                    volts: setpoint.voltage_v,
                    health: Health::GOOD,
                },
            )?;
        }
        let mut draw = Draw {
            frame,
            health: Health::GOOD,
            random: &mut random,
        };
        visit.ask(&mut draw, [ATTAINABLE, NEIGHBOURS])?;
        self.mixes += visit.mixes;
        let failures = self.add(visit);
        for out in [1, 2] {
            for _ in 0..HEALTHS {
                let health = draw_health(&mut random, 2 * frame.physics.units(), out);
                let mut visit = Visit::new(specimen, index, out);
                if !is_level_attainable(frame, health)? {
                    continue;
                }
                let mut draw = Draw {
                    frame,
                    health,
                    random: &mut random,
                };
                visit.ask(&mut draw, [WITH_ROTORS_OUT; 2])?;
                self.mixes += visit.mixes;
                self.add(visit);
            }
        }
        Ok(failures)
    }

    /// Takes in a visit; returns the first failure of each check that allows none.
    fn add(&mut self, visit: Visit<'_>) -> Vec<Failure> {
        let mut failures = Vec::new();
        for (check, count) in visit.counts {
            if visit.rotors_out == 0 && check.limit().rate == 0.0 {
                failures.extend(count.kept.first().cloned());
            }
            let all = self
                .counts
                .entry((visit.rotors_out, check, visit.specimen.class))
                .or_default();
            all.looked += count.looked;
            all.missed += count.missed;
            all.worst = all.worst.max(count.worst);
            // One of each frame.
            let room = KEPT.saturating_sub(all.kept.len()).min(1);
            all.kept.extend(count.kept.into_iter().take(room));
        }
        failures
    }

    /// Examples of the checks that are missed too often, with `rotors_out` rotors out: of all checks
    /// where rotors are out, else of those that allow some misses, as [`Soak::frame`] has returned
    /// the others.
    pub fn misses(&self, rotors_out: usize) -> impl Iterator<Item = &Failure> {
        self.counts
            .iter()
            .filter(move |((out, check, _), count)| {
                let rate = check.limit().rate(rotors_out);
                *out == rotors_out && (rotors_out > 0 || rate > 0.0) && count.is_beyond(rate)
            })
            .flat_map(|(_, count)| &count.kept)
    }
}

impl Count {
    /// Too many misses: one is none where some are allowed.
    fn is_beyond(&self, rate: f64) -> bool {
        let allowed = if rate > 0.0 {
            (rate * self.looked as f64).max(1.0)
        } else {
            0.0
        };
        self.missed as f64 > allowed
    }
}

/// Per heading a table of checks: how often, of what, at worst, and in which classes.
impl fmt::Display for Soak {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (out, heading) in ["all rotors", "one rotor out", "two rotors out"]
            .into_iter()
            .enumerate()
        {
            writeln!(
                f,
                "{heading:<16} {:>10} {:>8} {:>10} {:>8}  classes",
                "looked at", "missed", "worst", "allowed"
            )?;
            for limit in &LIMITS {
                let of_check = |((o, check, _), _): &(&(usize, Check, Class), &Count)| {
                    *o == out && *check == limit.check
                };
                let counts: Vec<_> = self.counts.iter().filter(of_check).collect();
                let looked: usize = counts.iter().map(|(_, count)| count.looked).sum();
                if looked == 0 {
                    continue;
                }
                let missed: usize = counts.iter().map(|(_, count)| count.missed).sum();
                let worst = counts.iter().map(|(_, count)| count.worst).fold(0.0, f64::max);
                let rate = limit.rate(out);
                write!(
                    f,
                    "  {:<14} {looked:>10} {missed:>8} {worst:>10.2e} {rate:>8}",
                    limit.name
                )?;
                for ((_, _, class), count) in counts.iter().filter(|(_, count)| count.missed > 0) {
                    let mark = if count.is_beyond(rate) { "!" } else { "" };
                    write!(f, "  {class} {} of {}{mark}", count.missed, count.looked)?;
                }
                writeln!(f)?;
            }
        }
        Ok(())
    }
}

/// What is found of one frame with so many rotors out.
struct Visit<'a> {
    specimen: &'a Specimen,
    index: u64,
    rotors_out: usize,
    mixes: usize,
    counts: BTreeMap<Check, Count>,
}

impl<'a> Visit<'a> {
    fn new(specimen: &'a Specimen, index: u64, rotors_out: usize) -> Self {
        Visit {
            specimen,
            index,
            rotors_out,
            mixes: 0,
            counts: BTreeMap::new(),
        }
    }

    /// Counts a look at something of this size.
    fn look(&mut self, check: Check, size: f64, requests: &[Request], said: impl FnOnce() -> String) {
        let count = self.counts.entry(check).or_default();
        count.looked += 1;
        count.worst = count.worst.max(size);
        // What is not a number is a miss.
        let is_within = size <= check.limit().size;
        if !is_within {
            count.missed += 1;
            if count.kept.is_empty() {
                count.kept.push(Failure {
                    check,
                    class: self.specimen.class,
                    index: self.index,
                    size,
                    said: said(),
                    text: self.specimen.text.clone(),
                    requests: requests.to_vec(),
                });
            }
        }
    }

    /// The answer to a finite request.
    fn answer(&mut self, frame: &Frame, request: &Request) -> Option<Answer> {
        self.mixes += 1;
        let answer = request.mix(frame);
        let size = if answer.is_ok() { 0.0 } else { f64::INFINITY };
        self.look(Check::Answered, size, &[*request], || format!("{answer:?}"));
        answer.ok()
    }

    /// An answer that nothing excuses if it is unsound.
    fn sound(&mut self, frame: &Frame, request: &Request) -> Result<Option<Answer>, Error> {
        let Some(answer) = self.answer(frame, request) else {
            return Ok(None);
        };
        let allowed = Allowed {
            slack: Check::Overstepped.limit().size,
            ..Allowed::default()
        };
        let faults = soundness::faults(frame, request, &answer, allowed)?;
        for (kind, check) in [
            (soundness::Kind::Throttle, Check::Throttle),
            (soundness::Kind::Truth, Check::Truth),
            (soundness::Kind::Flag, Check::Flag),
            (soundness::Kind::Overstepped, Check::Overstepped),
            (soundness::Kind::Turned, Check::Turned),
            (soundness::Kind::Raised, Check::Raised),
        ] {
            let fault = faults.iter().find(|fault| fault.kind == kind);
            // A fault is one however small it is.
            let size = fault.map_or(0.0, |fault| fault.size.max(check.limit().size.next_up()));
            self.look(check, size, &[*request], || {
                fault.map_or(String::new(), ToString::to_string)
            });
        }
        Ok(Some(answer))
    }

    /// Wrenches of throttles, neighbours, and what linear programmes judge.
    fn ask(&mut self, draw: &mut Draw<'_>, [attainable, neighbours]: [usize; 2]) -> Result<(), Error> {
        let frame = draw.frame;
        for _ in 0..attainable {
            let request = draw.attainable();
            if let Some(answer) = self.sound(frame, &request)? {
                let size = missed(frame, &request, &answer);
                let achieved = answer.achieved;
                self.look(Check::Delivered, size, &[request], || {
                    format!("{achieved:?} is given")
                });
            }
        }
        let mut moved = 0;
        for _ in 0..neighbours {
            let [request, next] = draw.neighbours();
            let answers = (self.sound(frame, &request)?, self.answer(frame, &next));
            if let (Some(answer), Some(after)) = answers
                && moved < MOST_MOVED
            {
                moved += usize::from(self.follow(frame, [&request, &next], [&answer, &after])?);
            }
        }
        if self.index.is_multiple_of(JUDGED_FRAMES) && frame.physics.units() <= MOST_JUDGED_UNITS {
            for _ in 0..JUDGED {
                let request = draw.moderate();
                self.judge(frame, &request)?;
            }
        }
        Ok(())
    }

    /// From a request to the next one; true where throttles move far.
    fn follow(
        &mut self,
        frame: &Frame,
        requests: [&Request; 2],
        answers: [&Answer; 2],
    ) -> Result<bool, Error> {
        let pair = requests.map(|request| *request);
        let step = (0..4)
            .map(|axis| (answers[0].achieved[axis] - answers[1].achieved[axis]).abs() / frame.size(axis))
            .fold(0.0, f64::max);
        self.look(Check::Step, step, &pair, || {
            format!("from {:?} to {:?}", answers[0].achieved, answers[1].achieved)
        });
        let change = answers[0].change(answers[1]);
        let is_far = change > JUMP;
        // No oracle says which jumps are forced with rotors out.
        let is_free = is_far
            && (self.rotors_out > 0
                || matches!(Motion::between(frame, requests[0], requests[1])?, Motion::Jump(_)));
        self.look(
            Check::Jump,
            if is_free { f64::from(change) } else { 0.0 },
            &pair,
            || format!("throttles move by {change}"),
        );
        Ok(is_far)
    }

    /// Holds an answer to the linear programme.
    fn judge(&mut self, frame: &Frame, request: &Request) -> Result<(), Error> {
        let Some(answer) = self.answer(frame, request) else {
            return Ok(());
        };
        let factors = frame.physics.factors(request.volts);
        let oracle = |build: fn(&_, &_, _, _) -> Oracle| {
            build(&frame.physics, frame.allocation(), factors, request.health)
        };
        let limit = Check::Optimal.limit().size;
        let hulls = oracle(Oracle::new);
        let shortfall =
            Shortfall::beyond_hulls(&answer, request, frame, limit, &hulls, || oracle(Oracle::exact))?;
        if let Some(shortfall) = shortfall {
            self.look(Check::Optimal, shortfall.largest(), &[*request], || {
                format!("{shortfall:?}")
            });
        }
        Ok(())
    }
}

/// The largest entry of M M+ - I over the served axes, with rows and columns per authority.
fn off_identity(frame: &Frame) -> f64 {
    let effectiveness = &frame.compiled.effectiveness;
    let product = &effectiveness.matrix * &effectiveness.pseudo_inverse;
    let served: Vec<usize> = (0..4).filter(|&axis| frame.served()[axis]).collect();
    let entry = |i: usize, j: usize| {
        let one = if i == j { 1.0 } else { 0.0 };
        (product[(i, j)] - one).abs() * frame.size(j) / frame.size(i)
    };
    let entries = served.iter().flat_map(|&i| served.iter().map(move |&j| (i, j)));
    entries.map(|(i, j)| entry(i, j)).fold(0.0, f64::max)
}

/// What a served axis misses most, as a share of its authority, beside the tolerance.
fn missed(frame: &Frame, request: &Request, answer: &Answer) -> f64 {
    let tolerance = frame.compiled.tables.tolerance.wrench.map(f64::from);
    (0..4)
        .filter(|&axis| frame.served()[axis])
        .map(|axis| {
            let missed = (request.asked()[axis] - answer.achieved[axis]).abs();
            (missed - tolerance[axis]) / frame.size(axis)
        })
        .fold(0.0, f64::max)
}

fn draw_health(random: &mut Random, rotors: usize, out: usize) -> Health {
    let mut channels: Vec<u8> = (0..rotors as u8).collect();
    random.shuffle(&mut channels);
    channels
        .iter()
        .take(out)
        .fold(Health::GOOD, |health, &channel| health.with_failed(channel))
}

/// True where roll, pitch and yaw can be zero without these rotors, at the middle of the voltage
/// range.
fn is_level_attainable(frame: &Frame, health: Health) -> Result<bool, Error> {
    let [low, high] = frame.physics.voltage_range().unwrap_or_default();
    let factors = frame.physics.factors(low.midpoint(high) as f32);
    let oracle = Oracle::new(&frame.physics, frame.allocation(), factors, health);
    Ok(oracle.thrust_floor(0.0)?.is_some())
}
