//! Line plots: attainable set against voltage, the yaw sweep of both mixers (Fig. 6), authority,
//! throttle and power against thrust.

use std::slice::from_ref;

use mixer_compiler::airframe::Axis;

use crate::report::authority::Authority;
use crate::report::comparison::{Comparison, Row, YawResponse};
use crate::report::effort::{EFFORTS, Effort};
use crate::report::figure::Figure;
use crate::report::level::Level;
use crate::report::maps::over_efforts;
use crate::report::number::{fixed, range, widened};
use crate::report::study::Study;

/// The attainable set of one unit at the lowest, the reference and the highest voltage.
pub fn attainable(study: &Study<'_>) -> Figure {
    let voltages = study.voltages();
    let largest = voltages
        .iter()
        .fold([1.0f64; 2], |size, (_, k)| [size[0].max(k[0]), size[1].max(k[1])]);
    let mut figure = over_efforts(
        from_ref(study),
        "Attainable thrust and torque of one unit",
        largest,
    )
    .reading("plane", &EFFORTS);
    for (index, (volts, k)) in voltages.iter().enumerate() {
        let points = study
            .border_efforts()
            .into_iter()
            .map(|[f, q]| [f * k[0], q * k[1]]);
        let name = volts.map_or("attainable set".to_owned(), |volts| format!("{volts} V"));
        figure.outline(of_voltage(*volts, index), &name, &points.collect::<Vec<_>>());
    }
    figure.mark(&study.hover_efforts(), "hover");
    figure
}

/// The class of the curve at the lowest, the reference and the highest voltage.
fn of_voltage(voltage_v: Option<f64>, index: usize) -> &'static str {
    match voltage_v {
        Some(_) => ["series-3", "series-1", "series-2"][index % 3],
        None => "series-1",
    }
}

/// Thrust or torque of every kind of single rotor over its throttle, with hover.
pub fn rotors(rotors: &[Study<'_>], effort: Effort) -> Figure {
    let k = effort as usize;
    let curve = |of: &Study<'_>| -> Vec<[f64; 2]> {
        let throttles = (0..=40).map(|step| of.throttles([f64::from(step) / 40.0; 2]));
        throttles.map(|at| [at[0], of.pair.efforts(at)[k]]).collect()
    };
    let curves: Vec<Vec<[f64; 2]>> = rotors.iter().map(curve).collect();
    let extent = |axis: usize| range(curves.iter().flatten().map(|point| point[axis]));
    let title = format!("{} of a single rotor over its throttle", effort.name());
    let y = widened(extent(1), 0.06);
    let mut figure = Figure::new(title, ("throttle x", extent(0)), (effort.label(), y))
        .high(200.0)
        .reading_curves();
    for (count, (of, curve)) in rotors.iter().zip(&curves).enumerate() {
        figure.curve(&told_apart(count), of.name(), curve);
        let hover = of.hover_throttles().into_iter().zip(of.hover_efforts());
        let hover: Vec<[f64; 2]> = hover.map(|([x, _], efforts)| [x, efforts[k]]).collect();
        figure.mark(&hover, "hover");
    }
    figure
}

/// The class of one of up to nine curves: three colours, then three dashes.
fn told_apart(count: usize) -> String {
    let (colour, dash) = (1 + count % 3, ["", " long", " dash-dot"][count / 3 % 3]);
    format!("series-{colour}{dash}")
}

