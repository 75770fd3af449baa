//! One bench file to samples in SI units.
//!
//! A cell that is not a number, or a throttle outside the range, refuses its row, named by file and
//! line. An empty cell is a missing value: streaming tools leave torque blank in most rows.

use std::fmt;

use mixer_compiler::atmosphere;
use serde::Serialize;

use crate::bench::header::{ABOVE_ONE, ByHand, Column, Columns, Split, is_unit, known};
use crate::bench::number::{Cell, is_blank, is_missing};
use crate::bench::sheet::{Sheet, names};
use crate::bench::units::{Quantity, Scale};
use crate::refusal::{Refusal, cut, cut_cell};
use crate::statistics::{extent, greatest};

/// A row that was left out, and why.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct RefusedRow {
    /// File name.
    pub file: String,
    /// Line in the file, from 1.
    pub line: u64,
    /// What is wrong with it.
    pub reason: String,
    /// What rows of one fault have in common.
    #[serde(skip)]
    pub kind: String,
}

impl RefusedRow {
    pub(crate) fn new(file: &str, line: u64, fault: Fault) -> Self {
        RefusedRow {
            file: file.to_owned(),
            line,
            reason: cut(fault.reason),
            kind: fault.kind,
        }
    }
}

impl fmt::Display for RefusedRow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: {}", self.file, self.line, self.reason)
    }
}

/// Refused rows in words, `most` of them one by one.
pub fn refusal_notes<'a>(rows: impl Iterator<Item = &'a RefusedRow> + Clone, most: usize) -> Vec<String> {
    let mut told: Vec<String> = rows
        .clone()
        .take(most)
        .map(|row| format!("refused: {row}"))
        .collect();
    let more = rows.count().saturating_sub(most);
    if more > 0 {
        told.push(format!("refused: {more} rows more"));
    }
    told
}

/// What is wrong with a row.
#[derive(Debug)]
pub(crate) struct Fault {
    kind: String,
    reason: String,
}

impl Fault {
    /// Of rows alike in `kind`.
    pub(crate) fn new(kind: impl Into<String>, reason: impl Into<String>) -> Fault {
        let (kind, reason) = (kind.into(), reason.into());
        Fault { kind, reason }
    }
}

/// One row. Missing values are NaN.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Line in the file, from 1.
    pub line: u64,
    /// Throttles of the upper and of the lower rotor.
    pub throttle: [f64; 2],
    /// Thrust, N.
    pub thrust: Split<f64>,
    /// Torque, N m.
    pub torque: Split<f64>,
    /// Supply voltage of the upper rotor or of both, and of the lower one where it has its own, V.
    pub voltage: [f64; 2],
    /// Electrical power of the whole, W.
    pub power_w: f64,
    /// Speeds of the upper and of the lower rotor, in the file's unit.
    pub speed: [f64; 2],
    /// Time since the log's start, s.
    pub time_s: f64,
}

impl Sample {
    /// Whether it reads the same, in every digit.
    pub(crate) fn equals(&self, other: &Sample) -> bool {
        let numbers = |s: &Sample| {
            let splits = [s.thrust, s.torque].map(|of| [of.whole, of.rotors[0], of.rotors[1]]);
            let numbers = [s.throttle, s.voltage, s.speed].concat().into_iter();
            numbers
                .chain(splits.concat())
                .chain([s.power_w])
                .map(f64::to_bits)
                .collect::<Vec<u64>>()
        };
        numbers(self) == numbers(other)
    }
}

/// The rotors' load cells in the order of thrust and torque, each of the upper and of the lower rotor.
pub(crate) const ROTOR_CELLS: [&str; 4] = [
    "thrust of the upper rotor",
    "thrust of the lower rotor",
    "torque of the upper rotor",
    "torque of the lower rotor",
];

/// All samples of one file.
#[derive(Debug, Clone)]
pub struct Log {
    /// File name without folders.
    pub name: String,
    /// What the header says.
    pub columns: Columns,
    /// Rows in the file's order.
    pub samples: Vec<Sample>,
    /// Rows that could not be read.
    pub refused: Vec<RefusedRow>,
    /// Temperature, K, pressure, Pa, and density of the air, kg/m3, of the rows in which columns tell the last.
    pub air: Vec<[f64; 3]>,
    /// By how much the currents of the upper and of the lower rotor change, A; negative where they have none.
    pub currents: [f64; 2],
    /// What was passed over or taken for something else.
    pub notes: Vec<String>,
    /// Options that had nothing to work on here.
    pub idle_options: Vec<String>,
}

