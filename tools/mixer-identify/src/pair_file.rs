//! A file with the model of a pair: what `identify` and `predict` write, or a whole airframe's.

use mixer_compiler::diagnostic::content::{self, Content};
use toml_edit::{DocumentMut, Item, Value};

use super::fragment::POWER_BIAS;

/// Tables that describe the pair; the others of an airframe describe its vehicle.
const OF_A_PAIR: [&str; 4] = ["throttle", "pair", "voltage", "air"];

/// The model of a pair, read.
#[derive(Debug, Clone)]
pub struct PairFile(DocumentMut);

impl PairFile {
    /// Reads the text of the file `name`.
    ///
    /// # Errors
    /// A text that is no TOML, has no `[pair]` or several.
    pub fn read(name: &str, text: &str) -> Result<PairFile, String> {
        let document: DocumentMut = text.parse().map_err(|error| match content::of(text) {
            Content::Airframe | Content::Pair => format!("{name}: {error}"),
            other => format!(
                "{name}: this is {}, with -o pair.toml for --pair",
                other.description()
            ),
        })?;
        if !document.contains_key("pair") {
            return Err(format!(
                "{name}: no [pair] in it; `cargo mixer identify BENCH.csv -o pair.toml` writes one"
            ));
        }
        if document
            .get("pair")
            .is_some_and(|pair| pair.as_table_like().is_none())
        {
            return Err(format!(
                "{name}: a list of `[[pair]]`, of which one is wanted: keep that one as `[pair]` in a file of its own"
            ));
        }
        Ok(PairFile(document))
    }

    /// The table of the pair under a name, as one of several.
    pub fn named(&self, name: &str) -> String {
        let mut file = self.clone();
        if let Some(pair) = file.0.get_mut("pair").and_then(Item::as_table_like_mut) {
            pair.remove("name");
        }
        file.0.set_trailing("");
        let (table, _) = file.tables(&["pair"]);
        let name = format!("name = {}\n", toml_edit::Value::from(name));
        let lines = table
            .split_inclusive('\n')
            .map(|line| match line.strip_prefix("[pair]") {
                Some(rest) => format!("[[pair]]{rest}{name}"),
                None => line.to_owned(),
            });
        lines.collect()
    }

    /// Moves a table into `[pair]`, unless the first file of a frame has the same.
    pub fn take_along(&mut self, table: &str, first: &PairFile) {
        let own = self
            .0
            .remove(table)
            .filter(|own| Some(own.to_string()) != first.0.get(table).map(Item::to_string));
        if let (Some(own), Some(pair)) = (own, self.0["pair"].as_table_like_mut()) {
            pair.entry(table).or_insert(own);
        }
    }

    /// Whether it has this table.
    pub fn has(&self, table: &str) -> bool {
        self.0.contains_key(table)
    }

    /// A number of a table.
    pub fn number(&self, table: &str, key: &str) -> Option<f64> {
        float(self.0.get(table)?.as_table_like()?.get(key)?)
    }

    /// `[thrust_n, torque_nm]` of a rotor alone, `lower_out` or `upper_out` of `[pair]`.
    pub fn curve(&self, name: &str) -> Option<[[f64; 3]; 2]> {
        let table = self.0.get("pair")?.get(name)?;
        let list = |key| {
            let terms = table.get(key)?.as_array()?.iter();
            let terms = terms.map(number);
            <[f64; 3]>::try_from(terms.collect::<Option<Vec<f64>>>()?).ok()
        };
        Some([list("thrust_n")?, list("torque_nm")?])
    }

    /// `[throttle]`, `[pair]`, `[voltage]` and `[air]`, and the torque of least power, N m per N.
    pub fn model(&self) -> (String, Option<f64>) {
        self.tables(&OF_A_PAIR)
    }

    /// The tables of these names, as they stand there with their comments, and the torque of least
    /// power, N m per N. Of a pair's own file with what is told below the tables; an airframe's bias
    /// was chosen for its vehicle.
    pub fn tables(&self, names: &[&str]) -> (String, Option<f64>) {
        let mut document = self.0.clone();
        document.retain(|name, _| names.contains(&name));
        let is_airframe = self.has("unit") || self.has("layout");
        let below = self
            .0
            .trailing()
            .as_str()
            .filter(|_| !is_airframe)
            .unwrap_or_default();
        let mut bias = None;
        let kept = below.split_inclusive('\n').filter(|line| {
            let found = commented_bias(line);
            bias = bias.or(found);
            found.is_none()
        });
        let below: String = kept.collect();
        document.set_trailing(below);
        (format!("{}\n\n", document.to_string().trim_end()), bias)
    }
}

/// The torque of least power, of a line in which it is commented out.
fn commented_bias(line: &str) -> Option<f64> {
    let line: DocumentMut = line.strip_prefix("# ")?.parse().ok()?;
    float(line.get(POWER_BIAS)?)
}

fn float(item: &Item) -> Option<f64> {
    number(item.as_value()?)
}

fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| Some(value.as_integer()? as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_taken_with_their_comments() {
        let text = "# top\n[throttle]\nmin = 0.1\n\n# bench\n[pair]\nthrust_n = [\n  [1.0, 2.0],\n]\n[pair.lower_out]\nx = 1\n\
                    [voltage]\nv = 1\n\n# below\n\n# power_bias_nm_per_n = 0.005    # told\n";
        let file = PairFile::read("a.toml", text).expect("a pair");
        let (model, bias) = file.model();
        assert_eq!(bias, Some(0.005));
        assert_eq!(
            model,
            text.split("\n\n# power").next().expect("text").to_owned() + "\n\n"
        );
        assert_eq!(file.number("throttle", "min"), Some(0.1));
        let (pair, _) = file.tables(&["pair"]);
        assert!(
            pair.trim_start().starts_with("# bench\n[pair]") && !pair.contains("v = 1"),
            "{pair}"
        );
        // Of an airframe what its vehicle asked for stays behind.
        let airframe = format!("name = \"a\"\n{text}[[unit]]\nx = 1\n# below\n");
        let (model, bias) = PairFile::read("a.toml", &airframe).expect("a pair").model();
        assert_eq!(bias, None);
        assert!(!model.contains("name =") && !model.contains("unit"), "{model}");
        assert!(PairFile::read("a.toml", "[throttle]\n").is_err());
    }
}
