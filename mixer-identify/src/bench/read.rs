//! One bench file to samples in SI units.
//!
//! A cell that is not a number, or a throttle outside the range, refuses its row, named by file and
//! line. An empty cell is a missing value: streaming tools leave torque blank in most rows.

use mixer_compiler::atmosphere;
use serde::Serialize;

use crate::bench::air;
use crate::bench::header::{ByHand, Column, Columns, Offers, STANDARD_DENSITY, Split, is_unit, known};
use crate::bench::number::{Cell, is_blank, is_missing};
use crate::bench::sheet::Sheet;
use crate::bench::units::{self, Scale};
use crate::refusal::{Refusal, cut, cut_cell};

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
}

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
    /// The air in the mean of the rows, where columns tell it, or of coefficients.
    pub air: Option<air::Known>,
    /// What was passed over or taken for something else.
    pub notes: Vec<String>,
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
    let place = format!("{name}:{}", sheet.line.max(1));
    let columns = named(&sheet, &place, Columns::find(&place, &sheet.headings, by_hand))?;
    let mut decimals = vec!['.'; sheet.headings.len()];
    for column in columns.all() {
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
    let mut log = Log {
        name: name.to_string(),
        notes: taken_for_throttle(&columns, by_hand),
        samples: Vec::new(),
        refused: Vec::new(),
        air: None,
        columns,
    };
    let cells = Cells {
        pwm_range: reading.pwm_range.unwrap_or(PWM_RANGE),
        pwm_given: reading.pwm_range.is_some(),
        offers: by_hand.offers,
        decimals,
        most: match sheet
            .headings
            .iter()
            .rposition(|heading| !heading.name.is_empty())
        {
            Some(last) => last + 1,
            None => 0,
        },
        least: if sheet.by_blanks { sheet.headings.len() } else { 0 },
    };
    let (mut densities, mut measured, mut aside) = (0.0, 0, Vec::new());
    for (line, record) in &sheet.rows {
        let line = *line;
        match cells.sample(line, &log.columns, record) {
            _ if let Some(what) = is_aside(&sheet, record) => aside.push((line, what)),
            Ok(sample) => {
                log.samples.push(sample);
                let density = cells.density(&log.columns, record);
                if density.is_finite() {
                    (densities, measured) = (densities + density, measured + 1);
                }
            }
            Err(fault) => {
                let names: Vec<String> = record.iter().map(str::to_owned).collect();
                if known(&names, by_hand) > 1 {
                    let reason = format!(
                        "another header, {}, below that of line {}",
                        names.join(", "),
                        sheet.line
                    );
                    return Err(Refusal::of(
                        format!("{name}:{line}"),
                        reason,
                        "one table in a file",
                    ));
                }
                log.refused.push(RefusedRow::new(name, line, fault));
            }
        }
    }
    let told = |(line, what): &(u64, &str)| format!("{name}:{line} is passed over: {what}");
    log.notes.extend(aside.iter().take(MOST_TOLD).map(told));
    if aside.len() > MOST_TOLD {
        log.notes.push(format!(
            "{name}: {} lines more are passed over",
            aside.len() - MOST_TOLD
        ));
    }
    let of_coefficients = log
        .columns
        .thrust
        .whole
        .as_ref()
        .is_some_and(|c| matches!(c.scale, Scale::OfSpeed(_)));
    log.air = match by_hand.density_kg_m3 {
        _ if !of_coefficients => (measured > 0).then(|| air::Known {
            density_kg_m3: densities / f64::from(measured),
            from: format!("columns of {name}"),
        }),
        Some(_) => None,
        None => Some(air::Known {
            density_kg_m3: STANDARD_DENSITY,
            from: "standard, for CT and CP".to_owned(),
        }),
    };
    Ok(log)
}

/// Lines passed over that are told one by one.
const MOST_TOLD: usize = 3;

/// The columns, or that the first line has numbers where their names should stand.
fn named(sheet: &Sheet, place: &str, found: Result<Columns, Refusal>) -> Result<Columns, Refusal> {
    found.map_err(|refusal| match sheet.without_names {
        false => refusal,
        true => {
            let names: Vec<&str> = sheet.headings.iter().map(|heading| heading.name.as_str()).collect();
            Refusal::of(
                place,
                format!("numbers where the names of the columns stand: {}", names.join(", ")),
                "a first line with names and units, as upper,lower,thrust_n,torque_nm or throttle,thrust_n,torque_nm",
            )
        }
    })
}

