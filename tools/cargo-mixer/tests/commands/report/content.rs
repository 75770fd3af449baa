//! What a page has: curves of authority, marks, folded tables, data and the keyboard. Its words are in
//! `cases/report`.

use mixer_files::report::study::Flown;

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

#[test]
fn authority_is_shown_at_the_lowest_voltage_and_with_a_rotor_out() {
    let of = |name: &str| {
        let compiled = compiled(&root().join(format!("airframes/{name}.toml")));
        let page = page(&Study::new(&compiled, None), None, None);
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
    let page = page(&Study::new(&x8(), None), None, None);
    let document = parsed(&page);
    for figure in named(document.root(), "figure") {
        let last = figure.children().rfind(Node::is_element).unwrap();
        assert_eq!(last.tag_name().name(), "figcaption");
        assert!(!text_of(last).is_empty());
    }
}

/// A flight stands beside the model: its lines, and a point on both maps for each of its throttles.
#[test]
fn a_flight_is_shown_over_the_model() {
    let compiled = x8();
    let mut study = Study::new(&compiled, None);
    study.flown = Some(Flown {
        log: "a<b>.ulg".to_owned(),
        lines: vec![("thrust", "model over measured 1.02".to_owned())],
        throttles: vec![[0.4, 0.5], [0.9, 0.2], [0.45, 0.5]],
    });
    let page = page(&study, None, None);
    let document = parsed(&page);
    assert_eq!(points(&document, "flown-dot"), [3, 3]);
    let text = text_of(document.root());
    for what in ["a<b>.ulg", "model over measured 1.02", "where the pairs flew"] {
        assert!(text.contains(what), "{what}");
    }
}

/// Every bench point has its residual, small where it lies below the idle, within the frame.
#[test]
fn residuals_are_mapped() {
    use mixer_files::report::bench::{BenchPoint, BenchPoints};

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
    let page = page(&study, Some(&bench), None);
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

/// Every figure has data, its own or with those above the link, and every plot that is read is reached by the Tab key:
/// itself or each of its curves.
#[test]
fn figures_have_data_and_are_reached_by_keyboard() {
    for compiled in airframes() {
        let name = &compiled.airframe.name;
        let study = Study::new(&compiled, None);
        let page = page(&study, None, None);
        let document = parsed(&page);
        let is_link = |node: &Node| node.has_attribute("download");
        let of_all: Vec<&str> = named(document.root(), "figure")
            .filter(|figure| !figure.descendants().any(|node| is_link(&node)))
            .map(|figure| {
                let below = figure.parent().unwrap().next_sibling().unwrap();
                let link = below.descendants().find(is_link).unwrap();
                assert_eq!(text_of(link), "Data of these pictures (CSV)", "{name}");
                link.attribute("download").unwrap()
            })
            .collect();
        let pairs = &compiled.airframe.pairs;
        let file = |word: &str, of: usize| match pairs[of].name.as_str() {
            "" => format!("{name}-{word}.csv"),
            pair => format!("{name}-{word}-{pair}.csv"),
        };
        let maps = [("forward", 4), ("inverse", 2), ("error", 2)].into_iter();
        let maps = maps.flat_map(|(word, count)| (0..pairs.len()).map(move |of| (word, of, count)));
        let expected: Vec<String> = maps
            .flat_map(|(word, of, count)| vec![file(word, of); count])
            .collect();
        assert_eq!(of_all, expected, "{name}");
        let mut files = BTreeSet::new();
        for link in document.descendants().filter(is_link) {
            let file = link.attribute("download").unwrap();
            assert!(files.insert(file), "{name}: {file} twice");
            let csv = link.attribute("href").unwrap().split_once(',').unwrap().1;
            let csv = csv.replace("%0A", "\n").replace("%22", "\"").replace("%20", " ");
            let mut reader = csv::Reader::from_reader(csv.as_bytes());
            assert!(reader.headers().unwrap().len() >= 2, "{file}: {csv:.100}");
            let least = if file.ends_with("-layout.csv") {
                compiled.airframe.units.len()
            } else {
                25
            };
            let rows: Result<Vec<_>, _> = reader.records().collect();
            assert!(rows.unwrap().len() >= least, "{file}: {csv:.100}");
        }
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
        // Maps and the attainable set have what the command writes.
        for of in study.of_each().iter().filter(|of| of.of_pair().is_some()) {
            for data in [Data::Attainable, Data::Forward, Data::Inverse, Data::Error] {
                let csv = sweep(of, data).unwrap();
                assert!(page.contains(&csv.replace('\n', "%0A")), "{name}: {data:?}");
            }
        }
    }
}

/// Named curves of a section, each with its class, by figure.
fn curves<'d>(document: &'d Document<'_>, id: &str) -> Vec<Vec<(&'d str, &'d str)>> {
    let figures = named(section(document, id), "figure");
    let of = |figure: Node<'d, '_>| -> Vec<(&str, &str)> {
        let all = figure.descendants();
        all.filter_map(|node| Some((node.attribute("data-name")?, node.attribute("class")?)))
            .collect()
    };
    figures.map(of).collect()
}

/// Of a frame of single rotors the page has their curves with hover, and no word of a pair.
#[test]
fn a_quad_has_its_rotors_curve_and_no_pair() {
    let compiled = compile_text(&quad());
    let study = Study::new(&compiled, None);
    let page = page(&study, None, None);
    let document = parsed(&page);
    let main = named(document.root(), "main").next().unwrap();
    let text = text_of(main).to_lowercase();
    for word in ["upper", "lower rotor", "pair", "coaxial", "wake"] {
        assert!(!text.contains(word), "{word}: {text}");
    }
    assert!(
        text.contains("takes its thrust for that of the single rotors in the mean"),
        "{text}"
    );
    let names: Vec<Vec<&str>> = curves(&document, "rotors")
        .into_iter()
        .map(|curves| curves.into_iter().map(|(name, _)| name).collect())
        .collect();
    assert_eq!(names, [["front"], ["front"]]);
    let marks = section(&document, "rotors").descendants();
    let marks = marks.filter(|node| node.attribute("class") == Some("mark-point"));
    assert_eq!(marks.count(), 2, "all rotors hover alike");
    for data in [Data::Attainable, Data::Forward, Data::Inverse, Data::Error] {
        assert!(
            sweep(&study, data)
                .unwrap_err()
                .contains("no unit of quad is a pair")
        );
    }
    for (data, header) in [
        (Data::Layout, "unit,x_m,y_m,z_m,layer,spin,channel\n"),
        (Data::Level, "voltage_v,thrust_n,single_throttle,power_w\n"),
        (Data::Hover, "voltage_v,single_throttle\n"),
    ] {
        assert!(sweep(&study, data).unwrap().starts_with(header), "{data:?}");
    }
}

/// Kinds of units are drawn each, and curves of units that differ are told apart.
#[test]
fn every_kind_is_drawn() {
    for compiled in airframes() {
        let name = &compiled.airframe.name;
        let page = page(&Study::new(&compiled, None), None, None);
        let document = parsed(&page);
        for figure in curves(&document, "comparison") {
            let drawn = figure.iter().filter(|(_, class)| class.contains("series"));
            let classes: Vec<&str> = drawn.map(|(_, class)| *class).collect();
            let distinct: BTreeSet<&&str> = classes.iter().collect();
            assert_eq!(distinct.len(), classes.len(), "{name}: {figure:?}");
        }
        let titles: Vec<String> = named(section(&document, "forward"), "h3").map(text_of).collect();
        let pairs = compiled.airframe.pairs.iter();
        let pairs = pairs
            .map(|pair| pair.name.as_str())
            .filter(|pair| !pair.is_empty());
        assert!(titles.iter().map(String::as_str).eq(pairs), "{name}: {titles:?}");
        if !compiled.airframe.single_rotors.is_empty() {
            for figure in curves(&document, "rotors") {
                let names = figure.iter().map(|(name, _)| *name);
                let kinds = compiled
                    .airframe
                    .single_rotors
                    .iter()
                    .map(|rotor| rotor.name.as_str());
                assert!(names.eq(kinds), "{name}: {figure:?}");
            }
        }
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
    let page = page(&study, None, None);
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
    let page = super::page(&Study::new(&unknown, None), None, None);
    assert!(page.contains("add [vehicle] mass_kg") && !page.contains("class=\"mark-point\""));
}
