//! The most expensive requests that a search has found: `tests/worst.csv`.

use std::fmt;
use std::path::PathBuf;

use super::Subject;
use crate::root;

/// Instructions of mixes after which a search ends.
pub const BUDGET: u64 = 2_000_000_000;

/// First word of an order to the `counts` image, as its `order.rs` has it.
const MARK: u32 = 0x4f52_4445;

/// A request, bit by bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Request {
    /// Roll, pitch, yaw (N m), thrust (N) and the battery's voltage (V): bits of f32.
    pub values: [u32; 5],
    /// A bit per channel whose rotor is out.
    pub failed: u64,
}

impl Request {
    /// From hexadecimal numbers with commas between them.
    pub fn parse(text: &str) -> Option<Request> {
        let (values, failed) = text.rsplit_once(',')?;
        let values = values.split(',').map(|cell| u32::from_str_radix(cell, 16).ok());
        let values: Vec<u32> = values.collect::<Option<_>>()?;
        Some(Request {
            values: values.try_into().ok()?,
            failed: u64::from_str_radix(failed, 16).ok()?,
        })
    }
}

impl fmt::Display for Request {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for value in self.values {
            write!(f, "{value:08x},")?;
        }
        write!(f, "{:016x}", self.failed)
    }
}

/// What the `counts` image is to do: search for as many instructions (0: count the sets instead),
/// with the requests that are given.
pub fn order(budget: u64, given: &[Request]) -> Vec<u8> {
    let halves = |number: u64| [(number >> 32) as u32, number as u32];
    let head = [MARK]
        .into_iter()
        .chain(halves(budget))
        .chain([given.len() as u32]);
    let requests = given
        .iter()
        .flat_map(|request| request.values.into_iter().chain(halves(request.failed)));
    head.chain(requests).flat_map(u32::to_le_bytes).collect()
}

/// The file.
pub fn file() -> PathBuf {
    root().join("tests/worst.csv")
}

const HEADER: &str = "mixer,airframe,roll_nm,pitch_nm,yaw_nm,thrust_n,voltage_v,failed";

/// Requests of a subject each.
pub type Found = Vec<(Subject, Request)>;

/// The text of the file.
pub fn text(found: &Found) -> String {
    let rows = found
        .iter()
        .map(|(Subject { mixer, airframe }, request)| format!("{mixer},{airframe},{request}\n"));
    format!("{HEADER}\n{}", rows.collect::<String>())
}

/// What the file holds; nothing where there is none.
///
/// # Errors
/// If it cannot be read or is not what [`text`] writes.
pub fn held() -> Result<Found, String> {
    let path = file();
    let fault = |what: &str| format!("{}: {what}", path.display());
    let text = match std::fs::read_to_string(&path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Found::new()),
        text => text.map_err(|error| fault(&error.to_string()))?,
    };
    let (header, rows) = text.split_once('\n').unwrap_or_default();
    let row = |line: &str| {
        let [mixer, airframe, request] = line.splitn(3, ',').collect::<Vec<_>>()[..] else {
            return None;
        };
        Some((Subject::new(mixer, airframe), Request::parse(request)?))
    };
    let found: Option<Found> = rows.lines().map(row).collect();
    match found {
        Some(found) if header == HEADER => Ok(found),
        _ => Err(fault("not requests")),
    }
}

/// Those of one subject.
pub fn of(found: &Found, subject: &Subject) -> Vec<Request> {
    let of = found.iter().filter(|(of, _)| of == subject);
    of.map(|(_, request)| *request).collect()
}
