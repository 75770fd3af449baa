//! Pictures as files of their own, for documents: a gallery of airframes and the figures of one of
//! them.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use mixer_compiler::Compiled;
use mixer_compiler::airframe::Axis;

use crate::authority;
use crate::comparison::Comparison;
use crate::data::{THRUSTS, YAW_COMMANDS};
use crate::effort::Effort;
use crate::figure::Figure;
use crate::maps;
use crate::page::FIGURE_STYLE;
use crate::plots;
use crate::study::Study;
use crate::surface;
use crate::{layout, number};

/// Files by name with their text.
pub type Files = BTreeMap<String, String>;

/// `gallery.md` and its pictures: layout, yaw sweep and yaw authority of every airframe, in the
/// order given.
pub fn gallery(airframes: &[Compiled]) -> Files {
    let mut files = Files::new();
    let mut page = String::from(
        "# Gallery\n\nThe airframes of [`airframes/`](../airframes), drawn by `cargo xtask gallery`. \
         `cargo mixer report` shows much more of each.\n",
    );
    for compiled in airframes {
        let study = Study::new(compiled, None);
        let name = &compiled.airframe.name;
        let _ = writeln!(page, "\n## {name}\n\n{}\n", compiled.airframe.description);
        let mut add = |picture: &str, text: &str, svg: String| {
            let file = format!("{name}-{picture}.svg");
            let _ = write!(page, "<img src=\"{file}\" width=\"32%\" alt=\"{text}\"> ");
            files.insert(file, svg);
        };
        add(
            "layout",
            "Layout from above",
            file(&layout::layout(&compiled.airframe)),
        );
        if let Some(comparison) = Comparison::sweep(&study, YAW_COMMANDS) {
            let text = format!("Yaw at {} N by both mixers", number::shortest(study.thrust_n));
            add("yaw", &text, file(&plots::yaw_plane(&study, &comparison)));
        }
        let all = authority::against_thrust(&study, &study.reference(), THRUSTS);
        if let Some(figure) = plots::authority(&study, &all, &[], Axis::Yaw) {
            add("authority", "Yaw authority against thrust", file(&figure));
        }
        page.push('\n');
    }
    files.insert("gallery.md".to_owned(), page);
    files
}

/// The figures of one airframe: forward, inverse and error maps, attainable set, thrust over yaw.
pub fn figures(compiled: &Compiled) -> Files {
    let study = Study::new(compiled, None);
    let name = &compiled.airframe.name;
    let mut files = Files::new();
    let mut add = |picture: &str, svg: String| files.insert(format!("{name}-{picture}.svg"), svg);
    for (effort, word) in Effort::BOTH.into_iter().zip(["thrust", "torque"]) {
        add(
            &format!("surface-{word}"),
            styled(&surface::surface(&study, effort, None)),
        );
        add(
            &format!("forward-{word}"),
            file(&maps::forward(&study, effort, None)),
        );
        let field = maps::error_field(&study, effort);
        add(
            &format!("error-{word}"),
            file(&maps::error(&study, effort, &field)),
        );
    }
    add("inverse-upper", file(&maps::inverse(&study, 0)));
    add("inverse-lower", file(&maps::inverse(&study, 1)));
    add("attainable", file(&plots::attainable(&study)));
    if let Some(comparison) = Comparison::sweep(&study, YAW_COMMANDS) {
        add("yaw-thrust", file(&plots::yaw_thrust(&comparison)));
        add("yaw-total", file(&plots::yaw_total(&comparison)));
    }
    files
}

fn file(figure: &Figure) -> String {
    styled(&figure.svg())
}

/// A picture with the style that the page would give it, and a ground of its own: documents may be
/// light or dark.
fn styled(svg: &str) -> String {
    let style = format!("<style>\n{FIGURE_STYLE}svg.figure {{ background: var(--paper); }}\n</style>\n");
    match svg.split_once('\n') {
        Some((start, rest)) => format!("{start}\n{style}{rest}"),
        None => svg.to_owned(),
    }
}
