//! Files that were meant for something else, by their content.

/// The beginning of a zip archive, which documents of offices are, too.
const ARCHIVE: &[u8] = b"PK\x03\x04";

/// Names in such an archive, and what it is.
const DOCUMENTS: [(&[u8], &str); 4] = [
    (b"xl/", "a workbook (.xlsx, .ods)"),
    (b"opendocument.spreadsheet", "a workbook (.xlsx, .ods)"),
    (b"word/", "a text document (.docx, .odt)"),
    (b"opendocument.text", "a text document (.docx, .odt)"),
];

/// Beginnings of files, and what these are.
const BEGINNINGS: [(&[u8], &str); 12] = [
    (ARCHIVE, "a packed file (unpack it first)"),
    (b"\xd0\xcf\x11\xe0", "a workbook (.xls)"),
    (b"%PDF", "a PDF document"),
    (b"{", "JSON"),
    (b"[{", "JSON"),
    (b"<", "a page of HTML or XML"),
    (b"ULog", "a flight log, which cargo mixer review reads"),
    (b"\xa3\x95", "a flight log, which cargo mixer review reads"),
    (
        b"FMT,",
        "ArduPilot's flight log as text: give the .bin file that it was made of",
    ),
    (
        b"H Product:Blackbox",
        "a log of Betaflight's blackbox, which no command reads",
    ),
    (b"\xfd7zXZ", "a packed file (unpack it first)"),
    (b"\x1f\x8b", "a packed file (unpack it first)"),
];

/// Beginnings of scripts.
const SCRIPTS: [&str; 5] = ["#!", "--", "import ", "from ", "local "];

/// What a text is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// An airframe file, whole or not.
    Airframe,
    /// The model of a pair without a vehicle.
    Pair,
    /// Parameters or a start script of PX4.
    Px4,
    /// Parameters of ArduPilot.
    Ardupilot,
    /// `diff all` or `dump` of Betaflight or INAV.
    Betaflight,
    /// A table, as of a bench.
    Table,
    /// A file of another program, and which.
    Foreign(&'static str),
    /// None of them.
    Other,
}

impl Content {
    /// What it is and who reads it, for a message that refuses it.
    #[must_use]
    pub fn description(self) -> &'static str {
        match self {
            Content::Airframe => "an airframe file, which cargo mixer check reads",
            Content::Pair => "the model of a pair, which cargo mixer new --pair reads",
            Content::Px4 => "a parameter file of PX4, which cargo mixer import reads",
            Content::Ardupilot => "a parameter file of ArduPilot, which cargo mixer import reads",
            Content::Betaflight => "a dump of Betaflight or INAV, which cargo mixer import reads",
            Content::Table => {
                "a table: cargo mixer identify reads the bench file of a pair, cargo mixer predict the run of one rotor"
            }
            Content::Foreign(what) => what,
            Content::Other => "a text of another kind",
        }
    }
}

/// Tables of an airframe file.
const TABLES: [&str; 9] = [
    "throttle",
    "pair",
    "voltage",
    "air",
    "layout",
    "unit",
    "inverse",
    "allocation",
    "vehicle",
];

/// How names of parameters begin that the stacks do not share.
const OF_PX4: [&str; 7] = ["CA_", "MC_", "MPC_", "PWM_MAIN_", "PWM_AUX_", "COM_", "SYS_AUTO"];
const OF_ARDUPILOT: [&str; 7] = ["FRAME_", "Q_", "MOT_", "ATC_", "SERVO", "ARMING_", "PSC_"];

/// The kind of a file that is neither a table of text nor TOML, by its beginning; `None` where that does not tell.
#[must_use]
pub fn foreign(bytes: &[u8]) -> Option<&'static str> {
    let bytes = bytes.trim_ascii_start();
    let holds = |name: &[u8]| bytes.windows(name.len()).any(|part| part == name);
    let document = DOCUMENTS
        .iter()
        .find(|(name, _)| bytes.starts_with(ARCHIVE) && holds(name));
    let known = document.or_else(|| BEGINNINGS.iter().find(|(begin, _)| bytes.starts_with(begin)));
    known.map(|(_, what)| *what)
}

/// The kind of a text by its words. Of what several kinds could be the first counts, in the order of [`Content`].
#[must_use]
pub fn of(text: &str) -> Content {
    if let Some(what) = foreign(text.as_bytes()) {
        return Content::Foreign(what);
    }
    let lines = || {
        let lines = text.trim_start_matches('\u{feff}').lines();
        lines.map(|line| line.split('#').next().unwrap_or_default().trim())
    };
    let keys: Vec<&str> = lines().filter_map(key).collect();
    if !keys.is_empty() {
        let is_of_vehicle = keys.iter().any(|key| matches!(*key, "unit" | "layout"));
        return match keys.contains(&"pair") && !is_of_vehicle {
            true => Content::Pair,
            false => Content::Airframe,
        };
    }
    if text.lines().any(is_of_a_dump) {
        return Content::Betaflight;
    }
    let count = |of_stack: &[&str]| lines().filter(|line| is_parameter(line, of_stack)).count();
    match (count(&OF_PX4), count(&OF_ARDUPILOT)) {
        (0, 0) => {}
        (px4, ardupilot) if px4 >= ardupilot => return Content::Px4,
        _ => return Content::Ardupilot,
    }
    if SCRIPTS.iter().any(|begin| text.starts_with(begin)) {
        return Content::Foreign("a script, of which cargo mixer import reads PX4's `param set` alone");
    }
    let first = lines().find(|line| !line.is_empty()).unwrap_or_default();
    match first.contains([',', ';', '\t']) {
        true => Content::Table,
        false => Content::Other,
    }
}

