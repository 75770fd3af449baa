//! Flights in the stacks' simulators: of the drawn vehicles, and of one vehicle with one condition changed each.

use csv::StringRecord;

use super::measured;
use super::tables::markdown;
use crate::root;

/// A row: what was flown, the step in the file, and its column.
type Figure = (&'static str, &'static str, &'static str);

const HEIGHT: &str = "height error, most (m)";
const TIME: &str = "time to 90 % (s)";
const OVERSHOOT: &str = "overshoot (%)";
const TILT: &str = "roll or pitch, most (deg)";
const LEAST: &str = "least";
const SETPOINT: &str = "thrust setpoint in hover";
const YAW: [&str; 2] = ["90 deg in yaw", "175 deg in yaw"];
const FULL: &str = "90 deg in yaw, full thrust";
const OUT: &str = "upper rotor out, 90 deg in yaw";

const FIGURES: [Figure; 11] = [
    ("yaw by 90 degrees: height error, most (m)", YAW[0], HEIGHT),
    ("yaw by 175 degrees: height error, most (m)", YAW[1], HEIGHT),
    ("yaw by 90 degrees: time to 90 % (s)", YAW[0], TIME),
    ("yaw by 175 degrees: time to 90 % (s)", YAW[1], TIME),
    ("yaw by 90 degrees: overshoot (%)", YAW[0], OVERSHOOT),
    ("yaw by 175 degrees: overshoot (%)", YAW[1], OVERSHOOT),
    ("up by 3 m: time to 90 % (s)", "3 m in height", TIME),
    ("sideways by 4 m: height error, most (m)", "4 m sideways", HEIGHT),
    (
        "sideways by 6 m with yaw by 90 degrees: height error, most (m)",
        "6 m sideways, 90 deg in yaw",
        HEIGHT,
    ),
    (
        "an upper rotor out, yaw by 90 degrees: height error, most (m)",
        OUT,
        HEIGHT,
    ),
    (
        "an upper rotor out, yaw by 90 degrees: roll or pitch, most (degrees)",
        OUT,
        TILT,
    ),
];

/// Rows of a stack that flew steps of yaw alone.
const YAW_ALONE: usize = 6;

/// Rows of the first page.
const FIRST_PAGE: [usize; 6] = [0, 1, 2, 7, 9, 10];

/// Mixers by their names in the files and in the tables.
const MIXERS: [(&str, &str); 4] = [
    ("as it comes", "as it comes"),
    ("fitted", "fitted"),
    ("mix", "`mix`"),
    ("mix_dynamic", "`mix_dynamic`"),
];

/// What PX4's allocator, as it comes and fitted, and this mixer at the loop gain of the fitted one hold.
pub(super) fn flown() -> Result<String, String> {
    drawn_table(
        "px4",
        &FIRST_PAGE.map(|row| FIGURES[row]),
        &[
            ("as it comes", "PX4, as it comes"),
            ("fitted", "PX4, fitted to the pair"),
            ("mix_dynamic, loop gain", "PX4 with this mixer"),
        ],
    )
}

/// Steps of yaw in Betaflight.
pub(super) fn in_betaflight() -> Result<String, String> {
    drawn_table("betaflight", &FIGURES[..YAW_ALONE], &MIXERS)
}

/// All figures in ArduPilot.
pub(super) fn in_ardupilot() -> Result<String, String> {
    drawn_table("ardupilot", &FIGURES, &MIXERS)
}

/// All mixers in PX4.
pub(super) fn drawn() -> Result<String, String> {
    let [comes, fitted, mix, dynamic] = MIXERS;
    let axis = ("fitted on the axis", "fitted on the axis");
    let gain = ("mix_dynamic, loop gain", "at the loop gain of the fitted");
    drawn_table("px4", &FIGURES, &[comes, axis, fitted, mix, dynamic, gain])
}

/// A file of flights.
struct Flights {
    path: String,
    header: StringRecord,
    rows: Vec<StringRecord>,
}

impl Flights {
    fn read(name: &str) -> Result<Flights, String> {
        let path = root().join(format!("tests/measurements/flights/{name}.csv"));
        let (header, rows) = measured(&path)?;
        let path = path.display().to_string();
        Ok(Flights { path, header, rows })
    }

    fn fault(&self, what: &str) -> String {
        format!("{}: {what}", self.path)
    }

    fn at(&self, column: &str) -> Result<usize, String> {
        let at = self.header.iter().position(|name| name == column);
        at.ok_or_else(|| self.fault(&format!("no column {column}")))
    }

    /// The values of a column in the rows that have these cells; `-` is none.
    fn values(&self, cells: &[(&str, &str)], column: &str) -> Result<Vec<f64>, String> {
        let cells: Vec<(usize, &str)> = cells
            .iter()
            .map(|(column, cell)| Ok((self.at(column)?, *cell)))
            .collect::<Result<_, String>>()?;
        let at = self.at(column)?;
        let is_of = |row: &&StringRecord| cells.iter().all(|(at, cell)| row[*at] == **cell);
        let cells = self.rows.iter().filter(is_of).map(|row| &row[at]);
        let values = cells.filter(|cell| *cell != "-").map(str::parse);
        values
            .collect::<Result<_, _>>()
            .map_err(|e| self.fault(&format!("{column}: {e}")))
    }

    /// Words, and for each mixer the means over the flights of some steps under a condition; `-` where there is none.
    fn line(
        &self,
        words: &str,
        condition: &str,
        steps: &[&str],
        column: &str,
    ) -> Result<Vec<String>, String> {
        let mut line = vec![words.to_owned()];
        let decimals = decimals(column);
        for (mixer, _) in MIXERS {
            let mut cells = Vec::new();
            for step in steps {
                let of = [("condition", condition), ("mixer", mixer), ("step", *step)];
                let values = self.values(&of, column)?;
                cells.push(match values.is_empty() {
                    true => "-".to_owned(),
                    false => format!("{:.decimals$}", mean(&values)),
                });
            }
            cells.dedup_by(|a, b| a == "-" && b == "-");
            line.push(cells.join("; "));
        }
        Ok(line)
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn decimals(column: &str) -> usize {
    match column {
        HEIGHT | SETPOINT => 3,
        OVERSHOOT => 1,
        _ => 2,
    }
}

/// The mean over the vehicles and the worst one, of each mixer.
fn drawn_table(stack: &str, figures: &[Figure], mixers: &[(&str, &str)]) -> Result<String, String> {
    let flights = Flights::read(&format!("{stack}-drawn"))?;
    let mut lines = Vec::new();
    for (words, step, column) in figures {
        let mut line = vec![(*words).to_owned()];
        for (mixer, _) in mixers {
            let values = flights.values(&[("mixer", mixer), ("step", step)], column)?;
            if values.is_empty() {
                return Err(flights.fault(&format!("{mixer}: no {step}")));
            }
            let worst = values.iter().copied().fold(0.0, f64::max);
            let decimals = decimals(column);
            line.push(format!("{:.decimals$}; {worst:.decimals$}", mean(&values)));
        }
        lines.push(line);
    }
    Ok(markdown(
        &header("mean of six vehicles; worst one", mixers),
        &lines,
    ))
}

fn header<'a>(first: &'a str, mixers: &[(&str, &'a str)]) -> Vec<&'a str> {
    [first]
        .into_iter()
        .chain(mixers.iter().map(|(_, name)| *name))
        .collect()
}

/// Height errors of one vehicle in steps of yaw, under each condition.
pub(super) fn conditions(stack: &str) -> Result<String, String> {
    let flights = Flights::read(&format!("{stack}-conditions"))?;
    let [condition_at, step_at] = [flights.at("condition")?, flights.at("step")?];
    let mut conditions: Vec<&str> = Vec::new();
    for row in flights.rows.iter().filter(|row| row[step_at] == *YAW[1]) {
        if !conditions.contains(&&row[condition_at]) {
            conditions.push(&row[condition_at]);
        }
    }
    let mut lines = Vec::new();
    for condition in conditions {
        lines.push(flights.line(condition, condition, &YAW, HEIGHT)?);
    }
    Ok(markdown(
        &header(
            "condition changed: height error, most (m), in yaw by 90; 175 degrees",
            &MIXERS,
        ),
        &lines,
    ))
}

/// What else was flown with one vehicle: words, condition, step, column.
const MANOEUVRES: [(&str, &str, &str, &str); 25] = [
    ("yaw by 90 degrees: time to 90 % (s)", "none", YAW[0], TIME),
    ("yaw by 175 degrees: time to 90 % (s)", "none", YAW[1], TIME),
    ("yaw by 90 degrees: overshoot (%)", "none", YAW[0], OVERSHOOT),
    ("yaw by 175 degrees: overshoot (%)", "none", YAW[1], OVERSHOOT),
    (
        "yaw by 175 degrees: least thrust over weight",
        "none",
        YAW[1],
        LEAST,
    ),
    (
        "the same, controllers do not brake: overshoot (%)",
        "controllers do not brake",
        YAW[1],
        OVERSHOOT,
    ),
    ("up by 3 m: time to 90 % (s)", "none", "3 m in height", TIME),
    (
        "roll by 15 degrees: time to 90 % (s)",
        "none",
        "15 deg in roll",
        TIME,
    ),
    (
        "sideways by 6 m: height error, most (m)",
        "none",
        "6 m sideways",
        HEIGHT,
    ),
    (
        "sideways by 6 m with yaw by 90 degrees: height error, most (m)",
        "none",
        "6 m sideways, 90 deg in yaw",
        HEIGHT,
    ),
    (
        "an upper rotor stops: roll or pitch, most (degrees)",
        "an upper rotor out",
        "the stop",
        TILT,
    ),
    (
        "then yaw by 90 degrees: height error, most (m)",
        "an upper rotor out",
        YAW[0],
        HEIGHT,
    ),
    (
        "a lower rotor stops: roll or pitch, most (degrees)",
        "a lower rotor out",
        "the stop",
        TILT,
    ),
    (
        "then yaw by 90 degrees: height error, most (m)",
        "a lower rotor out",
        YAW[0],
        HEIGHT,
    ),
    (
        "Y6, a lower rotor out, yaw by 90 degrees: height error, most (m)",
        "Y6, a lower rotor out",
        YAW[0],
        HEIGHT,
    ),
    (
        "the same: overshoot (%)",
        "Y6, a lower rotor out",
        YAW[0],
        OVERSHOOT,
    ),
    (
        "full thrust of 1.32 times the weight, yaw by 90 degrees: time to 90 % (s)",
        "full thrust",
        FULL,
        TIME,
    ),
    ("the same: least thrust over weight", "full thrust", FULL, LEAST),
    (
        "with a yaw reserve of 0.52 N m: time to 90 % (s)",
        "full thrust, yaw_reserve_nm 0.52",
        FULL,
        TIME,
    ),
    (
        "the same: least thrust over weight",
        "full thrust, yaw_reserve_nm 0.52",
        FULL,
        LEAST,
    ),
    (
        "with a yaw reserve of 0.8 N m: time to 90 % (s)",
        "full thrust, yaw_reserve_nm 0.8",
        FULL,
        TIME,
    ),
    (
        "the same: least thrust over weight",
        "full thrust, yaw_reserve_nm 0.8",
        FULL,
        LEAST,
    ),
    ("thrust setpoint in hover", "none", YAW[0], SETPOINT),
    ("the same at 3,000 m", "3,000 m", YAW[0], SETPOINT),
    (
        "the same at 3,000 m, file with `[air]`",
        "3,000 m, file with [air]",
        YAW[0],
        SETPOINT,
    ),
];

/// Figures of other manoeuvres of one vehicle; what a stack has not flown is left out.
pub(super) fn manoeuvres(stack: &str) -> Result<String, String> {
    let flights = Flights::read(&format!("{stack}-conditions"))?;
    let mut lines = Vec::new();
    for (words, condition, step, column) in MANOEUVRES {
        let line = flights.line(words, condition, &[step], column)?;
        if line[1..].iter().any(|cell| cell != "-") {
            lines.push(line);
        }
    }
    Ok(markdown(&header("mean of the steps", &MIXERS), &lines))
}
