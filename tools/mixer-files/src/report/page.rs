//! The page: one self-contained file that needs no network, no script to be read, and prints.
//!
//! It is written as XML that is also HTML (every element closed, every attribute quoted), so that
//! it can be checked by machine. [`content`] is what another page shows in an element of its own,
//! with [`STYLE`] and [`SCRIPT`].

mod link;

use maud::{Markup, PreEscaped, html};
use mixer_compiler::airframe::Axis;
use mixer_compiler::diagnostic::{printable, rounded_up};
use mixer_compiler::hover;
use mixer_facts::Fact;
use mixer_facts::cost::Cost;

use crate::report::authority;
use crate::report::bench::{BenchPoint, BenchPoints};
use crate::report::bench_check::bench_check;
use crate::report::comparison::Comparison;
use crate::report::data::{Data, THRUSTS, YAW_COMMANDS, no_yaw};
use crate::report::effort::Effort;
use crate::report::figure::Figure;
use crate::report::layout;
use crate::report::level;
use crate::report::maps;
use crate::report::number::{shortest, significant};
use crate::report::plots;
use crate::report::study::Study;
use crate::report::surface;
use crate::report::table;

/// The style of figures, in the page and in files of their own.
pub const FIGURE_STYLE: &str = include_str!("style.css");

/// The style of figures and of [`Content::body`] in an element of class `report`; nothing else is
/// touched but custom properties of the root.
pub const STYLE: &str = concat!(include_str!("style.css"), include_str!("report.css"));

/// Defines `report(element, model)`, which makes a [`Content::body`] in an element answer to the
/// pointer and the keyboard; called again for new content.
pub const SCRIPT: &str = include_str!("report.js");

/// Style of a page of its own around the content.
const PAGE_STYLE: &str = include_str!("page.css");

/// Thrusts at which it is found with every rotor out in turn.
const THRUSTS_ROTOR_OUT: usize = 21;

/// Every so many nodes of the error's grid are there for the pointer.
const HOVER_STRIDE: usize = 2;

/// The report without the page around it.
#[derive(Clone, Debug)]
pub struct Content {
    /// Markup, for an element of class `report`.
    pub body: String,
    /// JSON, for the script.
    pub model: String,
}

/// The whole page.
pub fn page(study: &Study<'_>, bench: Option<&BenchPoints>, digest: Option<&str>) -> String {
    let Content { body, model } = content(study, bench, digest);
    let title = html! { title { (printable(&study.compiled.airframe.name)) ": mixer" } };
    // The head's elements without content are closed, as XML demands.
    format!(
        "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n{}\n\
         <style>\n{STYLE}</style>\n<style>\n{PAGE_STYLE}</style>\n</head>\n<body>\n<main class=\"report\">{body}</main>\n\
         <script type=\"application/json\" id=\"model\">{model}</script>\n<script>//<![CDATA[\n{SCRIPT}\
         report(document.querySelector(\".report\"), JSON.parse(document.getElementById(\"model\").textContent));\n\
         //]]></script>\n</body>\n</html>\n",
        title.into_string(),
    )
}

