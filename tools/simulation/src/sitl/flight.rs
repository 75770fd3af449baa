//! A flight: the world, who flies it, and its record.

use std::net::SocketAddr;
use std::time::{Duration, Instant};

use super::arguments::{Arguments, Failure};
use super::pilot::Pilot;
use super::plan::{FIRST_S, Manoeuvre};
use super::record::Record;
use super::sensors::Sensors;
use super::vehicle::{Throttles, Vehicle};
use super::world::World;

/// How a flight ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// As it was meant to.
    Done,
    /// On the ground, at that time, s.
    Crashed(f64),
}

/// Serves a stack until its flight ends, or says why it cannot go on: a client that vanishes, a pilot who gives up.
pub type Serve = Box<dyn FnOnce(&mut Flight, &mut Sensors) -> Result<End, String>>;

/// A port on which a stack is waited for.
pub struct Port {
    /// The stack and the kind of port.
    pub name: &'static str,
    /// Its address.
    pub address: std::io::Result<SocketAddr>,
    /// Who flies a manoeuvre.
    pub pilot: Box<dyn Pilot>,
    /// Serves the stack once it has come.
    pub serve: Serve,
}

/// A flight under way, the same for all stacks.
#[derive(Debug)]
pub struct Flight {
    /// The vehicle in its place.
    pub world: World,
    /// The pilot, or who feeds PX4's battery.
    pub pilot: Option<Box<dyn Pilot>>,
    /// The record.
    pub record: Record,
    /// Time of the manoeuvre, or without one of the simulation, at which a rotor stopped, s.
    pub failed_s: Option<f64>,
    failure: Option<Failure>,
    end_s: Option<f64>,
    speed: f64,
    begun: Option<Instant>,
}

impl Flight {
    /// A flight that begins on the ground.
    pub fn new(vehicle: Vehicle, pilot: Option<Box<dyn Pilot>>, arguments: &Arguments) -> Flight {
        let stops_by_itself = arguments.fly == Some(Manoeuvre::Failure);
        let failure = arguments.fail.or(stops_by_itself.then_some(Failure {
            output: 0,
            time_s: FIRST_S,
        }));
        Flight {
            world: World::new(vehicle),
            pilot,
            record: Record::default(),
            failed_s: None,
            failure,
            end_s: arguments.seconds,
            speed: arguments.speed,
            begun: None,
        }
    }

    /// Flies on under throttles, and says when it is over.
    ///
    /// # Errors
    /// A pilot who gives up.
    pub fn advance(&mut self, throttles: &Throttles, duration_us: u64) -> Result<Option<End>, String> {
        self.world.advance(throttles, duration_us);
        let time_s = self.world.time_s();
        self.wait(time_s);
        if let Some(pilot) = &mut self.pilot {
            pilot.update(&self.world)?;
        }
        self.fail(time_s);
        self.record.take(&self.world, self.pilot.as_deref(), throttles);
        if let Some(crashed_s) = self.world.crashed_s {
            return Ok(Some(End::Crashed(crashed_s)));
        }
        let is_over = self.end_s.is_some_and(|end_s| time_s >= end_s);
        let is_flown = self.pilot.as_ref().is_some_and(|pilot| pilot.is_done(time_s));
        Ok((is_over || is_flown).then_some(End::Done))
    }

    /// Stops the rotor when its time has come.
    fn fail(&mut self, time_s: f64) {
        let pilot = self.pilot.as_ref().filter(|pilot| pilot.plan().is_some());
        let clock_s = pilot.map_or(Some(time_s), |pilot| pilot.manoeuvre_s(time_s));
        let (Some(failure), Some(clock_s)) = (self.failure, clock_s) else {
            return;
        };
        if clock_s < failure.time_s {
            return;
        }
        self.failure = None;
        self.failed_s = Some(clock_s);
        self.world.stop(failure.output);
        eprintln!("{time_s:8.2} s  the rotor on output {} stops", failure.output);
        if let Some(pilot) = &mut self.pilot {
            pilot.inject(failure.output);
        }
    }

    /// Puts the vehicle back to its start, for a stack that has started anew. Time goes on.
    ///
    /// # Errors
    /// A manoeuvre: its pilot's stack has gone.
    pub fn restart(&mut self) -> Result<(), String> {
        if self.pilot.is_some() {
            return Err("the stack has started anew, its flight is over".to_owned());
        }
        let time_us = self.world.time_us;
        self.world = World::new(self.world.vehicle.clone());
        self.world.time_us = time_us;
        Ok(())
    }

    /// Lets real time catch up.
    fn wait(&mut self, time_s: f64) {
        if self.speed <= 0.0 {
            return;
        }
        let begun = *self.begun.get_or_insert_with(Instant::now);
        let due = begun + Duration::from_secs_f64(time_s / self.speed);
        let early = due.saturating_duration_since(Instant::now());
        // Sleeping is no finer than this.
        if early > Duration::from_millis(1) {
            std::thread::sleep(early);
        }
    }
}
