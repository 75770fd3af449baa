//! Setpoints as CSV: a header `roll_nm,pitch_nm,yaw_nm,thrust_n[,voltage_v][,density_kg_m3]` in any
//! order, then one row per line.
//!
//! A row never spans lines, although CSV allows it in quotes: so a stray quote spoils its own row
//! and not all rows after it.

use std::io::{self, Read};

use csv::{ByteRecord, ReaderBuilder, Terminator};
use mixer_rt::Wrench;

/// The columns that must be there, in the order of [`Wrench::to_array`].
const REQUIRED: [&str; 4] = ["roll_nm", "pitch_nm", "yaw_nm", "thrust_n"];
const VOLTAGE: &str = "voltage_v";
const DENSITY: &str = "density_kg_m3";
pub(crate) const HEADER: &str = "roll_nm,pitch_nm,yaw_nm,thrust_n[,voltage_v][,density_kg_m3]";

/// One row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setpoint {
    /// What is asked for.
    pub wrench: Wrench,
    /// The battery's voltage, V, if there is such a column.
    pub voltage_v: Option<f32>,
    /// The air's density, kg/m3, if there is such a column.
    pub density_kg_m3: Option<f32>,
}

/// A line that is no setpoint.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BadLine {
    /// Line of the input, from 1.
    pub line: usize,
    /// What is wrong with it.
    pub message: String,
}

/// Why reading and mixing ended before the input did.
#[derive(Debug)]
pub enum Stopped {
    /// The first line is not the header.
    Header(BadLine),
    /// The input cannot be read.
    Input(io::Error),
    /// The output failed.
    Output(io::Error),
}

/// A row with its line, from 1.
pub type Row = (usize, Result<Setpoint, BadLine>);

/// Reads setpoints row by row.
#[derive(Debug)]
pub struct Setpoints<R> {
    rows: Rows<R>,
    columns: Columns,
}

impl<R: Read> Setpoints<R> {
    /// Reads the header.
    ///
    /// # Errors
    /// An input without one, a column that is missing, unknown or stands twice, or an input that
    /// fails.
    pub fn new(input: R) -> Result<Self, Stopped> {
        let mut rows = Rows::new(input);
        let columns = match rows.next().map_err(Stopped::Input)? {
            Some((_, row)) => fields(row).and_then(|fields| Columns::new(&fields)),
            None => Err(format!(
                "the input is empty; its first line is the header {HEADER}"
            )),
        };
        match columns {
            Ok(columns) => Ok(Self { rows, columns }),
            Err(message) => Err(Stopped::Header(BadLine {
                line: rows.line(),
                message,
            })),
        }
    }

    /// The next row and its line, or `None` at the end. Blank lines are passed over.
    ///
    /// # Errors
    /// An input that cannot be read any further.
    pub fn read(&mut self) -> Result<Option<Row>, Stopped> {
        let Some((line, row)) = self.rows.next().map_err(Stopped::Input)? else {
            return Ok(None);
        };
        let row = fields(row).and_then(|fields| self.columns.read(&fields));
        Ok(Some((line, row.map_err(|message| BadLine { line, message }))))
    }
}

/// Rows that are not blank.
#[derive(Debug)]
struct Rows<R> {
    reader: csv::Reader<io::Chain<Lines<R>, &'static [u8]>>,
    row: ByteRecord,
}

impl<R: Read> Rows<R> {
    fn new(input: R) -> Self {
        // A line feed alone ends a row: a carriage return within a line would hide what follows it.
        // The last row has one, too.
        let mut settings = ReaderBuilder::new();
        settings.has_headers(false).flexible(true).quoting(false);
        settings.terminator(Terminator::Any(b'\n'));
        Rows {
            reader: settings.from_reader(Lines { input, length: 0 }.chain(b"\n")),
            row: ByteRecord::new(),
        }
    }

    /// The next row and its line.
    fn next(&mut self) -> io::Result<Option<(usize, &ByteRecord)>> {
        let is_blank = |row: &ByteRecord| String::from_utf8_lossy(row.as_slice()).trim().is_empty();
        while self.reader.read_byte_record(&mut self.row)? {
            if self.row.len() > 1 || !is_blank(&self.row) {
                return Ok(Some((self.line(), &self.row)));
            }
        }
        Ok(None)
    }

