//! The images of one subject, built and run.

use std::fs;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::path::PathBuf;

use mixer_compiler::Source;
use mixer_files::library::{Airframe, Options};

use super::Row;
use super::subject::{C_INTERFACE, Subject};
use super::worst::{self, Request};
use crate::firmware::{TARGET, Toolchain};
use crate::image::Image;
use crate::root;

/// Most requests of a subject that are kept of a search.
const KEPT: usize = 4;

/// The images of one subject.
pub struct Images<'a> {
    toolchain: &'a Toolchain,
    subject: &'a Subject,
    counts: PathBuf,
    size: Image,
}

impl<'a> Images<'a> {
    /// Builds them.
    ///
    /// # Errors
    /// As [`Toolchain::build`].
    pub fn build(toolchain: &'a Toolchain, subject: &'a Subject) -> Result<Self, String> {
        let mut variant = subject.variant();
        if subject.mixer == C_INTERFACE {
            variant.library = Some(library(toolchain, &subject.airframe)?);
        }
        Ok(Images {
            toolchain,
            subject,
            counts: toolchain.build("counts", &variant)?,
            size: Image::read(&toolchain.build("size", &variant)?)?,
        })
    }

    /// Counts the sets of requests and `given`. `empty` is the `size` image without a mixer.
    ///
    /// # Errors
    /// If the image fails, or prints something else.
    pub fn measure(&self, empty: &Image, given: &[Request]) -> Result<Row, String> {
        let text = self.toolchain.order(&self.counts, &worst::order(0, given))?;
        let counts: Option<Vec<Count>> = text.lines().map(Count::parse).collect();
        let fault = || format!("{:?}: not counts:\n{text}", self.subject);
        let counts = counts.ok_or_else(fault)?;
        let set = |name: &str| counts.iter().find(|count| count.set == name).ok_or_else(fault);
        let (attainable, saturated, given) = (set("attainable")?, set("saturated")?, set("given")?);
        Ok(Row {
            subject: self.subject.clone(),
            values: [
                self.size.code - empty.code,
                self.size.tables - empty.tables,
                counts.iter().map(|count| count.stack).max().unwrap_or(0),
                attainable.requests,
                attainable.sum,
                attainable.median,
                attainable.worst,
                saturated.sum,
                saturated.worst,
                attainable.worst.max(saturated.worst).max(given.worst),
            ],
        })
    }

    /// Searches for the most expensive requests, from the sets and from `start`, and returns up to
    /// four with what they cost, the most expensive first. What an image has found before from
    /// the same start is not searched again.
    ///
    /// # Errors
    /// If the image fails, or prints something else.
    pub fn search(&self, start: &[Request]) -> Result<Vec<(u64, Request)>, String> {
        let order = worst::order(worst::BUDGET, start);
        let fault = |error: std::io::Error| format!("{}: {error}", self.counts.display());
        let mut hasher = DefaultHasher::new();
        (fs::read(&self.counts).map_err(fault)?, &order).hash(&mut hasher);
        let known = self
            .toolchain
            .scratch("found")?
            .join(format!("{:016x}", hasher.finish()));
        let text = match fs::read_to_string(&known) {
            Ok(text) => text,
            Err(_) => {
                let text = self.toolchain.order(&self.counts, &order)?;
                // In one step: a run may be stopped at any time.
                let written = known.with_extension("new");
                fs::write(&written, &text)
                    .and_then(|()| fs::rename(&written, &known))
                    .map_err(fault)?;
                text
            }
        };
        let found = text.lines().map(|line| {
            let (cost, request) = line.split_once(' ')?;
            Some((cost.parse().ok()?, Request::parse(request)?))
        });
        let mut found: Vec<(u64, Request)> = found
            .collect::<Option<_>>()
            .ok_or_else(|| format!("{:?}: not requests:\n{text}", self.subject))?;
        found.sort_by_key(|(cost, _)| std::cmp::Reverse(*cost));
        found.dedup_by_key(|(cost, _)| *cost);
        found.truncate(KEPT);
        Ok(found)
    }
}

/// What one set of requests costs, as the image prints it.
struct Count {
    set: String,
    requests: u64,
    sum: u64,
    median: u64,
    worst: u64,
    stack: u64,
}

impl Count {
    fn parse(line: &str) -> Option<Count> {
        let cells: Vec<&str> = line.split_whitespace().collect();
        let [set, requests, sum, median, worst, stack] = cells[..] else {
            return None;
        };
        Some(Count {
            set: set.to_owned(),
            requests: requests.parse().ok()?,
            sum: sum.parse().ok()?,
            median: median.parse().ok()?,
            worst: worst.parse().ok()?,
            stack: stack.parse().ok()?,
        })
    }
}

/// The library of an airframe of `airframes/` for C, made anew: its folder and its module.
fn library(toolchain: &Toolchain, airframe: &str) -> Result<(PathBuf, String), String> {
    let path = root().join("airframes").join(format!("{airframe}.toml"));
    let module = airframe.replace('-', "_");
    let fault = |error: std::io::Error| format!("{airframe}: {error}");
    let text = fs::read_to_string(&path).map_err(fault)?;
    let compiled = Airframe::new(&Source::new(airframe, text)).map_err(|faults| faults.to_string())?;
    let options = Options {
        target: Some(TARGET),
        health: false,
        dynamic: false,
    };
    let files = mixer_files::library::library(&[compiled], &options, |note| eprintln!("{note}"))
        .map_err(|error| error.to_string())?;
    let name = format!("lib{module}.a");
    let archive = files.into_iter().find(|file| file.name == name);
    let bytes = archive.map(|file| file.bytes).unwrap_or_default();
    // Cargo does not see that a library has changed, but that it has another path.
    let mut hasher = DefaultHasher::new();
    bytes.hash(&mut hasher);
    let folder = toolchain.scratch(&format!("c-interface-{:016x}", hasher.finish()))?;
    std::fs::write(folder.join(&name), bytes).map_err(fault)?;
    Ok((folder, module))
}
