//! A failure with what reproduces it.

use std::fmt::Write as _;
use std::path::Path;
use std::{fs, io};

use super::limits::Check;
use crate::frames::zoo::Class;
use crate::request::Request;

/// What a mixer or the compiler did not hold.
#[derive(Clone, Debug)]
pub struct Failure {
    /// What was looked at.
    pub check: Check,
    /// The frame's class.
    pub class: Class,
    /// The frame's index in the zoo.
    pub index: u64,
    /// The size, to compare with the limit's.
    pub size: f64,
    /// In words.
    pub said: String,
    /// The frame's file.
    pub text: String,
    /// The requests: none, one, or two neighbours, with the same rotors out.
    pub requests: Vec<Request>,
}

impl Failure {
    /// Writes the airframe to `folder` and says what failed, with the command that shows it.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn report(&self, folder: &Path) -> io::Result<String> {
        fs::create_dir_all(folder)?;
        let file = folder.join(format!("{}.toml", self.index));
        fs::write(&file, &self.text)?;
        let Failure {
            check, class, size, ..
        } = self;
        let mut report = format!(
            "{check}: {size:.3e}, limit {:.3e}, frame {} ({class})\n  {}\n",
            check.limit().size,
            self.index,
            self.said
        );
        // Writing to a String cannot fail.
        let _ = match self.requests.first() {
            None => writeln!(report, "  cargo mixer check {}", file.display()),
            Some(first) => {
                let density = first.density.map_or("", |_| ",density_kg_m3");
                let rows: String = self.requests.iter().map(|request| row(request) + "\\n").collect();
                writeln!(
                    report,
                    "  printf 'roll_nm,pitch_nm,yaw_nm,thrust_n,voltage_v{density}\\n{rows}' | cargo mixer mix {}{}",
                    file.display(),
                    failed(first)
                )
            }
        };
        Ok(report)
    }
}

/// A row of CSV for `cargo mixer mix`.
fn row(request: &Request) -> String {
    let [roll, pitch, yaw, thrust] = request.wrench;
    let density = request
        .density
        .map_or(String::new(), |density| format!(",{density:?}"));
    format!(
        "{roll:?},{pitch:?},{yaw:?},{thrust:?},{:?}{density}",
        request.volts
    )
}

fn failed(request: &Request) -> String {
    let out = (0..64).filter(|&channel| request.health.has_failed(channel));
    let out: Vec<String> = out.map(|channel| channel.to_string()).collect();
    if out.is_empty() {
        String::new()
    } else {
        format!(" --failed {}", out.join(","))
    }
}
