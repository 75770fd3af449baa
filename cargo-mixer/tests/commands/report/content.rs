//! What a page says of its origin, of a rotor out, of the bench, and how units are written.

use super::*;

fn text_of(node: Node) -> String {
    node.descendants()
        .filter(Node::is_text)
        .filter_map(|n| n.text())
        .collect()
}

fn section<'a, 'd>(document: &'d Document<'a>, id: &str) -> Node<'d, 'a> {
    named(document.root(), "section")
        .find(|section| section.attribute("id") == Some(id))
        .unwrap()
}

/// Headers of all tables of a page.
fn headers(document: &Document) -> Vec<Vec<String>> {
    named(document.root(), "thead")
        .map(|head| named(head, "th").map(text_of).collect())
        .collect()
}

#[test]
fn pages_name_their_origin() {
    let made = |epoch: &str| {
        let output = scratch(&format!("origin-{epoch}.html")).display().to_string();
        let mut command = Command::new(env!("CARGO_BIN_EXE_cargo-mixer"));
        command.args(["report", "airframes/single-pair.toml", "-o", &output]);
        let run = command
            .current_dir(root())
            .env("SOURCE_DATE_EPOCH", epoch)
            .output()
            .unwrap();
        assert_status(&run, 0, "");
        fs::read_to_string(output).unwrap()
    };
    let page = made("951782400");
    assert_eq!(page, made("951782401"), "of one day");
    let summed = Command::new("sha256sum")
        .arg(root().join("airframes/single-pair.toml"))
        .output()
        .unwrap();
    let hash = String::from_utf8(summed.stdout).unwrap();
    let hash = hash.split(' ').next().unwrap();
    assert!(
        page.contains(hash) && page.contains("<td>2000-02-29</td>"),
        "{hash}"
    );
    // All coefficients, with all their digits.
    let pair = compiled(&root().join("airframes/single-pair.toml")).airframe.pair;
    for coefficient in pair.thrust_n.iter().chain(&pair.torque_nm) {
        let cell = format!("<td>{}</td>", format!("{coefficient:?}").replace('-', "\u{2212}"));
        assert!(page.contains(&cell), "{cell}");
    }
}

#[test]
fn the_yaw_table_of_many_units_is_narrow() {
    let compiled = compiled(&root().join("airframes/px4-x12.toml"));
    let page = page(&Study::new(&compiled, None), None, &Origin::default());
    let document = parsed(&page);
    let table = headers(&document)
        .into_iter()
        .find(|header| header[0] == "yaw asked (N m)")
        .unwrap();
    let groups = [
        "f 0, 2, 5 (N)",
        "Q 0, 2, 5 (N m)",
        "f 1, 3, 4 (N)",
        "Q 1, 3, 4 (N m)",
    ];
    assert_eq!(table[2..6], groups);
    assert_eq!(table.len(), 8);
}

#[test]
fn units_of_headers_stand_in_parentheses() {
    for name in ["isae-x8", "px4-y6"] {
        let compiled = compiled(&root().join(format!("airframes/{name}.toml")));
        let page = page(&Study::new(&compiled, None), None, &Origin::default());
        for header in headers(&parsed(&page)).concat() {
            let bare = ["N", "m", "V", "kg", "instructions", "cycles", "bytes"]
                .iter()
                .any(|unit| header.split(' ').any(|word| word == *unit && header != *unit));
            let in_parentheses = header.contains('(') && header.ends_with(')');
            assert!(!bare || in_parentheses, "{header}");
        }
    }
}

#[test]
fn authority_is_shown_at_the_lowest_voltage_and_with_a_rotor_out() {
    let of = |name: &str| {
        let compiled = compiled(&root().join(format!("airframes/{name}.toml")));
        let page = page(&Study::new(&compiled, None), None, &Origin::default());
        let document = parsed(&page);
        let section = section(&document, "authority");
        let curves: Vec<String> = section
            .descendants()
            .filter_map(|n| n.attribute("data-name").map(str::to_owned))
            .collect();
        (curves, text_of(section))
    };
    let (curves, _) = of("isae-x8");
    for curve in ["14.8 V, largest", "12.8 V, largest", "any one rotor out, least"] {
        assert_eq!(curves.iter().filter(|name| *name == curve).count(), 3, "{curve}");
    }
    // One pair turns where a rotor is out.
    let (curves, text) = of("single-pair");
    assert!(
        curves.iter().all(|curve| !curve.contains("rotor out")),
        "{curves:?}"
    );
    assert!(text.contains("no thrust is held without a torque"), "{text}");
}

