//! A flight: the world, who flies it, and its record.

use std::time::{Duration, Instant};

use super::arguments::Arguments;
use super::pilot::Pilot;
use super::record::Record;
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

/// What both stacks fly.
#[derive(Debug)]
pub struct Flight {
    /// The vehicle in its place.
    pub world: World,
    /// The pilot, or who feeds PX4's battery.
    pub pilot: Option<Pilot>,
    /// The record.
    pub record: Record,
    end_s: Option<f64>,
    speed: f64,
    begun: Option<Instant>,
}

impl Flight {
    /// A flight that begins on the ground.
    pub fn new(vehicle: Vehicle, pilot: Option<Pilot>, arguments: &Arguments) -> Flight {
        Flight {
            world: World::new(vehicle),
            pilot,
            record: Record::default(),
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
            pilot.update(&mut self.world)?;
        }
        self.record.take(&self.world, self.pilot.as_ref(), throttles);
        if let Some(crashed_s) = self.world.crashed_s {
            return Ok(Some(End::Crashed(crashed_s)));
        }
        let is_over = self.end_s.is_some_and(|end_s| time_s >= end_s);
        let is_flown = self.pilot.as_ref().is_some_and(|pilot| pilot.is_done(time_s));
        Ok((is_over || is_flown).then_some(End::Done))
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