/// What stands in the page, and what its script needs.
pub fn content(study: &Study<'_>, bench: Option<&BenchPoints>, digest: Option<&str>) -> Content {
    let compiled = study.compiled;
    let airframe = &compiled.airframe;
    let kinds = study.of_each();
    let (pairs, rotors) = kinds.split_at(airframe.pairs.len());
    let of_each = |draw: &dyn Fn(&Study<'_>) -> Markup| {
        html! {
            @for (place, pair) in pairs.iter().enumerate() {
                div data-pair=(place) {
                    @if !pair.name().is_empty() { h3 { (printable(pair.name())) } }
                    (draw(pair))
                }
            }
        }
    };
    let facts = mixer_facts::facts(compiled);
    // Anchor, title, content.
    let mut sections = vec![
        ("layout", "Layout", layout_section(study)),
        ("bench-check", "Check list on the bench", bench_check(study)),
        ("level", "Throttle and power", level_section(study)),
        ("authority", "Authority", authority_section(study)),
        ("comparison", "Yaw at constant thrust", comparison_section(study)),
    ];
    if !rotors.is_empty() {
        sections.push(("rotors", "Single rotors", rotors_section(study, rotors)));
    }
    if !pairs.is_empty() {
        let bench_of = |pair: &Study<'_>| bench.filter(|_| pair.index == study.index);
        sections.extend([
            ("attainable", "Attainable set", of_each(&attainable_section)),
            (
                "forward",
                "Forward maps",
                of_each(&|pair| forward_section(pair, bench_of(pair))),
            ),
            ("inverse", "Inverse maps", of_each(&inverse_section)),
            ("error", "Error of the inverse", of_each(&error_section)),
        ]);
    }
    sections.extend([
        ("cost", "Cost on the target", cost_section(study, &facts)),
        ("matrices", "Allocation", table::matrices(study, &facts)),
    ]);
    let body = html! {
        h1 { (printable(&airframe.name)) }
        p.lead { (printable(&airframe.description)) }
        nav id="contents" aria-label="Contents" { @for (anchor, title, _) in &sections { a href={ "#" (anchor) } { (title) } " " } }
        (warnings(study, bench))
        (table::summary(study, &facts, digest))
        @for (anchor, title, content) in &sections {
            section id=(anchor) { h2 { (title) } (content) }
        }
        footer {
            "Made by " code { "cargo mixer report" } " " (env!("CARGO_PKG_VERSION")) " from "
            code { (printable(&compiled.source.file_name())) }
            ". Body frame FRD, SI units; clockwise yaw seen from above is positive, thrust is positive upwards. "
            @if !pairs.is_empty() { "The torque of a pair is positive where its lower rotor outweighs the upper one. " }
            @if !rotors.is_empty() { "That of a single rotor is positive whichever way it turns." }
        }
        a.back href="#contents" { "Contents" }
    };
    Content {
        body: body.into_string(),
        model: model(study, pairs).to_string(),
    }
}

/// What is plausibly a mistake; nothing where there is none.
fn warnings(study: &Study<'_>, bench: Option<&BenchPoints>) -> Markup {
    let records = mixer_compiler::lint(study.compiled).records();
    let doubts = bench.map_or_else(Vec::new, |bench| bench.doubts(study));
    html! {
        @if !records.is_empty() || !doubts.is_empty() {
            ul.warnings {
                @for record in &records {
                    li {
                        b {
                            "Warning"
                            @if let Some(line) = record.line { ", line " (line) }
                            ":"
                        }
                        " " (record.message) ". " (record.help) "."
                    }
                }
                @for doubt in &doubts { li { b { "Warning:" } " " (printable(doubt)) "." } }
            }
        }
    }
}

/// A figure with its caption, the link to its data, and a place for the values under the pointer.
fn shown(figure: &Figure, caption: &str, data: &Markup) -> Markup {
    still(&figure.with_readout().into_string(), caption, data)
}

/// A picture without values under the pointer.
fn still(svg: &str, caption: &str, data: &Markup) -> Markup {
    html! { figure { (PreEscaped(svg)) figcaption { (caption) " " (data) } } }
}

/// A figure whose data are its curves, in a file whose name ends in `word`.
fn curves(study: &Study<'_>, figure: &Figure, caption: &str, word: &str) -> Markup {
    shown(figure, caption, &link::curves(study, word, figure))
}

/// A small figure with the table of what it shows.
fn beside(figure: &Markup, table: &Markup) -> Markup {
    html! { div.beside { (figure) (table) } }
}

/// Figures and tables in rows that are full: of three where three go into their number, else of two.
fn figures(figures: &[Markup]) -> Markup {
    let three = figures.len().is_multiple_of(3);
    html! { div.figures.three[three] { @for figure in figures { (figure) } } }
}

fn layout_section(study: &Study<'_>) -> Markup {
    let figure = layout::layout(&study.compiled.airframe);
    let caption = "Seen from above; disks are not to scale. Motor 1 is output 0 of code and airframe file.";
    html! {
        (beside(&still(&figure.svg(), caption, &link::sweep(study, Data::Layout)), &table::units(study)))
    }
}