#[test]
fn captions_stand_below() {
    let page = page(&Study::new(&x8(), None), None, &Origin::default());
    let document = parsed(&page);
    for figure in named(document.root(), "figure") {
        let last = figure.children().rfind(Node::is_element).unwrap();
        assert_eq!(last.tag_name().name(), "figcaption");
        assert!(!text_of(last).is_empty());
    }
}

/// Every bench point has its residual, small where it lies below the idle, within the frame.
#[test]
fn residuals_are_mapped() {
    use mixer_report::bench::{BenchPoint, BenchPoints};

    let compiled = x8();
    let study = Study::new(&compiled, None);
    let point = |u: f64, off: f64| {
        let model = study.pair.efforts([u, 1.0]);
        BenchPoint {
            file: 0,
            line: 2,
            throttles: [u, 1.0],
            measured: [model[0] - off, model[1] + 0.1 * off],
            model,
        }
    };
    let bench = BenchPoints {
        points: vec![point(0.2, 0.1), point(0.6, -0.3), point(1.0, 0.0)],
        outside: vec![point(0.05, 9.0)],
        ..BenchPoints::default()
    };
    let page = page(&study, Some(&bench), &Origin::default());
    assert!(page.contains("1 more lie below the idle of 0.1: small"));
    let document = parsed(&page);
    let maps: Vec<Node> = named(document.root(), "svg")
        .filter(|svg| {
            svg.attribute("aria-label")
                .is_some_and(|label| label.contains("by the model less"))
        })
        .collect();
    assert_eq!(maps.len(), 2);
    for map in maps {
        let frame: Vec<f64> = map
            .attribute("data-box")
            .unwrap()
            .split(' ')
            .map(|number| number.parse().unwrap())
            .collect();
        let dots: Vec<Node> = named(map, "circle")
            .filter(|dot| dot.has_attribute("data-values"))
            .collect();
        let radii: Vec<&str> = dots.iter().map(|dot| dot.attribute("r").unwrap()).collect();
        assert_eq!(radii, ["6", "6", "6", "3.5"]);
        let mut colours: Vec<&str> = dots.iter().map(|dot| dot.attribute("fill").unwrap()).collect();
        colours.dedup();
        assert_eq!(colours.len(), 4, "{colours:?}");
        for dot in dots {
            let at = |name: &str| dot.attribute(name).unwrap().parse::<f64>().unwrap();
            let [left, top, width, height] = frame[..] else {
                panic!("{frame:?}")
            };
            assert!((left + 6.0..=left + width - 6.0).contains(&at("cx")), "{dot:?}");
            assert!((top + 6.0..=top + height - 6.0).contains(&at("cy")), "{dot:?}");
        }
    }
}

/// Power, the saving and the flight time against Q = 0, of an airframe with a power map.
#[test]
fn power_and_its_saving_are_told() {
    let file = "airframes/x8-11in-least-power.toml";
    let told = |file: &str| {
        let compiled = compiled(&root().join(file));
        let page = page(&Study::new(&compiled, None), None, &Origin::default());
        let document = parsed(&page);
        let mut rows = named(document.root(), "tr").map(text_of);
        rows.find(|row| row.starts_with("power") && !row.starts_with("power bias"))
    };
    let line = "power476.7 W at 35.30 N (in hover), 488.6 W at Q = 0: saves 2.44 %, flight time +2.50 %";
    assert_eq!(told(file).as_deref(), Some(line));
    assert_eq!(told("airframes/isae-x8.toml"), None, "it has no power map");
}

/// The page says that a pair was predicted, and by how much its hover and authority may be off.
#[test]
fn predictions_are_said_with_their_bands() {
    let text = fs::read_to_string(root().join("airframes/single-pair.toml")).unwrap();
    let uncertain = "\n[pair.uncertainty]\nthrust_percent = 2.0\ntorque_percent = 4.0\nsource = \"prediction\"\n\n\
                     [vehicle]\nmass_kg = 1.0\n";
    let page_of = |text: &str| {
        let compiled = compile_text(text);
        page(&Study::new(&compiled, None), None, &Origin::default())
    };
    let with = page_of(&(text.clone() + uncertain));
    let document = parsed(&with);
    let rows: Vec<String> = named(document.root(), "tr").map(text_of).collect();
    let told = "pairbiquadratic, predicted: \u{b1} 2 % of the largest thrust, 4 % of the largest torque (one standard deviation)";
    assert!(rows.iter().any(|row| row == told), "{rows:?}");
    assert!(with.contains("by [pair.uncertainty] 0."));
    assert!(with.contains("The pair is predicted: by one standard deviation of its uncertainty"));
    assert!(!page_of(&text).contains("predicted"));
}

