//! What a mix costs on the target: instructions, counted one by one by the `counts` image of
//! `tests/firmware`, and bytes of code, tables and stack.
//!
//! `tests/counts.csv` holds a [`Row`] per [`Subject`]. It is written by `cargo xtask counts
//! --bless` only, and begins with the compiler that built the firmware: another one gives other
//! counts.

use std::fmt;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::path::PathBuf;
use std::process::ExitCode;

use cargo_mixer::library::LibraryArgs;

use crate::firmware::{TARGET, Toolchain, Variant};
use crate::image::Image;
use crate::root;

/// [`Subject::mixer`] that is called from C.
const C_INTERFACE: &str = "c-interface";
/// [`Subject::mixer`] with rotors out.
const ONE_OUT: &str = "one-rotor-out";
const TWO_OUT: &str = "two-rotors-out";

/// A mixer of an airframe.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Subject {
    /// `coaxial`; the same as a library for C: `c-interface`; with one or two rotors out, at random
    /// channels: `one-rotor-out`, `two-rotors-out`; or a baseline: `conventional`, `sequential`,
    /// `wls`.
    pub mixer: String,
    /// A file of `airframes/`, or one of `tests/src/frames/counted.rs`.
    pub airframe: String,
}

impl Subject {
    fn new(mixer: &str, airframe: &str) -> Self {
        Subject {
            mixer: mixer.to_owned(),
            airframe: airframe.to_owned(),
        }
    }

    /// How many rotors are out.
    pub fn rotors_out(&self) -> u32 {
        match self.mixer.as_str() {
            ONE_OUT => 1,
            TWO_OUT => 2,
            _ => 0,
        }
    }

    /// True for this project's mixer, called from Rust.
    pub fn is_ours(&self) -> bool {
        self.mixer == "coaxial" || self.rotors_out() > 0
    }

    fn variant(&self) -> Variant {
        let rotors_out = self.rotors_out();
        let mut variant = Variant::of_airframe(&self.airframe, rotors_out);
        if rotors_out == 0 && self.mixer != "coaxial" {
            variant
                .cfgs
                .extend(["baseline".into(), format!("baseline={:?}", self.mixer)]);
        }
        if self.mixer == "wls" {
            variant.features.push("wls-alloc");
        }
        variant
    }
}

/// The subjects that every run of the tests compares: all airframes, and on the X8 the mixers of
/// isolated rotors, one rotor out, and the library for C.
pub fn compared(airframes: &[String]) -> Vec<Subject> {
    let airframes = airframes.iter().map(|airframe| Subject::new("coaxial", airframe));
    let others =
        ["conventional", "sequential", ONE_OUT, C_INTERFACE].map(|mixer| Subject::new(mixer, "isae-x8"));
    airframes.chain(others).collect()
}

/// All subjects: those compared, two rotors out, the baselines and rotors out on other frames,
/// regular frames of 1 to 8 units, the X8 with five tolerances and with other priorities, a Y6 and
/// an X8 whose attainable sets are not convex, and Y6s with the pairs of the X8s.
pub fn all(airframes: &[String]) -> Vec<Subject> {
    let mut subjects = compared(airframes);
    subjects.push(Subject::new("wls", "isae-x8"));
    for airframe in ["px4-y6", "px4-x12"] {
        subjects.extend(["conventional", "sequential", "wls"].map(|mixer| Subject::new(mixer, airframe)));
    }
    subjects.push(Subject::new(TWO_OUT, "isae-x8"));
    for airframe in [
        "px4-y6",
        "px4-x12",
        "x8-22in-cubic",
        "regular-8",
        "tilted-6",
        "tilted-8",
    ] {
        subjects.extend([ONE_OUT, TWO_OUT].map(|mixer| Subject::new(mixer, airframe)));
    }
    subjects.extend((1..=8).map(|units| Subject::new("coaxial", &format!("regular-{units}"))));
    let tolerances = ["0.1", "0.01", "0.004", "2e-4", "3e-5"];
    subjects.extend(tolerances.map(|tolerance| Subject::new("coaxial", &format!("tolerance-{tolerance}"))));
    let priorities = ["roll-pitch-yaw", "reserve-0.1", "roll-pitch-yaw-reserve-0.1"];
    let others = priorities
        .into_iter()
        .chain(["bent-3", "bent-4", "tilted-4", "tilted-6", "tilted-8"]);
    subjects.extend(others.map(|airframe| Subject::new("coaxial", airframe)));
    let pairs = airframes.iter().filter_map(|name| name.strip_prefix("x8-"));
    subjects.extend(pairs.map(|pair| Subject::new("coaxial", &format!("y6-{pair}"))));
    subjects
}