fn level_section(study: &Study<'_>) -> Markup {
    let voltages = study.voltages().into_iter();
    let levels = voltages.map(|(volts, _)| (volts, level::against_thrust(study, volts, THRUSTS)));
    let levels: Vec<_> = levels.collect();
    let mut plots: Vec<Markup> = Vec::new();
    for (rotor, (name, _)) in study.compiled.airframe.layers().enumerate() {
        let figure = plots::throttle(study, &levels, (rotor, name));
        let caption = format!("Mean throttle of the {name} rotors.");
        plots.push(curves(study, &figure, &caption, &format!("throttle-{name}")));
    }
    if let Some(figure) = plots::hover_throttle(study, &level::against_voltage(study)) {
        let data = link::sweep(study, Data::Hover);
        plots.push(shown(&figure, "Mean throttles in hover against voltage.", &data));
    }
    let reference_v = study.compiled.airframe.reference_v();
    let is_reference = |volts: &Option<f64>| volts.is_none_or(|volts| volts == reference_v);
    let reference = levels.iter().find(|(volts, _)| is_reference(volts));
    if let Some(figure) = reference.and_then(|(_, levels)| plots::power(study, levels)) {
        let at = study.at_reference();
        let alone = match at.as_str() {
            "" => "",
            _ => " The map holds at this voltage alone: power against voltage is not known.",
        };
        let caption = format!("Electrical power of all rotors{at}, by the file\u{2019}s map.{alone}");
        plots.push(curves(study, &figure, &caption, "power"));
    }
    html! {
        p { "Level flight: thrust and no torque, as the mixer delivers it. A curve ends where the thrust is no longer delivered in full." }
        (figures(&plots))
    }
}

fn comparison_section(study: &Study<'_>) -> Markup {
    let Some(comparison) = Comparison::sweep(study, YAW_COMMANDS) else {
        return html! { p { (printable(&no_yaw(study))) "." } };
    };
    let curves = |figure: Figure, caption: &str, word: &str| curves(study, &figure, caption, word);
    let plane = shown(
        &plots::yaw_plane(study, &comparison),
        "Thrust and torque of every unit, one point per yaw command (Fig. 6 of the paper).",
        &link::sweep(study, Data::Yaw),
    );
    let thrusts = plots::yaw_thrusts(&comparison).into_iter().enumerate();
    let thrusts =
        thrusts.map(|(k, figure)| curves(figure, "Thrust of the units.", &format!("yaw-thrust-{k}")));
    let others = [
        curves(plots::yaw_total(&comparison), "Total thrust given.", "yaw-total"),
        curves(
            plots::yaw_error(&comparison),
            "Yaw given less yaw asked.",
            "yaw-error",
        ),
    ];
    let plots: Vec<Markup> = [plane].into_iter().chain(thrusts).chain(others).collect();
    let isolated = match study.compiled.airframe.pairs.is_empty() {
        true => "that of the single rotors in the mean",
        false => {
            "f(d, 0) of the pairs\u{2019} mean map, the lower rotor at rest: an extrapolation where the bench kept both turning"
        }
    };
    html! {
        p {
            "A total thrust of " (shortest(comparison.thrust_n)) " N"
            @if study.hover_n() == Some(comparison.thrust_n) { ", the weight," }
            " and yaw over the whole range that this mixer \
             delivers there. The conventional mixer takes every rotor for isolated, with a torque proportional to its \
             thrust, and takes its thrust for " (isolated) ". Both mixers\u{2019} throttles are put through the units\u{2019} maps" (study.at_reference()) ": what \
             is shown is what the rotors give by that, not what the mixers believe."
        }
        (figures(&plots))
        (table::comparison(&comparison))
    }
}

fn authority_section(study: &Study<'_>) -> Markup {
    let all = authority::against_thrust(study, &study.reference(), THRUSTS);
    let voltage = study.compiled.airframe.voltage.as_ref();
    let lowest = voltage.map(|voltage| {
        let [lowest_v, _] = voltage.range;
        let all = authority::against_thrust(study, &study.at(Some(lowest_v)), THRUSTS);
        (format!("{lowest_v} V"), all)
    });
    let rotor_out = authority::with_a_rotor_out(study, THRUSTS_ROTOR_OUT);
    let is_held = rotor_out
        .iter()
        .any(|at| at.torque_nm.iter().flatten().any(|torque| torque.abs() > 0.0));
    let mut cases: Vec<plots::Case<'_>> = Vec::new();
    if let Some((name, all)) = &lowest {
        cases.push((name, "series-3", all));
    }
    if is_held {
        cases.push(("any one rotor out", "series-2", &rotor_out));
    }
    let plot = |axis: Axis| {
        let figure = plots::authority(study, &all, &cases, axis)?;
        let caption = format!("{} against thrust.", ["Roll", "Pitch", "Yaw"][axis as usize]);
        let word = format!("authority-{}", axis.name());
        Some(curves(study, &figure, &caption, &word))
    };
    let plots: Vec<Markup> = study.torque_axes().into_iter().filter_map(plot).collect();
    let at = study.at_reference();
    let rotor_out = match is_held {
        true => format!("With any one rotor out: what is left whichever it is{at}."),
        false => "With one rotor out, whichever it is, no thrust is held without a torque.".to_owned(),
    };
    let reference_v = voltage.map(|voltage| voltage.reference);
    let served = study.torque_axes().into_iter();
    let off: Vec<String> = served
        .filter_map(|axis| Some((axis, hover::band(study.compiled, axis, reference_v)?)))
        .map(|(axis, band)| format!("\u{b1} {} N m of {}", significant(band, 2), axis.name()))
        .collect();
    let views = study.compiled.airframe.views();
    let mut sources: Vec<&str> = views
        .filter_map(|view| Some(view.of.measured().uncertainty?.source()))
        .collect();
    sources.dedup();
    html! {
        p {
            "The largest torque about one axis that the compiled mixer delivers in full, within its tolerance, while it \
             holds the thrust and no other torque is asked, found by asking the mixer itself. "
            (rotor_out)
            @if !off.is_empty() {
                " The model is " (sources.join(" and ")) ": by one standard deviation of its uncertainty the true torques are off by "
                (off.join(", ")) "."
            }
        }
        (figures(&plots))
    }
}

