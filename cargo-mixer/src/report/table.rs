//! Tables of the page: summary, units, M and M+, the static comparison, the bench.

use std::fmt::Write as _;

use mixer_compiler::alternatives::Alternative;
use mixer_compiler::hover::Hover;
use mixer_compiler::report::{Summary, rounded_up};

use super::bench::BenchPoints;
use super::comparison::{Answer, Comparison};
use super::maps::Effort;
use super::number::{escaped, fixed, shortest, significant};
use super::study::Study;

/// Rows of the comparison that the page and the command show of the whole sweep.
const SHOWN_ROWS: usize = 9;

/// A table: the caption, one header row, rows whose first cell is their name. Cells are markup already.
pub fn table(caption: &str, header: &[String], rows: &[Vec<String>]) -> String {
    let mut html = String::from("<div class=\"wide\"><table>");
    let _ = write!(html, "<caption>{caption}</caption><thead><tr>");
    for cell in header {
        let _ = write!(html, "<th scope=\"col\">{cell}</th>");
    }
    html.push_str("</tr></thead>\n<tbody>\n");
    for row in rows {
        html.push_str("<tr>");
        for (index, cell) in row.iter().enumerate() {
            let _ = match index {
                0 => write!(html, "<th scope=\"row\">{cell}</th>"),
                _ => write!(html, "<td>{cell}</td>"),
            };
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</tbody></table></div>\n");
    html
}

/// Names with values, which are markup already.
pub fn facts_table<'a>(facts: impl IntoIterator<Item = &'a (&'a str, String)>) -> String {
    let mut html = String::from("<table class=\"facts\"><tbody>\n");
    for (name, value) in facts {
        let _ = writeln!(html, "<tr><th scope=\"row\">{name}</th><td>{value}</td></tr>");
    }
    html.push_str("</tbody></table>\n");
    html
}

/// Names with values: what `check` prints.
pub fn summary(study: &Study<'_>) -> String {
    let compiled = study.compiled;
    let airframe = &compiled.airframe;
    let summary = Summary::new(compiled);
    let inverse = &airframe.inverse;
    let facts = [
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
            "Throttle",
            format!(
                "{:?} to {:?}; the map is proven invertible from an idle of {}",
                airframe.throttle.min, airframe.throttle.max, summary.min_idle
            ),
        ),
        (
            "Inverse map",
            format!(
                "{}, {} bytes of tables",
                escaped(&summary.evaluator_description),
                summary.table_bytes
            ),
        ),
        (
            "Largest error of one unit",
            format!(
                "{} N, {} N m at every voltage, proven; allowed are {:?} N, {:?} N m",
                rounded_up(summary.proven_thrust_n),
                rounded_up(summary.proven_torque_nm),
                inverse.thrust_tolerance_n,
                inverse.torque_tolerance_nm
            ),
        ),
        (
            "Bare thrust",
            format!(
                "{} to {} N in all without torque, at the reference voltage",
                fixed(f64::from(summary.thrust_range_n[0]), 1),
                fixed(f64::from(summary.thrust_range_n[1]), 1)
            ),
        ),
        (
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
        ),
    ];
    let hover = summary.hover.iter().flat_map(hover);
    facts_table(&facts.into_iter().chain(hover).collect::<Vec<_>>())
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
                format!("{} {least} to {largest} N m", margin.axis)
            })
            .collect();
        let throttles = format!("throttle {} upper, {} lower", fixed(upper, 3), fixed(lower, 3));
        (
            "Hover",
            format!("{volts}{throttles}; left are {}", margins.join(", ")),
        )
    });
    [carried].into_iter().chain(at).collect()
}

/// Places, spins and outputs of the units.
pub fn units(study: &Study<'_>) -> String {
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
        &header.map(str::to_owned),
        &rows,
    )
}

/// M and M+.
pub fn matrices(study: &Study<'_>) -> String {
    let effectiveness = &study.compiled.effectiveness;
    let n = study.compiled.airframe.units.len();
    let efforts: Vec<String> = ["f", "Q"]
        .into_iter()
        .flat_map(|letter| (0..n).map(move |i| format!("{letter}<sub>{i}</sub>")))
        .collect();
    let axes = ["roll", "pitch", "yaw", "thrust"].map(str::to_owned);
    let header = |columns: &[String]| {
        let mut header = vec![String::new()];
        header.extend_from_slice(columns);
        header
    };
    let rows = |names: &[String], value: &dyn Fn(usize, usize) -> f64, columns: usize| -> Vec<Vec<String>> {
        let row = |(index, name): (usize, &String)| {
            let values = (0..columns).map(|column| fixed(value(index, column), 4));
            [name.clone()].into_iter().chain(values).collect()
        };
        names.iter().enumerate().map(row).collect()
    };
    let m = rows(&axes, &|row, column| effectiveness.matrix[(row, column)], 2 * n);
    let m_plus = rows(
        &efforts,
        &|row, column| effectiveness.pseudo_inverse[(row, column)],
        4,
    );
    let caption = "M: wrench (N m, N m, N m, N) = M &#183; efforts (f in N, Q in N m)";
    table(caption, &header(&efforts), &m)
        + &table(
            "M<sup>+</sup>: least-norm efforts = M<sup>+</sup> &#183; wrench",
            &header(&axes),
            &m_plus,
        )
}