    /// The line of the last row.
    fn line(&self) -> usize {
        let next = self.reader.position().line();
        usize::try_from(next.saturating_sub(1).max(1)).unwrap_or(usize::MAX)
    }
}

/// The fields of a row, without quotes and the blanks around them.
fn fields(row: &ByteRecord) -> Result<Vec<&str>, String> {
    let field = |field| {
        let text = str::from_utf8(field).map_err(|_| "not UTF-8".to_owned())?.trim();
        let inner = text.strip_prefix('"').and_then(|text| text.strip_suffix('"'));
        Ok(inner.map_or(text, str::trim))
    };
    row.iter().map(field).collect()
}

/// Longest line, bytes: six numbers take a hundred. A device without an end would fill the memory.
const LONGEST_LINE: usize = 1 << 16;

/// An input whose lines end.
#[derive(Debug)]
struct Lines<R> {
    input: R,
    /// Bytes of the last line so far.
    length: usize,
}

impl<R: Read> Read for Lines<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.input.read(buffer)?;
        let read = buffer.get(..count).unwrap_or_default();
        self.length = match read.iter().rposition(|byte| *byte == b'\n') {
            Some(end) => count - end,
            None => self.length + count,
        };
        if self.length > LONGEST_LINE {
            return Err(io::Error::other(format!(
                "a line has more than {LONGEST_LINE} bytes: setpoints are lines of numbers below {HEADER}"
            )));
        }
        Ok(count)
    }
}

/// Where the columns stand.
#[derive(Debug)]
struct Columns {
    count: usize,
    wrench: [usize; 4],
    voltage: Option<usize>,
    density: Option<usize>,
}

impl Columns {
    fn new(header: &[&str]) -> Result<Self, String> {
        let place = |name: &str| header.iter().position(|column| *column == name);
        let known = |name: &str| REQUIRED.contains(&name) || [VOLTAGE, DENSITY].contains(&name);
        let missing = REQUIRED.into_iter().filter(|name| place(name).is_none());
        let missing = missing.collect::<Vec<_>>().join(", ");
        if !missing.is_empty() {
            return Err(format!("no column {missing}; the header is {HEADER}"));
        }
        if let Some(unknown) = header.iter().find(|name| !known(name)) {
            let unknown = unknown.escape_debug();
            return Err(format!("unknown column `{unknown}`; the header is {HEADER}"));
        }
        let mut columns = header.iter().enumerate();
        if let Some((_, name)) = columns.find(|(i, name)| place(name) != Some(*i)) {
            return Err(format!("column `{name}` stands twice"));
        }
        Ok(Columns {
            count: header.len(),
            wrench: REQUIRED.map(|name| place(name).unwrap_or_default()),
            voltage: place(VOLTAGE),
            density: place(DENSITY),
        })
    }

    fn read(&self, fields: &[&str]) -> Result<Setpoint, String> {
        let (count, expected) = (fields.len(), self.count);
        if count != expected {
            let columns = if count == 1 { "column" } else { "columns" };
            return Err(format!("{count} {columns} where the header has {expected}"));
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
            density_kg_m3: self.density.map(|index| number(index, DENSITY)).transpose()?,
        })
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
            Err(Stopped::Header(BadLine { line, message })) => return (good, vec![(line, message)]),
            Err(stopped) => panic!("{stopped:?}"),
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
            density_kg_m3: None,
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
        let fault = |text: String| {
            let read = Setpoints::new(text.as_bytes()).and_then(|mut setpoints| setpoints.read());
            match read.unwrap_err() {
                Stopped::Input(error) => error.to_string(),
                other => panic!("{other:?}"),
            }
        };
        let long = "0".repeat(LONGEST_LINE + 1);
        assert!(fault(long.clone()).starts_with("a line has more than 65536 bytes"));
        assert!(fault(format!("roll_nm,pitch_nm,yaw_nm,thrust_n\n{long}")).starts_with("a line has"));
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
            (2, "roll_nm `\\\"1` is not a number"),
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
            (b"\n\n", 3, "the input is empty"),
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
            (many.as_bytes(), 1, "no column pitch_nm, yaw_nm, thrust_n"),
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
}
