//! Tables of an airframe file, as `toml_edit` has them.

use mixer_compiler::airframe::{Basis, Uncertainty};
use toml_edit::{Array, ArrayOfTables, DocumentMut, Item, Table, Value, value};

use crate::fit::basis::ThrottleBox;
use crate::rotor::Turning;

/// A table with a comment above it, lines with their ends.
pub(crate) fn table<'a>(comment: &str, entries: impl IntoIterator<Item = (&'a str, Item)>) -> Item {
    let mut table = Table::new();
    table.decor_mut().set_prefix(format!("\n{comment}"));
    for (key, value) in entries {
        table.insert(key, value);
    }
    Item::Table(table)
}

/// `[pair.uncertainty]`.
pub(crate) fn uncertainty(of: &Uncertainty) -> Item {
    let mut entries = vec![
        ("thrust_percent", value(of.thrust_percent)),
        ("torque_percent", value(of.torque_percent)),
    ];
    if of.is_predicted {
        entries.push(("source", value("prediction")));
    }
    table("# One standard deviation, % of full scale.\n", entries)
}

/// Numbers in one line.
pub(crate) fn numbers(values: impl IntoIterator<Item = f64>) -> Item {
    Item::Value(values.into_iter().collect::<Array>().into())
}

/// Texts in one line.
pub(crate) fn texts(values: &[String]) -> Item {
    Item::Value(values.iter().map(String::as_str).collect::<Array>().into())
}

/// Numbers in a line each, with a comment behind it.
pub(crate) fn commented(values: &[f64], comments: impl Iterator<Item = String>) -> Item {
    let mut array = Array::new();
    let mut before = String::new();
    for (value, comment) in values.iter().zip(comments) {
        let value = Value::from(*value);
        let behind = format!(
            "{:1$}  # {comment}",
            "",
            17_usize.saturating_sub(value.to_string().trim().len())
        );
        array.push_formatted(value.decorated(format!("{before}\n    "), ""));
        before = behind;
    }
    array.set_trailing_comma(true);
    array.set_trailing(before + "\n");
    Item::Value(array.into())
}

/// `[throttle]`, and `[pair]` or `[[rotor]]`, with what stands above a table by its name.
pub(crate) fn model(
    about: &dyn Fn(&str) -> String,
    ThrottleBox { min, max }: ThrottleBox,
    name: &str,
    mut entries: Vec<(&str, Item)>,
    uncertainty: Option<&Uncertainty>,
    options: &[String],
) -> DocumentMut {
    entries.extend(uncertainty.map(|of| ("uncertainty", self::uncertainty(of))));
    if !options.is_empty() {
        entries.push(("bench_options", texts(options)));
    }
    let mut document = DocumentMut::new();
    document.insert(
        "throttle",
        table(&about("throttle"), [("min", value(min)), ("max", value(max))]),
    );
    let own = match table(&about(name), entries) {
        Item::Table(own) if name == "rotor" => Item::ArrayOfTables(ArrayOfTables::from_iter([own])),
        own => own,
    };
    document.insert(name, own);
    document
}

/// What `[pair]` has, with its rotors alone.
pub(crate) fn pair(
    about: &dyn Fn(&str) -> String,
    basis: Basis,
    [thrust_n, torque_nm]: [Item; 2],
    lower_is_stronger: bool,
    alone: impl Iterator<Item = (Turning, [[f64; 3]; 2])>,
) -> Vec<(&'static str, Item)> {
    let mut entries = vec![
        ("basis", value(basis.name())),
        ("thrust_n", thrust_n),
        ("torque_nm", torque_nm),
        ("upper_spin", value("cw")),
    ];
    if lower_is_stronger {
        entries.push(("stronger", value("lower")));
    }
    entries.extend(alone.map(|(turning, of)| (turning.key(), table(&about(turning.table()), curves(of)))));
    entries
}

/// Thrust and torque of a rotor alone.
pub(crate) fn curves([thrust_n, torque_nm]: [[f64; 3]; 2]) -> [(&'static str, Item); 2] {
    [("thrust_n", numbers(thrust_n)), ("torque_nm", numbers(torque_nm))]
}
