//! Faults of an answer that no frame and no request excuses, optimal or not.

use std::fmt;

use mixer_rt::{Axis, Direction, Health, tables::Airmode};

use crate::optimum::Oracle;
use crate::request::{Answer, Frame, Request};
use crate::shortfall::ALLOWED;

/// Rounding in f32 of sums over the units and of the factors of the voltage, as a share of the authority.
const ROUNDING: f64 = 1e-5;

/// Share of the authority by which an axis may be reversed or exceeded, beside what the inverse map
/// may miss.
pub const SLACK: f64 = 3e-3;

/// Cost of roll and pitch over that of thrust in excess, `priorities` of the runtime. Where units differ they need unequal
/// thrusts to be level, and a little thrust may free more roll and pitch than that.
const EXCESS_PER_TORQUE: f64 = 400.0 / 2000.0;

/// What is wrong with an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaultKind {
    /// A throttle outside its range, or not 0 of a rotor that is out.
    Throttle,
    /// The achieved wrench is not what the throttles give.
    Truth,
    /// A flag that is missing or without cause.
    Flag,
    /// An axis that is reversed or given more of than asked.
    Overstepped,
    /// (roll, pitch) in another direction than asked.
    Turned,
    /// Thrust above the request and the least, with airmode "disabled".
    Raised,
}

/// A fault of an answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// What is wrong.
    pub kind: FaultKind,
    /// By how much: as a share of the axis' authority, of a throttle as it is.
    pub size: f64,
    /// In words.
    pub said: String,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.said)
    }
}

/// The first fault of an answer; `None` where it is sound.
///
/// # Errors
/// The solver of the oracle gave up.
pub fn fault(frame: &Frame, request: &Request, answer: &Answer) -> Result<Option<Fault>, microlp::Error> {
    Ok(faults(frame, request, answer)?.into_iter().next())
}

/// All faults of an answer, one of each axis and kind at most.
///
/// # Errors
/// The solver of the oracle gave up.
pub fn faults(frame: &Frame, request: &Request, answer: &Answer) -> Result<Vec<Fault>, microlp::Error> {
    let mut faults: Vec<Fault> = faults_of_form(frame, request, answer).collect();
    faults.extend(overstepping(frame, request, answer)?);
    Ok(faults)
}

/// As [`faults`], of what an answer says alone: throttles in range, the truth about the wrench, the
/// right flags.
pub fn faults_of_form(frame: &Frame, request: &Request, answer: &Answer) -> impl Iterator<Item = Fault> {
    let throttles = throttles(frame, request, answer).into_iter();
    throttles
        .chain(truth(frame, request, answer))
        .chain(flags(frame, request, answer))
}

/// Throttles within the range, stopped rotors at 0.
fn throttles(frame: &Frame, request: &Request, answer: &Answer) -> Option<Fault> {
    let range = frame.compiled.airframe.throttle;
    let count = frame.physics.rotors();
    let fault = |size: f64, said: String| Fault {
        kind: FaultKind::Throttle,
        size,
        said,
    };
    if answer.throttle.len() != count {
        return Some(fault(
            f64::INFINITY,
            format!("{} throttles for {count} rotors", answer.throttle.len()),
        ));
    }
    (0..).zip(&answer.throttle).find_map(|(channel, &throttle)| {
        let value = f64::from(throttle);
        let sound = if request.health.has_failed(channel) {
            throttle == 0.0
        } else {
            (range.min..=range.max).contains(&value)
        };
        (!sound).then(|| fault(value, format!("throttle {throttle} at output {channel}")))
    })
}

/// Levers that the compiler takes for none, m.
const LEAST_LEVER_M: f64 = 1e-6;

/// The achieved wrench is what the throttles give.
fn truth(frame: &Frame, request: &Request, answer: &Answer) -> Option<Fault> {
    let given = frame.physics.wrench_in(&answer.throttle, request.factors(frame));
    let [.., thrust_n] = given;
    Axis::ALL.into_iter().enumerate().find_map(|(index, axis)| {
        let (said, given) = (answer.achieved[index], given[index]);
        // Levers below a micrometre count as none; where pairs differ they do not cancel either.
        let lost = if index < 3 {
            LEAST_LEVER_M * thrust_n.abs()
        } else {
            0.0
        };
        let size = (said - given).abs() / frame.size(index);
        // What is not a number is not true.
        let is_true = size <= ROUNDING + lost / frame.size(index);
        (!is_true).then(|| Fault {
            kind: FaultKind::Truth,
            size,
            said: format!("{}: {said} said, {given} given by the throttles", axis.name()),
        })
    })
}

