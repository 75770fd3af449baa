//! One bench file to samples in SI units.
//!
//! A cell that is not a number, or a throttle outside the range, refuses its row, named by file and
//! line. An empty cell is a missing value: streaming tools leave torque blank in most rows.

use mixer_compiler::atmosphere;
use serde::Serialize;

use crate::bench::header::{ByHand, Column, Columns, Split};
use crate::bench::text;
use crate::bench::units::Scale;
use crate::refusal::{Refusal, cut, cut_cell};

/// Most columns of a log; loggers of whole vehicles have some hundred.
const MOST_COLUMNS: usize = 2000;

/// Longest header line, bytes.
const LONGEST_HEADER: usize = 100_000;

/// A row that was left out, and why.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct RefusedRow {
    /// File name.
    pub file: String,
    /// Line in the file, from 1.
    pub line: u64,
    /// What is wrong with it.
    pub reason: String,
}

impl RefusedRow {
    pub(crate) fn new(file: &str, line: u64, reason: impl Into<String>) -> Self {
        RefusedRow {
            file: file.to_owned(),
            line,
            reason: cut(reason.into()),
        }
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
    /// Density of the air in the mean of the rows, kg/m3, where columns tell it.
    pub density_kg_m3: Option<f64>,
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
        "a readable CSV file in UTF-8 or Latin-1",
    )
}

/// Reads a bench log named `name`.
///
/// # Errors
/// Bytes that are no text, and a header without the columns that every use needs.
pub fn read(name: &str, bytes: &[u8], reading: &Reading) -> Result<Log, Refusal> {
    let text = text::normalised(bytes).map_err(|reason| unreadable(name, reason))?;
    let (mut header, mut header_line, mut rows) = (&text[..0], 0, text.as_slice());
    while header.trim_ascii().is_empty() && !rows.is_empty() {
        let end = rows.iter().position(|byte| *byte == b'\n');
        (header, rows) = rows.split_at(end.map_or(rows.len(), |at| at + 1));
        header_line += 1;
    }
    if header.contains(&0) {
        return Err(unreadable(name, "it holds zero bytes and is no text"));
    }
    let separator = text::separator(header);
    let columns = header.iter().filter(|byte| **byte == separator).count() + 1;
    if columns > MOST_COLUMNS || header.len() > LONGEST_HEADER {
        return Err(Refusal::of(
            format!("{name}:{header_line}"),
            format!("a header line of {columns} columns and {} bytes", header.len()),
            format!("at most {MOST_COLUMNS} columns and {LONGEST_HEADER} bytes"),
        ));
    }
    let csv_of = |input| {
        let mut builder = csv::ReaderBuilder::new();
        builder.delimiter(separator).flexible(true).has_headers(false);
        builder.from_reader::<&[u8]>(input)
    };
    let Some(Ok(record)) = csv_of(header).byte_records().next() else {
        let needed = "a header line and rows of measurements";
        return Err(Refusal::of(name, "the file is empty", needed));
    };
    let cells = record.iter().map(|cell| text::decode(cell).trim().to_string());
    let headers: Vec<String> = cells.collect();
    let columns = Columns::find(name, &headers, &reading.by_hand)?;
    require(name, &columns, &headers)?;

    let mut log = Log {
        name: name.to_string(),
        columns,
        samples: Vec::new(),
        refused: Vec::new(),
        density_kg_m3: None,
    };
    let (mut densities, mut measured) = (0.0, 0);
    let mut rows = csv_of(rows);
    let mut record = csv::ByteRecord::new();
    let mut cells = Cells {
        pwm_range: reading.pwm_range.unwrap_or(PWM_RANGE),
        pwm_given: reading.pwm_range.is_some(),
        decimal_comma: separator == b';',
    };
    loop {
        let more = rows.read_byte_record(&mut record);
        if !more.map_err(|error| unreadable(name, &error.to_string()))? {
            log.density_kg_m3 = (measured > 0).then(|| densities / f64::from(measured));
            return Ok(log);
        }
        // The reader stands behind the row's line end (where the row begins it does not know: it
        // skips blank lines silently). A quoted cell may span lines.
        let inner = record.iter().flatten().filter(|b| **b == b'\n').count() as u64;
        let line = header_line + rows.position().line() - 1 - inner;
        if record.iter().all(|cell| cell.trim_ascii().is_empty()) {
            continue;
        }
        match cells.sample(line, &log.columns, &record) {
            Ok(sample) => {
                log.samples.push(sample);
                let density = cells.density(&log.columns, &record);
                if density.is_finite() {
                    (densities, measured) = (densities + density, measured + 1);
                }
            }
            Err(reason) => log.refused.push(RefusedRow::new(name, line, reason)),
        }
    }
}

