//! The prediction of a pair from a run of one rotor, against maps of real benches, where
//! `MIXER_BENCH_DATA` names their folder.
//!
//! `tests/measurements/interaction.csv` holds the errors of each map, and
//! `tests/measurements/interaction-constants.csv` the constants. Both are written by `cargo
//! interaction` only: the bench files are no part of the project.

use std::path::{Path, PathBuf};

use cargo_mixer::bench_files::read_one;
use mixer_identify::bench::{Bench, Point, Preparation};
use mixer_identify::fit::balance::balanced;
use mixer_identify::identified::Settings;
use mixer_identify::plan::CORRECTING;
use mixer_identify::rotor::interaction::{Interaction, OPEN_LOOP};
use mixer_identify::rotor::posterior::{self, BETWEEN_SYSTEMS, Case, Deviations, ROW, scaled};
use mixer_identify::rotor::single::{RunFacts, Single};

use crate::root;

/// A rotor, with parts of names that only its files have: the run of the upper rotor alone, and maps
/// of the pair with their z/D.
struct System {
    name: &'static str,
    diameter_m: f64,
    run: &'static str,
    maps: &'static [(&'static str, f64)],
}

const SYSTEMS: [System; 3] = [
    System {
        name: "11 in",
        diameter_m: 0.279,
        run: "propdrivev2_single_rotor_good",
        maps: &[
            ("07_23_08_27_27_11in", 0.2),
            ("08_17_11_11_55_11in", 0.4),
            ("08_17_09_33_47_11in", 1.0),
        ],
    },
    System {
        name: "16.2 in",
        diameter_m: 0.411,
        run: "U5_T_motor_single_rotor",
        maps: &[("08_09_18_15_06_16p2in", 0.5), ("07_22_10_20_01_16p2in", 1.0)],
    },
    System {
        name: "22 in",
        diameter_m: 0.559,
        run: "MN501S_T_motor_single_rotor",
        maps: &[("08_17_17_00_55_22in", 0.4), ("07_20_14_17_57_22in", 0.5)],
    },
];

/// What a fit on few systems knows beforehand: the sign and the size of the constants.
const BROAD: Deviations = Deviations {
    constants: [1.0; 6],
    scales: BETWEEN_SYSTEMS.scales,
    equal: f64::INFINITY,
};

/// Throttles of a data sheet's table.
const FIVE: [f64; 5] = [0.5, 0.65, 0.75, 0.85, 0.95];

/// Names of the predictions, in the order of the columns.
pub const PREDICTIONS: [&str; 6] = [
    "isolated",
    "left out",
    "shipped",
    "five rows",
    "no torque",
    "four points",
];

/// Errors on one map: root mean square of thrust and of torque, % of the map's greatest.
#[derive(Clone, Debug)]
pub struct Row {
    /// The rotor.
    pub system: String,
    /// z/D.
    pub spacing_ratio: f64,
    /// By prediction.
    pub percent: [[f64; 2]; 6],
}

/// What is measured.
#[derive(Clone, Debug)]
pub struct Measured {
    /// By map.
    pub rows: Vec<Row>,
    /// What the constants were fitted on, and the constants.
    pub constants: Vec<(String, [f64; 6])>,
}

/// The files of errors and of constants.
pub fn files() -> [PathBuf; 2] {
    ["interaction.csv", "interaction-constants.csv"].map(|name| root().join("tests/measurements").join(name))
}

impl Measured {
    /// The texts of the files.
    pub fn texts(&self) -> [String; 2] {
        let names = PREDICTIONS.map(|name| name.replace(' ', "_"));
        let columns = names.map(|name| format!("{name}_thrust_percent,{name}_torque_percent"));
        let mut errors = format!("rotor,spacing_ratio,{}\n", columns.join(","));
        for row in &self.rows {
            let cells = row.percent.map(|[f, q]| format!("{f:.2},{q:.2}"));
            errors += &format!("{},{},{}\n", row.system, row.spacing_ratio, cells.join(","));
        }
        let mut constants = String::from("fitted_on,b,m0,m1,n,a,limit\n");
        for (name, values) in &self.constants {
            let cells = values.map(|value| format!("{value:.3}"));
            constants += &format!("{name},{}\n", cells.join(","));
        }
        [errors, constants]
    }
}

/// One system's run and maps, read.
struct Bed {
    name: &'static str,
    diameter_m: f64,
    run: Bench,
    single: Single,
    maps: Vec<(f64, Vec<Point>)>,
}