/// Name and class of a mixer, with how to get at its answers.
type Mixer = (String, &'static str, fn(&Row) -> &YawResponse);

fn mixers(comparison: &Comparison) -> [Mixer; 2] {
    let [own, conventional] = comparison.names.map(|name| format!("{name} mixer"));
    [
        (own, "series-1", |row| &row.coaxial),
        (conventional, "series-2", |row| &row.conventional),
    ]
}

/// Fig. 6: what every unit gives over the yaw range, in the plane of thrust and torque.
pub fn yaw_plane(study: &Study<'_>, comparison: &Comparison) -> Figure {
    let kinds = study.of_each();
    let title = "Yaw commands in the attainable set of each unit";
    let [thrust, torque] = EFFORTS;
    let quantities = [("", ""), ("unit", ""), ("yaw asked", "N m"), thrust, torque];
    let mut figure = over_efforts(&kinds, title, [1.0, 1.0]).reading("dots", &quantities);
    for (of, dash) in kinds
        .iter()
        .zip(["", " dashed", " dotted", " dash-dot"].into_iter().cycle())
    {
        let name = match of.name() {
            "" => "attainable set".to_owned(),
            name => format!("attainable set of {name}"),
        };
        figure.outline(&format!("border{dash}"), &name, &of.border_efforts());
    }
    for (name, class, answer) in &mixers(comparison) {
        for unit in 0..comparison.share_n.len() {
            let points = comparison.rows.iter().map(|row| answer(row).efforts[unit]);
            figure.curve(&format!("{class} thin"), "", &points.collect::<Vec<_>>());
        }
        for row in &comparison.rows {
            for (unit, &efforts) in answer(row).efforts.iter().enumerate() {
                let values = [
                    name.clone(),
                    unit.to_string(),
                    fixed(row.yaw_nm, 3),
                    fixed(efforts[0], 3),
                    fixed(efforts[1], 4),
                ];
                figure.read_dot(&format!("class=\"dot {class}\""), 2.4, efforts, &values);
            }
        }
        figure.entry(&format!("dot {class}"), name);
    }
    figure
}

/// A plot over the yaw asked that has all `values` in view.
fn over_yaw(
    comparison: &Comparison,
    title: &str,
    label: &str,
    values: impl IntoIterator<Item = f64>,
) -> Figure {
    let asked = range(comparison.rows.iter().map(|row| row.yaw_nm));
    let values = widened(range(values), 0.08);
    Figure::new(title, ("yaw asked (N m)", asked), (label, values)).reading_curves()
}

/// The thrust of every unit over the yaw asked: in one figure, of each unit in its own where more than three differ.
pub fn yaw_thrusts(comparison: &Comparison) -> Vec<Figure> {
    let alike = comparison.alike();
    let each = alike.chunks(if alike.len() > 3 { 1 } else { 3 });
    each.map(|of| yaw_thrust(comparison, of)).collect()
}

fn yaw_thrust(comparison: &Comparison, alike: &[Vec<usize>]) -> Figure {
    let efforts = |row: &'_ Row| {
        [&row.coaxial, &row.conventional]
            .map(|answer| answer.efforts.clone())
            .concat()
    };
    // One scale for all units.
    let thrusts = comparison.rows.iter().flat_map(efforts).map(|efforts| efforts[0]);
    let all = thrusts.chain(comparison.share_n.iter().copied());
    // Units that share the thrust alike have one line.
    let mut shares: Vec<f64> = alike.iter().map(|of| comparison.share_n[of[0]]).collect();
    shares.sort_by(f64::total_cmp);
    shares.dedup_by(|a, b| (*a - *b).abs() < 1e-6 * comparison.thrust_n);
    let title = "Thrust of every unit over the yaw asked";
    let mut figure = over_yaw(comparison, title, "thrust of a unit (N)", all);
    for &share in &shares {
        let each = if shares.len() == 1 { " of each" } else { "" };
        figure.level("reference", &format!("share of the thrust{each}"), share);
    }
    for (name, class, answer) in &mixers(comparison) {
        for (count, of) in alike.iter().enumerate() {
            let at = |row: &Row| [row.yaw_nm, answer(row).efforts[of[0]][0]];
            let curve: Vec<[f64; 2]> = comparison.rows.iter().map(at).collect();
            // Six dashes that are told apart without colour too.
            let dash = match *class {
                "series-1" => ["", " long", " long-dot"],
                _ => [" dotted", " dashed", " dash-dot"],
            }[count % 3];
            figure.curve(
                &format!("{class}{dash}"),
                &format!("{name}, {}", listed(of)),
                &curve,
            );
        }
    }
    figure
}

