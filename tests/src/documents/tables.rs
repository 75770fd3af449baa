//! The tables, in Markdown.

use csv::StringRecord;
use isolated_rotors::IsolatedTables;
use mixer_compiler::airframe::KEYS;
use mixer_compiler::atmosphere::{self, density_at, pressure_at};
use mixer_compiler::diagnostic::rounded_up;
use mixer_compiler::spec::keys::{Key, Shape, ValueKind};
use mixer_compiler::{Compiled, Source};
use mixer_facts::hover;
use mixer_files::report::comparison::{Comparison, YawResponse, throttles};
use mixer_files::report::study::Study;
use mixer_rt::Wrench;

use super::{Table, measured};
use crate::{airframes, allocators, golden, root, thin_air};

/// The airframe of the paper.
const PAPER: &str = "isae-x8";

/// A table in Markdown; columns of numbers are aligned to the right.
pub(super) fn markdown(header: &[&str], rows: &[Vec<String>]) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let header: Vec<String> = header.iter().map(|cell| (*cell).to_owned()).collect();
    let is_number = |cell: &String| cell.starts_with(|c: char| c.is_ascii_digit() || c == '-');
    let first = rows.first().into_iter().flatten();
    let rule: String = first
        .map(|cell| if is_number(cell) { "|---:" } else { "|---" })
        .chain(["|\n"])
        .collect();
    let rows: String = rows.iter().map(|row| line(row)).collect();
    line(&header) + &rule + &rows
}

/// A wrench as the tables write it, thrust with fewer decimals; no negative zero.
fn wrench(values: [f64; 4], decimals: usize) -> String {
    let cell = |(axis, value): (usize, f64)| {
        let decimals = if axis == 3 { decimals.min(2) } else { decimals };
        let text = format!("{value:.decimals$}");
        match text.strip_prefix('-') {
            Some(digits) if digits.bytes().all(|digit| matches!(digit, b'0' | b'.')) => digits.to_owned(),
            _ => text,
        }
    };
    values
        .into_iter()
        .enumerate()
        .map(cell)
        .collect::<Vec<_>>()
        .join(", ")
}

/// The keys of the airframe file, a table for each of its tables.
pub(super) fn keys() -> Vec<Table> {
    let row = |key: &Key| {
        let value = match key.kind {
            ValueKind::Table(shape) | ValueKind::Tables(shape) | ValueKind::TableOrTables(shape) => {
                format!("`{}`", shape.header)
            }
            kind => kind.words(),
        };
        let optional = if key.required { "" } else { "Optional. " };
        vec![
            format!("`{}`", key.name),
            value,
            format!("{optional}{}", key.meaning()),
        ]
    };
    let table = |shape: &Shape| Table {
        page: "docs/airframe.md",
        name: match shape.header.trim_matches(['[', ']']) {
            "" => "file",
            name => name,
        },
        text: markdown(
            &["key", "value", "meaning"],
            &shape.keys.iter().map(row).collect::<Vec<_>>(),
        ),
    };
    KEYS.all().into_iter().map(table).collect()
}

/// Exponent of the density with ordinary speed controllers.
const DENSITY_EXPONENT: f64 = 0.75;

/// Thrust at equal throttles in the standard atmosphere, for a bench at sea level.
pub(super) fn altitudes() -> String {
    let row = |(words, altitude): (&str, f64)| {
        let sigma = density_at(altitude) / density_at(0.0);
        vec![
            words.to_owned(),
            format!("{:.3}", density_at(altitude)),
            format!("{:.1} %", 100.0 * libm::pow(sigma, DENSITY_EXPONENT)),
            format!("{:.1} %", 100.0 * sigma),
        ]
    };
    let altitudes = [("0", 0.0), ("1,500", 1500.0), ("3,000", 3000.0)];
    let header = [
        "altitude (m)",
        "kg/m³",
        "thrust, exponent 0.75",
        "linear, as ArduPilot corrects",
    ];
    markdown(&header, &altitudes.map(row))
}

