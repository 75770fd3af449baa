//! Setpoints as CSV: a header `roll_nm,pitch_nm,yaw_nm,thrust_n[,voltage_v]` in any order, then one
//! row per line.
//!
//! A row never spans lines, although CSV allows it in quotes: so a stray quote spoils its own row
//! and not all rows after it, every fault names its line, and a row can be answered as soon as its
//! line has ended.

use std::io::{self, BufRead, BufReader, Read};

use csv_core::ReadRecordResult;
use mixer_rt::Wrench;

/// The columns that must be there, in the order of [`Wrench::to_array`].
const REQUIRED: [&str; 4] = ["roll_nm", "pitch_nm", "yaw_nm", "thrust_n"];
const VOLTAGE: &str = "voltage_v";
pub(crate) const HEADER: &str = "roll_nm,pitch_nm,yaw_nm,thrust_n[,voltage_v]";
/// Columns that a header can have before it is refused for its first unknown or repeated one.
const MOST_COLUMNS: usize = 64;

/// One row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setpoint {
    /// What is asked for.
    pub wrench: Wrench,
    /// The battery's voltage, V, if there is such a column.
    pub voltage_v: Option<f32>,
}

/// A line that is no setpoint.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BadLine {
    /// Line of the input, from 1.
    pub line: usize,
    /// What is wrong with it.
    pub message: String,
}

/// Why there are no setpoints at all.
#[derive(Debug)]
pub enum HeaderError {
    /// The first line is not the header.
    Bad(BadLine),
    /// The input cannot be read.
    Io(io::Error),
}

/// Reads setpoints row by row.
#[derive(Debug)]
pub struct Setpoints<R> {
    lines: Lines<R>,
    columns: Columns,
}

impl<R: Read> Setpoints<R> {
    /// Reads the header.
    ///
    /// # Errors
    /// An input without one, a column that is missing, unknown or stands twice, or an input that
    /// fails.
    pub fn new(input: R) -> Result<Self, HeaderError> {
        let mut lines = Lines::new(input);
        let there_is_one = lines.advance().map_err(HeaderError::Io)?;
        let columns = if there_is_one {
            lines.fields().and_then(|fields| Columns::new(&fields))
        } else {
            Err(format!(
                "the input is empty; its first line is the header {HEADER}"
            ))
        };
        match columns {
            Ok(columns) => Ok(Self { lines, columns }),
            Err(message) => Err(HeaderError::Bad(BadLine {
                line: lines.number.max(1),
                message,
            })),
        }
    }

    /// The next row and its line, or `None` at the end. Blank lines are passed over.
    ///
    /// # Errors
    /// An input that cannot be read any further.
    pub fn read(&mut self) -> io::Result<Option<(usize, Result<Setpoint, BadLine>)>> {
        if !self.lines.advance()? {
            return Ok(None);
        }
        let line = self.lines.number;
        let row = self.lines.fields().and_then(|fields| self.columns.read(&fields));
        Ok(Some((line, row.map_err(|message| BadLine { line, message }))))
    }

    /// True where the next [`Setpoints::read`] may have to wait for input.
    pub fn may_wait(&self) -> bool {
        !self.lines.input.buffer().contains(&b'\n')
    }
}

/// Where the columns stand.
#[derive(Debug)]
struct Columns {
    count: usize,
    wrench: [usize; 4],
    voltage: Option<usize>,
}

impl Columns {
    fn new(header: &[&str]) -> Result<Self, String> {
        let place = |name: &str| header.iter().position(|column| *column == name);
        let known = |name: &str| REQUIRED.contains(&name) || name == VOLTAGE;
        let missing: Vec<&str> = REQUIRED
            .into_iter()
            .filter(|name| place(name).is_none())
            .collect();
        if !missing.is_empty() {
            return Err(format!(
                "no column {}; the header is {HEADER}",
                missing.join(", ")
            ));
        }
        if let Some(unknown) = header.iter().find(|name| !known(name)) {
            return Err(format!(
                "unknown column `{}`; the header is {HEADER}",
                unknown.escape_debug()
            ));
        }
        let repeated = header
            .iter()
            .enumerate()
            .find(|(i, name)| place(name) != Some(*i));
        if let Some((_, name)) = repeated {
            return Err(format!("column `{name}` stands twice"));
        }
        Ok(Columns {
            count: header.len(),
            wrench: REQUIRED.map(|name| place(name).unwrap_or_default()),
            voltage: place(VOLTAGE),
        })
    }

