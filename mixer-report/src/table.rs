//! Tables of the page: summary, units, M and M+, the static comparison, the bench.

use std::fmt::Write as _;

use maud::{Markup, html};
use mixer_compiler::airframe::Axis;
use mixer_compiler::diagnostic::printable;
use mixer_compiler::diagnostic::rounded_up;
use mixer_compiler::power::LevelPower;
use mixer_facts::checklist::{self, Checklist};
use mixer_facts::hover::Hover;
use mixer_facts::report::in_words;

use crate::bench::BenchPoints;
use crate::comparison::{Answer, Comparison};
use crate::effort::Effort;
use crate::number::{fixed, shortest, significant};
use crate::origin::Origin;
use crate::rows::{facts_table, table};
use crate::study::Study;

/// Rows of the comparison that the page and the command show of the whole sweep.
const SHOWN_ROWS: usize = 9;

/// Names with values, in the order in which an engineer asks for them: does it fly, what is left,
/// what it costs, how true it is, from what it was made.
pub fn summary(study: &Study<'_>, origin: &Origin) -> Markup {
    let compiled = study.compiled;
    let airframe = &compiled.airframe;
    let summary = &study.summary;
    let inverse = &airframe.inverse;
    let [floor, ceiling] = compiled.thrust_range_n.map(f64::from);
    let at = study.at_reference();
    let mut facts = vec![(
        "Bare thrust",
        format!(
            "{} to {} N in all without torque{at}",
            fixed(floor, 1),
            fixed(ceiling, 1)
        ),
    )];
    match &summary.hover {
        Some(vehicle) => facts.extend(hover(vehicle)),
        None => facts.push((
            "Hover",
            "add [vehicle] mass_kg to see hover and its margins".to_owned(),
        )),
    }
    facts.extend(summary.power.iter().map(|at| power(study, at)));
    facts.push((
        "Throttle",
        format!(
            "{:?} to {:?}; idle gives {} % of the largest thrust; the map is proven invertible from an idle of {}",
            airframe.throttle.min,
            airframe.throttle.max,
            fixed(100.0 * floor / ceiling, 1),
            summary.min_idle
        ),
    ));
    facts.push((
        "Voltage",
        airframe
            .voltage
            .as_ref()
            .map_or("no correction".to_owned(), |voltage| {
                format!(
                    "{} to {} V, reference {} V",
                    voltage.range_v[0], voltage.range_v[1], voltage.reference_v
                )
            }),
    ));
    let uncertainty = airframe.pair.uncertainty.iter();
    facts.extend(uncertainty.map(|u| ("Pair", in_words(u).replace("+-", "\u{b1}"))));
    let at_every = if airframe.voltage.is_some() {
        " at every voltage"
    } else {
        ""
    };
    facts.extend([
        (
            "Largest error of one unit",
            format!(
                "{} N, {} N m{at_every}, proven; allowed are {:?} N, {:?} N m",
                rounded_up(summary.proven_thrust_n),
                rounded_up(summary.proven_torque_nm),
                inverse.thrust_tolerance_n,
                inverse.torque_tolerance_nm
            ),
        ),
        (
            "Rotors",
            format!("{} in {} coaxial units", summary.rotors, summary.units),
        ),
        (
            "Served axes",
            format!(
                "{} (rank {}, condition of M {})",
                summary.axes.join(", "),
                summary.rank,
                fixed(summary.condition, 2)
            ),
        ),
        (
            "Inverse map",
            format!(
                "{}, {} bytes of tables",
                summary.evaluator_description, summary.table_bytes
            ),
        ),
    ]);
    let mut facts: Vec<(&str, Markup)> = facts
        .into_iter()
        .map(|(name, value)| (name, html! { (value) }))
        .collect();
    facts.push((
        "Airframe file",
        html! { code { (printable(&compiled.source.file_name())) } },
    ));
    facts.extend(origin.date.iter().map(|date| ("Date", html! { (date) })));
    let hash = origin.sha256.iter();
    facts.extend(hash.map(|hash| ("SHA-256 of the file", html! { code { (hash) } })));
    facts_table(&facts)
}

