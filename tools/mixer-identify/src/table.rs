//! Tables of an airframe file, as `toml_edit` has them.

use mixer_compiler::airframe::Uncertainty;
use toml_edit::{Array, Item, Table, Value, value};

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
