//! Tables of the page: summary, units, M and M+, the static comparison, model against bench.

use maud::{Markup, html};
use mixer_compiler::airframe::Rotor;
use mixer_compiler::diagnostic::printable;
use mixer_facts::Fact;

use crate::report::bench::BenchPoints;
use crate::report::comparison::{Comparison, YawResponse, rounded};
use crate::report::effort::Effort;
use crate::report::number::{fixed, range, shortest, significant};
use crate::report::rows::table;
use crate::report::study::{Flown, Study};

/// Rows of the comparison that the page shows of the whole sweep.
const SHOWN_ROWS: usize = 9;

/// What an engineer asks first, and what the page was made from.
pub fn summary(study: &Study<'_>, facts: &[Fact], digest: Option<&str>) -> Markup {
    let file = ("Airframe file", printable(&study.compiled.source.file_name()));
    let hash = digest.map(|digest| ("SHA-256 of the file", digest.to_owned()));
    let more: Vec<(&str, String)> = [file].into_iter().chain(hash).collect();
    // The frame is drawn below.
    let asked_first = facts
        .iter()
        .filter(|fact| fact.in_verdict && !fact.is_cost() && fact.name != "frame");
    self::facts(asked_first, &more)
}

/// Facts, and more names with values, in a table.
pub fn facts<'a>(facts: impl Iterator<Item = &'a Fact>, more: &[(&str, String)]) -> Markup {
    let said = |fact: &Fact| {
        let text = format!(" {}", fact.text()).replace(" -", " \u{2212}");
        text.trim_start().replace("+-", "\u{b1}")
    };
    html! {
        table.facts {
            tbody {
                @for fact in facts.filter(|fact| !fact.text().is_empty()) { tr { th scope="row" { (fact.name.replace("det J", "Jacobian")) } td { (said(fact)) } } }
                @for (name, value) in more { tr { th scope="row" { (name) } td { (value) } } }
            }
        }
    }
}

/// Places, spins and motors of the units.
pub fn units(study: &Study<'_>) -> Markup {
    let header = ["unit", "x (m)", "y (m)", "z (m)", "rotors"];
    let units = study.compiled.airframe.units.iter().enumerate();
    let rows: Vec<Vec<String>> = units
        .map(|(index, unit)| {
            let [x, y, z] = unit.position_m.map(|x| fixed(x, 4));
            let told = |rotor: Rotor| {
                format!(
                    "{} {}, motor {}",
                    rotor.layer,
                    rotor.spin.name(),
                    rotor.channel + 1
                )
            };
            let rotors = unit.rotors().map(told);
            vec![index.to_string(), x, y, z, itertools::join(rotors, "; ")]
        })
        .collect();
    let caption = "From the centre of gravity: x forward, y right, z down";
    table(caption, &header, &rows)
}

/// The ends of the attainable set by voltage.
pub fn attainable(study: &Study<'_>) -> Markup {
    let border = study.border_efforts();
    let header = ["", "thrust f, N", "torque Q, N m"];
    let rows: Vec<Vec<String>> = study
        .voltages()
        .into_iter()
        .map(|(volts, k)| {
            let between = |effort: Effort, decimals| {
                let values = border
                    .iter()
                    .map(|efforts| efforts[effort as usize] * k[effort as usize]);
                let [least, largest] = range(values);
                format!("{} to {}", fixed(least, decimals), fixed(largest, decimals))
            };
            let name = volts.map_or_else(|| "at every voltage".to_owned(), |volts| format!("{volts} V"));
            vec![name, between(Effort::Thrust, 2), between(Effort::Torque, 4)]
        })
        .collect();
    table("Least to largest of one unit", &header, &rows)
}

/// M and M+.
pub fn matrices(study: &Study<'_>, facts: &[Fact]) -> Markup {
    let effectiveness = &study.compiled.effectiveness;
    let n = study.compiled.airframe.units.len();
    let efforts: Vec<Markup> = ["f", "Q"]
        .into_iter()
        .flat_map(|letter| (0..n).map(move |i| html! { (letter) sub { (i) } }))
        .collect();
    let header = ["", "roll", "pitch", "yaw", "thrust"];
    // M transposed, as M+ is: four columns fit a phone whatever the number of units.
    let rows = |value: &dyn Fn(usize, usize) -> f64| -> Vec<Vec<Markup>> {
        let row = |(effort, name): (usize, &Markup)| {
            let values = (0..4).map(|axis| html! { (fixed(value(effort, axis), 4)) });
            [name.clone()].into_iter().chain(values).collect()
        };
        efforts.iter().enumerate().map(row).collect()
    };
    let m = rows(&|effort, axis| effectiveness.matrix[(axis, effort)]);
    let m_plus = rows(&|effort, axis| effectiveness.pseudo_inverse[(effort, axis)]);
    let caption = html! { "M" sup { "T" } ": wrench (N m, N m, N m, N) = M \u{b7} efforts (f in N, Q in N m); a row is what one unit\u{2019}s thrust or torque adds" };
    let inverse_caption = html! { "M" sup { "+" } ": least-norm efforts = M" sup { "+" } " \u{b7} wrench" };
    html! {
        div.figures {
            (table(caption, &header, &m))
            (table(inverse_caption, &header, &m_plus))
        }
        (self::facts(facts.iter().filter(|fact| !fact.in_verdict && !fact.is_cost()), &[]))
    }
}