    fn read(&self, fields: &[&str]) -> Result<Setpoint, String> {
        if fields.len() != self.count {
            let columns = if fields.len() == 1 { "column" } else { "columns" };
            return Err(format!(
                "{} {columns} where the header has {}",
                fields.len(),
                self.count
            ));
        }
        let number = |index: usize, name: &str| {
            let text = fields.get(index).copied().unwrap_or_default();
            text.parse::<f32>()
                .map_err(|_| format!("{name} `{}` is not a number", text.escape_debug()))
        };
        let mut wrench = [0.0; 4];
        for ((value, index), name) in wrench.iter_mut().zip(self.wrench).zip(REQUIRED) {
            *value = number(index, name)?;
        }
        Ok(Setpoint {
            wrench: Wrench::from_array(wrench),
            voltage_v: self.voltage.map(|index| number(index, VOLTAGE)).transpose()?,
        })
    }
}

/// Longest line, bytes: six numbers take a hundred. A device without an end would fill the memory.
const LONGEST_LINE: usize = 1 << 16;

/// Lines that are not blank, split at commas.
#[derive(Debug)]
struct Lines<R> {
    input: BufReader<R>,
    parser: csv_core::Reader,
    /// Number of the present line, from 1; 0 before the first.
    number: usize,
    line: Vec<u8>,
    unquoted: Vec<u8>,
}

impl<R: Read> Lines<R> {
    fn new(input: R) -> Self {
        Self {
            input: BufReader::new(input),
            // A carriage return within a line would otherwise end the row and hide what follows it.
            parser: csv_core::ReaderBuilder::new()
                .terminator(csv_core::Terminator::Any(b'\n'))
                .build(),
            number: 0,
            line: Vec::new(),
            unquoted: Vec::new(),
        }
    }

    /// Goes to the next line that is not blank; false at the end.
    fn advance(&mut self) -> io::Result<bool> {
        const BYTE_ORDER_MARK: &[u8] = "\u{feff}".as_bytes();
        loop {
            self.line.clear();
            let mut input = self.input.by_ref().take(LONGEST_LINE as u64 + 1);
            if input.read_until(b'\n', &mut self.line)? == 0 {
                return Ok(false);
            }
            self.number += 1;
            if self.line.len() > LONGEST_LINE {
                return Err(io::Error::other(format!(
                    "line {} has more than {LONGEST_LINE} bytes: setpoints are lines of numbers below {HEADER}",
                    self.number
                )));
            }
            if self.number == 1 && self.line.starts_with(BYTE_ORDER_MARK) {
                self.line.drain(..BYTE_ORDER_MARK.len());
            }
            if !String::from_utf8_lossy(&self.line).trim().is_empty() {
                return Ok(true);
            }
        }
    }

