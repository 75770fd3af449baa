//! From the samples of a log to the bench points that are fitted.
//!
//! In this order: find out whether both rotors turned; drop start and stop rows (a rotor at or
//! below `stop_throttle`); reduce a streaming log to one mean per plateau of constant command; make
//! signs and sums; refuse rows with a missing value.

use serde::Serialize;

use self::date::date_in;
use self::header::Columns;
use self::read::{Log, RefusedRow, Sample};
use self::sign::{SignChoice, SignPolicy, Signs};
use crate::refusal::Refusal;
use crate::rotor::Turning;

pub mod date;
pub mod header;
pub mod plateau;
pub mod read;
pub mod sign;
pub mod text;
pub mod units;

/// What a file can be used for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Both throttles vary: the pair's map.
    Pair,
    /// One rotor: only the dependence on voltage can be taken from it.
    SingleRotor,
}

/// One measured point in the sign convention of the airframe file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Line of the row, or of the first row of the plateau.
    pub line: u64,
    /// Throttle of the upper rotor (or of the only one).
    pub u: f64,
    /// Throttle of the lower rotor; 0 for a single rotor.
    pub l: f64,
    /// Thrust, N, upward positive.
    pub thrust: f64,
    /// Torque, N m, positive where the lower rotor outweighs the upper; NaN where not measured.
    pub torque: f64,
    /// Supply voltage, V; NaN where not measured.
    pub voltage: f64,
    /// Electrical power of the whole, W; NaN where not measured.
    pub power_w: f64,
}

/// A bench file made ready.
#[derive(Debug, Clone, Serialize)]
pub struct Bench {
    /// File name without folders.
    pub file: String,
    /// Format of the header.
    pub format: String,
    /// Date of the measurement, `YYYY-MM-DD`, from `--date` or the file's name.
    pub date: Option<String>,
    /// Pair or single rotor.
    pub kind: Kind,
    /// Which rotor turns in a run of one, where the header has a throttle for each.
    pub turning: Option<Turning>,
    /// Rows of measurements in the file.
    pub rows: usize,
    /// Start and stop rows dropped.
    pub start_stop_rows: usize,
    /// Whether it is a streaming log, reduced to plateau means.
    pub streaming: bool,
    /// Rows of a streaming log dropped because the command had just changed.
    pub settling_rows: usize,
    /// Points that remain.
    pub points_used: usize,
    /// Rows refused, with the reason.
    pub refused_rows: Vec<RefusedRow>,
    /// Signs applied.
    pub signs: Signs,
    /// Remarks for the report.
    pub notes: Vec<String>,
    /// Why there is no electrical power, where columns are missing for it.
    pub no_power: Option<String>,
    /// The points.
    #[serde(skip)]
    pub points: Vec<Point>,
}

/// What decides how a log becomes points.
#[derive(Debug, Clone)]
pub struct Preparation {
    /// Throttle at or below which a rotor stands still.
    pub stop_throttle: f64,
    /// Part of each plateau of a streaming log that is left to settle.
    pub settle: f64,
    /// Signs of thrust and torque.
    pub signs: SignPolicy,
    /// Whether rows of a pair may lack their torque.
    pub torque_may_lack: bool,
    /// Whether a run of one rotor is of that rotor, not of the whole: what it drives through the
    /// one at rest, which has a drag, is then left aside.
    pub own_columns: bool,
    /// Date given by hand.
    pub date: Option<String>,
}

/// Throttle at or below which a rotor stands still, unless the user says otherwise.
pub const STOP_THROTTLE: f64 = 0.005;
/// Part of each plateau of a streaming log that is left to settle, unless the user says otherwise.
pub const SETTLE: f64 = 0.33;

impl Default for Preparation {
    fn default() -> Self {
        Self {
            stop_throttle: STOP_THROTTLE,
            settle: SETTLE,
            signs: SignPolicy {
                thrust: SignChoice::Auto,
                torque: SignChoice::Auto,
            },
            torque_may_lack: false,
            own_columns: false,
            date: None,
        }
    }
}

/// Most points of a file: 100 levels of each rotor, plateaus of a streaming log counted as one.
const MOST_POINTS: usize = 10_000;