fn rotors_section(study: &Study<'_>, rotors: &[Study<'_>]) -> Markup {
    let hover = study.hover_n().map_or("", |_| " Diamonds: hover.");
    let plot = |effort: Effort| {
        let caption = format!(
            "{} over the throttle{}.{hover}",
            effort.name(),
            study.at_reference()
        );
        curves(
            study,
            &plots::rotors(rotors, effort),
            &caption,
            &format!("rotors-{}", effort.word()),
        )
    };
    html! {
        (figures(&Effort::BOTH.map(plot)))
        (table::rotors(study))
    }
}

fn attainable_section(study: &Study<'_>) -> Markup {
    let caption = if study.compiled.airframe.voltage.is_some() {
        "What one unit can give at the lowest, the reference and the highest voltage."
    } else {
        "What one unit can give. The airframe has no voltage correction."
    };
    html! {
        (beside(
            &shown(&plots::attainable(study), caption, &link::sweep(study, Data::Attainable)),
            &table::attainable(study),
        ))
    }
}

fn forward_section(study: &Study<'_>, bench: Option<&BenchPoints>) -> Markup {
    let points = bench.map_or("", |_| " Bench points with their distance from it.");
    let flown = study.flown.as_ref();
    let where_flown = flown.map_or("", |_| " Small dots: where the pairs flew.");
    let maps = Effort::BOTH.map(|effort| {
        let quantity = effort.name();
        let surface = still(
            &surface::surface(study, effort, bench),
            &format!("{quantity} of one unit by the model.{points} (Fig. 3 of the paper)"),
            &html! {},
        );
        let map = shown(
            &maps::forward(study, effort, bench),
            &format!("{quantity} with iso-curves.{where_flown} (Fig. 4)"),
            &html! {},
        );
        [surface, map]
    });
    let residual = |effort: Effort| {
        let figure = maps::residuals(study, effort, bench?)?;
        let caption = format!(
            "{} by the model less {} measured, in % of the pair\u{2019}s largest; + is too much by the model.",
            effort.name(),
            effort.word()
        );
        Some(shown(&figure, &caption, &link::bench(study, bench?, effort)))
    };
    let residuals: Vec<Markup> = Effort::BOTH.into_iter().filter_map(residual).collect();
    html! {
        @if let Some(bench) = bench { (bench_points(study, bench)) }
        @if let Some(flown) = flown { (table::flown(flown)) }
        (figures(maps.as_flattened()))
        (link::sweep_of_all(study, Data::Forward))
        @if !residuals.is_empty() { (figures(&residuals)) }
        (table::coefficients(study))
    }
}

