//! Pictures as files of their own, for documents: a gallery of airframes and the figures of one of
//! them.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use mixer_compiler::Compiled;
use mixer_compiler::airframe::Axis;

use crate::report::authority;
use crate::report::comparison::Comparison;
use crate::report::data::{THRUSTS, YAW_COMMANDS};
use crate::report::effort::Effort;
use crate::report::figure::Figure;
use crate::report::maps;
use crate::report::page::FIGURE_STYLE;
use crate::report::plots;
use crate::report::study::Study;
use crate::report::surface;
use crate::report::{layout, number};

/// Files by name with their text.
pub type Files = BTreeMap<String, String>;

/// `gallery.md` and its pictures: layout, yaw sweep and yaw authority of every airframe, in the
/// order given.
pub fn gallery(airframes: &[Compiled]) -> Files {
    let mut files = Files::new();
    let mut page = String::from(
        "# Gallery\n\nThe airframes of [`airframes/`](../airframes), drawn by `cargo gallery`. \
         `cargo mixer report` shows much more of each.\n",
    );
    for compiled in airframes {
        let study = Study::new(compiled, None);
        let name = &compiled.airframe.name;
        let _ = writeln!(page, "\n## {name}\n\n{}\n", compiled.airframe.description);
        let mut add = |picture: &str, text: &str, figure: &Figure| {
            let name = format!("{name}-{picture}.svg");
            let _ = write!(page, "<img src=\"{name}\" width=\"32%\" alt=\"{text}\"> ");
            files.insert(name, styled(&figure.svg()));
        };
        add("layout", "Layout from above", &layout::layout(&compiled.airframe));
        if let Some(comparison) = Comparison::sweep(&study, YAW_COMMANDS) {
            let text = format!("Yaw at {} N by both mixers", number::shortest(study.thrust_n));
            add("yaw", &text, &plots::yaw_plane(&study, &comparison));
        }
        let all = authority::against_thrust(&study, &study.reference(), THRUSTS);
        if let Some(figure) = plots::authority(&study, &all, &[], Axis::Yaw) {
            add("authority", "Yaw authority against thrust", &figure);
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
    let mut write = |picture: &str, svg: &str| files.insert(format!("{name}-{picture}.svg"), styled(svg));
    for effort in Effort::BOTH {
        let word = effort.word();
        let surface = surface::surface(&study, effort, None);
        let forward = maps::forward(&study, effort, None).svg();
        let error = maps::error(&study, effort, &maps::error_field(&study, effort)).svg();
        for (picture, svg) in [("surface", surface), ("forward", forward), ("error", error)] {
            write(&format!("{picture}-{word}"), &svg);
        }
    }
    write("inverse-upper", &maps::inverse(&study, 0).svg());
    write("inverse-lower", &maps::inverse(&study, 1).svg());
    write("attainable", &plots::attainable(&study).svg());
    if let Some(comparison) = Comparison::sweep(&study, YAW_COMMANDS) {
        write("yaw-thrust", &plots::yaw_thrust(&comparison).svg());
        write("yaw-total", &plots::yaw_total(&comparison).svg());
    }
    files
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
