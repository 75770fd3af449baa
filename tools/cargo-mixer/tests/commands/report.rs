//! The report page and the data of its figures: well-formed, complete, self-contained, true, and
//! without an error in a browser.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Output;
use std::{env, fs};

use mixer_compiler::{Compiled, Source, compile};
use mixer_files::report::data::{Data, sweep};
use mixer_files::report::page::page;
use mixer_files::report::study::Study;
use roxmltree::{Document, Node, ParsingOptions};

use crate::{root, run};

mod browser;
mod content;
mod mixers;
mod pictures;

/// A place for a file that is not there yet.
fn scratch(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("report-{name}"));
    let _ = fs::remove_file(&path);
    path
}

/// Every file of `airframes/`, compiled, in order.
fn airframes() -> Vec<Compiled> {
    let airframes = folder("airframes");
    assert!(airframes.len() >= 5, "{}", airframes.len());
    airframes
}

/// Every airframe file of a folder, compiled, in order.
fn folder(name: &str) -> Vec<Compiled> {
    let mut paths: Vec<PathBuf> = fs::read_dir(root().join(name))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    paths.sort();
    paths.iter().map(|path| compiled(path)).collect()
}

fn compiled(path: &Path) -> Compiled {
    compile_text(&fs::read_to_string(path).unwrap())
}

fn compile_text(text: &str) -> Compiled {
    compile(&Source::new("test.toml", text)).unwrap_or_else(|faults| panic!("{faults}"))
}

fn x8() -> Compiled {
    compiled(&root().join("airframes/isae-x8.toml"))
}

fn parsed(page: &str) -> Document<'_> {
    let options = ParsingOptions {
        allow_dtd: true,
        ..ParsingOptions::default()
    };
    Document::parse_with_options(page, options).unwrap()
}

fn named<'a, 'd>(node: Node<'a, 'd>, tag: &'static str) -> impl Iterator<Item = Node<'a, 'd>> {
    node.descendants()
        .filter(move |node| node.tag_name().name() == tag)
}

/// How many points each group of a class has.
fn points(document: &Document<'_>, class: &str) -> Vec<usize> {
    let groups = named(document.root(), "g").filter(|group| group.attribute("class") == Some(class));
    groups.map(|group| named(group, "circle").count()).collect()
}

/// Largest page of an airframe without bench points, bytes for each pair.
const LARGEST_PAGE: usize = 500_000;

#[test]
fn pages_are_well_formed_and_complete() {
    // The fixtures have tilted axes, other bases, other evaluators and voltage laws.
    for compiled in airframes().into_iter().chain(folder("tests/fixtures")) {
        let name = &compiled.airframe.name;
        let study = Study::new(&compiled, None);
        let page = page(&study, None, None);
        let most = LARGEST_PAGE * compiled.airframe.pairs.len().max(1);
        assert!(page.len() < most, "{name}: {} bytes", page.len());
        let document = parsed(&page);
        let sections: Vec<(&str, Node)> = named(document.root(), "section")
            .map(|section| (section.attribute("id").unwrap(), section))
            .collect();
        let anchors: Vec<&str> = sections.iter().map(|(id, _)| *id).collect();
        let has_single = usize::from(anchors.contains(&"rotors"));
        assert_eq!(has_single == 1, compiled.airframe.single_units() > 0, "{name}");
        // Four sections are of pairs.
        let of_pairs = if compiled.airframe.pairs.is_empty() { 7 } else { 11 };
        assert!(
            anchors.len() == of_pairs + has_single
                && anchors[0] == "layout"
                && anchors.last() == Some(&"matrices"),
            "{name}: {anchors:?}"
        );
        for (id, section) in &sections {
            let pictures = named(*section, "svg").count();
            let tables_only = ["cost", "matrices", "bench-check"].contains(id);
            assert!(pictures > 0 || tables_only, "{name}: no picture in {id}");
            assert_eq!(named(*section, "h2").count(), 1, "{name}: {id}");
        }
        let tables = named(document.root(), "table").count();
        assert!(tables >= 5, "{name}: {tables} tables");
        for svg in named(document.root(), "svg").filter(|svg| svg.attribute("aria-hidden").is_none()) {
            assert!(!svg.attribute("aria-label").unwrap().is_empty(), "{name}");
            assert!(
                named(svg, "text").count() > 4,
                "{name}: a picture without ticks and labels"
            );
            assert!(named(svg, "path").count() > 1, "{name}: an empty picture");
        }
        for node in document.descendants() {
            for attribute in node.attributes() {
                let value = attribute.value();
                assert!(
                    !value.contains("NaN") && !value.contains("inf"),
                    "{name}: {attribute:?}"
                );
            }
        }
        // As many roll, pitch and yaw plots as there are served axes.
        let authority = sections.iter().find(|(id, _)| *id == "authority").unwrap().1;
        let served = compiled.airframe.allocation.axes.len() - 1;
        assert_eq!(named(authority, "figure").count(), served, "{name}");
    }
}

