//! From the samples of a log to the bench points that are fitted.
//!
//! In this order: find out whether both rotors turned; examine rows at rest; drop start and stop rows (a rotor at or
//! below [`STOP_THROTTLE`]); reduce a streaming log to one mean per plateau of constant command; make
//! signs and sums; refuse rows with a missing value.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

use mixer_compiler::quantity;
use serde::Serialize;

use self::air::BenchAir;
use self::header::Columns;
use self::read::{Fault, Log, RefusedRow, Sample, refusal_notes};
use self::sign::{SignPolicy, Signs};
use self::units::{Quantity, Scale};
use crate::refusal::Refusal;
use crate::rotor::Turning;
use crate::statistics::{extent, mean_of_finite, median};

pub mod air;
pub mod header;
pub mod number;
pub mod plateau;
pub mod read;
pub mod sheet;
pub mod sign;
mod tare;
pub mod text;
pub mod units;

/// What a file can be used for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum BenchKind {
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
    /// Supply voltage, V, of the rotor that turns or in the mean of both; NaN where not measured.
    pub voltage: f64,
    /// What the upper rotor's own voltage is above that mean, and the lower one's below it, as a
    /// share; 0 where they have one supply.
    pub imbalance: f64,
    /// Electrical power of the whole, W; NaN where not measured.
    pub power_w: f64,
    /// Power of the shafts, W; NaN where not measured.
    pub shaft_w: f64,
    /// Speed of the upper rotor, or of the only one, and of the lower one, revolutions per minute; likewise.
    pub rpm: [f64; 2],
    /// Thrust of the upper and of the lower rotor, N, and torque likewise, N m, as their load cells have
    /// them; NaN where they have none.
    pub cells: [f64; 4],
}

impl Point {
    /// What the throttles of the point, measured at `own` V, give at `reference` V: thrust and torque
    /// follow V^k, electrical power the cube of the speed whose square is thrust.
    #[must_use]
    pub fn at_voltage(&self, own: f64, reference: f64, [thrust, torque]: [f64; 2]) -> Point {
        self.divided(own / reference, [thrust, torque, 1.5 * thrust])
    }

    /// Thrust, torque and power over powers of a ratio.
    #[must_use]
    pub(crate) fn divided(&self, ratio: f64, exponents: [f64; 3]) -> Point {
        let [thrust, torque, power] = exponents.map(|exponent| libm::pow(ratio, exponent));
        Point {
            thrust: self.thrust / thrust,
            torque: self.torque / torque,
            power_w: self.power_w / power,
            cells: [0, 1, 2, 3].map(|k| self.cells[k] / [thrust, torque][k / 2]),
            ..*self
        }
    }
}

/// A bench file made ready.
#[derive(Debug, Clone, Serialize)]
pub struct Bench {
    /// File name without folders.
    pub file: String,
    /// Format of the header.
    pub format: String,
    /// Pair or single rotor.
    pub kind: BenchKind,
    /// Which rotor turns in a run of one, where the header has a throttle for each.
    pub turning: Option<Turning>,
    /// Whether the user said which columns are the upper and which the lower rotor's.
    #[serde(skip)]
    pub sides_by_hand: bool,
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
    /// The air, where its density is known.
    pub air: Option<BenchAir>,
    /// What the load cells read at rest, where it was taken off.
    pub tare: Vec<String>,
    /// Offsets of the load cells at rest that remain in the points.
    pub offsets: Vec<String>,
    /// Remarks for the report.
    pub notes: Vec<String>,
    /// Why there is no electrical power, where columns are missing for it.
    pub no_power: Option<String>,
    /// Whether the record of a command seems to drift, so that neither rows nor the shape can be judged.
    #[serde(skip)]
    pub record_drifts: bool,
    /// Whether a throttle is a speed that the controller holds.
    #[serde(skip)]
    pub holds_speed: bool,
    /// Options that had nothing to work on in this file.
    #[serde(skip)]
    pub idle_options: Vec<String>,
    /// Lines of the rows in which every throttle was off.
    #[serde(skip)]
    pub rests: Vec<u64>,
    /// The points.
    #[serde(skip)]
    pub points: Vec<Point>,
}