fn listed(units: &[usize]) -> String {
    let numbers: Vec<String> = units.iter().map(usize::to_string).collect();
    match numbers.as_slice() {
        [one] => format!("unit {one}"),
        _ => format!("units {}", numbers.join(", ")),
    }
}

/// The total thrust that is really given over the yaw asked.
pub fn yaw_total(comparison: &Comparison) -> Figure {
    let title = "Total thrust given over the yaw asked";
    let level = ("asked", comparison.thrust_n);
    of_both(comparison, title, "total thrust given (N)", level, |_, answer| {
        answer.wrench[3]
    })
}

/// How far the yaw that is really given is off the yaw asked.
pub fn yaw_error(comparison: &Comparison) -> Figure {
    let (title, label) = ("Yaw given less yaw asked", "yaw given \u{2212} asked (N m)");
    let off = |row: &Row, answer: &YawResponse| answer.wrench[2] - row.yaw_nm;
    of_both(comparison, title, label, ("", 0.0), off)
}

/// A value of both mixers over the yaw asked, and what it should be.
fn of_both(
    comparison: &Comparison,
    title: &str,
    label: &str,
    (name, level): (&str, f64),
    value: impl Fn(&Row, &YawResponse) -> f64,
) -> Figure {
    let curve = |answer: fn(&Row) -> &YawResponse| -> Vec<[f64; 2]> {
        let of = |row: &Row| [row.yaw_nm, value(row, answer(row))];
        comparison.rows.iter().map(of).collect()
    };
    let curves = mixers(comparison).map(|(name, class, answer)| (name, class, curve(answer)));
    let points = curves.iter().flat_map(|(_, _, curve)| curve);
    let values = points.map(|point| point[1]);
    let mut figure = over_yaw(comparison, title, label, values.chain([level]));
    figure.level("reference", name, level);
    for (name, class, curve) in &curves {
        figure.curve(class, name, curve);
    }
    figure
}

/// Authority in words, with its class and the curve.
pub type Case<'a> = (&'a str, &'a str, &'a [Authority]);

/// Authority about one axis against thrust, and what of it other `cases` leave; `None` where the
/// axis is not served.
pub fn authority(study: &Study<'_>, all: &[Authority], cases: &[Case<'_>], axis: Axis) -> Option<Figure> {
    if axis == Axis::Thrust || !study.serves(axis) {
        return None;
    }
    let index = axis as usize;
    let side = |all: &[Authority], side: usize| -> Vec<[f64; 2]> {
        all.iter()
            .map(|at| [at.thrust_n, at.torque_nm[index][side]])
            .collect()
    };
    let (least, largest) = (side(all, 0), side(all, 1));
    let torques = least.iter().chain(&largest).map(|point| point[1]);
    let torques = widened(range(torques.chain([0.0])), 0.06);
    let mut figure = Figure::new(
        format!("Authority in {} against thrust", axis.name()),
        ("total thrust (N)", range(all.iter().map(|at| at.thrust_n))),
        (&format!("{} (N m)", axis.name()), torques),
    )
    .high(200.0)
    .reading_curves();
    let voltage = study.compiled.airframe.voltage.as_ref();
    let volts = voltage.map_or_else(String::new, |voltage| format!("{} V, ", voltage.reference));
    let ring: Vec<[f64; 2]> = largest.iter().chain(least.iter().rev()).copied().collect();
    let data = figure.path(&ring, true);
    figure.raw(&format!("<path class=\"fill-1\" d=\"{data}\"/>"));
    figure.level("axis-line", "", 0.0);
    figure.unlisted_curve("series-1", &format!("{volts}largest"), &largest);
    figure.unlisted_curve("series-1", &format!("{volts}least"), &least);
    if let Some(weight_n) = study.hover_n() {
        figure.mark_x(weight_n, "hover");
    }
    for (name, class, all) in cases {
        // Where not even the thrust is held, there is nothing to draw.
        let held: Vec<bool> = all.iter().map(|at| at.torque_nm[index] != [0.0; 2]).collect();
        for (k, word) in ["least", "largest"].into_iter().enumerate() {
            let points = side(all, k).into_iter().zip(&held);
            let curve: Vec<[f64; 2]> = points
                .map(|([thrust, torque], held)| [thrust, if *held { torque } else { f64::NAN }])
                .collect();
            figure.unlisted_curve(class, &format!("{name}, {word}"), &curve);
        }
    }
    Some(figure)
}

