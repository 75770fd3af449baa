//! Warnings of a review, a rule each.

use mixer_compiler::Compiled;
use mixer_compiler::airframe::Axis;
use mixer_compiler::diagnostic::rounded;
use mixer_compiler::hover::band;

use crate::flight::Flight;
use crate::review::{Range, Review};
use crate::text::beside;
use crate::thrust::Part;

/// Share of the scale by which parts of one flight may differ.
const PARTS_OFF: f64 = 0.04;

/// Distance of the centre of gravity that is worth a word, m.
const CENTRE_M: f64 = 0.01;

/// Torque in yaw, as a share of the pair's largest over all units.
const YAW_LEFT: f64 = 0.03;

/// Share of the time.
const OFTEN: f64 = 0.01;

/// What the rules look at.
pub(crate) struct Seen<'a> {
    pub(crate) review: &'a Review,
    pub(crate) flight: &'a Flight,
    pub(crate) compiled: &'a Compiled,
    /// Whether there is too little hover for the scale.
    pub(crate) is_short: bool,
    /// Whether the accelerometer's offset is known.
    pub(crate) has_velocity: bool,
}

type Rule = fn(&Seen<'_>) -> Vec<String>;

const RULES: [Rule; 8] = [damage, hover, scale, parts, centre, yaw, conditions, rotors];

/// A sentence each.
pub(crate) fn warnings(seen: &Seen<'_>) -> Vec<String> {
    RULES.iter().flat_map(|rule| rule(seen)).collect()
}

fn when(holds: bool, sentence: impl FnOnce() -> String) -> Vec<String> {
    holds.then(sentence).into_iter().collect()
}

fn damage(seen: &Seen<'_>) -> Vec<String> {
    let unknown = "no velocity is logged: the accelerometer's offset is in the scale's interval, 1 %";
    let velocity = when(!seen.has_velocity, || unknown.to_owned());
    seen.flight.damage.iter().cloned().chain(velocity).collect()
}

fn hover(seen: &Seen<'_>) -> Vec<String> {
    let [_, air, hover] = seen.review.seconds;
    when(seen.is_short, || {
        format!(
            "only {hover:.1} s of hover: the scale is that of all {air:.0} s in the air, with their climbs and speeds in it"
        )
    })
}

fn scale(seen: &Seen<'_>) -> Vec<String> {
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
    let percent = 100.0 * (thrust.scale - 1.0);
    when(!(low..=high).contains(&1.0), || {
        format!(
            "the model gives {:.1} % {} thrust than the vehicle{expected}: -o writes the file with the scale in it. Other reasons: the \
             mass, where the voltage is measured, the air's density, another propeller",
            percent.abs(),
            if percent > 0.0 { "more" } else { "less" },
        )
    })
}

fn parts(seen: &Seen<'_>) -> Vec<String> {
    let thrust = &seen.review.thrust;
    let of = |parts: &[Part], what: &str, mend: &str| {
        let scales = parts.iter().map(|part| part.scale);
        let (least, most) = scales.fold((f64::MAX, 0.0f64), |(low, high), scale| {
            (low.min(scale), high.max(scale))
        });
        when(most > (1.0 + PARTS_OFF) * least, || {
            format!(
                "the scale is {least:.3} to {most:.3} by {what}: one scale does not mend the model; {mend}"
            )
        })
    };
    let voltage = "look at [voltage], and at where the voltage is measured";
    let shape = "measure the pair on the bench (docs/bench.md)";
    [
        of(&thrust.by_voltage, "voltage", voltage),
        of(&thrust.by_thrust, "thrust", shape),
    ]
    .concat()
}

fn centre(seen: &Seen<'_>) -> Vec<String> {
    let off = seen
        .review
        .hover
        .centre_m
        .filter(|[x, y]| libm::hypot(*x, *y) > CENTRE_M);
    off.map_or_else(Vec::new, |centre| {
        vec![format!(
            "the centre of gravity is {} of the file's: move the pack, or the units' position_m",
            beside(centre)
        )]
    })
}

fn yaw(seen: &Seen<'_>) -> Vec<String> {
    let all_nm = seen.compiled.pair.scale()[1] * seen.compiled.airframe.units.len() as f64;
    let left_nm = seen.review.hover.yaw_nm.unwrap_or_default();
    when(left_nm.abs() > YAW_LEFT * all_nm, || {
        format!(
            "the model has {} N m of yaw in a straight hover, where there is none: the pair's torque is off, or motor mounts are twisted",
            rounded(left_nm)
        )
    })
}

/// Of voltage and density.
fn conditions(seen: &Seen<'_>) -> Vec<String> {
    let (airframe, review) = (&seen.compiled.airframe, seen.review);
    let of = |range: &Option<Range>, law: Option<f64>, key: &str, unit: &str, beyond: &str| {
        match range {
        Some(Range {
            least,
            largest,
            range: Some([low, high]),
            outside,
        }) => when(*outside > 0.0, || {
            format!(
                "{key} is {low} to {high} {unit}, and the flight had {least:.2} to {largest:.2}: outside the mixer holds the range's end"
            )
        }),
        Some(_) => Vec::new(),
        None => law.map_or_else(Vec::new, |reference| {
            vec![format!(
                "what {key} is of was not logged, or cannot be: the scale is that at {reference} {unit}{beyond}"
            )]
        }),
    }
    };
    let voltage = airframe.voltage.as_ref().map(|law| law.reference);
    let air = airframe.air.as_ref().map(|law| law.reference);
    [
        of(
            &review.voltage,
            voltage,
            "range_v",
            "V",
            ", and its interval that of the whole range",
        ),
        of(&review.density, air, "range_kg_m3", "kg/m3", ""),
    ]
    .concat()
}

/// Rotors that stop, and axes that are cut.
fn rotors(seen: &Seen<'_>) -> Vec<String> {
    let review = seen.review;
    let stops = review.stopped.iter();
    let stops: Vec<String> = stops
        .map(|stop| format!("output {} at {:.1} s", stop.output, stop.time_s))
        .collect();
    let stopped = when(!stops.is_empty(), || format!("rotors stop: {}", stops.join(", ")));
    let cut = [("roll", review.saturated.roll), ("pitch", review.saturated.pitch)];
    let cut = cut.into_iter().filter_map(|(axis, share)| {
        let share = share.filter(|share| *share > OFTEN)?;
        Some(format!("{axis} is cut for {:.1} % of the time", 100.0 * share))
    });
    stopped.into_iter().chain(cut).collect()
}