impl Bench {
    /// The tare, notes of the reading and rows refused, as few as can be read.
    pub(crate) fn passed_over(&self) -> Vec<String> {
        const MOST: usize = 5;
        let tare = self.tare.iter().map(|tare| format!("{}: {tare}", self.file));
        let tare = tare.chain(self.offset_notes());
        let rows = refusal_notes(self.refused_rows.iter(), MOST);
        tare.chain(self.notes.iter().cloned()).chain(rows).collect()
    }

    /// [`Bench::offsets`] with the file's name.
    pub(crate) fn offset_notes(&self) -> impl Iterator<Item = String> {
        self.offsets
            .iter()
            .map(|offset| format!("{}: {offset}", self.file))
    }
}

/// Mean supply voltage, V, and whether every point has one; nothing where none has.
pub(crate) fn mean_voltage<'a>(points: impl IntoIterator<Item = &'a Point>) -> Option<(f64, bool)> {
    let (mut sum, mut count, mut all) = (0.0, 0, true);
    for point in points {
        match point.voltage.is_finite() {
            true => (sum, count) = (sum + point.voltage, count + 1),
            false => all = false,
        }
    }
    (count > 0).then(|| (sum / f64::from(count), all))
}

/// What decides how a log becomes points.
#[derive(Debug, Clone, Default)]
pub struct Preparation {
    /// Signs of thrust and torque.
    pub signs: SignPolicy,
    /// Whether what the load cells read at rest is taken off.
    pub tare: bool,
    /// Whether these few rows of a pair correct a prediction: torque may be missing, and a single throttle
    /// column drives both rotors.
    pub is_correction: bool,
    /// Whether a run of one rotor is of that rotor, not of the whole: what it drives through the
    /// one at rest, which has a drag, is then left aside.
    pub prefers_rotor_cell: bool,
    /// The air of the bench, given by hand; else of columns where there are any.
    pub air: Option<BenchAir>,
}

/// Throttle at or below which a rotor stands still.
pub const STOP_THROTTLE: f64 = 0.005;

/// Most points of a file: 100 levels of each rotor, plateaus of a streaming log counted as one.
const MOST_POINTS: usize = 10_000;

/// Which rotors turned in a log.
struct Turned {
    kind: BenchKind,
    /// Of the two, or the one that turned.
    rotors: &'static [usize],
    /// Whether the log has a throttle for each.
    two_throttles: bool,
    /// Whether the stand drives both by one signal.
    one_signal: bool,
}

impl Turned {
    /// By the throttles; one signal becomes the throttle of both.
    fn of(samples: &mut [Sample], currents: [f64; 2], columns: &Columns, how: &Preparation) -> Turned {
        let one_throttle = columns[Quantity::Throttle].rotors[1].is_none();
        let moves = moving(samples, currents).or(how.is_correction.then_some([true; 2]));
        if let Some(moves) = moves.filter(|_| one_throttle) {
            let of = |s: &mut Sample| s.throttle = moves.map(|moves| if moves { s.throttle[0] } else { 0.0 });
            samples.iter_mut().for_each(of);
        }
        let one_signal = one_throttle && moves == Some([true; 2]);
        let two_throttles = moves.is_some() || !one_throttle;
        let [upper, lower] = [0, 1].map(|rotor| samples.iter().any(|s| s.throttle[rotor] > STOP_THROTTLE));
        let (kind, rotors): (BenchKind, &[usize]) = match (two_throttles, upper, lower) {
            (true, true, true) => (BenchKind::Pair, &[0, 1]),
            (true, false, _) => (BenchKind::SingleRotor, &[1]),
            _ => (BenchKind::SingleRotor, &[0]),
        };
        Turned {
            kind,
            rotors,
            two_throttles,
            one_signal,
        }
    }

    /// What the user should know of it.
    fn note(&self, columns: &Columns, how: &Preparation) -> Option<String> {
        match self.kind {
            BenchKind::SingleRotor
                if self.two_throttles
                    && !(how.prefers_rotor_cell && columns[Quantity::Throttle].rotors[1].is_some()) =>
            {
                let still = if self.rotors == [0] { "lower" } else { "upper" };
                Some(format!(
                    "the {still} rotor stands still throughout: a single rotor"
                ))
            }
            BenchKind::Pair if !columns.sides_named && !self.one_signal => {
                let upper = columns[Quantity::Throttle].rotors[0].as_ref();
                Some(format!(
                    "the header does not say which rotor is above: that of {:?} is taken (--swap exchanges)",
                    upper.map_or("", |column| column.name.as_str())
                ))
            }
            _ => None,
        }
    }