/// What bench points there are, and how well the model meets them.
fn bench_points(study: &Study<'_>, bench: &BenchPoints) -> Markup {
    let voltage = match bench.corrected {
        true => "brought to the model\u{2019}s voltage",
        false => "as measured",
    };
    let [low, _] = study.pair.range();
    let is_below = |point: &&BenchPoint| point.throttles.iter().any(|t| *t < low);
    let (all, low) = (bench.outside.len(), shortest(low));
    let outside = match bench.outside.iter().filter(is_below).count() {
        0 => format!("{all} more lie outside the throttle range"),
        below if below == all => format!("{all} more lie below the idle of {low}"),
        below => {
            format!("{all} more lie outside the throttle range, {below} of them below the idle of {low}")
        }
    };
    html! {
        p {
            (bench.points.len()) " bench points of "
            @for (index, file) in bench.files.iter().enumerate() {
                @if index > 0 { ", " }
                code { (printable(file)) }
            }
            ", " (voltage) "."
            @if all > 0 { " " (outside) ": small in the maps of what the model misses, and in no number." }
        }
        @for row in &bench.refused { p { "Refused: " (printable(row)) } }
        (table::bench(study, bench))
    }
}

fn inverse_section(study: &Study<'_>) -> Markup {
    let captions = [
        "The upper rotor\u{2019}s throttle. (Fig. 5 of the paper)",
        "The lower rotor\u{2019}s throttle.",
    ];
    let maps = [0, 1].map(|rotor| shown(&maps::inverse(study, rotor), captions[rotor], &html! {}));
    html! {
        (figures(&maps))
        (link::sweep_of_all(study, Data::Inverse))
    }
}

fn error_section(study: &Study<'_>) -> Markup {
    let Some((_, of)) = study.of_pair() else {
        return html! {};
    };
    let observed = &of.residual;
    let at = match study.at_reference().as_str() {
        "" => " with the pair\u{2019}s map".to_owned(),
        at => at.to_owned(),
    };
    let plot = |effort| {
        let caption = format!(
            "Proven for every point of the set: {} {unit} at most. Observed at {} points: {} {unit}, both{at}.",
            rounded_up(maps::error_bound(study, effort)),
            observed.points,
            rounded_up(observed.efforts[effort as usize]),
            unit = effort.unit()
        );
        shown(
            &maps::error(study, effort, &maps::error_field(study, effort)),
            &caption,
            &html! {},
        )
    };
    let plots: Vec<Markup> = Effort::BOTH.map(plot).into();
    html! {
        p {
            "What the emitted inverse misses when its throttles are put through the forward map: the inverse in single \
             precision as on the target, the map in double precision. Colours are logarithmic over two decades up to the \
             proven bound."
        }
        (figures(&plots))
        (link::sweep_of_all(study, Data::Error))
    }
}

fn cost_section(study: &Study<'_>, facts: &[Fact]) -> Markup {
    let costs = Cost::new(study.compiled);
    let facts = facts.iter().filter(|fact| fact.is_cost());
    html! {
        p {
            (costs.target)
            ". The inverse map is counted on its own; its cycles are its instructions and 13 more \
             for every division and square root. The whole mix is estimated: the inverse map of all units, and for checks, \
             voltage and allocation what counted mixers that desaturate "
            (costs.desaturates())
            " take per unit and per mix beside it. Memory that makes the core wait is not in it."
        }
        (table::facts(facts, &[]))
    }
}

/// What the script needs of all pairs.
fn model(study: &Study<'_>, pairs: &[Study<'_>]) -> serde_json::Value {
    let pairs: Vec<_> = pairs.iter().map(model_of).collect();
    serde_json::json!({ "throttle": study.pair.range(), "pairs": pairs })
}

/// What the script needs of a pair: the forward map and the error on its grid.
fn model_of(study: &Study<'_>) -> serde_json::Value {
    let terms = study.of_pair().map_or_else(Vec::new, |(pair, _)| {
        let coefficients = pair.thrust_n.iter().zip(&pair.torque_nm);
        let terms = pair.basis.exponents().iter().zip(coefficients);
        terms
            .map(|(&(i, j), (&f, &q))| serde_json::json!([i, j, f, q]))
            .collect()
    });
    let grids = Effort::BOTH.map(|effort| {
        let field = maps::error_field(study, effort);
        let largest = field.values().iter().copied().fold(0.0, f64::max);
        // Where nothing is missed, 0 / 0 is NaN, which becomes 0.
        let share = |x: &f64| (1e3 * x / largest).round() as u16;
        let thousandths: Vec<u16> = field.rows(HOVER_STRIDE).flatten().map(share).collect();
        let side = (field.side() - 1) / HOVER_STRIDE + 1;
        serde_json::json!({ "side": side, "largest": largest, "thousandths": thousandths })
    });
    serde_json::json!({ "scale": study.pair.scale(), "terms": terms, "errors": grids })
}