/// The vehicle in hover.
fn hover(hover: &Hover) -> Vec<(&'static str, String)> {
    let carried = (
        "Vehicle",
        format!(
            "{} kg, {} N; the largest bare thrust is {} times that",
            shortest(hover.mass_kg),
            fixed(hover.weight_n, 1),
            fixed(hover.thrust_over_weight, 2)
        ),
    );
    let at = hover.at.iter().map(|at| {
        let volts = at
            .voltage_v
            .map_or_else(String::new, |volts| format!("At {} V: ", shortest(volts)));
        let (Some(upper), Some(lower)) = (at.upper_throttle, at.lower_throttle) else {
            return ("Hover", format!("{volts}the weight is not carried"));
        };
        let margins: Vec<String> = at
            .margins
            .iter()
            .map(|margin| {
                let [least, largest] = margin.torque_nm.map(|torque| fixed(torque, 2));
                let band = margin
                    .band_nm
                    .map_or_else(String::new, |band| format!(" \u{b1} {}", fixed(band, 2)));
                format!("{} {least} to {largest}{band} N m", margin.axis)
            })
            .collect();
        let mut throttles = format!("throttle {} upper, {} lower", fixed(upper, 3), fixed(lower, 3));
        if let Some(band) = at.throttle_band {
            let [[least_upper, least_lower], [upper, lower]] = band.map(|end| end.map(|x| fixed(x, 3)));
            let _ = write!(
                throttles,
                " ({least_upper} to {upper}, {least_lower} to {lower} by the pair\u{2019}s uncertainty)"
            );
        }
        (
            "Hover",
            format!("{volts}{throttles}; left are {}", margins.join(", ")),
        )
    });
    [carried].into_iter().chain(at).collect()
}

/// Electrical power in level flight.
fn power(study: &Study<'_>, power: &LevelPower) -> (&'static str, String) {
    let mut text = format!(
        "{} W at {} N{}",
        fixed(power.power_w, 1),
        fixed(power.thrust_n, 1),
        study.at_reference()
    );
    if power.power_w != power.without_bias_w {
        let _ = write!(
            text,
            "; without the power bias {} W. It saves {} %, which is {} % of flight time",
            fixed(power.without_bias_w, 1),
            fixed(power.saving_percent, 2),
            fixed(power.flight_time_percent, 2)
        );
    }
    ("Power", text)
}

/// Places, spins and outputs of the units.
pub fn units(study: &Study<'_>) -> Markup {
    let header = ["unit", "x (m)", "y (m)", "z (m)", "upper rotor", "lower rotor"];
    let units = study.compiled.airframe.units.iter().enumerate();
    let rows: Vec<Vec<String>> = units
        .map(|(index, unit)| {
            let [x, y, z] = unit.position_m.map(|x| fixed(x, 4));
            let upper = format!("{}, output {}", unit.upper_spin.name(), unit.upper_channel);
            let lower = format!(
                "{}, output {}",
                unit.upper_spin.reversed().name(),
                unit.lower_channel
            );
            vec![index.to_string(), x, y, z, upper, lower]
        })
        .collect();
    table(
        "From the centre of gravity: x forward, y right, z down",
        &header,
        &rows,
    )
}

/// M and M+.
pub fn matrices(study: &Study<'_>) -> Markup {
    let effectiveness = &study.compiled.effectiveness;
    let n = study.compiled.airframe.units.len();
    let efforts: Vec<Markup> = ["f", "Q"]
        .into_iter()
        .flat_map(|letter| (0..n).map(move |i| html! { (letter) sub { (i) } }))
        .collect();
    let axes = ["roll", "pitch", "yaw", "thrust"].map(|axis| html! { (axis) });
    let header = |columns: &[Markup]| [&[html! {}], columns].concat();
    let rows = |names: &[Markup], value: &dyn Fn(usize, usize) -> f64, columns: usize| -> Vec<Vec<Markup>> {
        let row = |(index, name): (usize, &Markup)| {
            let values = (0..columns).map(|column| html! { (fixed(value(index, column), 4)) });
            [name.clone()].into_iter().chain(values).collect()
        };
        names.iter().enumerate().map(row).collect()
    };
    // Transposed, as M+ is: four columns fit a phone whatever the number of units.
    let m = rows(&efforts, &|effort, axis| effectiveness.matrix[(axis, effort)], 4);
    let m_plus = rows(
        &efforts,
        &|row, column| effectiveness.pseudo_inverse[(row, column)],
        4,
    );
    let caption = html! { "M" sup { "T" } ": wrench (N m, N m, N m, N) = M \u{b7} efforts (f in N, Q in N m); a row is what one unit\u{2019}s thrust or torque adds" };
    let inverse_caption = html! { "M" sup { "+" } ": least-norm efforts = M" sup { "+" } " \u{b7} wrench" };
    html! {
        (table(caption, &header(&axes), &m))
        (table(inverse_caption, &header(&axes), &m_plus))
    }
}