/// Every figure has the data of its own, and every plot that is read is reached by the Tab key:
/// itself or each of its curves.
#[test]
fn figures_have_data_and_are_reached_by_keyboard() {
    for compiled in airframes() {
        let name = &compiled.airframe.name;
        let study = Study::new(&compiled, None);
        let page = page(&study, None, &Origin::default());
        let document = parsed(&page);
        let (mut files, mut surfaces) = (BTreeSet::new(), 0);
        for figure in named(document.root(), "figure") {
            let Some(link) = named(figure, "a").find(|link| link.has_attribute("download")) else {
                // A surface has that of the map beside it.
                let next = figure.next_siblings().filter(Node::is_element).nth(1).unwrap();
                assert!(text_of(next).contains("Data of both pictures (CSV)"), "{name}");
                surfaces += 1;
                continue;
            };
            let file = link.attribute("download").unwrap();
            assert!(files.insert(file), "{name}: {file} twice");
            let csv = link.attribute("href").unwrap().split_once(',').unwrap().1;
            let csv = csv.replace("%0A", "\n").replace("%22", "\"").replace("%20", " ");
            let mut reader = csv::Reader::from_reader(csv.as_bytes());
            assert!(reader.headers().unwrap().len() >= 3, "{file}: {csv:.100}");
            let least = if file.ends_with("-layout.csv") {
                compiled.airframe.units.len()
            } else {
                41
            };
            let rows: Result<Vec<_>, _> = reader.records().collect();
            assert!(rows.unwrap().len() >= least, "{file}: {csv:.100}");
        }
        assert_eq!(surfaces, 2, "{name}");
        let read: Vec<Node> = named(document.root(), "svg")
            .filter(|svg| svg.has_attribute("data-hover"))
            .collect();
        assert!(read.len() >= 8, "{name}");
        for svg in read {
            let curves: Vec<Node> = svg
                .descendants()
                .filter(|node| node.has_attribute("data-name"))
                .collect();
            let along_curves = svg.attribute("role") == Some("group");
            assert!(!along_curves || !curves.is_empty(), "{name}: {svg:?}");
            assert_eq!(svg.has_attribute("tabindex"), !along_curves, "{name}: {svg:?}");
            assert!(
                curves
                    .iter()
                    .all(|curve| curve.has_attribute("tabindex") == along_curves),
                "{name}: {svg:?}"
            );
            let outputs = named(svg.parent().unwrap(), "output").count();
            assert!(outputs >= 2, "{name}: {outputs}");
        }
        // Some hold what the command writes.
        let csv = sweep(&study, Data::Attainable).unwrap();
        assert!(page.contains(&csv.replace('\n', "%0A")), "{name}");
    }
}

/// Hover is marked where the mass is known, and the comparison is made there.
#[test]
fn hover_is_marked_and_compared() {
    let compiled = compiled(&root().join("airframes/x8-11in-least-power.toml"));
    let study = Study::new(&compiled, None);
    assert!(
        (study.thrust_n - 9.80665 * 3.6).abs() < 1e-9,
        "{}",
        study.thrust_n
    );
    let page = page(&study, None, &Origin::default());
    let document = parsed(&page);
    let marked = |id: &str| {
        let marks = section(&document, id).descendants();
        marks
            .filter(|node| matches!(node.attribute("class"), Some("mark" | "mark-point")))
            .count()
    };
    assert_eq!(marked("authority"), 3);
    assert_eq!(marked("level"), 4, "two throttles, voltage, power");
    for id in ["attainable", "inverse", "forward"] {
        assert!(marked(id) > 0, "{id}");
    }
    let unknown = x8();
    let page = super::page(&Study::new(&unknown, None), None, &Origin::default());
    assert!(page.contains("add [vehicle] mass_kg") && !page.contains("class=\"mark-point\""));
}

/// Without `[voltage]` no voltage is spoken of but that there is no correction.
#[test]
fn there_is_no_reference_voltage_without_one() {
    let text = fs::read_to_string(root().join("airframes/isae-x8.toml")).unwrap();
    let (before, rest) = text.split_once("[voltage]").unwrap();
    let after = rest.split_once("\n[").unwrap().1;
    let compiled = compile_text(&format!("{before}[{after}"));
    let page = page(&Study::new(&compiled, None), None, &Origin::default());
    let document = parsed(&page);
    let told = text_of(named(document.root(), "body").next().unwrap());
    for words in ["reference", "every voltage", " V,", " V."] {
        let place = told
            .find(words)
            .map(|at| &told[at.saturating_sub(60)..at + words.len()]);
        assert_eq!(place, None, "{words}");
    }
}