/// Refuses a header without the columns that every use needs.
fn require(name: &str, columns: &Columns, headers: &[String]) -> Result<(), Refusal> {
    let has_thrust = columns.thrust.any();
    let (what, roles) = match columns.throttle.rotors.each_ref() {
        [None, None] => (
            "throttle",
            "upper=HEADER and --column lower=HEADER (rotor speeds are no throttles)",
        ),
        [None, Some(_)] => ("throttle of the upper rotor", "upper=HEADER"),
        _ if !has_thrust => ("thrust", "thrust=HEADER"),
        _ => return Ok(()),
    };
    let is_number = |header: &String| header.trim().parse::<f64>().is_ok();
    let (place, names) = (format!("{name}:1"), headers.join(", "));
    if headers.iter().all(is_number) {
        return Err(Refusal::of(
            place,
            format!("numbers where the names of the columns stand: {names}"),
            "a first line with names and units, as upper,lower,thrust_n,torque_nm or throttle,thrust_n,torque_nm",
        ));
    }
    Err(Refusal::of(
        place,
        format!("no {what} column among: {names}"),
        format!("the column by hand: --column {roles}"),
    ))
}

struct Cells {
    pwm_range: [f64; 2],
    pwm_given: bool,
    decimal_comma: bool,
}

impl Cells {
    fn sample(&mut self, line: u64, columns: &Columns, record: &csv::ByteRecord) -> Result<Sample, String> {
        let [upper, lower] = &columns.throttle.rotors;
        let split = |columns: &Split<Option<Column>>| -> Result<Split<f64>, String> {
            let [upper, lower] = &columns.rotors;
            Ok(Split {
                whole: self.value(&columns.whole, record)?,
                rotors: [self.value(upper, record)?, self.value(lower, record)?],
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
        Ok(Sample {
            line,
            throttle,
            thrust: split(&columns.thrust)?,
            torque: split(&columns.torque)?,
            voltage,
            power_w,
        })
    }

    /// Density of the air, kg/m3; NaN where the row does not tell it.
    fn density(&self, columns: &Columns, record: &csv::ByteRecord) -> f64 {
        let of = |column: &Split<Option<Column>>| self.value(&column.whole, record).unwrap_or(f64::NAN);
        match columns.density.whole {
            Some(_) => of(&columns.density),
            None => atmosphere::density(of(&columns.pressure), of(&columns.temperature)),
        }
    }

    fn value(&self, column: &Option<Column>, record: &csv::ByteRecord) -> Result<f64, String> {
        let Some(column) = column else { return Ok(f64::NAN) };
        let raw = self.number(column, record)?;
        Ok(match column.scale {
            Scale::Factor(factor) | Scale::Pulse(factor) => raw * factor,
            Scale::Affine(factor, offset) => raw * factor + offset,
        })
    }

    fn throttle(&self, column: &Option<Column>, record: &csv::ByteRecord) -> Result<f64, String> {
        let Some(column) = column else { return Ok(f64::NAN) };
        let raw = self.number(column, record)?;
        let [low, high] = self.pwm_range;
        let pulse = |us: f64| (us - low) / (high - low);
        let throttle = match column.scale {
            Scale::Pulse(to_us) => pulse(raw * to_us),
            // A column without a unit becomes a pulse width when the range is given and the value
            // cannot be a throttle.
            Scale::Factor(1.0) if self.pwm_given && raw > 1.5 => pulse(raw),
            Scale::Factor(factor) => raw * factor,
            Scale::Affine(factor, offset) => raw * factor + offset,
        };
        if throttle > 1.02 {
            let why = match column.scale {
                Scale::Factor(1.0) if !self.pwm_given => {
                    "is above 1: give --pwm-range 1000,2000 if it is a pulse width, --unit upper=% --unit lower=% if \
                     it is in per cent"
                        .to_string()
                }
                _ => format!("is throttle {throttle:.3}, above the range {low}..{high} us (--pwm-range)"),
            };
            return Err(format!("{:?} = {raw} {why}", column.name));
        }
        Ok(throttle)
    }

    /// A cell as a number; NaN where it is empty or the row is too short for it.
    fn number(&self, column: &Column, record: &csv::ByteRecord) -> Result<f64, String> {
        let cell = record.get(column.index).unwrap_or_default().trim_ascii();
        if cell.is_empty() {
            return Ok(f64::NAN);
        }
        let ascii = std::str::from_utf8(cell).ok();
        let parsed = ascii.and_then(|t| match self.decimal_comma && t.contains(',') {
            true => t.replace(',', ".").parse::<f64>().ok(),
            false => t.parse::<f64>().ok(),
        });
        match parsed {
            Some(value) if value.is_finite() => Ok(value),
            _ => Err(format!(
                "{:?} = {:?} is not a finite number",
                column.name,
                cut_cell(text::decode(cell))
            )),
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