/// Makes a log ready.
pub fn prepare(log: Log, how: &Preparation) -> Result<Bench, Refusal> {
    let Log {
        name,
        columns,
        samples,
        mut refused,
    } = log;
    let rows = samples.len() + refused.len();
    some_readable(&name, &columns, &samples, &refused)?;
    let mut notes = Vec::new();
    let turned = turned(&samples, &columns, how.stop_throttle, &mut notes);
    let Turned { kind, rotor } = turned;

    let Steady {
        samples,
        start_stop_rows,
        streaming,
        settling_rows,
    } = steady(&name, samples, &turned, how, &mut refused, &mut notes);
    if samples.len() > MOST_POINTS {
        return Err(Refusal::of(
            name,
            format!("{} points, at most {MOST_POINTS} are fitted", samples.len()),
            "the mean of what was recorded at each command",
        ));
    }
    if kind == Kind::Pair {
        notes.extend(uneven_levels(&samples));
    }

    let (signs, sums) = match kind {
        Kind::Pair => sign::pair(
            &name,
            &columns,
            &samples,
            &how.signs,
            how.torque_may_lack,
            &mut notes,
        )?,
        Kind::SingleRotor => sign::single(&columns, rotor, how.own_columns, &samples, &how.signs),
    };
    let points = points_of(
        &name,
        &turned,
        how.torque_may_lack,
        samples.iter().zip(sums),
        &mut refused,
    );
    refused.sort_by_key(|r| r.line);
    if points.is_empty() {
        let dropped = format!("{start_stop_rows} start and stop rows, {settling_rows} settling");
        return Err(none_usable(name, rows, &dropped, &refused));
    }
    let date = how.date.clone().or_else(|| date_in(&name));
    Ok(Bench {
        no_power: columns.no_power(),
        turning: (kind == Kind::SingleRotor && columns.lower.is_some())
            .then_some([Turning::Upper, Turning::Lower][rotor]),
        file: name,
        format: columns.format,
        date,
        kind,
        rows,
        start_stop_rows,
        streaming,
        settling_rows,
        points_used: points.len(),
        refused_rows: refused,
        signs,
        notes,
        points,
    })
}

/// Refuses a file of which no row can be read, or whose command was not recorded.
fn some_readable(
    name: &str,
    columns: &Columns,
    samples: &[Sample],
    refused: &[RefusedRow],
) -> Result<(), Refusal> {
    if let (true, Some(first)) = (samples.is_empty(), refused.first()) {
        return Err(Refusal::of(
            format!("{name}:{}", first.line),
            format!(
                "none of {} rows can be read, and this is the first: {}",
                refused.len(),
                first.reason
            ),
            "numbers in every row, throttles in [0, 1] or with their unit",
        ));
    }
    let throttle = columns.upper.as_ref().map_or("", |c| c.name.as_str());
    no_empty_throttle(name, throttle, samples, 0)
}

/// The samples of turning rotors at a command that holds.
struct Steady {
    samples: Vec<Sample>,
    start_stop_rows: usize,
    streaming: bool,
    settling_rows: usize,
}

/// Drops start and stop rows and those of a supply that was off, and reduces a streaming log to its
/// plateaus.
fn steady(
    name: &str,
    mut samples: Vec<Sample>,
    turned: &Turned,
    how: &Preparation,
    refused: &mut Vec<RefusedRow>,
    notes: &mut Vec<String>,
) -> Steady {
    let before = samples.len();
    // An empty throttle is no start or stop row: it stays and is refused later, with its line.
    samples.retain(|s| match turned.kind {
        Kind::Pair => !s.throttle.iter().any(|&t| t <= how.stop_throttle),
        Kind::SingleRotor => {
            let throttle = s.throttle[turned.rotor];
            throttle.is_nan() || throttle > how.stop_throttle
        }
    });
    let start_stop_rows = before - samples.len();
    supplied(name, &mut samples, refused, notes);
    let streaming = plateau::is_streaming(&samples);
    let mut settling_rows = 0;
    if streaming {
        (samples, settling_rows) = plateau::means(&samples, how.settle);
    }
    Steady {
        samples,
        start_stop_rows,
        streaming,
        settling_rows,
    }
}

/// Share of the median voltage below which a supply is off, or was not recorded.
const OFF: f64 = 0.25;

/// Refuses rows whose voltage cannot have driven the rotors. Where all are 0 none was recorded.
fn supplied(name: &str, samples: &mut Vec<Sample>, refused: &mut Vec<RefusedRow>, notes: &mut Vec<String>) {
    let mut volts: Vec<f64> = samples
        .iter()
        .map(|s| s.voltage)
        .filter(|v| v.is_finite())
        .collect();
    volts.sort_by(f64::total_cmp);
    let Some(&median) = volts.get(volts.len() / 2) else {
        return;
    };
    if median <= 0.0 {
        notes.push(format!(
            "the voltage is {median} V in most rows: taken as not measured"
        ));
        for sample in samples {
            (sample.voltage, sample.power_w) = (f64::NAN, f64::NAN);
        }
        return;
    }
    samples.retain(|s| {
        let off = s.voltage <= OFF * median;
        if off {
            refused.push(RefusedRow {
                file: name.to_owned(),
                line: s.line,
                reason: format!(
                    "the voltage is {} V, in the middle of the rows {median} V",
                    s.voltage
                ),
            });
        }
        !off
    });
}

