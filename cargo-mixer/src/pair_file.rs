//! A file with the model of a pair: what `identify` and `predict` write, or a whole airframe's.

use std::path::Path;

use mixer_identify::fragment;
use toml::Table;

/// Tables that describe the pair; the others of an airframe describe its vehicle.
const OF_A_PAIR: [&str; 3] = ["throttle", "pair", "voltage"];

/// The model of a pair, as text.
#[derive(Debug)]
pub(crate) struct PairFile {
    /// All of the file.
    pub(crate) table: Table,
    text: String,
}

impl PairFile {
    /// Reads a file.
    ///
    /// # Errors
    /// A file that cannot be read, is no TOML, or has no `[pair]`.
    pub(crate) fn read(path: &Path) -> Result<PairFile, String> {
        let text = crate::file::read_text(path)?;
        let name = path.display();
        let table: Table = text.parse().map_err(|error| format!("{name}: {error}"))?;
        if !table.contains_key("pair") {
            return Err(format!(
                "{name}: no [pair] in it; `cargo mixer identify BENCH.csv -o pair.toml` writes one"
            ));
        }
        Ok(PairFile { table, text })
    }

    /// The tables of these names, as they stand there with their comments.
    pub(crate) fn tables(&self, names: &[&str]) -> String {
        sections(&self.text, false, names)
    }

    /// `[throttle]`, `[pair]` and `[voltage]`, and the torque of least power, N m per N. Of a pair's
    /// own file with what is told above the tables; an airframe's bias was chosen for its vehicle.
    pub(crate) fn model(&self) -> (String, Option<f64>) {
        if self.table.contains_key("unit") || self.table.contains_key("layout") {
            return (self.tables(&OF_A_PAIR), None);
        }
        let (text, bias) = fragment::of_text(&self.text);
        (sections(&text, true, &OF_A_PAIR), bias)
    }
}

/// The tables of these names, and what is above the first table where it is wished.
fn sections(text: &str, head: bool, names: &[&str]) -> String {
    let mut out = String::new();
    let mut taken = head;
    for line in text.lines() {
        if let Some(header) = header(line) {
            let root = header.split('.').next().unwrap_or_default().trim();
            taken = names.contains(&root);
        }
        if taken {
            out += line;
            out.push('\n');
        }
    }
    let text = out.trim_end();
    format!("{text}\n\n")
}

/// Name of the table that begins in this line.
fn header(line: &str) -> Option<&str> {
    let line = line.trim_start();
    let inner = line.strip_prefix("[[").or_else(|| line.strip_prefix('['))?;
    let (name, _) = inner.split_once(']')?;
    let bare = |c: char| c.is_ascii_alphanumeric() || "_-. ".contains(c);
    (name.starts_with(|c: char| c.is_ascii_alphabetic()) && name.chars().all(bare)).then_some(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_taken_with_their_comments() {
        let text = "# top\nname = \"a\"\n[throttle]\nmin = 0.1\n[pair] # bench\nthrust_n = [\n  [1.0, 2.0],\n]\n\
                    [pair.lower_out]\nx = 1\n[[unit]]\nposition_m = 1\n[voltage]\nv = 1\n";
        let pair =
            "[pair] # bench\nthrust_n = [\n  [1.0, 2.0],\n]\n[pair.lower_out]\nx = 1\n[voltage]\nv = 1\n\n";
        assert_eq!(sections(text, false, &["pair", "voltage"]), pair);
        let with_head = format!("# top\nname = \"a\"\n[throttle]\nmin = 0.1\n{pair}");
        assert_eq!(sections(text, true, &OF_A_PAIR), with_head);
    }
}