/// 0 °C in K.
const ZERO_C: f64 = 273.15;

/// What an error of the density does to the thrust that is given.
pub(super) fn density() -> String {
    let sea = pressure_at(0.0);
    let at = |celsius: f64| atmosphere::density(sea, celsius + ZERO_C);
    let row = |(words, taken, true_): (&str, f64, f64)| {
        let percent = |ratio: f64| format!("{:+.1} %", 100.0 * (ratio - 1.0));
        let ratio = taken / true_;
        vec![
            words.to_owned(),
            percent(ratio),
            percent(libm::pow(ratio, -DENSITY_EXPONENT)),
        ]
    };
    let rows = [
        ("none is passed, at 1,500 m", at(15.0), density_at(1500.0)),
        ("none is passed, at 3,000 m", at(15.0), density_at(3000.0)),
        ("15 °C for -10 °C", at(15.0), at(-10.0)),
        ("15 °C for 40 °C", at(15.0), at(40.0)),
        (
            "15 °C for -4.5 °C, 3,000 m",
            atmosphere::density(pressure_at(3000.0), 15.0 + ZERO_C),
            density_at(3000.0),
        ),
        ("a board 25 K warmer than the air", at(40.0), at(15.0)),
    ];
    markdown(
        &["taken for the density", "is off by", "thrust given is off by"],
        &rows.map(row),
    )
}

/// Four requests to the paper's X8, and what isolated rotors and this mixer give by the pair's map.
pub(super) fn isolated() -> Result<String, String> {
    let compiled = golden::compile(PAPER)?;
    let study = Study::new(&compiled, None);
    let conventional = IsolatedTables::new(&compiled);
    let given = |throttles: Vec<f32>| study.wrench(&study.efforts_of(&study.by_unit(&throttles)));
    let requests = [
        [0.0, 0.0, 0.0, 31.4],
        [0.0, 0.0, 0.3, 31.4],
        [0.5, 0.0, 0.0, 31.4],
        [1.0, -0.5, 0.2, 40.0],
    ];
    let rows = requests.map(|request| {
        let [roll, pitch, yaw, thrust] = request;
        vec![
            format!("{roll}, {pitch}, {yaw}, {thrust}"),
            wrench(given(throttles(&study, &conventional, request).0), 3),
            wrench(given(study.mix(request, &study.reference()).0), 3),
        ]
    });
    Ok(markdown(
        &[
            "asked: roll, pitch, yaw (N m), thrust (N)",
            "isolated rotors give",
            "this mixer gives",
        ],
        &rows,
    ))
}

/// What the emitted inverse of every airframe misses.
pub(super) fn accuracy() -> Result<String, String> {
    let names = airframes().map_err(|error| format!("airframes/: {error}"))?;
    let rows = names
        .iter()
        .map(|name| {
            let compiled = golden::compile(name)?;
            let (proven, observed) = (
                compiled.of_pairs[0].certificate.stated,
                compiled.of_pairs[0].residual.efforts,
            );
            Ok(vec![
                name.clone(),
                compiled.of_pairs[0].evaluator.name().to_owned(),
                rounded_up(proven[0]),
                rounded_up(observed[0]),
                rounded_up(proven[1]),
                rounded_up(observed[1]),
            ])
        })
        .collect::<Result<Vec<_>, String>>()?;
    Ok(markdown(
        &[
            "airframe",
            "evaluator",
            "f proven (N)",
            "f observed (N)",
            "Q proven (N m)",
            "Q observed (N m)",
        ],
        &rows,
    ))
}

/// Yaw commands of [`static_comparison`], from zero to the largest.
const YAW_COMMANDS: usize = 5;