fn none_usable(name: String, rows: usize, dropped: &str, refused: &[RefusedRow]) -> Refusal {
    let first = refused.first().map_or(String::new(), |r| {
        format!(", the first: line {}: {}", r.line, r.reason)
    });
    Refusal::of(
        name,
        format!(
            "none of {rows} rows can be used: {dropped}, {} refused{first}",
            refused.len()
        ),
        "rows with both rotors turning (see --stop-throttle) and thrust and torque measured",
    )
}

/// Which rotors of a log turned.
struct Turned {
    kind: Kind,
    /// Of a single rotor: its index among the throttles.
    rotor: usize,
}

fn turned(samples: &[Sample], columns: &Columns, stop_throttle: f64, notes: &mut Vec<String>) -> Turned {
    let turning = |s: &Sample, rotor: usize| s.throttle[rotor] > stop_throttle;
    let both =
        columns.lower.is_some() && [0, 1].map(|r| samples.iter().any(|s| turning(s, r))) == [true, true];
    let kind = if both { Kind::Pair } else { Kind::SingleRotor };
    let rotor = usize::from(columns.lower.is_some() && !samples.iter().any(|s| turning(s, 0)));
    if kind == Kind::SingleRotor && columns.lower.is_some() {
        notes.push(format!(
            "the {} rotor stands still throughout: a single rotor",
            ["lower", "upper"][rotor]
        ));
    }
    if kind == Kind::Pair && !columns.sides_named {
        notes.push(
            "the header does not say which rotor is above: the first is taken (--swap exchanges)".into(),
        );
    }
    Turned { kind, rotor }
}

/// The points of rows with all that a fit needs; the others are refused.
fn points_of<'a>(
    name: &str,
    &Turned { kind, rotor }: &Turned,
    torque_may_lack: bool,
    rows: impl Iterator<Item = (&'a Sample, (f64, f64))>,
    refused: &mut Vec<RefusedRow>,
) -> Vec<Point> {
    let both = kind == Kind::Pair;
    let mut points = Vec::new();
    for (sample, (thrust, torque)) in rows {
        let missing = if sample.throttle[rotor].is_nan() || (both && sample.throttle[1].is_nan()) {
            Some("the throttle is empty")
        } else if thrust.is_nan() {
            Some("the thrust is empty")
        } else if both && torque.is_nan() && !torque_may_lack {
            Some("the torque is empty")
        } else {
            None
        };
        if let Some(reason) = missing {
            refused.push(RefusedRow {
                file: name.to_owned(),
                line: sample.line,
                reason: reason.into(),
            });
            continue;
        }
        let [u, l] = match kind {
            Kind::Pair => sample.throttle,
            Kind::SingleRotor => [sample.throttle[rotor], 0.0],
        };
        points.push(Point {
            line: sample.line,
            u,
            l,
            thrust,
            torque,
            voltage: sample.voltage,
            power_w: sample.power_w,
        });
    }
    points
}

/// A grid whose one rotor repeats its commands and the other does not: its record may have drifted,
/// which no fit sees.
fn uneven_levels(samples: &[Sample]) -> Option<String> {
    let levels = [0, 1].map(|rotor| {
        let mut us: Vec<i64> = samples
            .iter()
            .map(|s| (s.throttle[rotor] * 1000.0).round() as i64)
            .collect();
        us.sort_unstable();
        us.dedup();
        us.len()
    });
    let (few, many) = (levels[0].min(levels[1]), levels[0].max(levels[1]));
    (few * few <= 4 * samples.len() && many > 3 * few).then(|| {
        let rotor = if levels[0] > levels[1] { ["upper", "lower"] } else { ["lower", "upper"] };
        format!(
            "the {} rotor's command takes {many} values, the {}'s {few}: if a grid was commanded, the record of the \
             former drifts, and the map with it",
            rotor[0], rotor[1]
        )
    })
}

/// Refuses a file whose command was not recorded.
fn no_empty_throttle(name: &str, column: &str, samples: &[Sample], rotor: usize) -> Result<(), Refusal> {
    if samples.iter().any(|s| !s.throttle[rotor].is_nan()) {
        return Ok(());
    }
    let reason = match samples.len() {
        0 => "there are no rows below the header".to_string(),
        n => format!("the throttle column {column:?} is empty in all {n} rows"),
    };
    Err(Refusal::of(
        name,
        reason,
        "a log in which the command of each rotor was recorded with the measurements",
    ))
}
