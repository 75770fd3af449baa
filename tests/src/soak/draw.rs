//! Requests to any frame.

use mixer_rt::Health;
use mixer_setpoints::Random;

use crate::request::{Frame, Request};

/// Relative distance of a request to its neighbour.
const NEXT: f32 = 1e-4;

/// Draws requests to one frame, with these rotors out.
pub(super) struct Draw<'a> {
    pub(super) frame: &'a Frame,
    pub(super) health: Health,
    pub(super) random: &'a mut Random,
}

impl Draw<'_> {
    /// What throttles in the box give.
    pub(super) fn attainable(&mut self) -> Request {
        let conditions = self.conditions();
        self.of_throttles(conditions, 1.0)
    }

    fn conditions(&mut self) -> (f32, Option<f32>) {
        let volts = self.frame.draw_volts(self.random);
        (volts, self.frame.draw_density(self.random))
    }

    fn of_throttles(&mut self, (volts, density): (f32, Option<f32>), factor: f64) -> Request {
        let Draw {
            frame,
            random,
            health,
        } = self;
        let rotors = frame.physics.rotors();
        let shares: Vec<f64> = (0..rotors).map(|_| random.uniform(0.0, 1.0)).collect();
        let throttles = frame.physics.throttles(shares.into_iter(), *health);
        let factors = frame.physics.factors_in(volts, density);
        let wrench = frame.physics.wrench_in(&throttles, factors);
        Request {
            wrench: wrench.map(|value| (factor * value) as f32),
            volts,
            density,
            health: *health,
        }
    }

    /// As a controller in trouble asks: up to three times the authority, near what is attainable,
    /// with some torques zero, or yaw alone as an idle stick asks.
    pub(super) fn moderate(&mut self) -> Request {
        let conditions @ (volts, density) = self.conditions();
        let kind = self.random.below(6);
        let mut request = match kind {
            0 | 1 => {
                let factor = self.random.uniform(0.8, 1.3);
                self.of_throttles(conditions, factor)
            }
            2 => self.frame.draw(self.random, 3.0, volts),
            _ => self.frame.draw(self.random, 0.6, volts),
        };
        match kind {
            4 => request.wrench[self.random.below(3)] = 0.0,
            5 => {
                let yaw = self.frame.authority[2] * self.random.uniform(-3.0, 3.0);
                request.wrench = [0.0, 0.0, yaw as f32, request.wrench[3]];
            }
            _ => {}
        }
        request.density = density;
        request.health = self.health;
        request
    }

    /// A request and the next one: one axis or all a little larger.
    pub(super) fn neighbours(&mut self) -> [Request; 2] {
        let request = self.moderate();
        let moved = self.random.below(5);
        let mut next = request;
        for (axis, value) in next.wrench.iter_mut().enumerate() {
            if moved == 4 || moved == axis {
                *value *= 1.0 + NEXT;
            }
        }
        [request, next]
    }
}