/// Section V-A of the paper: yaw commands at constant thrust, and what units of each spin really
/// give.
pub(super) fn static_comparison() -> Result<String, String> {
    let compiled = golden::compile(PAPER)?;
    let study = Study::new(&compiled, None);
    let comparison = Comparison::sweep(&study, YAW_COMMANDS).ok_or("the paper's X8 has no yaw to sweep")?;
    let mut rows = Vec::new();
    // Negative commands mirror the positive ones.
    for row in comparison.rows.iter().skip(YAW_COMMANDS / 2) {
        for (mixer, answer) in [("coaxial", &row.coaxial), ("conventional", &row.conventional)] {
            let YawResponse {
                efforts,
                within,
                wrench,
                ..
            } = answer;
            let [first, second, ..] = efforts[..] else {
                return Err("the paper's X8 has four units".into());
            };
            let unit = |[f, q]: [f64; 2]| format!("{f:.3}, {:.4}", q + 0.0).replace("-0.0000", "0.0000");
            let limited = if *within { "" } else { ", a throttle at its limit" };
            rows.push(vec![
                format!("{:.3}", row.yaw_nm),
                format!("{mixer}{limited}"),
                unit(first),
                unit(second),
                format!("{:.4}", wrench[2]).replace("-0.0000", "0.0000"),
                format!("{:.3}", wrench[3]),
            ]);
        }
    }
    let header = [
        "yaw asked (N m)",
        "mixer",
        "units 0, 2: f (N), Q (N m)",
        "units 1, 3: f (N), Q (N m)",
        "yaw given (N m)",
        "thrust given (N)",
    ];
    Ok(markdown(&header, &rows))
}

/// Allocators on attainable wrenches.
pub(super) fn allocators() -> Result<String, String> {
    let (_, rows) = measured(&allocators::file())?;
    let percent = |(k, cell): (usize, &str)| {
        if k < 2 {
            cell.to_owned()
        } else {
            format!("{cell} %")
        }
    };
    let cells = |row: &StringRecord| row.iter().enumerate().map(percent).collect();
    let rows: Vec<Vec<String>> = rows.iter().map(cells).collect();
    Ok(markdown(
        &[
            "frame",
            "allocator",
            "delivered",
            "mean error",
            "worst error",
            "yaw reversed",
        ],
        &rows,
    ))
}

/// Yaw and thrust of X8s and a Y6 that are asked for all yaw near full thrust, with a yaw reserve
/// and without.
pub(super) fn yaw_reserve() -> Result<String, String> {
    let mut rows = Vec::new();
    for (title, name) in [
        ("X8, the paper's pair", PAPER),
        ("X8, 22 inch", "x8-22in-cubic"),
        ("Y6", "px4-y6"),
    ] {
        let plain = golden::compile(name)?;
        let reserve = hover::yaw_reserve(&plain).ok_or_else(|| format!("{name} has no yaw in hover"))?;
        let path = root().join(format!("airframes/{name}.toml"));
        let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let key = "[allocation]\n";
        let line = format!("{key}yaw_reserve_nm = {reserve:?}\n");
        let text = if text.contains(key) {
            text.replace(key, &line)
        } else {
            format!("{text}\n{line}")
        };
        let kept = mixer_compiler::compile(&Source::new(name, text)).map_err(|faults| faults.to_string())?;
        let volts = plain
            .airframe
            .voltage
            .as_ref()
            .map_or(0.0, |voltage| voltage.reference) as f32;
        let full = plain.thrust_range_n[1];
        // More yaw than any of them has.
        let yaw_nm = 10.0;
        for percent in [80.0, 100.0] {
            let setpoint = Wrench {
                yaw_nm,
                thrust_n: 0.01 * percent * full,
                ..Wrench::default()
            };
            let given = |compiled: &Compiled| {
                let mixed = compiled.tables.mix(&setpoint, volts);
                mixed
                    .map(|(_, achieved, _)| achieved)
                    .map_err(|error| error.to_string())
            };
            let [without, with] = [given(&plain)?, given(&kept)?];
            let yaw = |achieved: Wrench| format!("{:.3}", achieved.yaw_nm).replace("-0.000", "0.000");
            let thrust = |achieved: Wrench| format!("{:.1} %", 100.0 * achieved.thrust_n / full);
            rows.push(vec![
                title.to_owned(),
                format!("{reserve:.3}"),
                format!("{percent:.0} %"),
                yaw(without),
                thrust(without),
                yaw(with),
                thrust(with),
            ]);
        }
    }
    Ok(markdown(
        &[
            "frame",
            "reserve (N m)",
            "thrust asked",
            "without it: yaw (N m)",
            "thrust",
            "with it: yaw (N m)",
            "thrust",
        ],
        &rows,
    ))
}