/// How to read a file.
#[derive(Debug, Clone, Default)]
pub struct Reading {
    /// Columns and units by hand.
    pub by_hand: ByHand,
    /// Pulse widths of throttle 0 and 1, microseconds.
    pub pwm_range: Option<[f64; 2]>,
}

/// The usual range of pulse widths, microseconds.
const PWM_RANGE: [f64; 2] = [1000.0, 2000.0];

/// The refusal of a file that cannot be read.
pub fn unreadable(name: &str, reason: &str) -> Refusal {
    Refusal::of(
        name,
        format!("cannot be read: {reason}"),
        "a readable CSV file in UTF-8, UTF-16 or Latin-1",
    )
}

/// Reads a bench log named `name`.
///
/// # Errors
/// Bytes that are no table of text, a header without the columns that every use needs, and numbers
/// of two meanings.
pub fn read(name: &str, bytes: &[u8], reading: &Reading) -> Result<Log, Refusal> {
    let by_hand = &reading.by_hand;
    let sheet = Sheet::of(name, bytes, &|cells| known(cells, by_hand), &is_unit)?;
    let place = format!("{name}:{}", sheet.line);
    let header: Vec<&str> = sheet
        .headings
        .iter()
        .map(|heading| heading.name.as_str())
        .collect();
    let columns = Columns::find(&place, &sheet.headings, by_hand).map_err(|refusal| match sheet.without_names {
        false => refusal,
        true => Refusal::of(
            &place,
            format!("numbers where the names of the columns stand: {}", header.join(", ")),
            "a first line with names and units, as upper,lower,thrust_n,torque_nm or throttle,thrust_n,torque_nm",
        ),
    })?;
    let mut decimals = vec!['.'; header.len()];
    for column in columns
        .all()
        .chain(columns.twins.iter().flat_map(|(both, _)| both))
    {
        decimals[column.index] = sheet.decimal(column.index).map_err(|(line, number)| {
            Refusal::of(
                format!("{name}:{line}"),
                format!(
                    "{:?} = {number:?} may be in thousands or with three decimals, and no other number tells",
                    column.name
                ),
                "numbers without separators of thousands, as 1234 or 1.234",
            )
        })?;
    }
    let cells = Cells {
        pwm_range: reading.pwm_range.unwrap_or(PWM_RANGE),
        pwm_given: reading.pwm_range.is_some(),
        has_pulses: std::cell::Cell::new(false),
        decimals,
        most: header
            .iter()
            .rposition(|name| !name.is_empty())
            .map_or(0, |last| last + 1),
        least: if sheet.by_blanks { header.len() } else { 0 },
    };
    if let Some(twin) = columns.twins.iter().find(|(both, _)| cells.differ(both, &sheet)) {
        return Err(Columns::refusal(&place, &header, vec![twin.1.clone()]));
    }
    let (mut samples, mut refused, mut asides, mut air) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for (line, record) in &sheet.rows {
        if let Some(what) = aside(record) {
            let names = names(record);
            if known(&names, by_hand) > 1 && names != header {
                return Err(Refusal::of(
                    format!("{name}:{line}"),
                    format!(
                        "another header, {}, below that of line {}",
                        names.join(", "),
                        sheet.line
                    ),
                    "one table in a file",
                ));
            }
            asides.push((line, what));
            continue;
        }
        match cells.sample(*line, &columns, record) {
            Ok(sample) => {
                samples.push(sample);
                air.push(cells.air(&columns, record));
            }
            Err(fault) => refused.push(RefusedRow::new(name, *line, fault)),
        }
    }
    let mut notes: Vec<String> = beyond_full_speed(&mut refused, samples.len())
        .into_iter()
        .collect();
    if let Some((line, what)) = asides.first() {
        let more = match asides.len() {
            1 => String::new(),
            all => format!("; so are {} lines more", all - 1),
        };
        notes.push(format!("{name}:{line} is passed over: {what}{more}"));
    }
    let currents = columns[Quantity::Current].rotors.each_ref().map(|column| {
        let all = sheet.rows.iter().filter(|(_, record)| aside(record).is_none());
        let all = all.filter_map(|(_, record)| cells.value(column, record).ok());
        let [low, high] = extent(all.filter(|x| x.is_finite()));
        high - low
    });
    air.retain(|[_, _, density]| density.is_finite());
    let pulses = (cells.pwm_given && !cells.has_pulses.get()).then(|| "--pwm-range".to_owned());
    let units = by_hand
        .units
        .iter()
        .filter(|(role, _)| role != "lower" && columns.of_role(role).is_none());
    let units = units.map(|(role, unit)| format!("--unit {role}={unit}"));
    Ok(Log {
        idle_options: pulses.into_iter().chain(units).collect(),
        name: name.to_owned(),
        columns,
        samples,
        refused,
        air,
        currents,
        notes,
    })
}