/// Every axis is flagged on the side on which it was missed by more than the tolerance, and on no
/// other; the voltage is flagged where it was clamped.
fn flags(frame: &Frame, request: &Request, answer: &Answer) -> Option<Fault> {
    let tolerance = frame.compiled.tables.tolerance.wrench.map(f64::from);
    let axes = Axis::ALL.into_iter().enumerate().find_map(|(index, axis)| {
        let missing = request.asked()[index] - answer.achieved[index];
        // The mixer subtracts and compares in f32.
        let rounding = 2.0 * f64::from(f32::EPSILON) * missing.abs();
        [(Direction::Positive, missing), (Direction::Negative, -missing)]
            .into_iter()
            .find_map(|(direction, missing)| {
                let flagged = answer.saturation.is_saturated(axis, direction);
                let excess = missing - tolerance[index];
                let wrong = excess.abs() > rounding && flagged != (excess > 0.0);
                let name = axis.name();
                wrong.then(|| Fault {
                    kind: FaultKind::Flag,
                    size: missing.abs() / frame.size(index),
                    said: format!("{name} {direction:?}: {missing} missing, flag {flagged}"),
                })
            })
    });
    let outside = |range: Option<[f64; 2]>, x: Option<f32>| {
        let range = range.zip(x);
        range.is_some_and(|([low, high], x)| !(low as f32..=high as f32).contains(&x))
    };
    let voltage = outside(frame.physics.voltage_range(), Some(request.volts));
    let density = outside(frame.physics.density_range(), request.density);
    let given = [
        answer.saturation.voltage_clamped(),
        answer.saturation.density_clamped(),
    ];
    axes.or_else(|| {
        (given != [voltage, density]).then(|| Fault {
            kind: FaultKind::Flag,
            size: 0.0,
            said: format!("{request:?}: voltage and density clamped {given:?}"),
        })
    })
}

/// No controlled axis is reversed or exceeded, but for yaw with rotors out, (roll, pitch) keeps its
/// direction, and airmode "disabled" does not raise the thrust beyond the request or the floor: all
/// where roll = pitch = 0 is attainable at all within the yaw asked, with rotors out at the thrust
/// asked with any yaw.
fn overstepping(frame: &Frame, request: &Request, answer: &Answer) -> Result<Vec<Fault>, microlp::Error> {
    let served = frame.served();
    let mut asked = request.asked();
    for (asked, _) in asked.iter_mut().zip(served).filter(|(_, served)| !served) {
        *asked = 0.0;
    }
    let tolerance = frame.compiled.tables.tolerance.wrench.map(f64::from);
    let slack: [f64; 4] = std::array::from_fn(|axis| tolerance[axis] + SLACK * frame.authority[axis]);
    let is_whole = request.health == Health::GOOD;
    let mut faults = Vec::new();
    for (index, axis) in Axis::ALL
        .into_iter()
        .enumerate()
        .take(if is_whole { 3 } else { 2 })
        .filter(|(index, _)| served[*index])
    {
        let (asked, got) = (asked[index], answer.achieved[index]);
        let beyond = (got * asked.signum() - asked.abs()).max(-got * asked.signum());
        if beyond > slack[index] {
            faults.push(Fault {
                kind: FaultKind::Overstepped,
                size: beyond / frame.size(index),
                said: format!("{}: {asked} asked, {got} given", axis.name()),
            });
        }
    }
    if served[0] && served[1] {
        let length = |[roll, pitch]: [f64; 2]| (roll * roll + pitch * pitch).sqrt();
        let torque = length([asked[0], asked[1]]);
        let turned = (answer.achieved[0] * asked[1] - answer.achieved[1] * asked[0]).abs() / torque;
        if torque > 0.0 && turned > length([slack[0], slack[1]]) {
            faults.push(Fault {
                kind: FaultKind::Turned,
                size: turned / length([frame.size(0), frame.size(1)]),
                said: format!("(roll, pitch) turned by {turned} N m"),
            });
        }
    }
    let disabled = frame.allocation().airmode == Airmode::Disabled;
    let raised = disabled && answer.achieved[3] > asked[3] + slack[3];
    if faults.is_empty() && !raised {
        return Ok(faults);
    }
    let factors = request.factors(frame);
    let oracle = Oracle::new(&frame.physics, frame.allocation(), factors, request.health);
    let Some(mut floor) = oracle.thrust_floor(asked[2])? else {
        return Ok(Vec::new());
    };
    let exact = || Oracle::exact(&frame.physics, frame.allocation(), factors, request.health);
    let is_judged =
        is_whole || oracle.has_level(asked[2], asked[3])? && exact().has_level(asked[2], asked[3])?;
    if !is_judged {
        return Ok(Vec::new());
    }
    let given = answer.achieved[3];
    let freed = if frame.compiled.airframe.is_unlike() {
        let share = |axis: usize| answer.achieved[axis] / frame.size(axis);
        let [roll, pitch] = [share(0), share(1)];
        EXCESS_PER_TORQUE * (roll * roll + pitch * pitch).sqrt()
    } else {
        0.0
    };
    let is_above = |floor: f64| given > floor + (ALLOWED + freed) * frame.authority[3];
    if raised && is_above(floor) {
        // Convex hulls reach below the least thrust. The mixer's is that of level flight without
        // yaw, which less thrust may come with where units at idle have a torque.
        let exact = exact();
        for yaw in [asked[2], 0.0] {
            floor = floor.max(exact.thrust_floor(yaw)?.unwrap_or(floor));
        }
    }
    if raised && is_above(floor) {
        faults.push(Fault {
            kind: FaultKind::Raised,
            size: (given - floor.max(asked[3])) / frame.size(3),
            said: format!("thrust: {} asked, {given} given, {floor} is the least", asked[3]),
        });
    }
    Ok(faults)
}