    /// Whether every throttle of a row is off.
    fn is_rest(&self, sample: &Sample) -> bool {
        let throttles = &sample.throttle[..1 + usize::from(self.two_throttles)];
        throttles.iter().all(|&t| t <= STOP_THROTTLE)
    }

    /// Whether a throttle of a rotor that turned is off. An empty one is not: its row is refused later, with its
    /// line.
    fn is_start_or_stop(&self, sample: &Sample) -> bool {
        self.rotors
            .iter()
            .any(|&rotor| sample.throttle[rotor] <= STOP_THROTTLE)
    }

    /// A row with its thrust and torque as a point.
    fn point(
        &self,
        sample: &Sample,
        (thrust, torque): (f64, f64),
        may_lack_torque: bool,
    ) -> Result<Point, &'static str> {
        let [u, l] = match self.kind {
            BenchKind::Pair => sample.throttle,
            BenchKind::SingleRotor => [sample.throttle[self.rotors[0]], 0.0],
        };
        let lacks_torque = self.kind == BenchKind::Pair && !may_lack_torque && torque.is_nan();
        if u.is_nan() || l.is_nan() {
            return Err("the throttle is empty");
        } else if thrust.is_nan() {
            return Err("the thrust is empty");
        } else if lacks_torque {
            return Err("the torque is empty");
        }
        let [voltage, imbalance] = supply(self.rotors, sample.voltage);
        let alone = self.kind == BenchKind::SingleRotor;
        let shaft = |&rotor: &usize| {
            let own = if alone {
                torque
            } else {
                sample.torque.rotors[rotor]
            };
            (own * sample.speed[rotor]).abs() * (PI / 30.0)
        };
        Ok(Point {
            shaft_w: self.rotors.iter().map(shaft).sum(),
            rpm: match alone {
                true => [sample.speed[self.rotors[0]], f64::NAN],
                false => sample.speed,
            },
            line: sample.line,
            u,
            l,
            thrust,
            torque,
            voltage,
            imbalance,
            power_w: sample.power_w,
            cells: [0, 1, 2, 3].map(|k| [sample.thrust, sample.torque][k / 2].rotors[k % 2]),
        })
    }
}

