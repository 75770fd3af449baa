//! The flights of the drawn vehicles: the table of the first page, and that of all mixers.

use super::measured;
use super::tables::markdown;
use crate::root;

/// A row: what was flown, the step in the file, and its column.
type Figure = (&'static str, &'static str, &'static str);

const HEIGHT: &str = "height error, most (m)";
const TIME: &str = "time to 90 % (s)";
const OVERSHOOT: &str = "overshoot (%)";
const TILT: &str = "roll or pitch, most (deg)";
const OUT: &str = "upper rotor out, 90 deg in yaw";

const FIGURES: [Figure; 11] = [
    (
        "yaw by 90 degrees: height error, most (m)",
        "90 deg in yaw",
        HEIGHT,
    ),
    (
        "yaw by 175 degrees: height error, most (m)",
        "175 deg in yaw",
        HEIGHT,
    ),
    ("yaw by 90 degrees: time to 90 % (s)", "90 deg in yaw", TIME),
    ("yaw by 175 degrees: time to 90 % (s)", "175 deg in yaw", TIME),
    ("yaw by 90 degrees: overshoot (%)", "90 deg in yaw", OVERSHOOT),
    ("yaw by 175 degrees: overshoot (%)", "175 deg in yaw", OVERSHOOT),
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

/// Rows of stacks that flew steps of yaw alone.
const YAW: usize = 6;

/// Rows of the first page.
const FIRST_PAGE: [usize; 6] = [0, 1, 2, 7, 9, 10];

/// What PX4's allocator, as it comes and fitted, and this mixer at the loop gain of the fitted one hold.
pub(super) fn flown() -> Result<String, String> {
    table(
        "px4",
        &FIRST_PAGE.map(|row| FIGURES[row]),
        &[
            ("as it comes", "PX4, as it comes"),
            ("fitted", "PX4, fitted to the pair"),
            ("mix_dynamic, loop gain", "PX4 with this mixer"),
        ],
    )
}

/// Steps of yaw of another stack.
pub(super) fn turned(stack: &str) -> Result<String, String> {
    table(
        stack,
        &FIGURES[..YAW],
        &[
            ("as it comes", "as it comes"),
            ("fitted", "fitted"),
            ("mix", "`mix`"),
            ("mix_dynamic", "`mix_dynamic`"),
        ],
    )
}

/// All mixers in PX4.
pub(super) fn drawn() -> Result<String, String> {
    table(
        "px4",
        &FIGURES,
        &[
            ("as it comes", "as it comes"),
            ("fitted on the axis", "fitted on the axis"),
            ("fitted", "fitted"),
            ("mix", "`mix`"),
            ("mix_dynamic", "`mix_dynamic`"),
            ("mix_dynamic, loop gain", "at the loop gain of the fitted"),
        ],
    )
}

/// The mean over the vehicles and the worst one, of each mixer by its name in the file and in the table.
fn table(stack: &str, figures: &[Figure], mixers: &[(&str, &str)]) -> Result<String, String> {
    let path = root().join(format!("tests/measurements/flights/{stack}-drawn.csv"));
    let fault = |what: &str| format!("{}: {what}", path.display());
    let (header, rows) = measured(&path)?;
    let column = |name: &str| {
        let at = header.iter().position(|column| column == name);
        at.ok_or_else(|| fault(&format!("no column {name}")))
    };
    let [mixer_at, step_at] = [column("mixer")?, column("step")?];
    let mut lines = Vec::new();
    for (words, step, name) in figures {
        let at = column(name)?;
        let mut line = vec![(*words).to_owned()];
        for (mixer, _) in mixers {
            let of = rows
                .iter()
                .filter(|row| row.get(mixer_at) == Some(mixer) && row.get(step_at) == Some(step));
            let values: Option<Vec<f64>> = of.map(|row| row.get(at)?.parse().ok()).collect();
            let values = values.filter(|values| !values.is_empty());
            let values = values.ok_or_else(|| fault(&format!("{mixer}: {step} has no {name}")))?;
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            let worst = values.iter().copied().fold(0.0, f64::max);
            let decimals = match *name {
                HEIGHT => 3,
                OVERSHOOT => 1,
                _ => 2,
            };
            line.push(format!("{mean:.decimals$}; {worst:.decimals$}"));
        }
        lines.push(line);
    }
    let names = mixers.iter().map(|(_, name)| *name);
    let header: Vec<&str> = ["mean of six vehicles; worst one"]
        .into_iter()
        .chain(names)
        .collect();
    Ok(markdown(&header, &lines))
}