/// One line of the comparison: columns of both mixers.
struct Line {
    cells: Vec<String>,
    limited: bool,
}

/// Columns of the comparison beside yaw and mixer.
fn columns(comparison: &Comparison) -> Vec<String> {
    let units = comparison.rows.first().map_or(0, |row| row.coaxial.efforts.len());
    let efforts = (0..units).flat_map(|i| [format!("f{i} N"), format!("Q{i} N m")]);
    let mut columns = vec!["yaw asked N m".to_owned(), "mixer".to_owned()];
    columns.extend(efforts);
    columns.extend(["yaw given N m", "thrust given N"].map(str::to_owned));
    columns
}

fn lines(comparison: &Comparison) -> Vec<Line> {
    let count = comparison.rows.len();
    let mut lines = Vec::new();
    let shown = SHOWN_ROWS.min(count).max(2);
    for k in 0..shown {
        let Some(row) = comparison.rows.get(k * count.saturating_sub(1) / (shown - 1)) else {
            continue;
        };
        for (name, answer) in [("coaxial", &row.coaxial), ("conventional", &row.conventional)] {
            let Answer { efforts, wrench, .. } = answer;
            let mut cells = vec![fixed(row.yaw_nm, 3), name.to_owned()];
            cells.extend(efforts.iter().flat_map(|[f, q]| [fixed(*f, 3), fixed(*q, 4)]));
            cells.extend([fixed(wrench[2], 4), fixed(wrench[3], 3)]);
            lines.push(Line {
                cells,
                limited: !answer.within,
            });
        }
    }
    lines
}

/// The static comparison as HTML.
pub fn comparison(comparison: &Comparison) -> String {
    let caption = format!(
        "{} N asked in all; conventional: \u{3ba} = {} m. An asterisk: a throttle is at its limit",
        shortest(comparison.thrust_n),
        significant(comparison.kappa_m, 4)
    );
    let rows: Vec<Vec<String>> = lines(comparison)
        .into_iter()
        .map(|mut line| {
            if line.limited {
                line.cells[1].push('*');
            }
            line.cells
        })
        .collect();
    table(&caption, &columns(comparison), &rows)
}

/// The static comparison as text in columns.
pub fn comparison_text(comparison: &Comparison) -> String {
    let mut rows = vec![columns(comparison)];
    rows.extend(lines(comparison).into_iter().map(|mut line| {
        if line.limited {
            line.cells[1].push('*');
        }
        line.cells
    }));
    let widths: Vec<usize> = (0..rows[0].len())
        .map(|column| {
            rows.iter()
                .map(|row| row[column].chars().count())
                .max()
                .unwrap_or(0)
        })
        .collect();
    let mut text = format!(
        "{} N asked in all, reference voltage; conventional: kappa = {} m; *: a throttle is at its limit\n",
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

/// The evaluators to choose from.
pub fn front(alternatives: &[Alternative]) -> String {
    let header = [
        "evaluator",
        "",
        "cycles",
        "f proven (N)",
        "observed",
        "Q proven (N m)",
        "observed",
    ];
    let rows: Vec<Vec<String>> = alternatives
        .iter()
        .map(|alternative| {
            let proven = alternative.proven.map(|bound| {
                if bound.is_finite() {
                    rounded_up(bound)
                } else {
                    "none".to_owned()
                }
            });
            let observed = alternative.observed.map(rounded_up);
            let [[proven_f, proven_q], [observed_f, observed_q]] = [proven, observed];
            vec![
                escaped(&alternative.description),
                alternative.verdict().to_owned(),
                alternative.cost.map_or_else(String::new, |cost| cost.to_string()),
                proven_f,
                observed_f,
                proven_q,
                observed_q,
            ]
        })
        .collect();
    let caption = "Evaluators by about the cycles of one unit on a Cortex-M4F, with what one unit misses over the attainable set: proven at \
                   every voltage, observed at the reference voltage";
    table(caption, &header.map(str::to_owned), &rows)
}

/// Model against bench.
pub fn bench(bench: &BenchPoints) -> String {
    let header = ["", "rms", "largest", "R\u{b2}"].map(str::to_owned);
    let rows: Vec<Vec<String>> = Effort::BOTH
        .into_iter()
        .filter_map(|effort| {
            let misfit = bench.misfit(effort)?;
            let unit = effort.unit();
            Some(vec![
                effort.label().to_owned(),
                format!("{} {unit}", significant(misfit.rms, 3)),
                format!("{} {unit}", significant(misfit.largest, 3)),
                fixed(misfit.r_squared, 5),
            ])
        })
        .collect();
    table("Model less measurement", &header, &rows)
}