/// Makes a log ready.
///
/// # Errors
/// A log of which no row can be used, and columns that do not measure a pair.
pub fn prepare(log: Log, how: &Preparation) -> Result<Bench, Refusal> {
    let Log {
        name,
        columns,
        mut samples,
        mut refused,
        air,
        currents,
        mut notes,
        idle_options,
    } = log;
    let rows = samples.len() + refused.len();
    few_refused(&name, &refused, rows)?;
    some_commanded(&name, &columns, &samples)?;
    let unreadable = refused.len();
    let air = match &how.air {
        None => by_columns(&name, &air)?,
        given => given.clone(),
    };
    let turned = Turned::of(&mut samples, currents, &columns, how);
    notes.extend(turned.note(&columns, how));
    let tare = tare::examine(&mut samples, |s| turned.is_rest(s), how.tare);
    let rests = samples
        .iter()
        .filter(|s| turned.is_rest(s))
        .map(|s| s.line)
        .collect();
    let before = samples.len();
    samples.retain(|s| !turned.is_start_or_stop(s));
    let start_stop_rows = before - samples.len();
    for rotor in [0, 1] {
        let turns = turned.rotors.contains(&rotor);
        supplied(&name, rotor, turns, &mut samples, &mut refused, &mut notes)?;
    }
    let may_lack_torque = how.is_correction || turned.one_signal;
    if turned.kind == BenchKind::SingleRotor || may_lack_torque {
        notes.extend(tare::no_torque(&mut samples, turned.rotors));
    }
    let (streaming, mut settling_rows) = (plateau::is_streaming(&samples), 0);
    if streaming {
        (samples, settling_rows) = plateau::means(&samples);
    } else {
        notes.extend(counted_once(&name, &mut samples));
    }
    notes.extend(without_load_cell(&name, streaming, &mut samples));
    if samples.len() > MOST_POINTS {
        return Err(Refusal::of(
            name,
            format!("{} points, at most {MOST_POINTS} are fitted", samples.len()),
            "the mean of what was recorded at each command",
        ));
    }
    let mut record_drifts = false;
    let (signs, sums) = match turned.kind {
        BenchKind::Pair => {
            let uneven = uneven_levels(&samples);
            record_drifts = uneven.is_some();
            notes.extend(uneven);
            sign::pair(&name, &columns, &samples, &how.signs, may_lack_torque, &mut notes)?
        }
        BenchKind::SingleRotor => sign::single(
            &columns,
            turned.rotors[0],
            how.prefers_rotor_cell,
            &samples,
            &how.signs,
        ),
    };
    let mut points = Vec::new();
    for (sample, sums) in samples.iter().zip(sums) {
        match turned.point(sample, sums, may_lack_torque) {
            Ok(point) => points.push(point),
            Err(reason) => refused.push(RefusedRow::new(&name, sample.line, Fault::new(reason, reason))),
        }
    }
    match streaming {
        true => few_refused(&name, &refused[unreadable..], samples.len())?,
        false => few_refused(&name, &refused, rows)?,
    }
    refused.sort_by_key(|r| r.line);
    if points.is_empty() {
        let first = refused.first().map_or(String::new(), |r| {
            format!(", the first: line {}: {}", r.line, r.reason)
        });
        return Err(Refusal::of(
            name,
            format!(
                "none of {rows} rows can be used: {start_stop_rows} start and stop rows, {settling_rows} settling, {} \
                 refused{first}",
                refused.len()
            ),
            "rows with both rotors turning and thrust and torque measured",
        ));
    }
    let alone = turned.kind == BenchKind::SingleRotor && turned.two_throttles;
    let holds_speed = columns
        .all()
        .any(|column| matches!(column.scale, Scale::Speed(_)));
    Ok(Bench {
        no_power: columns.no_power(),
        holds_speed,
        turning: alone.then_some([Turning::Upper, Turning::Lower][turned.rotors[0]]),
        file: name,
        format: columns.format,
        kind: turned.kind,
        sides_by_hand: columns.sides_by_hand,
        rows,
        start_stop_rows,
        streaming,
        settling_rows,
        points_used: points.len(),
        refused_rows: refused,
        signs,
        air,
        tare: tare.taken_off,
        offsets: tare.warnings,
        notes,
        idle_options,
        record_drifts,
        rests,
        points,
    })
}

/// Span of the temperature that air has within a run, K. Motors have more.
const AIR_WARMS_K: f64 = 10.0;

/// The air by the columns of a file, whose `rows` are temperature, K, pressure, Pa, and density, kg/m3.
fn by_columns(name: &str, rows: &[[f64; 3]]) -> Result<Option<BenchAir>, Refusal> {
    let column = |k: usize| rows.iter().map(move |row| row[k]).filter(|x| x.is_finite());
    let [kelvin, pascal, density_kg_m3] = [0, 1, 2].map(|k| mean_of_finite(column(k)));
    let [coldest, warmest] = extent(column(0));
    let values = [
        (quantity::TEMPERATURE, kelvin - 273.15),
        (quantity::PRESSURE, 0.01 * pascal),
        (quantity::DENSITY, density_kg_m3),
    ];
    let fault = match warmest - coldest > AIR_WARMS_K {
        true => Some(format!(
            "temperature: it spans {:.0} K, as motors do",
            warmest - coldest
        )),
        false => values
            .into_iter()
            .filter(|(_, x)| x.is_finite())
            .find_map(|(of, x)| {
                let told = of.check((1e3 * x).round() / 1e3).err()?;
                Some(format!("{}: {told}", of.name))
            }),
    };
    let from = format!("columns of {name}");
    match fault {
        None => Ok(density_kg_m3
            .is_finite()
            .then_some(BenchAir { density_kg_m3, from })),
        Some(fault) => Err(Refusal::of(
            name,
            format!("its columns are not of the air: {fault}"),
            "the unit by --unit temperature=K (or F, pressure=mmHg ..); where it is a motor's, the air by --temperature C --pressure HPA in \
             place of the columns",
        )),
    }
}