/// Kind of the fault of a row whose speed is above that of full throttle.
const BEYOND: &str = "beyond full speed";

/// Takes rows above full speed from those refused, where they are the fewer: a propeller's table goes on beyond what a
/// motor reaches. What is said of them.
fn beyond_full_speed(refused: &mut Vec<RefusedRow>, read: usize) -> Option<String> {
    let is_beyond = |row: &&RefusedRow| row.kind == BEYOND;
    let count = refused.iter().filter(is_beyond).count();
    let first = refused.iter().find(is_beyond).filter(|_| count < read)?;
    let is = if count == 1 { "is" } else { "are" };
    let all = read + refused.len();
    let told = format!(
        "{count} of {all} rows {is} left out, the first in line {}: {}",
        first.line, first.reason
    );
    refused.retain(|row| row.kind != BEYOND);
    Some(told)
}

/// Letters that make a cell a word, not a value with a letter astray.
const WORD: usize = 4;

/// Why a row is none of measurements.
fn aside(record: &csv::StringRecord) -> Option<&'static str> {
    const SUMMARIES: &str = "average averages avg mean max maximum min minimum total sum std median stddev mittelwert \
                             moyenne promedio";
    let first = record.iter().map(str::trim).find(|cell| !cell.is_empty())?;
    let first = first.trim_end_matches([':', '.']);
    match SUMMARIES
        .split(' ')
        .any(|summary| summary.eq_ignore_ascii_case(first))
    {
        true => Some("a summary of other rows"),
        false => {
            let is_number = |cell: &&str| Cell::of(cell).is_some();
            let is_text = |cell: &str| cell.chars().filter(|c| c.is_alphabetic()).count() >= WORD;
            match record.iter().filter(is_number).count() {
                0 => Some("there is no number in it"),
                1 if record
                    .iter()
                    .any(|cell| Cell::of(cell).is_none() && is_text(cell)) =>
                {
                    Some("a remark")
                }
                _ => None,
            }
        }
    }
}

/// Difference of two columns of one quantity in two units, in shares of its greatest value, that their rounding explains.
const ROUNDED: f64 = 0.02;

struct Cells {
    pwm_range: [f64; 2],
    pwm_given: bool,
    /// Whether a throttle was a pulse width.
    has_pulses: std::cell::Cell<bool>,
    /// Decimal mark by column.
    decimals: Vec<char>,
    /// Columns with a name, and the fewest cells that a row may have.
    most: usize,
    least: usize,
}

/// Share of the pulse widths' range by which a controller at rest is commanded below it.
const AT_REST: f64 = 0.3;

impl Cells {
    fn sample(&self, line: u64, columns: &Columns, record: &csv::StringRecord) -> Result<Sample, Fault> {
        self.in_columns(record)?;
        let speeds = &columns[Quantity::Speed].rotors;
        let speed = [0, 1].map(|rotor| self.value(&speeds[rotor], record).unwrap_or(f64::NAN));
        let split = |quantity: Quantity| -> Result<Split<f64>, Fault> {
            let Split {
                whole,
                rotors: [upper, lower],
            } = &columns[quantity];
            let value = |column| self.value(column, record);
            Ok(Split {
                whole: value(whole)?,
                rotors: [value(upper)?, value(lower)?],
            })
        };
        let [upper, lower] = &columns[Quantity::Throttle].rotors;
        let throttle = [self.throttle(upper, record)?, self.throttle(lower, record)?];
        let (voltage, current, power) = (
            split(Quantity::Voltage)?.rotors,
            split(Quantity::Current)?,
            split(Quantity::Power)?,
        );
        // Of the whole, or of both rotors together; NaN where a part of it is not measured.
        let lower_voltage = voltage[usize::from(columns[Quantity::Voltage].rotors[1].is_some())];
        let by_current = match columns[Quantity::Current].whole {
            Some(_) => voltage[0] * current.whole,
            None => voltage[0] * current.rotors[0] + lower_voltage * current.rotors[1],
        };
        let measured = [by_current, power.whole, power.rotors[0] + power.rotors[1]];
        Ok(Sample {
            line,
            throttle,
            thrust: split(Quantity::Thrust)?,
            torque: split(Quantity::Torque)?,
            voltage,
            power_w: measured
                .into_iter()
                .find(|power| !power.is_nan())
                .unwrap_or(f64::NAN),
            speed,
            time_s: self
                .value(&columns[Quantity::Time].whole, record)
                .unwrap_or(f64::NAN),
        })
    }

