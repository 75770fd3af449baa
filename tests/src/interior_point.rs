//! A second allocator, as unlike the mixer's as can be: an interior point method on the throttles.
//!
//! It minimises the cost of what a request falls short of, over the throttles of the rotors that
//! work and by the airframe file's own polynomials, in f64. It knows no polygon, no inverse map and
//! no linear programme. So what it reaches is attainable, also with rotors out, where the linear
//! programmes of [`optimum`](crate::optimum) range over hulls that nobody reaches. The sets are not
//! convex, so its optimum is a local one.
//!
//! Unknowns are x in (0, 1) per rotor, whose throttle is sqrt(min^2 + x (max^2 - min^2)), and per
//! shortage s; lambda is the multiplier of the four rows. An iteration is one step of Newton's
//! method on the conditions of
//!
//! ```text
//! least  sum_j c_j s_j - mu (barriers of all x and s)   with  sum_i B_i y_i(x) + sum_j a_j s_j = w
//! ```
//!
//! with all unknowns but lambda eliminated, so that a 4 by 4 system is left.

use mixer_rt::tables::Airmode;
use nalgebra::{Matrix4, Vector4};

use crate::request::{Frame, Request};

/// Iterations; the barrier's weight in the first, its fall from one to the next, and its least.
const ITERATIONS: usize = 60;
const FIRST: f64 = 60.0;
const FALL: f64 = 0.766;
const LEAST: f64 = 1e-4;

/// Steps at the end that meet the rows with the shortages as they are.
const CORRECTIONS: usize = 10;

/// Share of the way to the nearest bound.
const SHARE: f64 = 0.97;

/// Keeps the system regular where a row is not served.
const LEAST_PIVOT: f64 = 1e-9;

/// Costs per row: of thrust in its two places of the order, of roll and pitch, of thrust that
/// nothing may raise, and of the reserve of yaw.
const THRUST: f64 = 20.0;
const ROLL_PITCH: f64 = 400.0;
const FORBIDDEN: f64 = 2000.0;
const RESERVE: f64 = 10_000.0;

/// An unknown between 0 and 1, with what the last iteration found.
struct Unknown {
    x: f64,
    /// Rows per unit of x.
    column: Vector4<f64>,
    /// The step without a change of lambda, and per unit of that change along the column.
    step: f64,
    response: f64,
}

impl Unknown {
    fn new(x: f64, column: Vector4<f64>) -> Self {
        Unknown {
            x,
            column,
            step: 0.0,
            response: 0.0,
        }
    }

    /// Eliminates it: `gain` is what more of it is worth, `curvature` how fast that falls.
    fn eliminate(&mut self, gain: f64, curvature: f64, mu: f64) {
        let (low, high) = (self.x, 1.0 - self.x);
        let span = low * high;
        // The distance from the bound that the gain does not lead to.
        let from = if gain > 0.0 { low } else { high };
        let scale = from / (from * (gain.abs() * from + curvature * span) + mu);
        self.response = span * scale;
        self.step = (gain * span + mu * (high - low)) * scale;
    }
}

/// The unknowns of a request.
struct Problem<'a> {
    frame: &'a Frame,
    factors: [f64; 2],
    /// Rows per N m and N.
    rows: [f64; 4],
    wanted: Vector4<f64>,
    /// Unit, side (0 upper) and unknown of each rotor that works.
    rotors: Vec<(usize, usize, Unknown)>,
    /// Shortages, and their costs.
    shortages: Vec<(Unknown, f64)>,
}

/// The wrench (`[roll, pitch, yaw, thrust]`, N m, N) that it reaches for a request.
pub fn allocate(frame: &Frame, request: &Request) -> [f64; 4] {
    let mut problem = Problem::new(frame, request);
    let mut lambda = Vector4::zeros();
    let mut inverse = Matrix4::identity();
    let mut mu = FIRST;
    for _ in 0..ITERATIONS {
        inverse = problem.iterate(&mut lambda, mu);
        mu = (mu * FALL).max(LEAST);
    }
    for _ in 0..CORRECTIONS {
        problem.correct(&inverse);
    }
    problem.given()
}