/// Change of a rotor's current, torque or thrust over the other's, below which it stands still: a rotor at rest draws what its
/// controller needs, and has a drag in the other's wake; the lower one of a pair that turns has half or more.
const STILL: f64 = 0.25;

/// Which rotors move, by the first of these quantities that each rotor has; nothing where none tells.
fn moving(samples: &[Sample], currents: [f64; 2]) -> Option<[bool; 2]> {
    let change = |of: fn(&Sample) -> [f64; 2]| {
        [0, 1].map(|rotor| {
            let [low, high] = extent(samples.iter().map(|s| of(s)[rotor]).filter(|x| x.is_finite()));
            high - low
        })
    };
    let changes = [currents, change(|s| s.torque.rotors), change(|s| s.thrust.rotors)];
    let known = |[a, b]: &[f64; 2]| *a >= 0.0 && *b >= 0.0 && a + b > 0.0;
    let changes = changes.into_iter().find(known)?;
    Some(changes.map(|own| own > STILL * changes[0].max(changes[1])))
}

/// Passes over rows, or stops of a streaming log, in which no load cell has a value: loggers are faster than load cells.
fn without_load_cell(name: &str, streaming: bool, samples: &mut Vec<Sample>) -> Option<String> {
    let has = |s: &Sample| {
        let cells = [s.thrust, s.torque].map(|of| [of.whole, of.rotors[0], of.rotors[1]]);
        cells.as_flattened().iter().any(|x| x.is_finite())
    };
    let (all, first) = (samples.len(), samples.iter().find(|s| !has(s))?.line);
    if samples.iter().any(has) {
        samples.retain(has);
    }
    let (what, passed) = (["rows", "stops"][usize::from(streaming)], all - samples.len());
    (passed > 0).then(|| {
        format!("{name}:{first}: {passed} of {all} {what} are passed over: no load cell has a value in them")
    })
}

/// Whether throttles are of one signal for both rotors; that of either supply may move them a little.
pub(crate) fn is_one_signal([u, l]: [f64; 2]) -> bool {
    (u - l).abs() < 0.05
}

/// What a run of both rotors by one signal is for.
pub(crate) fn equal_commands(files: &[&str]) -> String {
    format!(
        "a run or data sheet of ONE rotor, whose prediction this corrects: cargo mixer identify {} --prior SINGLE.csv",
        files.join(" ")
    )
}

/// Share of refused rows above which a file is refused. Real files have none (`maps_warn`), and what
/// is wrong with a column is in most of its rows.
const REFUSED: f64 = 0.05;

/// Refuses a file of which too many rows are refused, with the reason that most of them share.
pub(crate) fn few_refused(name: &str, refused: &[RefusedRow], rows: usize) -> Result<(), Refusal> {
    if refused.len() as f64 <= REFUSED * rows as f64 {
        return Ok(());
    }
    let mut kinds: BTreeMap<&str, Vec<&RefusedRow>> = BTreeMap::new();
    for row in refused {
        kinds.entry(&row.kind).or_default().push(row);
    }
    let most = kinds
        .into_values()
        .max_by_key(|rows| rows.len())
        .unwrap_or_default();
    let Some(first) = most.first() else { return Ok(()) };
    let shared = match most.len() == refused.len() {
        true => String::new(),
        false => format!(", {} of them for this reason", most.len()),
    };
    Err(Refusal::of(
        format!("{name}:{}", first.line),
        format!(
            "{} of {rows} rows are refused{shared}: {}",
            refused.len(),
            first.reason
        ),
        "values in 95 % of the rows or more, of one unit and one way to write numbers",
    ))
}

/// Throttle that the greatest of a file is above: one per cent as a share, or a share as per cent.
const COMMANDED: f64 = 0.02;

