//! Faults of an answer that no frame and no request excuses, optimal or not.

use mixer_rt::{Axis, Direction, tables::Airmode};

use crate::optimum::Oracle;
use crate::request::{Answer, Frame, Request};
use crate::shortfall::ALLOWED;

/// Rounding of sums in f32, as a share of the authority.
const ROUNDING: f64 = 5e-6;

/// Share of the authority by which an axis may be reversed or exceeded, beside what the inverse map
/// may miss.
const SLACK: f64 = 1e-3;

/// The first fault of an answer, in words; `None` where it is sound.
///
/// # Errors
/// The solver of the oracle gave up.
pub fn fault(frame: &Frame, request: &Request, answer: &Answer) -> Result<Option<String>, microlp::Error> {
    fault_above(frame, request, answer, 0.0)
}

/// As [`fault`], of an answer that may raise the thrust up to `least_thrust_n`.
///
/// # Errors
/// The solver of the oracle gave up.
pub fn fault_above(
    frame: &Frame,
    request: &Request,
    answer: &Answer,
    least_thrust_n: f64,
) -> Result<Option<String>, microlp::Error> {
    match fault_of_form(frame, request, answer) {
        Some(fault) => Ok(Some(fault)),
        None => overstepping(frame, request, answer, least_thrust_n),
    }
}

/// As [`fault`], of what an answer says alone: throttles in range, the truth about the wrench, the
/// right flags.
pub fn fault_of_form(frame: &Frame, request: &Request, answer: &Answer) -> Option<String> {
    throttles(frame, request, answer)
        .or_else(|| truth(frame, request, answer))
        .or_else(|| flags(frame, request, answer))
}

/// Throttles within the range, stopped rotors at 0.
fn throttles(frame: &Frame, request: &Request, answer: &Answer) -> Option<String> {
    let range = frame.compiled.airframe.throttle;
    let count = 2 * frame.physics.units();
    if answer.throttle.len() != count {
        return Some(format!("{} throttles for {count} rotors", answer.throttle.len()));
    }
    (0..).zip(&answer.throttle).find_map(|(channel, &throttle)| {
        let sound = if request.health.has_failed(channel) {
            throttle == 0.0
        } else {
            (range.min..=range.max).contains(&f64::from(throttle))
        };
        (!sound).then(|| format!("throttle {throttle} at output {channel}"))
    })
}

/// The achieved wrench is what the throttles give.
fn truth(frame: &Frame, request: &Request, answer: &Answer) -> Option<String> {
    let given = frame.physics.wrench(&answer.throttle, request.volts);
    Axis::ALL.into_iter().enumerate().find_map(|(index, axis)| {
        let (said, given) = (answer.achieved[index], given[index]);
        let true_enough = (said - given).abs() <= ROUNDING * frame.authority[index];
        (!true_enough).then(|| format!("{}: {said} said, {given} given by the throttles", axis.name()))
    })
}

/// Every axis is flagged on the side on which it was missed by more than the tolerance, and on no
/// other; the voltage is flagged where it was clamped.
fn flags(frame: &Frame, request: &Request, answer: &Answer) -> Option<String> {
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
                wrong.then(|| format!("{name} {direction:?}: {missing} missing, flag {flagged}"))
            })
    });
    let clamped = frame
        .physics
        .voltage_range()
        .is_some_and(|[low, high]| !(low as f32..=high as f32).contains(&request.volts));
    let voltage = clamped != answer.saturation.voltage_clamped();
    axes.or_else(|| voltage.then(|| format!("voltage {}: clamped {clamped}", request.volts)))
}

/// No controlled axis is reversed or exceeded, (roll, pitch) keeps its direction, and airmode
/// "disabled" does not raise the thrust beyond the request or the floor: all where roll = pitch = 0
/// is attainable at all within the yaw asked and its reserve.
fn overstepping(
    frame: &Frame,
    request: &Request,
    answer: &Answer,
    least_thrust_n: f64,
) -> Result<Option<String>, microlp::Error> {
    let served = frame.served();
    let mut asked = request.asked();
    for (asked, _) in asked.iter_mut().zip(served).filter(|(_, served)| !served) {
        *asked = 0.0;
    }
    let slack: [f64; 4] = std::array::from_fn(|axis| {
        f64::from(frame.compiled.tables.tolerance.wrench[axis]) + SLACK * frame.authority[axis]
    });
    let mut fault = None;
    for (index, axis) in Axis::ALL
        .into_iter()
        .enumerate()
        .take(3)
        .filter(|(index, _)| served[*index])
    {
        let (asked, got) = (asked[index], answer.achieved[index]);
        let beyond = (got * asked.signum() - asked.abs()).max(-got * asked.signum());
        if beyond > slack[index] {
            fault = Some(format!("{}: {asked} asked, {got} given", axis.name()));
        }
    }
    if served[0] && served[1] {
        let length = |[roll, pitch]: [f64; 2]| (roll * roll + pitch * pitch).sqrt();
        let torque = length([asked[0], asked[1]]);
        let turned = (answer.achieved[0] * asked[1] - answer.achieved[1] * asked[0]).abs();
        if torque > 0.0 && turned > length([slack[0], slack[1]]) * torque {
            fault = Some(format!("(roll, pitch) turned by {} N m", turned / torque));
        }
    }
    let disabled = frame.allocation().airmode == Airmode::Disabled;
    let raised = disabled && answer.achieved[3] > asked[3] + slack[3];
    if fault.is_none() && !raised {
        return Ok(None);
    }
    let oracle = Oracle::new(
        &frame.physics,
        frame.allocation(),
        frame.physics.factors(request.volts),
        request.health,
    );
    let Some(floor) = oracle.thrust_floor(asked[2])? else {
        return Ok(None);
    };
    // The mixer's own floor is that of what it has of the attainable set.
    let most = floor.max(least_thrust_n) + ALLOWED * frame.authority[3];
    if raised && answer.achieved[3] > most {
        let given = answer.achieved[3];
        fault = Some(format!(
            "thrust: {} asked, {given} given, {floor} is the least",
            asked[3]
        ));
    }
    Ok(fault)
}
