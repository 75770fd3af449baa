//! The documents: tables are what their commands write, links lead somewhere, code blocks are what
//! they say.
//!
//! Rust blocks are run as documentation tests, see `src/lib.rs`.
#![allow(missing_docs)]

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use mixer_compiler::Source;
use mixer_compiler::diagnostic::{Code, Severity};
use mixer_tests::{allocators, bases, documents, interaction, root};

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn tables_are_what_the_command_writes() {
    let tables = documents::tables().unwrap_or_else(|error| panic!("{error}"));
    let mut stale = Vec::new();
    for table in &tables {
        let page = read(&root().join(table.page));
        let filled = documents::filled(&page, table).unwrap_or_else(|error| panic!("{error}"));
        // Sizes change with every change of code; a look at them is due where something is added.
        if filled != page && table.name != "sizes" {
            stale.push(format!("{}: {}", table.page, table.name));
        }
    }
    assert!(stale.is_empty(), "{stale:?} are stale; run `cargo tables`");
    for path in documents::pages().expect("documents") {
        for name in read(&path)
            .lines()
            .filter_map(|line| line.strip_prefix("<!-- table: ")?.strip_suffix(" -->"))
        {
            let written = tables
                .iter()
                .any(|table| table.name == name && path == root().join(table.page));
            assert!(written, "{}: nothing writes the table {name}", path.display());
        }
    }
}