/// What one subject costs. Instructions of all requests of a set (`_sum`), of its middle
/// one (`_median`) and of its most expensive (`_worst`), bytes.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Whose cost.
    pub subject: Subject,
    /// Name and value, in the order of [`COLUMNS`].
    pub values: [u64; COLUMNS.len()],
}

/// Names of a [`Row`]'s values. `attainable` and `saturated` are sets of as many `requests` each,
/// drawn by `mixer_setpoints::Requests`; `searched` is what a search for the most expensive request
/// found.
pub const COLUMNS: [&str; 10] = [
    "code_b",
    "tables_b",
    "stack_b",
    "requests",
    "attainable_sum",
    "attainable_median",
    "attainable_worst",
    "saturated_sum",
    "saturated_worst",
    "searched_worst",
];

impl Row {
    /// Builds and runs one subject. `empty` is the `size` image without a mixer.
    ///
    /// # Errors
    /// As [`Toolchain::run`], or if an image prints something else.
    pub fn measure(toolchain: &Toolchain, subject: &Subject, empty: &Image) -> Result<Row, String> {
        let mut variant = subject.variant();
        if subject.mixer == C_INTERFACE {
            variant.library = Some(library(toolchain, &subject.airframe)?);
        }
        let size = Image::read(&toolchain.build("size", &variant)?)?;
        let text = toolchain.run("counts", &variant)?;
        let counts: Option<Vec<Count>> = text.lines().map(Count::parse).collect();
        let fault = || format!("{subject:?}: not counts:\n{text}");
        let counts = counts.ok_or_else(fault)?;
        let set = |name: &str| counts.iter().find(|count| count.set == name).ok_or_else(fault);
        let (attainable, saturated, searched) = (set("attainable")?, set("saturated")?, set("searched")?);
        Ok(Row {
            subject: subject.clone(),
            values: [
                size.code - empty.code,
                size.tables - empty.tables,
                counts.iter().map(|count| count.stack).max().unwrap_or(0),
                attainable.requests,
                attainable.sum,
                attainable.median,
                attainable.worst,
                saturated.sum,
                saturated.worst,
                searched.worst,
            ],
        })
    }

    /// The value of a column.
    pub fn get(&self, column: &str) -> u64 {
        let index = COLUMNS.iter().position(|name| *name == column);
        index.map_or(0, |index| self.values[index])
    }

    /// Mean over the set `attainable` or `saturated`.
    pub fn mean(&self, set: &str) -> f64 {
        self.get(&format!("{set}_sum")) as f64 / self.get("requests") as f64
    }

    /// The most instructions of any request of any set.
    pub fn worst(&self) -> u64 {
        let sets = ["attainable_worst", "saturated_worst", "searched_worst"];
        sets.into_iter().map(|set| self.get(set)).max().unwrap_or(0)
    }

    fn parse(line: &str) -> Option<Row> {
        let cells: Vec<&str> = line.split(',').collect();
        let [mixer, airframe, values @ ..] = &cells[..] else {
            return None;
        };
        let values: Vec<u64> = values
            .iter()
            .map(|cell| cell.parse().ok())
            .collect::<Option<_>>()?;
        Some(Row {
            subject: Subject::new(mixer, airframe),
            values: values.try_into().ok()?,
        })
    }
}