/// How far throttles move for the last yaw of X8s, at shares of full thrust.
pub(super) fn steep() -> Result<String, String> {
    let mut rows = Vec::new();
    for name in [PAPER, "x8-11in-cubic", "x8-16in-quartic", "x8-22in-cubic"] {
        let compiled = golden::compile(name)?;
        let volts = compiled.airframe.reference_v() as f32;
        for percent in [16.0, 50.0] {
            let thrust_n = 0.01 * percent * compiled.thrust_range_n[1];
            let mix = |yaw_nm: f32| {
                let setpoint = Wrench {
                    yaw_nm,
                    thrust_n,
                    ..Wrench::default()
                };
                compiled
                    .tables
                    .mix(&setpoint, volts)
                    .map_err(|error| error.to_string())
            };
            // More yaw than any of them has.
            let (_, Wrench { yaw_nm: most, .. }, _) = mix(10.0)?;
            let moved = |from: f32, to: f32| -> Result<String, String> {
                let [(before, ..), (after, ..)] = [mix(from * most)?, mix(to * most)?];
                let moves = before.iter().zip(&after).map(|(a, b)| (a - b).abs());
                Ok(format!("{:.2}", moves.fold(0.0, f32::max)))
            };
            let names = [name.to_owned(), format!("{percent:.0} %"), format!("{most:.2}")];
            let moves = [moved(0.0, 0.15)?, moved(0.75, 0.9)?, moved(0.85, 1.0)?];
            rows.push([names, moves].concat());
        }
    }
    Ok(markdown(
        &[
            "airframe",
            "thrust",
            "most yaw (N m)",
            "0 to 15 % of it",
            "75 to 90 %",
            "85 to 100 %",
        ],
        &rows,
    ))
}

/// One flight of `tests/measurements/flight.csv`.
struct Flight {
    scenario: String,
    seed: String,
    mixer: String,
    /// Nine errors of Table II (MSE, MAE, MaxAE of x, y, z), then hover thrust over weight.
    figures: Vec<f64>,
}

fn flights() -> Result<Vec<Flight>, String> {
    let path = root().join("tests/measurements/flight.csv");
    let flight = |row: &StringRecord| {
        let cells = row.deserialize(None);
        let (scenario, seed, mixer, figures) =
            cells.map_err(|error| format!("{}: {error}", path.display()))?;
        Ok(Flight {
            scenario,
            seed,
            mixer,
            figures,
        })
    };
    measured(&path)?.1.iter().map(flight).collect()
}

/// Mean and standard deviation, with these decimals.
fn spread(values: &[f64], decimals: usize) -> String {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
    let deviation = (squares / (count - 1.0).max(1.0)).sqrt();
    format!("{mean:.decimals$} ± {deviation:.decimals$}")
}

/// Column of hover thrust over weight among a flight's figures.
const HOVER: usize = 9;

/// Names of the scenarios, in the order of the file.
fn scenarios(flights: &[Flight]) -> Vec<&str> {
    let mut scenarios: Vec<&str> = flights.iter().map(|flight| flight.scenario.as_str()).collect();
    scenarios.dedup();
    scenarios
}