#[test]
fn pages_refer_to_nothing_outside() {
    for compiled in airframes() {
        let page = page(&Study::new(&compiled, None), None, None);
        let document = parsed(&page);
        let anchors: BTreeSet<&str> = document.descendants().filter_map(|n| n.attribute("id")).collect();
        for node in document.descendants() {
            let tag = node.tag_name().name();
            assert!(
                !matches!(
                    tag,
                    "link" | "img" | "iframe" | "object" | "embed" | "image" | "use" | "base"
                ),
                "{tag}"
            );
            for attribute in node.attributes() {
                let (name, value) = (attribute.name(), attribute.value());
                assert!(
                    !matches!(name, "src" | "srcset" | "action" | "data" | "style"),
                    "{name}"
                );
                assert!(!name.starts_with("on"), "{name}");
                if name == "href" && !value.starts_with("data:text/csv;") {
                    assert!(anchors.contains(value.strip_prefix('#').unwrap()), "{value}");
                }
            }
        }
        for forbidden in [
            "url(",
            "@import",
            "fetch(",
            "XMLHttpRequest",
            "WebSocket",
            "import(",
        ] {
            assert!(!page.contains(forbidden), "{forbidden}");
        }
        for (place, _) in page.match_indices("http") {
            let rest = &page[place..];
            assert!(
                rest.starts_with("http://www.w3.org/") || rest.starts_with("http-equiv"),
                "{}",
                rest.chars().take(60).collect::<String>()
            );
        }
    }
}

#[test]
fn text_of_the_airframe_is_no_markup() {
    let text = fs::read_to_string(root().join("airframes/single-pair.toml")).unwrap();
    let text = text.replace("One coaxial pair", "<script>alert(1)</script> & <b>");
    let compiled = compile_text(&text);
    let page = page(&Study::new(&compiled, None), None, None);
    let document = parsed(&page);
    let lead = document
        .descendants()
        .find(|n| n.attribute("class") == Some("lead"))
        .unwrap();
    assert!(
        lead.text()
            .unwrap()
            .starts_with("<script>alert(1)</script> & <b>"),
        "{lead:?}"
    );
    assert_eq!(named(document.root(), "script").count(), 2);
}

#[test]
fn sweeps_are_rectangular_with_units_in_the_header() {
    for compiled in airframes() {
        let study = Study::new(&compiled, None);
        for (figure, ..) in Data::ALL {
            let data = match sweep(&study, figure) {
                Ok(data) => data,
                Err(message) => {
                    assert!(figure == Data::Hover && message.contains("mass_kg"), "{message}");
                    continue;
                }
            };
            let mut reader = csv::Reader::from_reader(data.as_bytes());
            let header = reader.headers().unwrap().clone();
            for column in &header {
                let known = [
                    "_nm",
                    "_n",
                    "_v",
                    "_m",
                    "_w",
                    "_throttle",
                    "mixer",
                    "throttle_limited",
                    "unit",
                    "layer",
                    "spin",
                    "channel",
                ];
                assert!(known.iter().any(|end| column.ends_with(end)), "{column}");
            }
            let mut rows = 0;
            for record in reader.records() {
                let record = record.unwrap_or_else(|error| panic!("{figure:?}: {error}"));
                for (column, cell) in header.iter().zip(&record) {
                    let may_be_empty = figure == Data::Level || column == "voltage_v";
                    let free =
                        ["mixer", "layer", "spin"].contains(&column) || (may_be_empty && cell.is_empty());
                    assert!(
                        free || cell.parse::<f64>().is_ok_and(f64::is_finite),
                        "{column}: {cell}"
                    );
                }
                rows += 1;
            }
            let least = match figure {
                Data::Layout => compiled.airframe.units.len(),
                Data::Hover => 41,
                _ => 50,
            };
            assert!(rows >= least, "{figure:?}: {rows} rows");
        }
    }
}

