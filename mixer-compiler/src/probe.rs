//! Probes of what is emitted: the tables are run through `mixer-rt` and compared with the physics of
//! the airframe file in f64.
//!
//! The proof holds for the inverse map of one unit. M+, the sides of the closed form, channels and
//! signs come after it. A fault of the compiler in any of these gives an airframe that
//! compiles and flies wrong, so the whole mixer is tried before the compiler says yes:
//!
//! ```text
//! border      points on the sides of the closed form are attainable; no more area is lost than stated
//! wrenches    each axis both ways and mixtures, small and large, at three thrusts, and at the ends of
//!             the ranges of voltage and density
//! rotors out  every rotor alone, and pairs of rotors: level flight and torques from there
//! ```
//!
//! A wrench is delivered, or flagged and, with one rotor out at most, sound: no torque reversed or exceeded (with a rotor out
//! yaw may be), the direction of (roll, pitch) kept, with airmode disabled and all rotors no more thrust than asked and than costs
//! trade for roll and pitch, and with a rotor out no thrust given up for yaw. It has to be delivered where the throttles of
//! least norm are well inside their range. The physics ([`Compiled::physics`]) know nothing of M: they add forces and torques unit by unit.

mod border;

use mixer_rt::tables::Airmode;
use mixer_rt::{Axis, Conditions, Health, Saturation, Wrench};

use crate::airframe::Correction;
use crate::compiled::Compiled;
use crate::diagnostic::{Code, Diagnostic};
use crate::model::scales;

/// Share of an axis' authority by which a flagged wrench may be exceeded, reversed or off its
/// direction. Faults of the tables are off by more. Curves of single rotors, and level flight of tilted
/// axes under conditions beside the bench's, are met to a few tenths of a percent.
const SOUND: f64 = 1e-2;

/// Share of its authority by which airmode disabled may raise the thrust, per share of roll and pitch that is given: the ratio
/// of their costs, which tells where units lean or differ.
const RAISED: f64 = 0.2;

/// Thrusts that are probed, as shares of the range of level flight.
const THRUSTS: [f64; 3] = [0.2, 0.5, 0.8];

/// Sizes of the torques, as shares of the authority: one that most frames deliver, one that none
/// does.
const SIZES: [f64; 2] = [0.2, 1.0];