/// A plot of level flight against thrust, at which hover is marked.
fn over_thrust(study: &Study<'_>, title: &str, levels: &[Level], y: (&str, [f64; 2])) -> Figure {
    let x = ("total thrust (N)", range(levels.iter().map(|level| level.at)));
    let mut figure = Figure::new(title, x, y).high(200.0).reading_curves();
    if let Some(weight_n) = study.hover_n() {
        figure.mark_x(weight_n, "hover");
    }
    figure
}

/// A curve of `value` over what the levels are at.
fn curve(levels: &[Level], value: impl Fn(&Level) -> f64) -> Vec<[f64; 2]> {
    levels.iter().map(|level| [level.at, value(level)]).collect()
}

/// Throttles in level flight against thrust at every voltage, of a layer of rotors by its place and its word.
pub fn throttle(
    study: &Study<'_>,
    levels: &[(Option<f64>, Vec<Level>)],
    (layer, name): (usize, &str),
) -> Figure {
    let title = format!("Throttle of the {name} rotors in level flight against thrust");
    let label = format!("throttle of the {name} rotors");
    // The thrusts are the same at every voltage.
    let first = levels.first().map_or(&[][..], |(_, all)| all);
    let mut figure = over_thrust(study, &title, first, (&label, [0.0, 1.0]));
    for (index, (volts, all)) in levels.iter().enumerate() {
        let name = volts.map_or_else(|| "throttle".to_owned(), |volts| format!("{volts} V"));
        let curve = curve(all, |level| level.throttles[layer]);
        figure.curve(of_voltage(*volts, index), &name, &curve);
    }
    figure
}

/// Throttles of all layers of rotors in hover against voltage; `None` without a mass or an effect of
/// voltage.
pub fn hover_throttle(study: &Study<'_>, levels: &[Level]) -> Option<Figure> {
    let voltage = study.compiled.airframe.voltage.as_ref()?;
    levels.first()?;
    let x = ("voltage (V)", range(levels.iter().map(|level| level.at)));
    let title = "Throttles in hover against voltage";
    let mut figure = Figure::new(title, x, ("throttle in hover", [0.0, 1.0]))
        .high(200.0)
        .reading_curves();
    for (place, (layer, _)) in study.compiled.airframe.layers().enumerate() {
        let curve = curve(levels, |level| level.throttles[place]);
        figure.curve(&told_apart(place), &format!("{layer} rotors"), &curve);
    }
    figure.mark_x(voltage.reference, "reference");
    Some(figure)
}

/// Electrical power in level flight against thrust; `None` where the file has no power map.
pub fn power(study: &Study<'_>, levels: &[Level]) -> Option<Figure> {
    let curve = curve(levels, |level| level.power_w);
    curve.iter().find(|point| point[1].is_finite())?;
    // The range is that of the finite ones.
    let powers = curve.iter().map(|point| point[1]);
    let powers = widened(range(powers.chain([0.0])), 0.04);
    let title = "Electrical power in level flight against thrust";
    let mut figure = over_thrust(study, title, levels, ("power of all rotors (W)", powers));
    figure.curve("series-1", "power", &curve);
    Some(figure)
}