impl<'a> Problem<'a> {
    fn new(frame: &'a Frame, request: &Request) -> Self {
        let physics = &frame.physics;
        let n = physics.units() as f64;
        let (served, authority) = (frame.served(), frame.authority);
        let rows: [f64; 4] = std::array::from_fn(|axis| {
            if served[axis] && authority[axis] > 0.0 {
                n / authority[axis]
            } else {
                0.0
            }
        });
        let asked = request.asked();
        let wanted = Vector4::from_fn(|axis, _| rows[axis] * asked[axis]);
        let working = physics.channels.iter().enumerate().flat_map(|(unit, channels)| {
            let works = |side: &usize| !request.health.has_failed(channels[*side] as u8);
            (0..2).filter(works).map(move |side| (unit, side))
        });
        let rotors = working
            .map(|(unit, side)| (unit, side, Unknown::new(0.5, Vector4::zeros())))
            .collect();
        Problem {
            frame,
            factors: physics.factors(request.volts),
            rows,
            wanted,
            rotors,
            shortages: shortages(frame, wanted, frame.allocation().yaw_reserve_nm * rows[2], n),
        }
    }

    /// The throttle at x.
    fn throttle(&self, x: f64) -> f64 {
        let range = self.frame.physics.pair.range();
        let [low, high] = range.map(|throttle| throttle * throttle);
        (low + x * (high - low)).sqrt()
    }

    /// Throttles `[u, l]` per unit; 0 for a rotor that is out.
    fn throttles(&self) -> Vec<[f64; 2]> {
        let mut throttles = vec![[0.0; 2]; self.frame.physics.units()];
        for (unit, side, unknown) in &self.rotors {
            throttles[*unit][*side] = self.throttle(unknown.x);
        }
        throttles
    }

    /// The wrench of all units, N m and N.
    fn given(&self) -> [f64; 4] {
        let physics = &self.frame.physics;
        let efforts = self.throttles().into_iter().map(|unit| physics.given(unit));
        physics.wrench_of(efforts, self.factors)
    }

    fn in_rows(&self, wrench: [f64; 4]) -> Vector4<f64> {
        Vector4::from_fn(|axis, _| self.rows[axis] * wrench[axis])
    }

    /// The wanted rows less those of units and shortages.
    fn residual(&self) -> Vector4<f64> {
        let shortages = self.shortages.iter();
        let short: Vector4<f64> = shortages.map(|(short, _)| short.column * short.x).sum();
        self.wanted - self.in_rows(self.given()) - short
    }

    /// First and second derivative of the rows by a rotor's unknown.
    fn derivatives(&self, rotor: usize) -> [Vector4<f64>; 2] {
        let physics = &self.frame.physics;
        let (unit, side, unknown) = &self.rotors[rotor];
        let mut throttles = self.throttles()[*unit];
        let h = 1e-4_f64.min(0.5 * unknown.x).min(0.5 * (1.0 - unknown.x));
        let [less, at, more] = [-h, 0.0, h].map(|change| {
            throttles[*side] = self.throttle(unknown.x + change);
            self.in_rows(physics.contribution(*unit, physics.given(throttles), self.factors))
        });
        [(more - less) / (2.0 * h), (more - 2.0 * at + less) / (h * h)]
    }