    /// Whether two columns of one quantity differ in a row by more than the rounding of a table.
    fn differ(&self, columns: &[Column; 2], sheet: &Sheet) -> bool {
        let rows = sheet.rows.iter().filter(|(_, record)| aside(record).is_none());
        let value = |column: &Column, record| match column.quantity {
            Quantity::Throttle => self.throttle(&Some(column.clone()), record),
            _ => self.value(&Some(column.clone()), record),
        };
        let of = |column: &Column, record| value(column, record).unwrap_or(f64::INFINITY);
        let both = rows.map(|(_, record)| columns.each_ref().map(|column| of(column, record)));
        let both: Vec<[f64; 2]> = both.filter(|[a, b]| !a.is_nan() && !b.is_nan()).collect();
        let most = greatest(&both.iter().map(|both| both[0]).collect::<Vec<_>>());
        // Of infinite ones the difference is no number.
        !both.iter().all(|[a, b]| (a - b).abs() <= ROUNDED * most)
    }

    /// Refuses a row whose cells cannot stand in the columns of the header.
    fn in_columns(&self, record: &csv::StringRecord) -> Result<(), Fault> {
        let nameless = record.iter().skip(self.most).any(|cell| !is_blank(cell));
        match nameless || record.len() < self.least {
            false => Ok(()),
            true => Err(Fault::new(
                "cells",
                format!(
                    "{} cells, the header has {}: a separator inside of numbers or names?",
                    record.len(),
                    self.most
                ),
            )),
        }
    }

    /// Temperature, pressure and density of the air; NaN where the row does not tell them.
    fn air(&self, columns: &Columns, record: &csv::StringRecord) -> [f64; 3] {
        let of = |quantity| self.value(&columns[quantity].whole, record).unwrap_or(f64::NAN);
        let [kelvin, pascal] = [of(Quantity::Temperature), of(Quantity::Pressure)];
        match columns[Quantity::Density].whole {
            Some(_) => [f64::NAN, f64::NAN, of(Quantity::Density)],
            None => [kelvin, pascal, atmosphere::density(pascal, kelvin)],
        }
    }

    fn value(&self, column: &Option<Column>, record: &csv::StringRecord) -> Result<f64, Fault> {
        let Some(column) = column else { return Ok(f64::NAN) };
        Ok(column.scale.of(self.number(column, record)?))
    }

    fn throttle(&self, column: &Option<Column>, record: &csv::StringRecord) -> Result<f64, Fault> {
        let Some(column) = column else { return Ok(f64::NAN) };
        let raw = self.number(column, record)?;
        let [low, high] = self.pwm_range;
        // A column without a unit becomes a pulse width when the range is given and the value cannot
        // be a throttle.
        let us = match column.scale {
            Scale::Pulse(to_us) => Some(raw * to_us),
            Scale::Factor(1.0) if self.pwm_given && raw > 1.5 => Some(raw),
            _ => None,
        };
        self.has_pulses.set(self.has_pulses.get() || us.is_some());
        let throttle = us.map_or(column.scale.of(raw), |us| (us - low) / (high - low));
        let why = match column.scale {
            _ if us.is_some_and(|us| us > 0.0 && throttle < -AT_REST) => {
                format!("is far below the pulse widths {low}..{high} us: another unit, or --pwm-range")
            }
            _ if throttle.is_nan() || throttle <= 1.02 => return Ok(throttle),
            Scale::Factor(1.0) if !self.pwm_given => ABOVE_ONE.to_owned(),
            Scale::Pulse(_) | Scale::Factor(1.0) => {
                format!("is throttle {throttle:.3}, above the range {low}..{high} us (--pwm-range)")
            }
            Scale::Speed(_) => {
                return Err(Fault::new(
                    BEYOND,
                    format!(
                        "{:?} = {raw} is above --rpm-at-full: throttle {throttle:.3}",
                        column.name
                    ),
                ));
            }
            _ => format!("is throttle {throttle:.3}, above full throttle: another unit"),
        };
        Err(Fault::new(
            format!("{} range", column.index),
            format!("{:?} = {raw} {why}", column.name),
        ))
    }