#[test]
fn the_error_stays_below_its_bound() {
    for compiled in airframes() {
        let study = Study::new(&compiled, None);
        let allowed = compiled.of_pairs[0].certificate.reference;
        let data = sweep(&study, Data::Error).unwrap();
        let mut largest = [0.0f64; 2];
        for line in data.lines().skip(1) {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            largest = [largest[0].max(cells[4].abs()), largest[1].max(cells[5].abs())];
        }
        assert!(
            largest[0] > 0.0 && largest[1] > 0.0,
            "an inverse without any error"
        );
        assert!(
            largest[0] <= allowed[0] && largest[1] <= allowed[1],
            "{largest:?} {allowed:?}"
        );
    }
}

/// A quadcopter of the rotors of y4, with its weight.
fn quad() -> String {
    let y4 = fs::read_to_string(root().join("airframes/y4.toml")).unwrap();
    let part = |from: &str, to: &str| {
        let start = y4.find(from).unwrap();
        y4[start..start + y4[start..].find(to).unwrap()].to_owned()
    };
    let mut text =
        "name = \"quad\"\n".to_owned() + &part("[throttle]", "[[pair]]") + &part("\n[[rotor]]\n", "[[unit]]");
    for (channel, (x, y, spin)) in [(3, 3, "ccw"), (-3, -3, "ccw"), (3, -3, "cw"), (-3, 3, "cw")]
        .into_iter()
        .enumerate()
    {
        text += &format!(
            "[[unit]]\nposition_m = [{x}.0e-1, {y}.0e-1, 0.0]\nupper_spin = \"{spin}\"\nrotor = \"front\"\nchannels = [{channel}]\n"
        );
    }
    text + "[vehicle]\nmass_kg = 4.2\n"
}

#[track_caller]
fn assert_status(output: &Output, status: i32, words: &str) {
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(status), "{text}");
    assert!(text.contains(words) && !text.contains("panicked"), "{text}");
}

/// A bench file that is off the model by a known amount: the page shows its points and finds the
/// amount.
#[test]
fn bench_points_stand_beside_the_model() {
    let compiled = x8();
    let study = Study::new(&compiled, None);
    let mut bench = String::from("upper,lower,thrust_n,torque_nm\n");
    for i in 1..=10 {
        for j in 1..=10 {
            let (u, l) = (f64::from(i) / 10.0, f64::from(j) / 10.0);
            let [f, q] = study.pair.efforts([u, l]);
            let off = if (i + j) % 2 == 0 { 0.1 } else { -0.1 };
            bench.push_str(&format!("{u},{l},{},{}\n", f + off, q + 0.01 * off));
        }
    }
    // Below the airframe's idle, where the model is not used.
    bench.push_str("0.05,0.5,3.0,0.02\n");
    let file = scratch("bench.csv");
    fs::write(&file, bench).unwrap();
    let output = scratch("bench.html");
    let (file, output) = (file.display().to_string(), output.display().to_string());
    let told = run(&[
        "report",
        "airframes/isae-x8.toml",
        "-o",
        &output,
        "--bench",
        &file,
    ]);
    assert_status(&told, 0, "");
    let page = fs::read_to_string(&output).unwrap();
    let document = parsed(&page);
    // Thrust and torque, each as a surface and as a map.
    assert_eq!(points(&document, "bench-dot"), [100; 4]);
    assert!(page.contains("1 more lie below the idle of 0.1"));
    let cells: Vec<&str> = named(document.root(), "td")
        .filter_map(|cell| cell.text())
        .collect();
    // In N or N m and in percent of the pair's largest effort, with the row of the largest.
    let scale = study.pair.scale();
    for (rms, size, scale) in [("0.100", 0.1, scale[0]), ("0.00100", 0.001, scale[1])] {
        let percent = format!("{:.2}", 100.0 * size / scale);
        let told = |row: &[&str]| row[..4] == [rms, &percent, rms, &percent] && row[4].starts_with("line ");
        assert!(cells.windows(5).any(told), "{rms}: {cells:?}");
    }
}