/// Units by what both mixers make of them: those that always give the same as one another share
/// their columns.
fn alike(comparison: &Comparison) -> Vec<Vec<usize>> {
    let units = comparison.rows.first().map_or(0, |row| row.coaxial.efforts.len());
    let same = |a: usize, b: usize| {
        comparison.rows.iter().all(|row| {
            [&row.coaxial, &row.conventional].into_iter().all(|answer| {
                let [a, b] = [answer.efforts[a], answer.efforts[b]].map(rounded);
                a == b
            })
        })
    };
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for unit in 0..units {
        match groups.iter_mut().find(|group| same(group[0], unit)) {
            Some(group) => group.push(unit),
            None => groups.push(vec![unit]),
        }
    }
    groups
}

/// A unit's efforts to the digits of the table.
fn rounded([f, q]: [f64; 2]) -> [String; 2] {
    [fixed(f, 2), fixed(q, 3)]
}

/// Columns of the comparison beside yaw and mixer.
fn columns(comparison: &Comparison) -> Vec<String> {
    let mut columns = vec!["yaw asked (N m)".to_owned(), "mixer".to_owned()];
    for group in alike(comparison) {
        let numbers: Vec<String> = group.iter().map(usize::to_string).collect();
        let numbers = numbers.join(", ");
        columns.extend([format!("f {numbers} (N)"), format!("Q {numbers} (N m)")]);
    }
    columns.extend(["yaw given (N m)", "thrust given (N)"].map(str::to_owned));
    columns
}

/// Rows of both mixers; an asterisk marks a throttle at its limit.
fn lines(comparison: &Comparison) -> Vec<Vec<String>> {
    let groups = alike(comparison);
    let count = comparison.rows.len();
    let mut lines = Vec::new();
    let shown = SHOWN_ROWS.min(count).max(2);
    for k in 0..shown {
        let Some(row) = comparison.rows.get(k * count.saturating_sub(1) / (shown - 1)) else {
            continue;
        };
        for (name, answer) in [("coaxial", &row.coaxial), ("conventional", &row.conventional)] {
            let Answer { efforts, wrench, .. } = answer;
            let limited = if answer.within { "" } else { "*" };
            let mut cells = vec![fixed(row.yaw_nm, 3), format!("{name}{limited}")];
            cells.extend(groups.iter().flat_map(|group| rounded(efforts[group[0]])));
            cells.extend([fixed(wrench[2], 3), fixed(wrench[3], 2)]);
            lines.push(cells);
        }
    }
    lines
}

/// The static comparison as HTML.
pub fn comparison(comparison: &Comparison) -> Markup {
    let caption = format!(
        "{} N asked in all; conventional: \u{3ba} = {} m. An asterisk: a throttle is at its limit",
        shortest(comparison.thrust_n),
        significant(comparison.kappa_m, 4)
    );
    table(&caption, &columns(comparison), &lines(comparison))
}

/// The static comparison as text in columns.
pub fn comparison_text(comparison: &Comparison) -> String {
    let mut rows = vec![columns(comparison)];
    rows.extend(lines(comparison));
    let widths: Vec<usize> = (0..rows[0].len())
        .map(|column| {
            rows.iter()
                .map(|row| row[column].chars().count())
                .max()
                .unwrap_or(0)
        })
        .collect();
    let mut text = format!(
        "{} N asked in all; conventional: kappa = {} m; *: a throttle is at its limit\n",
        shortest(comparison.thrust_n),
        significant(comparison.kappa_m, 4)
    );
    for row in rows {
        let cells: Vec<String> = row
            .iter()
            .zip(&widths)
            .map(|(cell, width)| format!("{cell:>width$}"))
            .collect();
        let _ = writeln!(text, "{}", cells.join("  "));
    }
    // A terminal and its tools know the hyphen.
    text.replace('\u{2212}', "-")
}