/// One line of CSV.
impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let values = self.values.map(|value| value.to_string()).join(",");
        write!(f, "{},{},{values}", self.subject.mixer, self.subject.airframe)
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
        let [set, requests, sum, median, worst, stack, _dearest] = cells[..] else {
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
    let made = toolchain.scratch("c-interface")?;
    let args = LibraryArgs::for_target(path, TARGET, made.clone());
    if cargo_mixer::library::run(&args) != ExitCode::SUCCESS {
        return Err(format!("no library of {airframe} for {TARGET}: see above"));
    }
    // Cargo does not see that a library has changed, but that it has another path.
    let name = format!("lib{module}.a");
    let fault = |error: std::io::Error| format!("{name}: {error}");
    let bytes = std::fs::read(made.join(&name)).map_err(fault)?;
    let mut hasher = DefaultHasher::new();
    bytes.hash(&mut hasher);
    let folder = toolchain.scratch(&format!("c-interface-{:016x}", hasher.finish()))?;
    std::fs::write(folder.join(&name), bytes).map_err(fault)?;
    Ok((folder, module))
}

/// The file of the counts.
pub fn file() -> PathBuf {
    root().join("tests/counts.csv")
}

/// The text of the file: the compiler, the header, the rows.
pub fn text(compiler: &str, rows: &[Row]) -> String {
    let rows: String = rows.iter().map(|row| format!("{row}\n")).collect();
    format!("# {compiler}\nmixer,airframe,{}\n{rows}", COLUMNS.join(","))
}

/// The compiler and the rows of the file.
///
/// # Errors
/// If it cannot be read or is not what [`text`] writes.
pub fn held() -> Result<(String, Vec<Row>), String> {
    let path = file();
    let fault = |what: &str| format!("{}: {what}", path.display());
    let text = std::fs::read_to_string(&path).map_err(|e| fault(&e.to_string()))?;
    let mut lines = text.lines();
    let compiler = lines.next().and_then(|line| line.strip_prefix("# "));
    let header = format!("mixer,airframe,{}", COLUMNS.join(","));
    if lines.next() != Some(&header) {
        return Err(fault("not the expected header"));
    }
    let rows: Option<Vec<Row>> = lines.map(Row::parse).collect();
    match (compiler, rows) {
        (Some(compiler), Some(rows)) => Ok((compiler.to_owned(), rows)),
        _ => Err(fault("not counts")),
    }
}

/// The page of all counts.
pub fn page() -> PathBuf {
    root().join("docs/costs.md")
}

/// The text of that page.
pub fn document(compiler: &str, rows: &[Row]) -> String {
    let mut text = format!(
        "# Costs\n\nWritten by `cargo xtask counts --page` from `tests/counts.csv`. Instructions per mix on a \
         Cortex-M4F, counted in QEMU with firmware of {compiler}; bytes of code, tables and stack of an image that holds this mixer only.\n\n\
         * attainable: 2,000 wrenches that random throttles give, at random voltages\n\
         * saturated: 2,000 requests up to four times the authority, one axis alone, on and beyond the border\n\
         * worst: the most of these, and of a search for more\n\n\
         Mixers: `coaxial` is this one, `c-interface` is its library for C with a caller who copies the throttles, `one-rotor-out` and `two-rotors-out` are its `mix_with_health` with random rotors out (\"attainable\" is with all \
         rotors); `conventional` (the paper's), `sequential` (after PX4) and `wls` (the crate `wls-alloc`) take rotors as isolated. Airframes are files of `airframes/`, \
         `y6-*` with the pairs of the `x8-*`, and frames of `tests/src/frames/counted.rs`.\n\n\
         | mixer | airframe | attainable, mean | saturated, mean | worst | code | tables | stack |\n\
         |---|---|---:|---:|---:|---:|---:|---:|\n"
    );
    for row in rows {
        text.push_str(&format!(
            "| {} | {} | {:.0} | {:.0} | {} | {} | {} | {} |\n",
            row.subject.mixer,
            row.subject.airframe,
            row.mean("attainable"),
            row.mean("saturated"),
            row.worst(),
            row.get("code_b"),
            row.get("tables_b"),
            row.get("stack_b"),
        ));
    }
    text
}