    /// A cell as a number; NaN where it holds none or the row is too short for it.
    fn number(&self, column: &Column, record: &csv::StringRecord) -> Result<f64, Fault> {
        let text = record.get(column.index).unwrap_or_default().trim();
        if is_missing(text) {
            return Ok(f64::NAN);
        }
        let cell = Cell::of(text).filter(Cell::is_number);
        let value = cell.and_then(|cell| cell.value(self.decimals[column.index]));
        let why = match cell.zip(value.filter(|value| value.is_finite())) {
            None => "is not a finite number",
            Some((cell, value)) if column.holds(cell.unit) => return Ok(value),
            Some(_) => "is in another unit than its column",
        };
        Err(Fault::new(
            format!("{} {why}", column.index),
            format!("{:?} = {:?} {why}", column.name, cut_cell(text.to_owned())),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn log(bytes: &[u8]) -> Result<Log, Refusal> {
        read(
            "bench.csv",
            bytes,
            &Reading {
                by_hand: ByHand::default(),
                pwm_range: None,
            },
        )
    }

    #[test]
    fn a_bad_cell_names_its_line_and_stops_nothing() {
        let log = log(b"upper,lower,thrust_n,torque_nm\n.1,.2,3,4\n.1,x,3,4\n\n.5,.6,inf,4\n.7,.8,9,\n")
            .expect("a log");
        assert_eq!(log.samples.len(), 2);
        let refused: Vec<(u64, &str)> = log.refused.iter().map(|r| (r.line, r.reason.as_str())).collect();
        assert_eq!(refused.len(), 2, "{refused:?}");
        assert_eq!(refused[0], (3, "\"lower\" = \"x\" is not a finite number"));
        assert_eq!(refused[1].0, 5);
        assert_eq!(log.samples[1].line, 6);
        assert!(log.samples[1].torque.whole.is_nan());
    }

    #[test]
    fn lines_are_counted_with_every_line_end() {
        for end in ["\n", "\r\n", "\r"] {
            let text = [
                "upper,lower,thrust_n,torque_nm",
                ".1,.2,3,4",
                "bad,.2,3,4",
                ".3,.2,3,4",
                "",
            ]
            .join(end);
            let log = log(text.as_bytes()).expect("a log");
            assert_eq!(log.refused[0].line, 3, "{end:?}");
            assert_eq!(log.samples[1].line, 4, "{end:?}");
        }
    }

    #[test]
    fn semicolons_allow_decimal_commas() {
        let log = log(b"upper;lower;Thrust (kgf);Torque (N\xb7m)\n0,5;0,25;1,5;-0,02\n").expect("a log");
        let s = log.samples[0];
        assert_eq!((s.throttle, s.torque.whole), ([0.5, 0.25], -0.02));
        assert!((s.thrust.whole - 1.5 * 9.80665).abs() < 1e-12);
    }

    #[test]
    fn pulse_widths_need_their_range() {
        let error = log(b"upper,lower,thrust_n,torque_nm\n1500,1600,3,4\n")
            .expect("a log")
            .refused;
        assert!(error[0].reason.contains("--pwm-range"), "{error:?}");
        let by_hand = ByHand::default();
        let reading = Reading {
            by_hand,
            pwm_range: Some([1100.0, 1900.0]),
        };
        let text = &b"upper,lower,thrust_n,torque_nm\n1500,1700,3,4\n"[..];
        let log = read("bench.csv", text, &reading).expect("a log");
        assert_eq!(log.samples[0].throttle, [0.5, 0.75]);
    }

    #[test]
    fn numbers_are_no_header() {
        let refusal = read(
            "a.csv",
            "0.1,0.1,0.62,3e-3\n0.1,0.2,0.9,0.01\n".as_bytes(),
            &Reading::default(),
        );
        let told = refusal.unwrap_err().to_string();
        assert!(
            told.starts_with("a.csv:1: numbers where the names of the columns stand: 0.1, 0.1, 0.62, 3e-3"),
            "{told}"
        );
    }

    #[test]
    fn what_is_missing_is_named() {
        let error = log(b"RPM,T_A(N),Q_A(Nm)\n1,2,3\n").unwrap_err().to_string();
        assert!(
            error.contains("no throttle column") && error.contains("RPM"),
            "{error}"
        );
        let error = log(b"upper,lower,torque_nm\n1,2,3\n").unwrap_err().to_string();
        assert!(error.contains("no thrust column"), "{error}");
        assert!(log(b"").unwrap_err().to_string().contains("empty"));
        assert!(
            log(b"\x00\x01\x02\n")
                .unwrap_err()
                .to_string()
                .contains("no text")
        );
    }
}