/// Thrust command over weight in hover (Fig. 10).
pub(super) fn hover() -> Result<String, String> {
    let flights = flights()?;
    let row = |scenario: &str| {
        let of = |mixer: &str| {
            let flown = flights
                .iter()
                .filter(|flight| flight.scenario == scenario && flight.mixer == mixer);
            spread(&flown.map(|flight| flight.figures[HOVER]).collect::<Vec<_>>(), 3)
        };
        vec![scenario.to_owned(), of("coaxial"), of("conventional")]
    };
    let rows: Vec<Vec<String>> = scenarios(&flights).into_iter().map(row).collect();
    Ok(markdown(
        &["thrust command / weight", "coaxial", "conventional"],
        &rows,
    ))
}

/// Names of the errors of Table II, with the paper's own ratios of x, y and z.
const TABLE_II: [(&str, [f64; 3]); 3] = [
    ("MSE", [0.55, 0.39, 0.45]),
    ("MAE", [0.72, 0.69, 0.73]),
    ("MaxAE", [0.90, 0.50, 0.78]),
];

/// Table II: errors with the coaxial mixer over those with the conventional one, seed by seed.
pub(super) fn tracking() -> Result<String, String> {
    let flights = flights()?;
    let scenarios = scenarios(&flights);
    let mut rows = Vec::new();
    for (row, (name, paper)) in TABLE_II.into_iter().enumerate() {
        for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
            let mut cells = vec![format!("{name} {letter}")];
            for scenario in &scenarios {
                let of = |mixer: &str| {
                    let flown = flights
                        .iter()
                        .filter(|flight| flight.scenario == *scenario && flight.mixer == mixer);
                    flown
                        .map(|flight| (flight.seed.as_str(), flight.figures[3 * row + axis]))
                        .collect::<Vec<_>>()
                };
                let (coaxial, simple) = (of("coaxial"), of("conventional"));
                if coaxial
                    .iter()
                    .map(|flight| flight.0)
                    .ne(simple.iter().map(|flight| flight.0))
                {
                    return Err(format!("{scenario}: a seed was not flown with both mixers"));
                }
                let ratios: Vec<f64> = coaxial.iter().zip(&simple).map(|(a, b)| a.1 / b.1).collect();
                cells.push(spread(&ratios, 2));
            }
            cells.push(format!("{:.2}", paper[axis]));
            rows.push(cells);
        }
    }
    let header: Vec<&str> = ["error, coaxial / conventional"]
        .into_iter()
        .chain(scenarios.iter().copied())
        .chain(["paper"])
        .collect();
    Ok(markdown(&header, &rows))
}

/// Level thrust of ten pairs in other air, by motors of their own.
pub(super) fn level_thrust() -> Result<String, String> {
    let flights = thin_air::fly()?;
    let cells = |errors: &[f64]| {
        thin_air::size(errors)
            .map(|percent| format!("{percent:.1}"))
            .join("; ")
    };
    let mut rows: Vec<Vec<String>> = flights
        .iter()
        .map(|flight| {
            let place = flight
                .place
                .map(|[altitude, celsius]| format!("{altitude} m, {celsius} °C"));
            vec![
                format!("{:.3}", flight.sigma),
                place.unwrap_or_default(),
                cells(&flight.without),
                cells(&flight.with),
            ]
        })
        .collect();
    let all =
        |of: fn(&thin_air::Flight) -> &Vec<f64>| flights.iter().flat_map(of).copied().collect::<Vec<_>>();
    let [without, with] = [all(|flight| &flight.without), all(|flight| &flight.with)];
    rows.push(vec![
        "all".to_owned(),
        String::new(),
        cells(&without),
        cells(&with),
    ]);
    Ok(markdown(
        &[
            "density over the bench's",
            "there",
            "without `[air]`: mean; worst (%)",
            "with it (%)",
        ],
        &rows,
    ))
}