/// What stands for throttle and thrust.
fn taken_for_throttle(columns: &Columns, by_hand: &ByHand) -> Vec<String> {
    let mut notes = Vec::new();
    let speeds = columns.throttle.rotors.iter().flatten();
    let speeds: Vec<String> = speeds
        .filter(|column| matches!(column.scale, Scale::Speed(_)))
        .map(|column| format!("{:?}", column.name))
        .collect();
    if let (Some(full), false) = (by_hand.full_rpm, speeds.is_empty()) {
        notes.push(format!(
            "throttle is {} over {full} rpm (--rpm-at-full)",
            speeds.join(" and ")
        ));
    }
    if let (Some(Scale::OfSpeed(_)), Some(diameter)) =
        (columns.thrust.whole.as_ref().map(|c| c.scale), by_hand.diameter_m)
    {
        let density = by_hand.density_kg_m3.unwrap_or(STANDARD_DENSITY);
        let standard = if by_hand.density_kg_m3.is_none() {
            " (standard; --density gives another)"
        } else {
            ""
        };
        notes.push(format!(
            "thrust and torque are those of CT and CP with a diameter of {diameter} m in air of {density} kg/m3{standard}"
        ));
    }
    notes
}

/// Why a row is none of measurements: the header again, a summary, a remark.
fn is_aside(sheet: &Sheet, record: &csv::StringRecord) -> Option<&'static str> {
    const SUMMARIES: [&str; 16] = [
        "average",
        "averages",
        "avg",
        "mean",
        "max",
        "maximum",
        "min",
        "minimum",
        "total",
        "sum",
        "std",
        "median",
        "stddev",
        "mittelwert",
        "moyenne",
        "promedio",
    ];
    let first = record.iter().map(str::trim).find(|cell| !cell.is_empty())?;
    if first.starts_with(|c: char| c.is_ascii_digit()) {
        return None;
    }
    let held = record.iter().filter(|cell| !is_blank(cell)).count();
    let has_number = record.iter().any(|cell| Cell::of(cell).is_some());
    let word = first.trim_end_matches([':', '.']);
    let names = sheet.headings.iter().map(|heading| heading.name.as_str());
    let below = sheet
        .headings
        .iter()
        .map(|heading| heading.below.as_deref().unwrap_or_default());
    let units = record
        .iter()
        .map(|cell| cell.trim_matches(['(', ')', '[', ']', ' ']));
    match () {
        () if SUMMARIES.iter().any(|summary| word.eq_ignore_ascii_case(summary)) => {
            Some("a summary of other rows")
        }
        () if names.eq(record.iter().map(str::trim)) => Some("the header again"),
        () if has_number => None,
        () if units.eq(below) => Some("the units again"),
        () if held == 1 || first.starts_with(['#', '%']) && !is_error(first) => Some("a remark"),
        () => None,
    }
}

/// Whether a cell is what a spreadsheet writes for a value that it cannot compute.
fn is_error(cell: &str) -> bool {
    cell.starts_with('#') && cell[1..].starts_with(|c: char| c.is_uppercase())
}

struct Cells {
    pwm_range: [f64; 2],
    pwm_given: bool,
    offers: Offers,
    /// Decimal mark by column.
    decimals: Vec<char>,
    /// Most cells that have a name, and least of a row.
    most: usize,
    least: usize,
}

/// Share of the pulse widths' range by which a controller at rest is commanded below it.
const AT_REST: f64 = 0.3;

