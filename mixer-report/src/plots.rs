//! Line plots: attainable set against voltage, the yaw sweep of both mixers (Fig. 6), authority,
//! throttle and power against thrust.

use mixer_compiler::airframe::Axis;

use crate::authority::Authority;
use crate::comparison::{Answer, Comparison, Row};
use crate::effort::EFFORTS;
use crate::figure::{Figure, Hover};
use crate::level::Level;
use crate::maps::over_efforts;
use crate::number::{fixed, range, widened};
use crate::study::Study;

/// The attainable set of one unit at the lowest, the reference and the highest voltage.
pub fn attainable(study: &Study<'_>) -> Figure {
    let voltages = study.voltages();
    let largest = voltages
        .iter()
        .fold([1.0f64; 2], |size, (_, k)| [size[0].max(k[0]), size[1].max(k[1])]);
    let mut figure = over_efforts(study, "Attainable thrust and torque of one unit", largest)
        .reading(Hover::Plane, &EFFORTS);
    let border = study.border();
    for (index, (volts, k)) in voltages.iter().enumerate() {
        let points: Vec<[f64; 2]> = border
            .iter()
            .map(|&throttles| study.pair.efforts(throttles))
            .map(|[f, q]| [f * k[0], q * k[1]])
            .collect();
        let name = volts.map_or("attainable set".to_owned(), |volts| format!("{volts} V"));
        figure.outline(of_voltage(*volts, index), &name, &points);
    }
    let hover: Vec<[f64; 2]> = study
        .hover_throttles()
        .into_iter()
        .map(|throttles| study.pair.efforts(throttles))
        .collect();
    figure.mark(&hover, "hover");
    figure
}

/// The class of the curve at the lowest, the reference and the highest voltage.
fn of_voltage(voltage_v: Option<f64>, index: usize) -> &'static str {
    match voltage_v {
        Some(_) => ["series-3", "series-1", "series-2"][index % 3],
        None => "series-1",
    }
}

/// Names and classes of the two mixers, with how to get at their answers.
type Mixer = (&'static str, &'static str, fn(&Row) -> &Answer);
const MIXERS: [Mixer; 2] = [
    ("coaxial mixer", "series-1", |row| &row.coaxial),
    ("conventional mixer", "series-2", |row| &row.conventional),
];