/// The static comparison; an asterisk marks a throttle at its limit.
pub fn comparison(comparison: &Comparison) -> Markup {
    let groups = comparison.alike();
    // Thrust alone of many: a phone has room for it.
    let quantities = if groups.len() > 3 { 1 } else { 2 };
    let mut columns = vec!["yaw asked (N m)".to_owned(), "mixer".to_owned()];
    for group in &groups {
        let numbers: Vec<String> = group.iter().map(usize::to_string).collect();
        let numbers = numbers.join(", ");
        let both = [format!("f {numbers} (N)"), format!("Q {numbers} (N m)")];
        columns.extend(both.into_iter().take(quantities));
    }
    columns.extend(["yaw given (N m)", "thrust given (N)"].map(str::to_owned));
    let count = comparison.rows.len();
    let shown = SHOWN_ROWS.min(count).max(2);
    let mut lines = Vec::new();
    for row in (0..shown).filter_map(|k| comparison.rows.get(k * count.saturating_sub(1) / (shown - 1))) {
        for (name, answer) in comparison
            .names
            .into_iter()
            .zip([&row.coaxial, &row.conventional])
        {
            let YawResponse { efforts, wrench, .. } = answer;
            let limited = if answer.within { "" } else { "*" };
            let mut cells = vec![fixed(row.yaw_nm, 3), format!("{name}{limited}")];
            let of = |group: &Vec<usize>| rounded(efforts[group[0]]).into_iter().take(quantities);
            cells.extend(groups.iter().flat_map(of));
            cells.extend([fixed(wrench[2], 3), fixed(wrench[3], 2)]);
            lines.push(cells);
        }
    }
    let caption = format!(
        "{} N asked in all; conventional: \u{3ba} = {} m. An asterisk: a throttle is at its limit",
        shortest(comparison.thrust_n),
        significant(comparison.kappa_m, 4)
    );
    table(&caption, &columns, &lines)
}

/// Model against bench; percent of the pair's largest thrust and torque.
pub fn bench(study: &Study<'_>, bench: &BenchPoints) -> Markup {
    #[rustfmt::skip]
    let header = ["", "rms", "rms (%)", "largest", "largest (%)", "of the row", "R\u{b2}"];
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

/// A flight over the model.
pub fn flown(flown: &Flown) -> Markup {
    let lines = flown.lines.iter();
    let lines: Vec<(&str, String)> = lines.map(|(name, text)| (name.trim(), printable(text))).collect();
    html! {
        p { "The flight of " code { (printable(&flown.log)) } " over the model:" }
        (facts([].iter(), &lines))
    }
}

/// The pair's coefficients, as the file has them.
pub fn coefficients(study: &Study<'_>) -> Markup {
    let Some((pair, _)) = study.of_pair() else {
        return html! {};
    };
    let terms = pair.basis.exponents().iter();
    let terms = terms.map(|(i, j)| html! { (power("u", *i)) (power("l", *j)) });
    let caption = format!(
        "The pair\u{2019}s coefficients, {}; its upper rotor turned {} on the bench",
        pair.basis.name(),
        pair.upper_spin.name()
    );
    of_terms(&caption, terms, &pair.thrust_n, &pair.torque_nm)
}

/// The coefficients of single rotors, likewise.
pub fn rotors(study: &Study<'_>) -> Markup {
    html! {
        @for rotor in &study.compiled.airframe.single_rotors {
            (of_terms(
                &format!("The coefficients of \u{201c}{}\u{201d} in its throttle x", printable(&rotor.name)),
                (1..=3).map(|exponent| power("x", exponent)),
                &rotor.alone.thrust_n,
                &rotor.alone.torque_nm,
            ))
        }
    }
}

fn power(letter: &str, exponent: u8) -> Markup {
    html! {
        @if exponent > 0 { (letter) }
        @if exponent > 1 { sup { (exponent) } }
    }
}

fn of_terms(
    caption: &str,
    terms: impl Iterator<Item = Markup>,
    thrust_n: &[f64],
    torque_nm: &[f64],
) -> Markup {
    let rows = terms.zip(thrust_n.iter().zip(torque_nm));
    let rows = rows.map(|(term, (f, q))| vec![term, html! { (exact(*f)) }, html! { (exact(*q)) }]);
    let rows: Vec<_> = rows.collect();
    table(caption, &["term", "thrust f (N)", "torque Q (N m)"], &rows)
}

/// All digits, with a typographic minus.
fn exact(x: f64) -> String {
    format!("{x:?}").replace('-', "\u{2212}")
}