/// The key of an airframe's table in the table's header, or in a line that gives it, or its name, a value of TOML.
fn key(line: &str) -> Option<&str> {
    let header = line.strip_prefix('[').and_then(|line| line.strip_suffix(']'));
    let path = match header {
        Some(header) => header.trim_start_matches('[').trim_end_matches(']'),
        None => {
            let (path, value) = line.split_once('=')?;
            let is_toml = value
                .trim_start()
                .starts_with(['"', '\'', '{', '[', '\u{201c}', '\u{201d}']);
            is_toml.then_some(path)?
        }
    };
    let first = path.split('.').next()?.trim();
    (TABLES.contains(&first) || (header.is_none() && first == "name")).then_some(first)
}

/// Whether a line is one that Betaflight's and INAV's `diff all` and `dump` have, and no file of parameters.
/// Older scripts of PX4 have `mixer load`.
fn is_of_a_dump(line: &str) -> bool {
    let mut words = line.split_whitespace();
    match (words.next(), words.next(), words.next()) {
        (Some("mmix" | "board_name" | "mixer_profile" | "feature"), Some(_), _) => true,
        (Some("mixer"), Some(name), _) => name != "load",
        (Some("batch"), Some("start"), None) => true,
        (Some("#"), Some("Betaflight" | "Cleanflight"), Some("/")) => true,
        (Some("#"), Some(head), _) => ["Betaflight/", "Cleanflight/", "INAV/"]
            .iter()
            .any(|of| head.starts_with(of)),
        _ => false,
    }
}

/// Whether a line gives a parameter that begins like these a value: `NAME VALUE`, a script's `param set NAME VALUE`,
/// or QGroundControl's line.
fn is_parameter(line: &str, beginnings: &[&str]) -> bool {
    let separated = |c: char| c.is_whitespace() || matches!(c, ',' | '=' | '"' | '\'');
    let words: Vec<&str> = line.split(separated).filter(|word| !word.is_empty()).collect();
    let is_of_stack = |name: &str| beginnings.iter().any(|begin| name.starts_with(begin));
    let is_value = |word: &str| word.starts_with('$') || word.parse::<f64>().is_ok();
    words
        .windows(2)
        .any(|pair| is_of_stack(pair[0]) && is_value(pair[1]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_told_by_their_words() {
        for (text, kind) in [
            (
                "name = \"x8\"\n[throttle]\nmin = 0.1\n[[unit]]\n",
                Content::Airframe,
            ),
            (
                "\u{feff}# mine\r\n[layout]\r\narm_m = 0,45\r\n[pair]\r\n",
                Content::Airframe,
            ),
            ("name = \u{201c}x8\u{201d}\n", Content::Airframe),
            ("[throttle]\nmin = 0.2\n\n[pair]\n", Content::Pair),
            ("[[pair]]\nname = \"front\"\n", Content::Pair),
            ("pair.basis = \"cubic\"\n", Content::Pair),
            (
                "# Vehicle-Id Component-Id Name Value Type\n1\t1\tCA_ROTOR_COUNT\t8\t6\n",
                Content::Px4,
            ),
            ("CA_ROTOR0_PX = 0.35   # was 1\n", Content::Px4),
            (
                "#!/bin/sh\nmixer load a b\nparam set-default -s CA_ROTOR0_PX $ARM\n",
                Content::Px4,
            ),
            ("FRAME_CLASS,4\nFRAME_TYPE,1\n", Content::Ardupilot),
            ("MOT_SPIN_MIN     0.15 @READONLY\n", Content::Ardupilot),
            (
                "# reset configuration to default settings\ndefaults nosave\n\nmixer OCTOX8\n",
                Content::Betaflight,
            ),
            (
                "# Betaflight / STM32F7X2 (S7X2) 4.5.1\nset gyro_lpf1_static_hz = 0\n",
                Content::Betaflight,
            ),
            (
                "# INAV/MATEKF765 7.1.2\nset platform_type = AIRPLANE\n",
                Content::Betaflight,
            ),
            ("batch start\nboard_name X\n", Content::Betaflight),
            ("upper,lower,thrust_n\n0.3,0.4,5\n", Content::Table),
            // What a bench notes above its table.
            ("name = My prop\nbatch,thrust\n1;2\n", Content::Other),
            ("feature,thrust\n1,2\n", Content::Table),
            ("SERVO output (us),Thrust (gf)\n1100,5\n", Content::Table),
            (
                "ULog\u{1}",
                Content::Foreign("a flight log, which cargo mixer review reads"),
            ),
            ("these are mine\n", Content::Other),
            ("", Content::Other),
        ] {
            assert_eq!(of(text), kind, "{text}");
        }
    }
}
