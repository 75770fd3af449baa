//! What is looked at on one frame.

use std::collections::BTreeMap;

use microlp::Error;
use mixer_rt::Health;

use super::draw::Draw;
use super::failure::Failure;
use super::limits::Check;
use crate::frames::zoo::Specimen;
use crate::optimum::Oracle;
use crate::request::{Answer, Frame, Request};
use crate::shortfall::Shortfall;
use crate::soundness;

/// Requests per state of health that are judged by linear programmes, and of how many frames one is.
const JUDGED: usize = 2;
const JUDGED_FRAMES: u64 = 4;

/// Rays of growing torques per state of health with rotors out, and requests along each.
const RAYS: usize = 8;
const STEPS: u8 = 20;

/// Units beyond which they are not: a programme takes seconds.
const MOST_JUDGED_UNITS: usize = 8;

/// How often something was looked at and missed.
#[derive(Clone, Debug, Default)]
pub(super) struct Count {
    pub(super) looked: usize,
    pub(super) missed: usize,
    pub(super) worst: f64,
    /// Misses with what reproduces them.
    pub(super) kept: Vec<Failure>,
}

impl Count {
    /// Too many misses: one is none where some are allowed.
    pub(super) fn is_beyond(&self, rate: f64) -> bool {
        let allowed = if rate > 0.0 {
            (rate * self.looked as f64).max(1.0)
        } else {
            0.0
        };
        self.missed as f64 > allowed
    }
}

/// What is found of one frame with so many rotors out.
pub(super) struct Visit<'a> {
    pub(super) specimen: &'a Specimen,
    index: u64,
    pub(super) rotors_out: usize,
    pub(super) mixes: usize,
    pub(super) counts: BTreeMap<Check, Count>,
}

impl<'a> Visit<'a> {
    pub(super) fn new(specimen: &'a Specimen, index: u64, rotors_out: usize) -> Self {
        Visit {
            specimen,
            index,
            rotors_out,
            mixes: 0,
            counts: BTreeMap::new(),
        }
    }