    /// One iteration; returns the inverse of its system.
    fn iterate(&mut self, lambda: &mut Vector4<f64>, mu: f64) -> Matrix4<f64> {
        for rotor in 0..self.rotors.len() {
            let [first, second] = self.derivatives(rotor);
            let unknown = &mut self.rotors[rotor].2;
            unknown.column = first;
            unknown.eliminate(lambda.dot(&first), (-lambda.dot(&second)).max(0.0), mu);
        }
        for (short, cost) in &mut self.shortages {
            short.eliminate(lambda.dot(&short.column) - *cost, 0.0, mu);
        }
        let mut system = Matrix4::identity() * LEAST_PIVOT;
        let mut residual = self.residual();
        for unknown in self.unknowns() {
            system += unknown.column * unknown.column.transpose() * unknown.response;
            residual -= unknown.column * unknown.step;
        }
        let inverse = system.try_inverse().unwrap_or_else(Matrix4::zeros);
        let change = inverse * residual;
        *lambda += change;
        let steps = |unknown: &Unknown| unknown.step + unknown.response * unknown.column.dot(&change);
        self.advance(steps, true);
        inverse
    }

    /// Moves the throttles to meet the rows, the shortages as they are.
    fn correct(&mut self, inverse: &Matrix4<f64>) {
        let change = inverse * self.residual();
        self.advance(|unknown| unknown.response * unknown.column.dot(&change), false);
    }

    fn unknowns(&self) -> impl Iterator<Item = &Unknown> {
        let shortages = self.shortages.iter().map(|(short, _)| short);
        self.rotors.iter().map(|(_, _, rotor)| rotor).chain(shortages)
    }

    /// Makes the same share of all steps, so that nothing comes to its bound.
    fn advance(&mut self, step: impl Fn(&Unknown) -> f64, with_shortages: bool) {
        let rotors = self.rotors.iter_mut().map(|(_, _, rotor)| rotor);
        let shortages = self.shortages.iter_mut().map(|(short, _)| short);
        let moved: Vec<(&mut Unknown, f64)> = rotors
            .chain(shortages.filter(|_| with_shortages))
            .map(|unknown| {
                let step = step(unknown);
                (unknown, step)
            })
            .collect();
        let most = moved.iter().map(|(unknown, step)| {
            let room = if *step > 0.0 { 1.0 - unknown.x } else { unknown.x };
            step.abs() / room
        });
        let share = SHARE / most.fold(SHARE, f64::max);
        for (unknown, step) in moved {
            unknown.x = (unknown.x + share * step).clamp(1e-12, 1.0 - 1e-12);
        }
    }
}

/// The shortages of a request in rows, with their costs: of roll and pitch together, of thrust, of
/// yaw beyond the reserve, and of the reserve; and the excess of thrust.
fn shortages(frame: &Frame, wanted: Vector4<f64>, reserve: f64, units: f64) -> Vec<(Unknown, f64)> {
    let airmode = frame.allocation().airmode;
    let (thrust_cost, yaw_cost) = match airmode {
        Airmode::RollPitchYaw => (1.0, THRUST),
        _ => (THRUST, 1.0),
    };
    let excess_cost = match airmode {
        Airmode::Disabled => FORBIDDEN,
        _ => thrust_cost,
    };
    let least = |width: f64| width.max(1e-3);
    let size = (wanted[0] * wanted[0] + wanted[1] * wanted[1]).sqrt();
    let along = if size > 0.0 {
        [wanted[0] / size, wanted[1] / size]
    } else {
        [1.0, 0.0]
    };
    let yaw = wanted[2].signum();
    let kept = reserve.min(wanted[2].abs());
    let beyond = wanted[2].abs() - kept;
    let all = [
        ([along[0], along[1], 0.0, 0.0], least(size), ROLL_PITCH),
        ([0.0, 0.0, 0.0, 1.0], least(wanted[3]), thrust_cost),
        ([0.0, 0.0, 0.0, -1.0], least(1.1 * units - wanted[3]), excess_cost),
        ([0.0, 0.0, yaw, 0.0], least(beyond), yaw_cost),
        ([0.0, 0.0, yaw, 0.0], least(kept), RESERVE),
    ];
    all.into_iter()
        .map(|(direction, width, cost)| {
            let column = Vector4::from(direction) * width;
            let cost = cost * width;
            (Unknown::new(0.5 - 0.45 * cost / (20.0 + cost), column), cost)
        })
        .collect()
}
