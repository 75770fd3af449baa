//! Frames of the zoo and requests without end, each answer held to the physics of the airframe file
//! in f64. `cargo soak` runs it for minutes or hours, `tests/soak.rs` for some seconds.

mod draw;
mod failure;
pub mod jumps;
pub mod limits;
mod visit;

use std::collections::BTreeMap;
use std::fmt;

use microlp::Error;
use mixer_compiler::Source;
use mixer_compiler::diagnostic::Severity;
use mixer_rt::Health;
use mixer_setpoints::{Random, RequestKind, Requests};

use crate::frames::zoo::{Class, REFUSALS, Specimen, Zoo};
use crate::request::{Frame, Request};
use draw::Draw;
pub use failure::Failure;
use limits::{Check, LIMITS};
use visit::{Count, Visit, is_level_attainable, off_identity};

/// Requests of every kind per frame, wrenches of throttles, and pairs of neighbours.
const REQUESTS: usize = 800;
const ATTAINABLE: usize = 1000;
const NEIGHBOURS: usize = 400;

/// States of health with one rotor out and with two per frame, and requests of each kind to each.
const HEALTHS: usize = 2;
const WITH_ROTORS_OUT: usize = 50;

/// Misses of one check that are kept with what reproduces them, per class.
const KEPT: usize = 3;

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
        for setpoint in Requests::new(&view, RequestKind::Saturated, random.bits()).take(REQUESTS) {
            visit.sound(
                frame,
                &Request {
                    wrench: setpoint.wrench,
                    volts: setpoint.voltage_v,
                    density: frame.physics.density_range().map(|_| setpoint.density_kg_m3),
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
                let health = draw_health(&mut random, frame.compiled.tables.channels(), out);
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

    /// Examples of the checks that are missed too often: with rotors out of all, else of those that
    /// allow some misses, as [`Soak::frame`] has returned the others.
    pub fn misses(&self) -> impl Iterator<Item = &Failure> {
        let is_beyond = |out: usize, check: Check| {
            let rate = check.limit().rate(out);
            (out > 0 || rate > 0.0) && self.count(out, check).is_beyond(rate)
        };
        self.counts
            .iter()
            .filter(move |((out, check, _), _)| is_beyond(*out, *check))
            .flat_map(|(_, count)| &count.kept)
    }

    /// Of all classes together, with none of the misses kept.
    fn count(&self, out: usize, check: Check) -> Count {
        let mut all = Count::default();
        let is_of = |(o, c, _): &(usize, Check, Class)| (*o, *c) == (out, check);
        for (_, count) in self.counts.iter().filter(|(key, _)| is_of(key)) {
            all.looked += count.looked;
            all.missed += count.missed;
            all.worst = all.worst.max(count.worst);
        }
        all
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
                let all = self.count(out, limit.check);
                if all.looked == 0 {
                    continue;
                }
                let rate = limit.rate(out);
                let mark = if all.is_beyond(rate) { "!" } else { " " };
                write!(
                    f,
                    "  {:<14} {:>10} {:>7}{mark} {:>10.2e} {rate:>8}",
                    limit.name, all.looked, all.missed, all.worst
                )?;
                for ((o, check, class), count) in &self.counts {
                    if (*o, *check) == (out, limit.check) && count.missed > 0 {
                        write!(f, "  {class} {} of {}", count.missed, count.looked)?;
                    }
                }
                writeln!(f)?;
            }
        }
        Ok(())
    }
}

fn draw_health(random: &mut Random, rotors: usize, out: usize) -> Health {
    let mut channels: Vec<u8> = (0..rotors as u8).collect();
    random.shuffle(&mut channels);
    channels
        .iter()
        .take(out)
        .fold(Health::GOOD, |health, &channel| health.with_failed(channel))
}