    /// Counts a look at something of this size.
    pub(super) fn look(
        &mut self,
        check: Check,
        size: f64,
        requests: &[Request],
        said: impl FnOnce() -> String,
    ) {
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
    pub(super) fn sound(&mut self, frame: &Frame, request: &Request) -> Result<Option<Answer>, Error> {
        let Some(answer) = self.answer(frame, request) else {
            return Ok(None);
        };
        let faults = soundness::faults(frame, request, &answer)?;
        for (kind, check) in [
            (soundness::FaultKind::Throttle, Check::Throttle),
            (soundness::FaultKind::Truth, Check::Truth),
            (soundness::FaultKind::Flag, Check::Flag),
            (soundness::FaultKind::Overstepped, Check::Overstepped),
            (soundness::FaultKind::Turned, Check::Turned),
            (soundness::FaultKind::Raised, Check::Raised),
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
    pub(super) fn ask(
        &mut self,
        draw: &mut Draw<'_>,
        [attainable, neighbours]: [usize; 2],
    ) -> Result<(), Error> {
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
        for _ in 0..neighbours {
            let [request, next] = draw.neighbours();
            let answers = (self.sound(frame, &request)?, self.answer(frame, &next));
            if let (Some(answer), Some(after)) = answers {
                self.follow(frame, [&request, &next], [&answer, &after]);
            }
        }
        for _ in 0..if self.rotors_out > 0 { RAYS } else { 0 } {
            let request = draw.moderate();
            self.grow(frame, &request)?;
            self.leave_yaw_last(frame, &request)?;
        }
        if self.index.is_multiple_of(JUDGED_FRAMES) && frame.physics.units() <= MOST_JUDGED_UNITS {
            for _ in 0..JUDGED {
                let request = draw.moderate();
                self.judge(frame, &request)?;
            }
        }
        Ok(())
    }

    /// From a request to the next one.
    fn follow(&mut self, frame: &Frame, requests: [&Request; 2], answers: [&Answer; 2]) {
        let pair = requests.map(|request| *request);
        let step = (0..4)
            .filter(|&axis| frame.served()[axis])
            .map(|axis| (answers[0].achieved[axis] - answers[1].achieved[axis]).abs() / frame.size(axis))
            .fold(0.0, f64::max);
        self.look(Check::Step, step, &pair, || {
            format!("from {:?} to {:?}", answers[0].achieved, answers[1].achieved)
        });
        let change = answers[0].change(answers[1]);
        self.look(Check::Jump, f64::from(change), &pair, || {
            format!("throttles move by {change}")
        });
    }

    /// Roll and pitch that grow at one thrust and one yaw: a smaller answer stays attainable, so that one that gives less
    /// is no optimum, and no programme is needed to see it. Yaw must not grow with them: a reserve then comes before thrust
    /// by more, and has its price in roll and pitch.
    fn grow(&mut self, frame: &Frame, request: &Request) -> Result<(), Error> {
        let [roll, pitch, ..] = request.asked();
        let size = (roll * roll + pitch * pitch).sqrt() * frame.size(0).min(frame.size(1));
        let mut best = (f64::NEG_INFINITY, *request);
        for step in 1..=STEPS {
            let mut larger = *request;
            let torques = larger.wrench.iter_mut().take(2);
            torques.for_each(|torque| *torque *= f32::from(step) / f32::from(STEPS));
            let Some(answer) = self.answer(frame, &larger).filter(|_| size > 0.0) else {
                return Ok(());
            };
            let given = (answer.achieved[0] * roll + answer.achieved[1] * pitch) / size;
            let (most, smaller) = best;
            if given >= most {
                best = (given, larger);
            }
            let lost = most - given;
            // Else thrust is given up first.
            let is_excused = lost > Check::Grown.limit().size && !has_level(frame, &smaller)?;
            let lost = if is_excused { 0.0 } else { lost.max(0.0) };
            self.look(Check::Grown, lost, &[smaller, larger], || {
                format!("{lost} of the authority is lost")
            });
        }
        Ok(())
    }

    /// Yaw asked beside the rest of a wrench takes nothing of it that comes before yaw, and so does none: a smaller answer
    /// stays attainable whatever yaw is asked.
    fn leave_yaw_last(&mut self, frame: &Frame, request: &Request) -> Result<(), Error> {
        let allocation = frame.allocation();
        if allocation.airmode.is_yaw_first() || allocation.yaw_reserve_nm > 0.0 {
            return Ok(());
        }
        let mut without = *request;
        without.wrench[2] = 0.0;
        let (Some(answer), Some(free)) = (self.answer(frame, request), self.answer(frame, &without)) else {
            return Ok(());
        };
        let missed = |answer: &Answer, axis: usize| (answer.achieved[axis] - request.asked()[axis]).abs();
        let lost = |axis: usize| (missed(&answer, axis) - missed(&free, axis)).abs() / frame.size(axis);
        let lost = [0, 1, 3]
            .into_iter()
            .filter(|axis| frame.served()[*axis])
            .map(lost)
            .fold(0.0, f64::max);
        let is_excused = lost > Check::YawLast.limit().size && !has_level(frame, request)?;
        let size = if is_excused { 0.0 } else { lost };
        self.look(Check::YawLast, size, &[*request, without], || {
            format!("{:?} with yaw, {:?} without", answer.achieved, free.achieved)
        });
        Ok(())
    }

    /// Holds an answer to the linear programme.
    fn judge(&mut self, frame: &Frame, request: &Request) -> Result<(), Error> {
        let Some(answer) = self.answer(frame, request) else {
            return Ok(());
        };
        let factors = request.factors(frame);
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
pub(super) fn off_identity(frame: &Frame) -> f64 {
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

/// True where level flight at the thrust asked is attainable, with rotors out at any yaw.
fn has_level(frame: &Frame, request: &Request) -> Result<bool, Error> {
    let factors = request.factors(frame);
    let oracle = Oracle::exact(&frame.physics, frame.allocation(), factors, request.health);
    let [.., yaw, thrust] = request.asked();
    oracle.has_level(yaw, thrust)
}

/// True where roll and pitch can be zero without these rotors, at the middle of the voltage range.
pub(super) fn is_level_attainable(frame: &Frame, health: Health) -> Result<bool, Error> {
    let [low, high] = frame.physics.voltage_range().unwrap_or_default();
    let factors = frame.physics.factors(low.midpoint(high) as f32);
    let oracle = Oracle::new(&frame.physics, frame.allocation(), factors, health);
    Ok(oracle.thrust_floor(0.0)?.is_some())
}