    /// The fields of the present line, without quotes and the blanks around them.
    fn fields(&mut self) -> Result<Vec<&str>, String> {
        let line = str::from_utf8(&self.line).map_err(|_| "not UTF-8".to_owned())?;
        // A line feed ends the record, whether the input's last line has one or not.
        let record = format!("{}\n", line.trim());
        self.unquoted.resize(record.len(), 0);
        let mut ends = [0; MOST_COLUMNS];
        self.parser.reset();
        let (result, _, _, count) = self
            .parser
            .read_record(record.as_bytes(), &mut self.unquoted, &mut ends);
        match result {
            ReadRecordResult::Record => {}
            ReadRecordResult::OutputEndsFull => return Err(format!("more than {MOST_COLUMNS} columns")),
            _ => return Err("a quote is not closed on its line".to_owned()),
        }
        let mut start = 0;
        let fields = ends.iter().take(count).map(|&end| {
            let field = self.unquoted.get(start..end).unwrap_or_default();
            start = end;
            str::from_utf8(field).map(str::trim)
        });
        fields
            .collect::<Result<_, _>>()
            .map_err(|_| "not UTF-8".to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The rows of `text`, and the line and message of each that is bad.
    fn read(text: impl AsRef<[u8]>) -> (Vec<Setpoint>, Vec<(usize, String)>) {
        let (mut good, mut bad) = (Vec::new(), Vec::new());
        let mut setpoints = match Setpoints::new(text.as_ref()) {
            Ok(setpoints) => setpoints,
            Err(HeaderError::Bad(BadLine { line, message })) => return (good, vec![(line, message)]),
            Err(HeaderError::Io(error)) => panic!("{error}"),
        };
        while let Some((_, row)) = setpoints.read().unwrap() {
            match row {
                Ok(setpoint) => good.push(setpoint),
                Err(BadLine { line, message }) => bad.push((line, message)),
            }
        }
        (good, bad)
    }

    fn setpoint(wrench: [f32; 4], voltage_v: Option<f32>) -> Setpoint {
        Setpoint {
            wrench: Wrench::from_array(wrench),
            voltage_v,
        }
    }

    #[test]
    fn columns_in_any_order() {
        let (good, bad) = read("voltage_v,thrust_n,yaw_nm,pitch_nm,roll_nm\n15,4,3,2,1\n");
        assert_eq!(good, [setpoint([1.0, 2.0, 3.0, 4.0], Some(15.0))]);
        assert_eq!(bad, []);
    }

    #[test]
    fn files_of_other_systems() {
        let expected = [setpoint([1.0, -2.5, 3e-3, 40.0], None); 2];
        for text in [
            "roll_nm,pitch_nm,yaw_nm,thrust_n\n1,-2.5,3e-3,40\n1,-2.5,3e-3,40",
            "\u{feff}roll_nm,pitch_nm,yaw_nm,thrust_n\r\n1,-2.5,3e-3,40\r\n\u{a0}\r\n1,-2.5,3e-3,40\r\n",
            "\n \"roll_nm\" ,\"pitch_nm\",\"yaw_nm\",thrust_n \n\"1\",\" -2.5 \",3e-3,40\n\t\n+1.0, -2.5,.003,40.\n",
        ] {
            assert_eq!(read(text), (expected.to_vec(), vec![]), "{text:?}");
        }
    }

    #[test]
    fn a_line_without_end_is_refused() {
        let fault = |text: String| match Setpoints::new(text.as_bytes()) {
            Err(HeaderError::Io(error)) => error.to_string(),
            Err(HeaderError::Bad(bad)) => panic!("{bad:?}"),
            Ok(mut setpoints) => setpoints.read().unwrap_err().to_string(),
        };
        let long = "0".repeat(LONGEST_LINE + 1);
        assert!(fault(long.clone()).starts_with("line 1 has more than 65536 bytes"));
        assert!(fault(format!("roll_nm,pitch_nm,yaw_nm,thrust_n\n{long}")).starts_with("line 2 has"));
        let padded = format!(
            "{:<1$}\n1,2,3,4\n",
            "roll_nm,pitch_nm,yaw_nm,thrust_n",
            LONGEST_LINE - 1
        );
        assert_eq!(read(padded), (vec![setpoint([1.0, 2.0, 3.0, 4.0], None)], vec![]));
    }

    #[test]
    fn a_bad_row_spoils_no_other() {
        let rows: [&[u8]; 10] = [
            b"roll_nm,pitch_nm,yaw_nm,thrust_n",
            b"\"1,2,3,4",
            b"",
            b"1,2,3",
            b"1,2,3,4,5",
            b"1,,3,4",
            b"\xff,2,3,4",
            b"1,2,3,4 N",
            b"1,2,3,4\r5,6,7,8",
            b"1,2,3,4",
        ];
        let (good, bad) = read(rows.join(&b'\n'));
        assert_eq!(good, [setpoint([1.0, 2.0, 3.0, 4.0], None)]);
        let expected = [
            (2, "a quote is not closed on its line"),
            (4, "3 columns where the header has 4"),
            (5, "5 columns where the header has 4"),
            (6, "pitch_nm `` is not a number"),
            (7, "not UTF-8"),
            (8, "thrust_n `4 N` is not a number"),
            (9, "7 columns where the header has 4"),
        ];
        assert_eq!(bad, expected.map(|(line, message)| (line, message.to_owned())));
    }

    #[test]
    fn headers_that_are_none() {
        let many = format!("roll_nm{}", ",roll_nm".repeat(100));
        let cases: [(&[u8], usize, &str); 8] = [
            (b"", 1, "the input is empty"),
            (b"\n\n", 2, "the input is empty"),
            (
                b"0,0,0,30\n",
                1,
                "no column roll_nm, pitch_nm, yaw_nm, thrust_n; the header is",
            ),
            (
                b"\nroll_nm,pitch_nm,thrust_n\n",
                2,
                "no column yaw_nm; the header is",
            ),
            (b"t,roll_nm,pitch_nm,yaw_nm,thrust_n", 1, "unknown column `t`"),
            (
                b"roll_nm,pitch_nm,yaw_nm,thrust_n,yaw_nm",
                1,
                "column `yaw_nm` stands twice",
            ),
            (b"\xff\xfer\0o\0l\0l\0\n\0", 1, "not UTF-8"),
            (many.as_bytes(), 1, "more than 64 columns"),
        ];
        for (text, line, message) in cases {
            let (good, bad) = read(text);
            let [(bad_line, bad_message)] = &bad[..] else {
                panic!("{bad:?}");
            };
            assert_eq!(good, []);
            assert_eq!(*bad_line, line, "{bad_message}");
            assert!(bad_message.starts_with(message), "{bad_message}");
        }
    }

    #[test]
    fn waits_only_for_what_has_not_come() {
        let mut setpoints = Setpoints::new(&b"roll_nm,pitch_nm,yaw_nm,thrust_n\n1,2,3,4\n5,6"[..]).unwrap();
        assert!(!setpoints.may_wait());
        setpoints.read().unwrap();
        assert!(setpoints.may_wait());
    }
}