/// Model against bench; percent of the pair's largest thrust and torque.
pub fn bench(study: &Study<'_>, bench: &BenchPoints) -> Markup {
    let header = [
        "",
        "rms",
        "rms (%)",
        "largest",
        "largest (%)",
        "of the row",
        "R\u{b2}",
    ]
    .map(str::to_owned);
    let scale = study.pair.scale();
    let rows: Vec<Vec<String>> = Effort::BOTH
        .into_iter()
        .filter_map(|effort| {
            let misfit = bench.misfit(effort)?;
            let percent = |x: f64| fixed(100.0 * x / scale[effort as usize], 2);
            let [u, l] = misfit.at.throttles.map(|throttle| significant(throttle, 3));
            Some(vec![
                effort.label().to_owned(),
                significant(misfit.rms, 3),
                percent(misfit.rms),
                significant(misfit.largest, 3),
                percent(misfit.largest),
                format!("{} (u {u}, l {l})", bench.place(&misfit.at)),
                fixed(misfit.r_squared, 5),
            ])
        })
        .collect();
    let caption = format!(
        "Model less measurement; percent of the pair\u{2019}s largest, {} N and {} N m",
        significant(scale[0], 3),
        significant(scale[1], 3)
    );
    table(&caption, &header, &rows)
}

/// What to try on the bench before the first flight: outputs one by one, then the axes.
pub fn bench_check(study: &Study<'_>) -> Markup {
    let checklist = Checklist(study.compiled);
    let mut outputs: Vec<(usize, Vec<String>)> = Vec::new();
    for (index, unit) in study.compiled.airframe.units.iter().enumerate() {
        let rotors = [
            (unit.upper_channel, "upper", unit.upper_spin),
            (unit.lower_channel, "lower", unit.upper_spin.reversed()),
        ];
        for (channel, rotor, spin) in rotors {
            let place = checklist.place(unit);
            let words = format!("unit {index}, {place}: {rotor} rotor");
            outputs.push((
                channel,
                vec![
                    channel.to_string(),
                    words,
                    spin.in_words().to_owned(),
                    BOX.to_owned(),
                ],
            ));
        }
    }
    outputs.sort_by_key(|(channel, _)| *channel);
    let outputs: Vec<Vec<String>> = outputs.into_iter().map(|(_, row)| row).collect();
    let commands: Vec<Vec<String>> = Axis::ALL
        .into_iter()
        .filter_map(|axis| {
            let rises = checklist.rises_in_words(axis)?;
            let command = format!("+{}", axis.name());
            Some(vec![
                command,
                rises,
                checklist::motion(axis).to_owned(),
                BOX.to_owned(),
            ])
        })
        .collect();
    html! {
        p { "Propellers off. Drive the outputs one by one, then command each axis; spins are as seen from above." }
        div.figures.words {
            (table("Outputs", &["output", "drives", "turns", "seen"], &outputs))
            (table("Commands, the strongest outputs first", &["command", "raises outputs", "moves", "seen"], &commands))
        }
    }
}

/// To be ticked on paper.
const BOX: &str = "\u{2610}";

/// The pair's coefficients, as the file has them.
pub fn coefficients(study: &Study<'_>) -> Markup {
    let pair = &study.compiled.airframe.pair;
    let terms = pair.basis.exponents().iter();
    let power = |letter: &str, exponent: u8| {
        html! {
            @if exponent > 0 { (letter) }
            @if exponent > 1 { sup { (exponent) } }
        }
    };
    let rows: Vec<Vec<Markup>> = terms
        .zip(pair.thrust_n.iter().zip(&pair.torque_nm))
        .map(|(&(i, j), (f, q))| {
            let term = html! { (power("u", i)) (power("l", j)) };
            vec![term, html! { (exact(*f)) }, html! { (exact(*q)) }]
        })
        .collect();
    let caption = format!(
        "The pair\u{2019}s coefficients, {}; its upper rotor turned {} on the bench",
        pair.basis.name(),
        pair.upper_spin.name()
    );
    table(&caption, &["term", "thrust f (N)", "torque Q (N m)"], &rows)
}

/// All digits, with a typographic minus.
fn exact(x: f64) -> String {
    format!("{x:?}").replace('-', "\u{2212}")
}
