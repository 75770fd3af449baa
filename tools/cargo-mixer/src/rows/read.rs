//! Rows as CSV: a header with the columns that a command needs and, if there are such, `voltage_v`
//! and `density_kg_m3`, in any order, then one row per line.
//!
//! A row never spans lines, although CSV allows it in quotes: so a stray quote spoils its own row
//! and not all rows after it.

use std::io::{self, Read};
use std::str::FromStr;

use csv::{ByteRecord, ReaderBuilder, Terminator};
use mixer_compiler::airframe::Airframe;

const VOLTAGE: &str = "voltage_v";
const DENSITY: &str = "density_kg_m3";

/// The header in words: the columns that must be there, and those that may.
pub(crate) fn header(required: &[String]) -> String {
    format!("{}[,{VOLTAGE}][,{DENSITY}]", required.join(","))
}

/// One row of numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Row<T> {
    /// Values of the columns that must be there, in the command's order.
    pub values: Vec<T>,
    /// The battery's voltage, V, if there is such a column.
    pub voltage_v: Option<T>,
    /// The air's density, kg/m3, if there is such a column.
    pub density_kg_m3: Option<T>,
}

/// A line that is no row.
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
pub type Line<T> = (usize, Result<Row<T>, BadLine>);

/// Reads a table row by row.
#[derive(Debug)]
pub struct Rows<R> {
    records: Records<R>,
    columns: Columns,
}

impl<R: Read> Rows<R> {
    /// Reads the header, in which the `required` columns must be.
    ///
    /// # Errors
    /// An input without one, a column that is missing, unknown or stands twice, or an input that
    /// fails.
    pub fn new(input: R, required: Vec<String>) -> Result<Self, Stopped> {
        let header = header(&required);
        let mut records = Records::new(input, header.clone());
        let columns = match records.next().map_err(Stopped::Input)? {
            Some((_, record)) => fields(record).and_then(|fields| Columns::new(&fields, required, &header)),
            None => Err(format!(
                "the input is empty; its first line is the header {header}"
            )),
        };
        match columns {
            Ok(columns) => Ok(Self { records, columns }),
            Err(message) => Err(Stopped::Header(BadLine {
                line: records.line(),
                message,
            })),
        }
    }

    /// A sentence for each column that an airframe ignores.
    pub fn ignored(&self, airframe: &Airframe) -> Vec<String> {
        let columns = [
            (
                self.columns.voltage.is_some() && airframe.voltage.is_none(),
                VOLTAGE,
                "[voltage]",
            ),
            (
                self.columns.density.is_some() && airframe.air.is_none(),
                DENSITY,
                "[air]",
            ),
        ];
        let ignored = columns.into_iter().filter(|(is_ignored, ..)| *is_ignored);
        let told = ignored
            .map(|(_, column, table)| format!("{column} is ignored: {} has no {table}", airframe.name));
        told.collect()
    }

    /// The next row and its line, or `None` at the end. Blank lines are passed over.
    ///
    /// # Errors
    /// An input that cannot be read any further.
    pub fn read<T: FromStr>(&mut self) -> Result<Option<Line<T>>, Stopped> {
        let Some((line, record)) = self.records.next().map_err(Stopped::Input)? else {
            return Ok(None);
        };
        let row = fields(record).and_then(|fields| self.columns.read(&fields));
        Ok(Some((line, row.map_err(|message| BadLine { line, message }))))
    }
}

/// Lines that are not blank.
#[derive(Debug)]
struct Records<R> {
    reader: csv::Reader<io::Chain<Lines<R>, &'static [u8]>>,
    record: ByteRecord,
}

impl<R: Read> Records<R> {
    fn new(input: R, header: String) -> Self {
        // A line feed alone ends a row: a carriage return within a line would hide what follows it.
        // The last row has one, too.
        let mut settings = ReaderBuilder::new();
        settings.has_headers(false).flexible(true).quoting(false);
        settings.terminator(Terminator::Any(b'\n'));
        let lines = Lines {
            input,
            header,
            length: 0,
        };
        Records {
            reader: settings.from_reader(lines.chain(b"\n")),
            record: ByteRecord::new(),
        }
    }

    /// The next record and its line.
    fn next(&mut self) -> io::Result<Option<(usize, &ByteRecord)>> {
        let is_blank = |record: &ByteRecord| String::from_utf8_lossy(record.as_slice()).trim().is_empty();
        while self.reader.read_byte_record(&mut self.record)? {
            if self.record.len() > 1 || !is_blank(&self.record) {
                return Ok(Some((self.line(), &self.record)));
            }
        }
        Ok(None)
    }

    /// The line of the last record.
    fn line(&self) -> usize {
        let next = self.reader.position().line();
        usize::try_from(next.saturating_sub(1).max(1)).unwrap_or(usize::MAX)
    }
}

/// The fields of a record, without quotes and the blanks around them.
fn fields(record: &ByteRecord) -> Result<Vec<&str>, String> {
    let field = |field| {
        let text = str::from_utf8(field).map_err(|_| "not UTF-8".to_owned())?.trim();
        let inner = text.strip_prefix('"').and_then(|text| text.strip_suffix('"'));
        Ok(inner.map_or(text, str::trim))
    };
    record.iter().map(field).collect()
}

/// Longest line, bytes: sixty-six numbers take two thousand. A device without an end would fill the memory.
const LONGEST_LINE: usize = 1 << 16;