#[test]
fn allocators_measure_what_is_held() {
    let rows = allocators::measure().unwrap_or_else(|error| panic!("{error}"));
    let held = read(&allocators::file());
    assert_eq!(held, allocators::text(&rows), "run `cargo allocators`");
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn bases_measure_what_is_held() {
    let data =
        std::env::var_os("MIXER_BENCH_DATA").expect("MIXER_BENCH_DATA names the folder of the bench files");
    let rows = bases::measure(Path::new(&data)).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(read(&bases::file()), bases::text(&rows), "run `cargo bases`");
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn predictions_measure_what_is_held() {
    let data =
        std::env::var_os("MIXER_BENCH_DATA").expect("MIXER_BENCH_DATA names the folder of the bench files");
    let measured = interaction::measure(Path::new(&data)).unwrap_or_else(|error| panic!("{error}"));
    for (path, text) in interaction::files().iter().zip(measured.texts()) {
        assert_eq!(read(path), text, "run `cargo interaction`");
    }
    let mean = |name: &str, effort: usize| {
        let column = interaction::PREDICTIONS
            .iter()
            .position(|known| *known == name)
            .expect("a column");
        let errors = measured.rows.iter().map(|row| row.percent[column][effort]);
        errors.sum::<f64>() / measured.rows.len() as f64
    };
    assert!(mean("shipped", 0) < 1.7 && mean("shipped", 1) < 4.3);
    // Of two systems alone the constants are worse, and still far better than none.
    assert!(
        mean("left out", 0) < 0.25 * mean("isolated", 0) && mean("left out", 1) < 0.65 * mean("isolated", 1)
    );
    assert!(mean("four points", 0) < 1.35 && mean("four points", 1) < 2.8);
}

/// A stranger reads it in two minutes.
#[test]
fn the_readme_is_short() {
    let readme = read(&root().join("README.md"));
    assert!(readme.lines().count() <= 250, "{} lines", readme.lines().count());
    assert!(readme.len() <= 16_000, "{} bytes", readme.len());
}

/// Headings as their anchors: lower case, without punctuation, `-` for a space.
fn anchors(page: &str) -> BTreeSet<String> {
    let headings = page
        .lines()
        .filter(|line| line.starts_with('#'))
        .map(|line| line.trim_start_matches('#').trim());
    headings
        .map(|heading| {
            let kept = heading
                .chars()
                .filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
            kept.collect::<String>().to_lowercase().replace(' ', "-")
        })
        .collect()
}

/// Targets of `[text](target)` and `src="target"` outside of code.
fn links(page: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut in_code = false;
    for line in page.lines() {
        if line.starts_with("```") {
            in_code = !in_code;
            continue;
        }
        if in_code {
            continue;
        }
        for (open, close) in [("](", ')'), ("src=\"", '"')] {
            let targets = line.split(open).skip(1);
            found.extend(targets.filter_map(|rest| Some(rest.split_once(close)?.0.to_owned())));
        }
    }
    found
}

#[test]
fn links_lead_somewhere() {
    let mut dead = Vec::new();
    let mut count = 0;
    for path in documents::pages().expect("documents") {
        let page = read(&path);
        for link in links(&page) {
            // The forge's own pages stand above the tree.
            if link.contains("://") || link.contains("../releases/latest") {
                continue;
            }
            count += 1;
            let (file, anchor) = link.split_once('#').unwrap_or((&link, ""));
            let target = path.parent().unwrap_or(Path::new("")).join(file);
            let target = if file.is_empty() { path.clone() } else { target };
            let alive = target.exists() && (anchor.is_empty() || anchors(&read(&target)).contains(anchor));
            if !alive {
                dead.push(format!("{}: {link}", path.display()));
            }
        }
    }
    assert!(count > 100, "only {count} links were found");
    assert!(dead.is_empty(), "{dead:#?}");
}

#[test]
fn the_index_has_every_page() {
    let docs = root().join("docs");
    let index = read(&docs.join("SUMMARY.md"));
    let listed: BTreeSet<String> = links(&index).into_iter().collect();
    let pages = documents::pages().expect("documents");
    let names = pages
        .iter()
        .filter(|path| path.parent() == Some(&docs) && !path.ends_with("SUMMARY.md"))
        .filter_map(|path| Some(path.file_name()?.to_string_lossy().into_owned()));
    assert_eq!(listed, names.collect());
}

/// Fenced blocks of a page: language and text.
fn blocks(page: &str) -> Vec<(String, String)> {
    let mut blocks: Vec<(String, String)> = Vec::new();
    let mut open = false;
    for line in page.lines() {
        match line.strip_prefix("```") {
            Some(_) if open => open = false,
            Some(language) => {
                blocks.push((language.to_owned(), String::new()));
                open = true;
            }
            None if open => {
                if let Some((_, text)) = blocks.last_mut() {
                    text.push_str(line);
                    text.push('\n');
                }
            }
            None => {}
        }
    }
    assert!(!open, "a code block is not closed");
    blocks
}

/// A block of TOML that has a name is a whole airframe: it compiles without a warning.
#[test]
fn blocks_of_toml_are_read() {
    let mut airframes = 0;
    for path in documents::pages().expect("documents") {
        for (language, text) in blocks(&read(&path)) {
            let place = format!("{}:\n{text}", path.display());
            assert!(!language.is_empty(), "a block without a language: {place}");
            if language.starts_with("rust") {
                let run = ["README.md", "docs/firmware.md"]
                    .iter()
                    .any(|page| path == root().join(page));
                assert!(run, "src/lib.rs does not run the examples of {place}");
                assert!(!language.contains("ignore"), "{place}");
            }
            if language != "toml" {
                continue;
            }
            let table: toml::Table = text.parse().unwrap_or_else(|error| panic!("{place}{error}"));
            if table.contains_key("name") && table.contains_key("pair") {
                airframes += 1;
                let compiled = mixer_compiler::compile(&Source::new("block.toml", text.clone()))
                    .unwrap_or_else(|faults| panic!("{place}{faults}"));
                let warnings = mixer_compiler::lint(&compiled);
                assert!(warnings.is_empty(), "{place}{warnings}");
            }
        }
    }
    assert!(airframes > 0, "the README has a whole airframe");
}

/// The sections of `docs/airframe.md` make one airframe, so that every key in them is one that the
/// compiler knows.
#[test]
fn the_airframe_page_is_an_airframe() {
    let page = read(&root().join("docs/airframe.md"));
    let toml = blocks(&page)
        .into_iter()
        .filter(|(language, _)| language == "toml");
    // `[layout]` stands in place of `[[unit]]`, and `[pair]` in place of several or of single rotors.
    let sections: Vec<String> = toml
        .map(|(_, text)| text)
        .filter(|text| {
            !["[[unit]]", "[[pair]]", "[[rotor]]"]
                .iter()
                .any(|other| text.starts_with(other))
        })
        .collect();
    let text = sections.concat();
    let compiled = mixer_compiler::compile(&Source::new("airframe.md", text))
        .unwrap_or_else(|faults| panic!("{faults}"));
    assert_eq!(compiled.airframe.units.len(), 4);
}

#[test]
fn every_warning_is_documented() {
    let text = read(&root().join("docs/warnings.md"));
    for code in Code::ALL
        .iter()
        .filter(|code| code.severity() == Severity::Warning)
    {
        assert!(
            text.contains(&format!("\n| {code} | ")),
            "{code} is not in docs/warnings.md"
        );
    }
}