/// Predicts all maps in `data`, the folder of bench files.
///
/// # Errors
/// A file that is missing or refused.
pub fn measure(data: &Path) -> Result<Measured, String> {
    let folder = data.join("newdexterity");
    let mut files = Vec::new();
    for entry in std::fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))? {
        files.push(entry.map_err(|error| error.to_string())?.path());
    }
    let read = |part: &str| {
        let mut files = files.iter();
        let file = files
            .find(|file| file.to_string_lossy().contains(part))
            .ok_or_else(|| format!("{}: no file {part}", folder.display()))?;
        let settings = Settings {
            preparation: Preparation {
                prefers_rotor_cell: true,
                ..Preparation::default()
            },
            ..Settings::default()
        };
        read_one(file, &settings).map_err(|refusal| refusal.to_string())
    };
    let mut beds = Vec::new();
    for system in &SYSTEMS {
        let run = read(system.run)?;
        let single = single(&run, &RunFacts::default())?;
        let mut maps = Vec::new();
        for (part, spacing_ratio) in system.maps {
            // As the run: at one voltage.
            let map = balanced(&read(part)?).points.into_iter();
            let points = map.map(|p| match single.voltage_v {
                Some(of_run) => p.at_voltage(p.voltage, of_run, single.exponents),
                None => p,
            });
            maps.push((*spacing_ratio, points.collect()));
        }
        beds.push(Bed {
            name: system.name,
            diameter_m: system.diameter_m,
            single,
            run,
            maps,
        });
    }
    let fitted = |left_out: Option<&str>| {
        let others = beds.iter().filter(|bed| Some(bed.name) != left_out);
        let cases: Vec<Case> = others.flat_map(Bed::cases).collect();
        posterior::fit(OPEN_LOOP, BROAD, &cases).interaction
    };
    let mut rows = Vec::new();
    let mut constants = Vec::new();
    for bed in &beds {
        let left_out = fitted(Some(bed.name));
        constants.push((format!("all but {}", bed.name), left_out.constants));
        for (spacing_ratio, points) in &bed.maps {
            rows.push(Row {
                system: bed.name.to_owned(),
                spacing_ratio: *spacing_ratio,
                percent: bed.errors(left_out, *spacing_ratio, points)?,
            });
        }
    }
    constants.push(("all three".to_owned(), fitted(None).constants));
    constants.push(("shipped".to_owned(), OPEN_LOOP.constants));
    Ok(Measured { rows, constants })
}

fn single(run: &Bench, known: &RunFacts) -> Result<Single, String> {
    Single::of(run, known, &mut Vec::new()).map_err(|refusal| refusal.to_string())
}

fn full_scale(points: &[Point]) -> [f64; 2] {
    points.iter().fold([0.0; 2], |[f, q], p| {
        [f64::max(f, p.thrust.abs()), f64::max(q, p.torque.abs())]
    })
}

impl Bed {
    fn case(&self, spacing_ratio: f64, points: &[Point], rows: impl Fn(&Point) -> bool) -> Case {
        Case {
            rotors: [self.single.rotor; 2],
            spacing_ratio,
            rows: points
                .iter()
                .filter(|p| rows(p))
                .map(|p| [p.u, p.l, p.thrust, p.torque])
                .collect(),
            full_scale: full_scale(points),
            row: ROW,
        }
    }

    fn cases(&self) -> impl Iterator<Item = Case> {
        self.maps
            .iter()
            .map(|(spacing_ratio, points)| self.case(*spacing_ratio, points, |_| true))
    }

    /// The errors of all predictions on a map.
    fn errors(
        &self,
        left_out: Interaction,
        spacing_ratio: f64,
        points: &[Point],
    ) -> Result<[[f64; 2]; 6], String> {
        let alone = [self.single.rotor; 2];
        let of = |interaction: Interaction, rotors| {
            percent(points, |throttles| {
                interaction.pair(&rotors, spacing_ratio, throttles)
            })
        };
        let isolated = percent(points, |[u, l]| {
            let [upper, lower] = alone;
            [
                upper.thrust.at(u) + lower.thrust.at(l),
                lower.torque.at(l) - upper.torque.at(u),
            ]
        });
        let mut table = self.run.clone();
        table.points.retain(|p| nearest(&self.run.points, p, &FIVE));
        let at_one_voltage = RunFacts {
            reference_v: self.single.voltage_v,
            ..RunFacts::default()
        };
        let five = single(&table, &at_one_voltage)?.rotor;
        let mut blank = self.run.clone();
        blank.points.iter_mut().for_each(|p| p.torque = f64::NAN);
        let known = RunFacts {
            diameter_m: Some(self.diameter_m),
            ..at_one_voltage
        };
        let no_torque = single(&blank, &known)?.rotor;
        let four = self.case(spacing_ratio, points, |p| {
            CORRECTING.iter().any(|at| closest(points, *at).line == p.line)
        });
        let found = posterior::fit(OPEN_LOOP, BETWEEN_SYSTEMS, &[four]);
        Ok([
            isolated,
            of(left_out, alone),
            of(OPEN_LOOP, alone),
            of(OPEN_LOOP, [five; 2]),
            of(OPEN_LOOP, [no_torque; 2]),
            of(found.interaction, scaled(&alone, found.factors[0])),
        ])
    }
}

/// The point of a map nearest to these throttles.
fn closest(points: &[Point], [u, l]: [f64; 2]) -> Point {
    let distance = |p: &Point| (p.u - u) * (p.u - u) + (p.l - l) * (p.l - l);
    let nearest = points.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    *nearest.expect("a map has points")
}

/// Whether a point is that of its run nearest to one of these throttles.
fn nearest(points: &[Point], point: &Point, throttles: &[f64]) -> bool {
    throttles
        .iter()
        .any(|x| closest(points, [*x, 0.0]).line == point.line)
}

fn percent(points: &[Point], model: impl Fn([f64; 2]) -> [f64; 2]) -> [f64; 2] {
    let full = full_scale(points);
    let mut squares = [0.0; 2];
    for p in points {
        let predicted = model([p.u, p.l]);
        for (k, measured) in [p.thrust, p.torque].into_iter().enumerate() {
            squares[k] += (predicted[k] - measured) * (predicted[k] - measured);
        }
    }
    [0, 1].map(|k| 100.0 * (squares[k] / points.len() as f64).sqrt() / full[k])
}