/// An input whose lines end.
#[derive(Debug)]
struct Lines<R> {
    input: R,
    /// The header in words.
    header: String,
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
                "a line has more than {LONGEST_LINE} bytes: rows are lines of numbers below {}",
                self.header
            )));
        }
        Ok(count)
    }
}

/// Where the columns stand.
#[derive(Debug)]
struct Columns {
    count: usize,
    /// Names and places of those that must be there.
    required: Vec<(String, usize)>,
    voltage: Option<usize>,
    density: Option<usize>,
}

impl Columns {
    fn new(fields: &[&str], required: Vec<String>, header: &str) -> Result<Self, String> {
        let place = |name: &str| fields.iter().position(|field| *field == name);
        // `wrench` takes what `mix` writes.
        let known = |name: &str| {
            let is_answer = name.starts_with("achieved_") || name == "saturation";
            is_answer || required.iter().any(|column| column == name) || [VOLTAGE, DENSITY].contains(&name)
        };
        let missing = required.iter().filter(|name| place(name).is_none());
        let missing: Vec<&str> = missing.map(String::as_str).collect();
        if !missing.is_empty() {
            return Err(format!(
                "no column {}; the header is {header}",
                missing.join(", ")
            ));
        }
        if let Some(unknown) = fields.iter().find(|name| !known(name)) {
            let unknown = unknown.escape_debug();
            return Err(format!("unknown column `{unknown}`; the header is {header}"));
        }
        let mut columns = fields.iter().enumerate();
        if let Some((_, name)) = columns.find(|(i, name)| place(name) != Some(*i)) {
            return Err(format!("column `{name}` stands twice"));
        }
        let placed = |name: String| {
            let place = place(&name)?;
            Some((name, place))
        };
        Ok(Columns {
            count: fields.len(),
            voltage: place(VOLTAGE),
            density: place(DENSITY),
            required: required.into_iter().filter_map(placed).collect(),
        })
    }

    fn read<T: FromStr>(&self, fields: &[&str]) -> Result<Row<T>, String> {
        let (count, expected) = (fields.len(), self.count);
        if count != expected {
            let columns = if count == 1 { "column" } else { "columns" };
            return Err(format!("{count} {columns} where the header has {expected}"));
        }
        let number = |name: &str, index: usize| {
            let text = fields.get(index).copied().unwrap_or_default();
            text.parse::<T>()
                .map_err(|_| format!("{name} `{}` is not a number", text.escape_debug()))
        };
        let values = self.required.iter().map(|(name, index)| number(name, *index));
        Ok(Row {
            values: values.collect::<Result<_, _>>()?,
            voltage_v: self.voltage.map(|index| number(VOLTAGE, index)).transpose()?,
            density_kg_m3: self.density.map(|index| number(DENSITY, index)).transpose()?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reads the header of `text` as that of setpoints.
    fn rows(text: &[u8]) -> Result<Rows<&[u8]>, Stopped> {
        let required = ["roll_nm", "pitch_nm", "yaw_nm", "thrust_n"];
        Rows::new(text, required.map(str::to_owned).into())
    }

    /// The rows of `text`, and the line and message of each that is bad.
    fn read(text: impl AsRef<[u8]>) -> (Vec<Row<f32>>, Vec<(usize, String)>) {
        let (mut good, mut bad) = (Vec::new(), Vec::new());
        let mut rows = match rows(text.as_ref()) {
            Ok(rows) => rows,
            Err(Stopped::Header(BadLine { line, message })) => return (good, vec![(line, message)]),
            Err(stopped) => panic!("{stopped:?}"),
        };
        while let Some((_, row)) = rows.read().unwrap() {
            match row {
                Ok(row) => good.push(row),
                Err(BadLine { line, message }) => bad.push((line, message)),
            }
        }
        (good, bad)
    }

    fn row(values: [f32; 4], voltage_v: Option<f32>) -> Row<f32> {
        Row {
            values: values.into(),
            voltage_v,
            density_kg_m3: None,
        }
    }

    #[test]
    fn columns_in_any_order() {
        let (good, bad) = read("voltage_v,thrust_n,yaw_nm,pitch_nm,roll_nm\n15,4,3,2,1\n");
        assert_eq!(good, [row([1.0, 2.0, 3.0, 4.0], Some(15.0))]);
        assert_eq!(bad, []);
    }

    #[test]
    fn files_of_other_systems() {
        let expected = vec![row([1.0, -2.5, 3e-3, 40.0], None); 2];
        for text in [
            "roll_nm,pitch_nm,yaw_nm,thrust_n\n1,-2.5,3e-3,40\n1,-2.5,3e-3,40",
            "\u{feff}roll_nm,pitch_nm,yaw_nm,thrust_n\r\n1,-2.5,3e-3,40\r\n\u{a0}\r\n1,-2.5,3e-3,40\r\n",
            "\n \"roll_nm\" ,\"pitch_nm\",\"yaw_nm\",thrust_n \n\"1\",\" -2.5 \",3e-3,40\n\t\n+1.0, -2.5,.003,40.\n",
        ] {
            assert_eq!(read(text), (expected.clone(), vec![]), "{text:?}");
        }
    }

    #[test]
    fn a_line_without_end_is_refused() {
        let fault = |text: String| {
            let read = rows(text.as_bytes()).and_then(|mut rows| rows.read::<f32>());
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
        assert_eq!(read(padded), (vec![row([1.0, 2.0, 3.0, 4.0], None)], vec![]));
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
        assert_eq!(good, [row([1.0, 2.0, 3.0, 4.0], None)]);
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