/// Signs of roll, pitch and yaw: each axis both ways, then mixtures.
const DIRECTIONS: [[f64; 3]; 14] = [
    [1.0, 0.0, 0.0],
    [-1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, -1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.0, 0.0, -1.0],
    [1.0, 1.0, 1.0],
    [1.0, 1.0, -1.0],
    [1.0, -1.0, 1.0],
    [1.0, -1.0, -1.0],
    [-1.0, 1.0, 1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [-1.0, -1.0, -1.0],
];

/// Distance from idle and from the ceiling, as a share of the range, from which a throttle is well
/// inside.
const INSIDE: f32 = 0.05;

/// Most pairs of rotors out that are probed, taken evenly from all.
const MOST_PAIRS: usize = 28;

/// Runs the probes.
///
/// # Errors
/// The first one that fails: a fault of the compiler.
pub(crate) fn run(compiled: &Compiled) -> Result<(), Vec<Diagnostic>> {
    border::check(compiled)
        .and_then(|()| probe_whole(compiled))
        .and_then(|()| probe_rotors_out(compiled))
        .map_err(|message| {
            vec![compiled.airframe.diagnostic(
                Code::Probe,
                "name",
                message,
                "",
                "this is a fault of the compiler, not of the file: please report it with the file",
            )]
        })
}

/// Wrenches with all rotors.
fn probe_whole(compiled: &Compiled) -> Result<(), String> {
    // All thrusts in the middle of the ranges of voltage and density, one at their ends.
    let between = |correction: &Option<Correction>, share: f64| match correction {
        Some(Correction {
            range: [low, high], ..
        }) => low + share * (high - low),
        None => 0.0,
    };
    let airframe = &compiled.airframe;
    for (share, thrusts) in [(0.0, &THRUSTS[1..2]), (0.5, &THRUSTS[..]), (1.0, &THRUSTS[1..2])] {
        let conditions = [&airframe.voltage, &airframe.air].map(|correction| between(correction, share));
        let at = At::new(compiled, conditions, Health::GOOD);
        for &share in thrusts {
            let thrust = at.thrust(share);
            at.probe([0.0, 0.0, 0.0, thrust])?;
            for (size, direction) in SIZES.iter().flat_map(|size| DIRECTIONS.map(|d| (size, d))) {
                let [roll, pitch, yaw] = [0, 1, 2].map(|axis| size * direction[axis] * at.authority[axis]);
                at.probe([roll, pitch, yaw, thrust])?;
            }
        }
    }
    Ok(())
}

/// Wrenches with one and with two rotors out, where the others keep the frame level.
fn probe_rotors_out(compiled: &Compiled) -> Result<(), String> {
    let rotors = compiled.airframe.rotors() as u8;
    let singles = (0..rotors).map(|rotor| Health::GOOD.with_failed(rotor));
    let pairs: Vec<Health> = (0..rotors)
        .flat_map(|first| (first + 1..rotors).map(move |second| (first, second)))
        .map(|(first, second)| Health::GOOD.with_failed(first).with_failed(second))
        .collect();
    let step = pairs.len().div_ceil(MOST_PAIRS).max(1);
    let reference = [
        compiled.airframe.reference_v(),
        compiled.airframe.reference_density(),
    ];
    for health in singles.chain(pairs.into_iter().step_by(step)) {
        let at = At::new(compiled, reference, health);
        let level = [0.0, 0.0, 0.0, at.thrust(0.4)];
        if !at.probe(level)? {
            continue;
        }
        for [roll, pitch, yaw] in [[1.0, -1.0, 1.0], [0.0, 0.0, -1.0]] {
            let [p, q, r, _] = at.authority;
            at.probe([0.2 * roll * p, 0.2 * pitch * q, 0.2 * yaw * r, level[3]])?;
        }
    }
    Ok(())
}

/// The mixer under some conditions with some rotors out.
struct At<'a> {
    compiled: &'a Compiled,
    /// Voltage, V, and density, kg/m3.
    conditions: [f64; 2],
    health: Health,
    /// `[k_f, k_Q]`.
    factors: [f64; 2],
    /// The most of each axis with all rotors, N m and N.
    authority: [f64; 4],
}

/// What the mixer answers to a wrench; wrenches are `[roll, pitch, yaw, thrust]`, N m and N.
struct Delivered<'a> {
    at: &'a At<'a>,
    asked: [f64; 4],
    /// A throttle per channel.
    throttle: Vec<f32>,
    /// The wrench that the mixer reports.
    achieved: [f64; 4],
    /// The wrench that the throttles give by the physics.
    given: [f64; 4],
    saturation: Saturation,
}