impl Cells {
    fn sample(&self, line: u64, columns: &Columns, record: &csv::StringRecord) -> Result<Sample, Fault> {
        self.in_columns(record)?;
        let [upper, lower] = &columns.throttle.rotors;
        let rpm = self
            .value(&columns.speed.rotors[0], record, f64::NAN)
            .unwrap_or(f64::NAN);
        let value = |column: &Option<Column>| self.value(column, record, rpm);
        let split = |columns: &Split<Option<Column>>| -> Result<Split<f64>, Fault> {
            let [upper, lower] = &columns.rotors;
            Ok(Split {
                whole: value(&columns.whole)?,
                rotors: [value(upper)?, value(lower)?],
            })
        };
        let throttle = [self.throttle(upper, record)?, self.throttle(lower, record)?];
        let (voltage, current) = (split(&columns.voltage)?.rotors, split(&columns.current)?);
        // Of the whole, or of both rotors together; NaN where a part of it is not measured.
        let lower_voltage = voltage[usize::from(columns.voltage.rotors[1].is_some())];
        let power_w = match columns.current.whole {
            Some(_) => voltage[0] * current.whole,
            None => voltage[0] * current.rotors[0] + lower_voltage * current.rotors[1],
        };
        let power_w = match split(&columns.power)? {
            _ if !power_w.is_nan() => power_w,
            Split {
                whole,
                rotors: [upper, lower],
            } => {
                if whole.is_nan() {
                    upper + lower
                } else {
                    whole
                }
            }
        };
        Ok(Sample {
            line,
            throttle,
            thrust: split(&columns.thrust)?,
            torque: split(&columns.torque)?,
            voltage,
            power_w,
        })
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

    /// Density of the air, kg/m3; NaN where the row does not tell it.
    fn density(&self, columns: &Columns, record: &csv::StringRecord) -> f64 {
        let of =
            |column: &Split<Option<Column>>| self.value(&column.whole, record, f64::NAN).unwrap_or(f64::NAN);
        match columns.density.whole {
            Some(_) => of(&columns.density),
            None => atmosphere::density(of(&columns.pressure), of(&columns.temperature)),
        }
    }

    fn value(&self, column: &Option<Column>, record: &csv::StringRecord, rpm: f64) -> Result<f64, Fault> {
        let Some(column) = column else { return Ok(f64::NAN) };
        let raw = self.number(column, record)?;
        Ok(match column.scale {
            Scale::Factor(factor) | Scale::Pulse(factor) | Scale::Speed(factor) => raw * factor,
            Scale::Affine(factor, offset) => raw * factor + offset,
            Scale::OfSpeed(factor) => raw * factor * rpm * rpm,
        })
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
        let throttle = match (us, column.scale) {
            (Some(us), _) => (us - low) / (high - low),
            (None, Scale::Affine(factor, offset)) => raw * factor + offset,
            (
                None,
                Scale::Factor(factor) | Scale::Pulse(factor) | Scale::Speed(factor) | Scale::OfSpeed(factor),
            ) => raw * factor,
        };
        let why = match column.scale {
            _ if us.is_some_and(|us| us > 0.0 && throttle < -AT_REST) => {
                format!("is far below the pulse widths {low}..{high} us: another unit, or --pwm-range")
            }
            _ if throttle.is_nan() || throttle <= 1.02 => return Ok(throttle),
            Scale::Factor(1.0) if !self.pwm_given => {
                let per_cent = match self.offers {
                    Offers::Pair => "--unit upper=% --unit lower=%",
                    Offers::OneRotor => "--unit throttle=%",
                    Offers::Header => "Throttle (%) in the header",
                };
                let pulse = match self.offers {
                    Offers::Header => "PWM (us) in the header",
                    _ => "--pwm-range 1000,2000",
                };
                format!("is above 1: give {pulse} if it is a pulse width, {per_cent} if it is in per cent")
            }
            Scale::Factor(_) => {
                format!("is throttle {throttle:.3}, above full throttle: its unit is another")
            }
            Scale::Speed(factor) => format!(
                "is above the speed at full throttle, {:.0} (--rpm-at-full)",
                1.0 / factor
            ),
            _ => format!("is throttle {throttle:.3}, above the range {low}..{high} us (--pwm-range)"),
        };
        Err(Fault::new(
            format!("{} range", column.index),
            format!("{:?} = {raw} {why}", column.name),
        ))
    }

    /// A cell as a number; NaN where it holds none or the row is too short for it.
    fn number(&self, column: &Column, record: &csv::StringRecord) -> Result<f64, Fault> {
        let cell = record.get(column.index).unwrap_or_default().trim();
        if is_missing(cell) {
            return Ok(f64::NAN);
        }
        let fault = |what: &str, why: &str| {
            let (name, cell) = (&column.name, cut_cell(cell.to_owned()));
            Fault::new(
                format!("{} {what}", column.index),
                format!("{name:?} = {cell:?} {why}"),
            )
        };
        let of = |cell: &Cell<'_>| {
            cell.value(self.decimals[column.index])
                .filter(|value| value.is_finite())
        };
        let taken = Cell::of(cell);
        let Some((value, unit)) = taken.and_then(|cell| Some((of(&cell)?, cell.unit))) else {
            return Err(fault("number", "is not a finite number"));
        };
        let own = || units::scale(column.quantity, unit);
        match &column.in_cells {
            _ if unit.is_empty() && column.in_cells.is_none() => Ok(value),
            Some(common) if unit == common => Ok(value),
            Some(common) => Err(fault("unit", &format!("is not in {common:?} as the others"))),
            None if own().is_none() => Err(fault("number", "is not a finite number")),
            None if own() == Some(column.scale) => Ok(value),
            None => Err(fault("unit", "is in another unit than its column")),
        }
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