/// Fig. 6: what every unit gives over the yaw range, in the plane of thrust and torque.
pub fn yaw_plane(study: &Study<'_>, comparison: &Comparison) -> Figure {
    let mut figure = over_efforts(
        study,
        "Yaw commands in the attainable set of each unit",
        [1.0, 1.0],
    )
    .reading(
        Hover::Dots,
        &[
            ("", ""),
            ("unit", ""),
            ("yaw asked", "N m"),
            EFFORTS[0],
            EFFORTS[1],
        ],
    );
    let border: Vec<[f64; 2]> = study.border().iter().map(|&t| study.pair.efforts(t)).collect();
    figure.outline("border", "attainable set", &border);
    for (name, class, answer) in MIXERS {
        let units = comparison.rows.first().map_or(0, |row| row.coaxial.efforts.len());
        for unit in 0..units {
            let points: Vec<[f64; 2]> = comparison
                .rows
                .iter()
                .map(|row| answer(row).efforts[unit])
                .collect();
            figure.curve(&format!("{class} thin"), "", &points);
        }
        for row in &comparison.rows {
            for (unit, &efforts) in answer(row).efforts.iter().enumerate() {
                let values = [
                    name.to_owned(),
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

/// The thrust of every unit over the yaw asked.
pub fn yaw_thrust(comparison: &Comparison) -> Figure {
    let thrusts = comparison
        .rows
        .iter()
        .flat_map(|row| row.coaxial.efforts.iter().chain(&row.conventional.efforts))
        .map(|efforts| efforts[0]);
    // Units that share the thrust alike have one line.
    let mut shares = comparison.share_n.clone();
    shares.sort_by(f64::total_cmp);
    shares.dedup_by(|a, b| (*a - *b).abs() < 1e-6 * comparison.thrust_n);
    let [low, high] = yaw_range(comparison);
    let mut figure = Figure::new(
        "Thrust of every unit over the yaw asked",
        ("yaw asked (N m)", [low, high]),
        (
            "thrust of a unit (N)",
            widened(range(thrusts.chain(shares.iter().copied())), 0.08),
        ),
    )
    .reading_curves();
    for &share in &shares {
        let each = if shares.len() == 1 { " of each" } else { "" };
        figure.level("reference", &format!("share of the thrust{each}"), share);
    }
    for (name, class, answer) in MIXERS {
        let units = comparison.rows.first().map_or(0, |row| row.coaxial.efforts.len());
        for (count, (curve, of)) in distinct(comparison, units, answer).into_iter().enumerate() {
            // Six dashes that are told apart without colour too.
            let dash = match class {
                "series-1" => ["", " long", " long-dot"],
                _ => [" dotted", " dashed", " dash-dot"],
            }[count % 3];
            let name = format!("{name}, {}", listed(&of));
            figure.curve(&format!("{class}{dash}"), &name, &curve);
        }
    }
    figure
}

/// Curves of unit thrust that differ, each with the units that share it: symmetric units lie on one
/// another.
fn distinct(
    comparison: &Comparison,
    units: usize,
    answer: fn(&Row) -> &Answer,
) -> Vec<(Vec<[f64; 2]>, Vec<usize>)> {
    let mut curves: Vec<(Vec<[f64; 2]>, Vec<usize>)> = Vec::new();
    for unit in 0..units {
        let curve: Vec<[f64; 2]> = comparison
            .rows
            .iter()
            .map(|row| [row.yaw_nm, answer(row).efforts[unit][0]])
            .collect();
        let same = |other: &[[f64; 2]]| {
            other
                .iter()
                .zip(&curve)
                .all(|(a, b)| (a[1] - b[1]).abs() < 5e-4 * comparison.thrust_n)
        };
        match curves.iter_mut().find(|(other, _)| same(other)) {
            Some((_, of)) => of.push(unit),
            None => curves.push((curve, vec![unit])),
        }
    }
    curves
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
    let totals = comparison.rows.iter().flat_map(|row| {
        [
            row.coaxial.wrench[3],
            row.conventional.wrench[3],
            comparison.thrust_n,
        ]
    });
    let mut figure = Figure::new(
        "Total thrust given over the yaw asked",
        ("yaw asked (N m)", yaw_range(comparison)),
        ("total thrust given (N)", widened(range(totals), 0.08)),
    )
    .reading_curves();
    figure.level("reference", "asked", comparison.thrust_n);
    for (name, class, answer) in MIXERS {
        let curve: Vec<[f64; 2]> = comparison
            .rows
            .iter()
            .map(|row| [row.yaw_nm, answer(row).wrench[3]])
            .collect();
        figure.curve(class, name, &curve);
    }
    figure
}

/// How far the yaw that is really given is off the yaw asked.
pub fn yaw_error(comparison: &Comparison) -> Figure {
    let off = |row: &Row, answer: fn(&Row) -> &Answer| answer(row).wrench[2] - row.yaw_nm;
    let errors = comparison
        .rows
        .iter()
        .flat_map(|row| MIXERS.map(|(_, _, answer)| off(row, answer)))
        .chain([0.0]);
    let mut figure = Figure::new(
        "Yaw given less yaw asked",
        ("yaw asked (N m)", yaw_range(comparison)),
        ("yaw given \u{2212} asked (N m)", widened(range(errors), 0.08)),
    )
    .reading_curves();
    figure.level("reference", "", 0.0);
    for (name, class, answer) in MIXERS {
        let curve: Vec<[f64; 2]> = comparison
            .rows
            .iter()
            .map(|row| [row.yaw_nm, off(row, answer)])
            .collect();
        figure.curve(class, name, &curve);
    }
    figure
}

fn yaw_range(comparison: &Comparison) -> [f64; 2] {
    range(comparison.rows.iter().map(|row| row.yaw_nm))
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
    let torques = || all.iter().flat_map(|at| at.torque_nm[index]);
    let mut figure = Figure::new(
        format!("Authority in {} against thrust", axis.name()),
        ("total thrust (N)", range(all.iter().map(|at| at.thrust_n))),
        (
            &format!("{} (N m)", axis.name()),
            widened(range(torques().chain([0.0])), 0.06),
        ),
    )
    .sized(300.0, 240.0)
    .reading_curves();
    let side = |k: usize| -> Vec<[f64; 2]> {
        all.iter()
            .map(|at| [at.thrust_n, at.torque_nm[index][k]])
            .collect()
    };
    let (least, largest) = (side(0), side(1));
    let voltage = study.compiled.airframe.voltage.as_ref();
    let volts = voltage.map_or_else(String::new, |voltage| format!("{} V, ", voltage.reference_v));
    let mut ring = largest.clone();
    ring.extend(least.iter().rev());
    let data = figure.path(&ring, true);
    figure.raw(&format!("<path class=\"fill-1\" d=\"{data}\"/>"));
    figure.level("axis-line", "", 0.0);
    figure.unlisted_curve("series-1", &format!("{volts}largest"), &largest);
    figure.unlisted_curve("series-1", &format!("{volts}least"), &least);
    if let Some(weight_n) = study.hover_n() {
        figure.mark_x(weight_n, "hover");
    }
    for (name, class, all) in cases {
        for side in 0..2 {
            // Where not even the thrust is held, there is nothing to draw.
            let held = |at: &Authority| at.torque_nm[index] != [0.0; 2];
            let torque = |at: &Authority| {
                if held(at) {
                    at.torque_nm[index][side]
                } else {
                    f64::NAN
                }
            };
            let curve: Vec<[f64; 2]> = all.iter().map(|at| [at.thrust_n, torque(at)]).collect();
            figure.unlisted_curve(class, &format!("{name}, {}", ["least", "largest"][side]), &curve);
        }
    }
    Some(figure)
}

/// Throttles in level flight against thrust at every voltage: of the upper (0) or of the lower (1)
/// rotors.
pub fn throttle(study: &Study<'_>, levels: &[(Option<f64>, Vec<Level>)], rotor: usize) -> Figure {
    let name = ["upper", "lower"][rotor];
    let curve = |levels: &[Level]| -> Vec<[f64; 2]> {
        levels
            .iter()
            .map(|level| [level.at, level.throttles[rotor]])
            .collect()
    };
    let mut figure = Figure::new(
        format!("Throttle of the {name} rotors in level flight against thrust"),
        (
            "total thrust (N)",
            range(
                levels
                    .iter()
                    .flat_map(|(_, all)| all.iter().map(|level| level.at)),
            ),
        ),
        (&format!("throttle of the {name} rotors"), [0.0, 1.0]),
    )
    .sized(372.0, 240.0)
    .reading_curves();
    for (index, (volts, all)) in levels.iter().enumerate() {
        let name = volts.map_or_else(|| "throttle".to_owned(), |volts| format!("{volts} V"));
        figure.curve(of_voltage(*volts, index), &name, &curve(all));
    }
    if let Some(weight_n) = study.hover_n() {
        figure.mark_x(weight_n, "hover");
    }
    figure
}

/// Throttles of both rotors in hover against voltage; `None` without a mass or an effect of
/// voltage.
pub fn hover_throttle(study: &Study<'_>, levels: &[Level]) -> Option<Figure> {
    let voltage = study.compiled.airframe.voltage.as_ref()?;
    if levels.is_empty() {
        return None;
    }
    let mut figure = Figure::new(
        "Throttles in hover against voltage",
        ("voltage (V)", range(levels.iter().map(|level| level.at))),
        ("throttle in hover", [0.0, 1.0]),
    )
    .sized(372.0, 240.0)
    .reading_curves();
    for (rotor, name, class) in [(0, "upper rotors", "series-1"), (1, "lower rotors", "series-2")] {
        let curve: Vec<[f64; 2]> = levels
            .iter()
            .map(|level| [level.at, level.throttles[rotor]])
            .collect();
        figure.curve(class, name, &curve);
    }
    figure.mark_x(voltage.reference_v, "reference");
    Some(figure)
}

/// Electrical power in level flight against thrust; `None` where the file has no power map.
pub fn power(study: &Study<'_>, levels: &[Level]) -> Option<Figure> {
    study.compiled.airframe.pair.power.as_ref()?;
    let powers = levels
        .iter()
        .map(|level| level.power_w)
        .filter(|power| power.is_finite());
    let mut figure = Figure::new(
        "Electrical power in level flight against thrust",
        ("total thrust (N)", range(levels.iter().map(|level| level.at))),
        (
            "power of all rotors (W)",
            widened(range(powers.chain([0.0])), 0.04),
        ),
    )
    .sized(372.0, 240.0)
    .reading_curves();
    let curve: Vec<[f64; 2]> = levels.iter().map(|level| [level.at, level.power_w]).collect();
    figure.curve("series-1", "power", &curve);
    if let Some(weight_n) = study.hover_n() {
        figure.mark_x(weight_n, "hover");
    }
    Some(figure)
}