/// What a judge has against an answer, in words.
type Judge = fn(&Delivered<'_>) -> Option<String>;

const JUDGES: [Judge; 5] = [
    judge_throttles,
    judge_report,
    judge_flags,
    judge_service,
    judge_soundness,
];

impl<'a> At<'a> {
    fn new(compiled: &'a Compiled, [volts, density]: [f64; 2], health: Health) -> Self {
        let factors = compiled.airframe.factors(volts, density);
        let efforts = scales(&compiled.airframe, factors);
        At {
            compiled,
            conditions: [volts, density],
            health,
            factors,
            authority: [0, 1, 2, 3].map(|axis| compiled.effectiveness.largest(axis, &efforts)),
        }
    }

    /// The thrust at a share of the range of level flight, N.
    fn thrust(&self, share: f64) -> f64 {
        let [least, most] = self.compiled.thrust_range_n.map(f64::from);
        self.factors[0] * (least + share * (most - least))
    }

    /// Mixes a wrench `[roll, pitch, yaw, thrust]`, N m and N. True where it is delivered.
    ///
    /// # Errors
    /// What is wrong with the answer.
    fn probe(&self, asked: [f64; 4]) -> Result<bool, String> {
        let answer = self.answer(asked.map(|x| x as f32));
        let fault = match &answer {
            Ok(answer) => JUDGES.iter().find_map(|judge| judge(answer)),
            Err(refused) => Some(refused.clone()),
        };
        let Some(fault) = fault else {
            return Ok(answer.is_ok_and(|answer| answer.is_delivered()));
        };
        let out: String = self
            .failed()
            .map(|channel| format!(", rotor {channel} out"))
            .collect();
        let [volts, density] = self.conditions;
        let airframe = &self.compiled.airframe;
        let of_voltage = airframe.voltage.as_ref().map(|_| format!(" at {volts:.2} V"));
        let of_air = airframe.air.as_ref().map(|_| format!(" at {density:.3} kg/m3"));
        let conditions: String = of_voltage.into_iter().chain(of_air).collect();
        Err(format!(
            "the emitted mixer fails a probe: asked {}{conditions}{out}, {fault}",
            words(&asked)
        ))
    }

    fn answer(&self, asked: [f32; 4]) -> Result<Delivered<'_>, String> {
        let [voltage_v, density_kg_m3] = self.conditions.map(|x| x as f32);
        let conditions = Conditions::at_voltage(voltage_v).in_air(density_kg_m3);
        let (throttle, achieved, saturation) = self
            .compiled
            .tables
            .mix_with_health(&Wrench::from_array(asked), conditions, self.health)
            .map_err(|error| error.to_string())?;
        Ok(Delivered {
            at: self,
            asked: asked.map(f64::from),
            given: self
                .compiled
                .physics()
                .wrench(&throttle, self.factors, self.health),
            throttle,
            achieved: achieved.to_array().map(f64::from),
            saturation,
        })
    }

    /// Outputs of the rotors that are out.
    fn failed(&self) -> impl Iterator<Item = u8> {
        let rotors = 0..self.compiled.airframe.rotors() as u8;
        rotors.filter(|&channel| self.health.has_failed(channel))
    }

    fn serves(&self, axis: Axis) -> bool {
        self.compiled.airframe.allocation.controls(axis)
    }

    /// The error of an axis that is allowed, N m or N.
    fn tolerance(&self, axis: Axis) -> f64 {
        f64::from(self.compiled.tables.tolerance.wrench[axis as usize])
    }
}

impl Delivered<'_> {
    /// The first served axis that is at fault.
    fn find(&self, is_at_fault: impl Fn(Axis, usize) -> bool) -> Option<Axis> {
        let mut served = Axis::ALL.into_iter().filter(|&axis| self.at.serves(axis));
        served.find(|&axis| is_at_fault(axis, axis as usize))
    }

    fn is_delivered(&self) -> bool {
        self.find(|axis, _| self.saturation.is_flagged(axis)).is_none()
    }
}

/// Throttles are within the range, those of rotors that are out zero.
fn judge_throttles(answer: &Delivered<'_>) -> Option<String> {
    let range = &answer.at.compiled.tables.throttle;
    let is_allowed = |channel: usize, throttle: f32| match answer.at.health.has_failed(channel as u8) {
        true => throttle == 0.0,
        false => (range.min..=range.max).contains(&throttle),
    };
    let mut throttles = answer.throttle.iter().enumerate();
    let (channel, throttle) = throttles.find(|(channel, throttle)| !is_allowed(*channel, **throttle))?;
    Some(format!("output {channel} gets {throttle}"))
}

/// What is reported is given.
fn judge_report(answer: &Delivered<'_>) -> Option<String> {
    let (achieved, given) = (&answer.achieved, &answer.given);
    answer.find(|axis, k| {
        let is_true = (given[k] - achieved[k]).abs() <= answer.at.tolerance(axis);
        !is_true
    })?;
    Some(format!("reported {}, given {}", words(achieved), words(given)))
}

