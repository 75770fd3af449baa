//! Warnings of a review, a rule each.

use mixer_compiler::Compiled;
use mixer_compiler::airframe::{Axis, Correction};
use mixer_compiler::diagnostic::rounded;
use mixer_compiler::hover::band;
use mixer_compiler::model::scales;

use crate::review::flight::Flight;
use crate::review::result::{Range, Review};
use crate::review::rotors::Speed;
use crate::review::text::beside;

/// Distance of the centre of gravity that is worth a word, m.
const CENTRE_M: f64 = 0.01;

/// Torque in yaw, as a share of the pair's largest over all units.
const YAW_LEFT: f64 = 0.03;

/// Share of the time.
const OFTEN: f64 = 0.01;

/// What the rules look at.
pub(crate) struct WarningInputs<'a> {
    pub(crate) review: &'a Review,
    pub(crate) flight: &'a Flight,
    pub(crate) compiled: &'a Compiled,
    /// Whether there is too little hover for the scale.
    pub(crate) is_short: bool,
    /// Whether the accelerometer's offset is known.
    pub(crate) has_velocity: bool,
}

type Rule = fn(&WarningInputs<'_>) -> Vec<String>;

const RULES: [Rule; 8] = [damage, hover, scale, changes, rotors, centre, yaw, conditions];

/// A sentence each.
pub(crate) fn warnings(seen: &WarningInputs<'_>) -> Vec<String> {
    RULES.iter().flat_map(|rule| rule(seen)).collect()
}

fn when(holds: bool, sentence: impl FnOnce() -> String) -> Vec<String> {
    holds.then(sentence).into_iter().collect()
}

fn damage(seen: &WarningInputs<'_>) -> Vec<String> {
    let unknown = "no velocity is logged: the accelerometer's offset is in the scale's interval, 1 %";
    let velocity = when(!seen.has_velocity, || unknown.to_owned());
    seen.flight.damage.iter().cloned().chain(velocity).collect()
}

fn hover(seen: &WarningInputs<'_>) -> Vec<String> {
    let [_, air, hover] = seen.review.seconds;
    when(seen.is_short, || {
        format!(
            "only {hover:.1} s of hover: the scale is that of all {air:.0} s in the air, with their climbs and speeds in it"
        )
    })
}

fn scale(seen: &WarningInputs<'_>) -> Vec<String> {
    let airframe = &seen.compiled.airframe;
    let thrust = &seen.review.thrust;
    let [low, high] = thrust.interval;
    let volts = airframe.voltage.as_ref().map(|law| law.reference);
    let of_model = band(seen.compiled, Axis::Thrust, volts).zip(airframe.weight_n());
    let expected = of_model.map_or(String::new(), |(band, weight)| {
        format!(
            "; the model's own standard deviation is {:.1} %",
            100.0 * band / weight
        )
    });
    let percent = 100.0 * (thrust.median - 1.0);
    when(thrust.scale.is_some() && !(low..=high).contains(&1.0), || {
        format!(
            "the model gives {:.1} % {} thrust than the vehicle{expected}: -o writes the file with the scale in it. Other reasons: the \
             mass, where the voltage is measured, the air's density, another propeller",
            percent.abs(),
            if percent > 0.0 { "more" } else { "less" },
        )
    })
}

/// Take-offs that disagree, and flights within which the scale changes.
fn changes(seen: &WarningInputs<'_>) -> Vec<String> {
    let thrust = &seen.review.thrust;
    let told = thrust
        .parts
        .windows(2)
        .filter(|pair| pair[0].flight == pair[1].flight);
    let told = told.map(|pair| {
        let [before, after] = [&pair[0], &pair[1]];
        format!(
            "the thrust changes at the same acceleration: the scale is {:.3} to {:.0} s ({:.1} V) and {:.3} from {:.0} s on ({:.1} V). A load \
             that is taken up or released does that (--mass is that of one part), ageing of rotors and motors, and a [voltage] that is \
             not the vehicle's",
            before.scale, before.to_s, before.voltage_v, after.scale, after.from_s, after.voltage_v
        )
    });
    let differ = when(thrust.scale.is_none(), || {
        "the intervals of the log's parts have no value in common, so there is no one scale: another load or battery, or damage".to_owned()
    });
    told.chain(differ).collect()
}

/// The centre of gravity, where its interval is beside the file's; not where a rotor is the cause.
fn centre(seen: &WarningInputs<'_>) -> Vec<String> {
    let hover = &seen.review.hover;
    let is_off = |[low, high]: &[f64; 2]| *low > 0.0 || *high < 0.0;
    let beyond = hover
        .centre_interval_m
        .is_some_and(|axes| axes.iter().any(is_off));
    let off = hover
        .centre_m
        .filter(|[x, y]| beyond && libm::hypot(*x, *y) > CENTRE_M);
    let speeds = &seen.review.speeds;
    let cause = match speeds.is_empty() {
        true => ", or a rotor there is the stronger one (the log has no speeds of the rotors)",
        false => ": the rotors' speeds are alike",
    };
    let named = off.filter(|_| speeds.iter().all(Speed::is_alike));
    named.map_or_else(Vec::new, |centre| {
        vec![format!(
            "the centre of gravity is {} of the file's{cause}; move the pack, or correct the units' position_m",
            beside(centre)
        )]
    })
}

fn yaw(seen: &WarningInputs<'_>) -> Vec<String> {
    let all_nm: f64 = scales(&seen.compiled.airframe, [1.0; 2])
        .iter()
        .map(|scale| scale[1])
        .sum();
    let left_nm = seen.review.hover.yaw_nm.unwrap_or_default();
    when(left_nm.abs() > YAW_LEFT * all_nm, || {
        format!(
            "the model has {} N m of yaw in a straight hover, where there is none: the pair's torque is off, or motor mounts are twisted",
            rounded(left_nm)
        )
    })
}

/// Voltage and density beyond the mixer's range, or unknown.
fn conditions(seen: &WarningInputs<'_>) -> Vec<String> {
    let (airframe, review) = (&seen.compiled.airframe, seen.review);
    let of = |name: &str, unit: &str, measured: &Option<Range>, law: &Option<Correction>| match (
        measured, law,
    ) {
        (Some(measured), Some(law)) if measured.outside > 0.0 => Some(format!(
            "the flight had a {name} of {:.2} to {:.2}, beyond the file's {} to {} {unit}: outside the mixer holds the range's end",
            measured.least, measured.largest, law.range[0], law.range[1]
        )),
        (None, Some(law)) => Some(format!(
            "no {name} was logged, or none that can be: the scale is that at {} {unit}, and its interval that of the whole range",
            law.reference
        )),
        _ => None,
    };
    let voltage = of("voltage", "V", &review.voltage, &airframe.voltage);
    voltage
        .into_iter()
        .chain(of("density", "kg/m3", &review.density, &airframe.air))
        .collect()
}

/// Rotors that stop or differ from their fellows, and axes that are cut.
fn rotors(seen: &WarningInputs<'_>) -> Vec<String> {
    let review = seen.review;
    let stops = review.stopped.iter();
    let stops: Vec<String> = stops
        .map(|stop| format!("output {} at {:.1} s", stop.output, stop.time_s))
        .collect();
    let stopped = when(!stops.is_empty(), || format!("rotors stop: {}", stops.join(", ")));
    let unlike = review.speeds.iter().filter(|speed| !speed.is_alike()).map(|speed| {
        let percent = 100.0 * (speed.ratio - 1.0);
        let (sense, parts) = match percent > 0.0 {
            true => ("faster", "propeller: worn, smaller or of less pitch"),
            false => ("slower", "motor, its controller, a heavier or larger propeller"),
        };
        format!(
            "the rotor of output {} turns {:.1} % {sense} than its fellows at one throttle: look at its {parts}",
            speed.output,
            percent.abs()
        )
    });
    let cut = [("roll", review.saturated.roll), ("pitch", review.saturated.pitch)];
    let cut = cut.into_iter().filter_map(|(axis, share)| {
        let share = share.filter(|share| *share > OFTEN)?;
        Some(format!("{axis} is cut for {:.1} % of the time", 100.0 * share))
    });
    stopped.into_iter().chain(unlike).chain(cut).collect()
}