/// Refuses a file whose command was not recorded.
fn some_commanded(name: &str, columns: &Columns, samples: &[Sample]) -> Result<(), Refusal> {
    let column = columns[Quantity::Throttle].rotors[0]
        .as_ref()
        .map_or("", |c| c.name.as_str());
    let throttles = samples.iter().flat_map(|s| s.throttle).filter(|t| !t.is_nan());
    let greatest = throttles.reduce(f64::max);
    let reason = match (greatest, samples.len()) {
        (_, 0) => "there are no rows below the header".to_string(),
        (None, n) => format!("the throttle column {column:?} is empty in all {n} rows"),
        (Some(t), _) if 0.0 < t && t < COMMANDED => format!(
            "the throttle column {column:?} reaches {t} of full throttle at most: shares taken as per cent, or another unit"
        ),
        _ => return Ok(()),
    };
    Err(Refusal::of(
        name,
        reason,
        "a log in which the command of each rotor was recorded with the measurements",
    ))
}

/// Leaves one of equal rows one below the other: the same measurement, whether pasted twice or logged by a program that
/// got stuck.
fn counted_once(name: &str, samples: &mut Vec<Sample>) -> Option<String> {
    let (before, mut again) = (samples.len(), 0);
    samples.dedup_by(|next, first| {
        let same = next.equals(first);
        again = if same && again == 0 { next.line } else { again };
        same
    });
    let more = before - samples.len();
    (more > 0).then(|| {
        format!("{name}:{again}: {more} of {before} rows are equal to the one before them and count once")
    })
}

/// Share of the median voltage below which a supply is off, or was not recorded.
const OFF: f64 = 0.25;

/// Mean voltage of the rotors that turn, V, and the upper one's over it less 1. One supply is all of
/// a rotor that has none of its own.
fn supply(turning: &[usize], volts: [f64; 2]) -> [f64; 2] {
    let own = |rotor: usize| {
        Some(volts[rotor])
            .filter(|v| v.is_finite())
            .unwrap_or(volts[1 - rotor])
    };
    let mean = turning.iter().map(|&rotor| own(rotor)).sum::<f64>() / turning.len() as f64;
    let above = own(turning[0]) / mean - 1.0;
    [mean, if above.is_finite() { above } else { 0.0 }]
}

/// Refuses rows whose voltage cannot have driven the rotor. A column below any supply is of a meter that was not plugged in.
fn supplied(
    name: &str,
    rotor: usize,
    turns: bool,
    samples: &mut Vec<Sample>,
    refused: &mut Vec<RefusedRow>,
    notes: &mut Vec<String>,
) -> Result<(), Refusal> {
    let Some(median) = median(samples.iter().map(|s| s.voltage[rotor])) else {
        return Ok(());
    };
    match quantity::VOLTAGE.check(median) {
        Err(_) if median < quantity::VOLTAGE.range[0] => {
            notes.push(format!(
                "the voltage is {median} V in most rows: taken as not measured"
            ));
            for sample in samples {
                (sample.voltage[rotor], sample.power_w) = (f64::NAN, f64::NAN);
            }
        }
        Err(told) => {
            let needed = format!("volts, or --unit {}=mV", ["voltage", "lower_voltage"][rotor]);
            return Err(Refusal::of(name, format!("the voltage: {told}"), needed));
        }
        Ok(_) if turns => samples.retain(|s| {
            let (own, off) = (s.voltage[rotor], s.voltage[rotor] <= OFF * median);
            if off {
                let reason = format!("the voltage is {own} V, in the middle of the rows {median} V");
                refused.push(RefusedRow::new(name, s.line, Fault::new("voltage off", reason)));
            }
            !off
        }),
        Ok(_) => {}
    }
    Ok(())
}

/// A grid whose one rotor repeats its commands and the other does not: its record may have drifted,
/// which no fit sees.
fn uneven_levels(samples: &[Sample]) -> Option<String> {
    let levels = [0, 1].map(|rotor| {
        let throttles = samples
            .iter()
            .map(|s| (s.throttle[rotor] * 1000.0).round() as i64);
        throttles.collect::<BTreeSet<i64>>().len()
    });
    let (few, many) = (levels[0].min(levels[1]), levels[0].max(levels[1]));
    (few * few <= 4 * samples.len() && many > 3 * few).then(|| {
        let [of_many, of_few] = match levels[0] > levels[1] {
            true => ["upper", "lower"],
            false => ["lower", "upper"],
        };
        format!(
            "the {of_many} rotor's command takes {many} values, the {of_few}'s {few}: if a grid was commanded, the record of the \
             former drifts, and the map with it"
        )
    })
}

#[cfg(test)]
mod tests;