/// What is not flagged is delivered.
fn judge_flags(answer: &Delivered<'_>) -> Option<String> {
    let axis = answer.find(|axis, k| {
        let missed = (answer.given[k] - answer.asked[k]).abs();
        !answer.saturation.is_flagged(axis) && missed > 2.0 * answer.at.tolerance(axis)
    })?;
    Some(format!("given {} without a flag on {axis}", words(&answer.given)))
}

/// A wrench is delivered where the throttles of least norm are well inside their range.
fn judge_service(answer: &Delivered<'_>) -> Option<String> {
    let (at, tables) = (answer.at, &answer.at.compiled.tables);
    if !at.health.is_good() || answer.is_delivered() {
        return None;
    }
    let range = &tables.throttle;
    let margin = INSIDE * (range.max - range.min);
    let inside = range.min + margin..=range.max - margin;
    let units = tables.least_norm(answer.asked.map(|x| x as f32), at.factors)?;
    let is_inside = units
        .as_flattened()
        .iter()
        .all(|throttle| inside.contains(throttle));
    is_inside.then(|| format!("given {}, although all units could", words(&answer.given)))
}

/// No axis is exceeded, reversed or off its direction. With a rotor out that is roll and pitch, and yaw alone takes
/// no thrust where thrust comes before it.
///
/// With one rotor out torques are sound where level flight at the thrust asked is attainable; the
/// caller goes on from there. With two they are all but always, which is no proof of a fault.
fn judge_soundness(answer: &Delivered<'_>) -> Option<String> {
    let Delivered { at, asked, given, .. } = answer;
    let is_whole = at.health.is_good();
    let is_promised = is_whole || answer.is_delivered() || asked[..3] != [0.0; 3];
    if !is_promised || at.failed().count() > 1 {
        return None;
    }
    let room = |axis: Axis| at.tolerance(axis) + SOUND * at.authority[axis as usize];
    let allocation = &at.compiled.airframe.allocation;
    let is_yaw_last = !allocation.airmode.is_yaw_first() && allocation.yaw_reserve_nm == 0.0;
    let is_beyond = |axis: Axis, k: usize| {
        if axis == Axis::Thrust && is_whole {
            let share = |axis: Axis| match at.serves(axis) {
                true => given[axis as usize] / at.authority[axis as usize],
                false => 0.0,
            };
            let raised = RAISED * libm::hypot(share(Axis::Roll), share(Axis::Pitch)) * at.authority[k];
            return allocation.airmode == Airmode::Disabled && given[k] > asked[k] + raised + room(axis);
        }
        if axis == Axis::Thrust {
            // The ratio of the costs allows as much again.
            let is_given_up = (given[k] - asked[k]).abs() > 2.0 * room(axis);
            return asked[..2] == [0.0; 2] && is_yaw_last && is_given_up;
        }
        if axis == Axis::Yaw && !is_whole {
            return false;
        }
        given[k] > asked[k].max(0.0) + room(axis) || given[k] < asked[k].min(0.0) - room(axis)
    };
    let off_direction = || {
        let [roll, pitch] = [Axis::Roll, Axis::Pitch];
        let size = libm::hypot(asked[0], asked[1]);
        let across = (asked[0] * given[1] - asked[1] * given[0]).abs();
        let is_off = at.serves(roll) && at.serves(pitch) && across > size * room(roll).max(room(pitch));
        is_off.then_some(roll)
    };
    let axis = answer.find(is_beyond).or_else(off_direction)?;
    Some(format!(
        "given {}: {axis} is exceeded, reversed or off its direction",
        words(given)
    ))
}

/// A wrench in words.
fn words([roll, pitch, yaw, thrust]: &[f64; 4]) -> String {
    format!("roll {roll:.4} N m, pitch {pitch:.4} N m, yaw {yaw:.4} N m, thrust {thrust:.3} N")
}

#[cfg(test)]
mod tests;
