//! The JSON schema of the airframe file, by which editors complete and check
//! it.

use mixer_compiler::airframe::KEYS;
use mixer_compiler::spec::keys::{Key, Range, Shape, ValueKind};
use serde_json::{Map, Value, json};

/// The line by which an airframe file names its schema.
pub const DIRECTIVE: &str = "#:schema ./airframe.schema.json";

/// The schema as text.
pub fn text() -> String {
    format!("{:#}\n", schema())
}

/// The schema, draft 7: what editors' language servers know.
pub fn schema() -> Value {
    let mut schema = table(KEYS);
    let head = [
        ("$schema", json!("http://json-schema.org/draft-07/schema#")),
        ("title", json!("Airframe of a coaxial multirotor, version 1")),
        // The parser asks for one of them.
        (
            "anyOf",
            json!([{ "required": ["unit"] }, { "required": ["layout"] }]),
        ),
    ];
    if let Some(schema) = schema.as_object_mut() {
        schema.extend(head.map(|(key, value)| (key.to_owned(), value)));
    }
    schema
}

fn table(shape: &Shape) -> Value {
    let properties = shape.keys.iter().map(|key| (key.name.to_owned(), property(key)));
    let properties: Map<String, Value> = properties.collect();
    let required = shape.keys.iter().filter(|key| key.required);
    let required: Vec<&str> = required.map(|key| key.name).collect();
    json!({
        "type": "object",
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}

fn property(key: &Key) -> Value {
    let array = |items: Value, [least, most]: [usize; 2]| json!({ "type": "array", "items": items, "minItems": least, "maxItems": most });
    let number = || json!({ "type": "number" });
    let channel = || json!({ "type": "integer", "minimum": 0 });
    let mut property = match key.kind {
        ValueKind::Flag => json!({ "type": "boolean" }),
        ValueKind::Text => json!({ "type": "string" }),
        ValueKind::Texts => json!({ "type": "array", "items": { "type": "string" } }),
        ValueKind::Name => json!({ "type": "string", "pattern": "^[a-z][a-z0-9]*([-_][a-z0-9]+)*$" }),
        ValueKind::Word(words) => json!({ "type": "string", "enum": words }),
        ValueKind::Words(words) => json!({ "type": "array", "items": { "type": "string", "enum": words } }),
        ValueKind::Number(Range::Positive) => json!({ "type": "number", "exclusiveMinimum": 0 }),
        ValueKind::Number(Range::UpTo(most)) => {
            json!({ "type": "number", "exclusiveMinimum": 0, "maximum": bound(most) })
        }
        ValueKind::Number(Range::Within([least, most])) => {
            json!({ "type": "number", "minimum": bound(least), "maximum": bound(most) })
        }
        ValueKind::Count([least, most]) => json!({ "type": "integer", "minimum": least, "maximum": most }),
        ValueKind::Numbers(count) => array(number(), count),
        ValueKind::Points => json!({ "type": "array", "items": array(number(), [2, 2]) }),
        ValueKind::Channels => array(channel(), [1, 2]),
        ValueKind::ListOfChannels => json!({ "type": "array", "items": array(channel(), [2, 2]) }),
        ValueKind::Table(shape) => table(shape),
        // What is said of properties holds of tables alone, what is said of items of lists.
        ValueKind::TableOrTables(shape) => {
            let mut either = table(shape);
            either["type"] = json!(["object", "array"]);
            either["items"] = json!({ "$ref": format!("#/properties/{}", key.name) });
            either["minItems"] = json!(1);
            either
        }
        ValueKind::Tables(shape) => json!({ "type": "array", "items": table(shape), "minItems": 1 }),
    };
    property["description"] = json!(key.meaning());
    property
}

/// A bound, without `.0` where it is whole.
fn bound(x: f64) -> Value {
    if x.fract() == 0.0 {
        json!(x as i64)
    } else {
        json!(x)
    }
}
