//! The schema of the airframe file says what the parser takes and refuses.

use std::fs;

use mixer_compiler::Source;
use mixer_compiler::airframe::Airframe;
use mixer_files::schema;
use serde_json::{Value, json};

use crate::root;

/// What of `value` the schema does not allow, by its path; as much of draft 7 as the schema uses,
/// and no more.
fn faults(schema: &Value, value: &Value, path: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut hold = |holds: bool, rule: &str| {
        if !holds {
            found.push(format!("{path}: {rule}"));
        }
    };
    let mut inner = Vec::new();
    for (rule, bound) in schema.as_object().expect("a schema") {
        let number = value.as_f64();
        let count = value.as_array().map(Vec::len);
        match rule.as_str() {
            "type" => {
                let types = bound
                    .as_array()
                    .map_or(std::slice::from_ref(bound), Vec::as_slice);
                let is = |of: &Value| match of.as_str().expect("a type") {
                    "object" => value.is_object(),
                    "array" => value.is_array(),
                    "string" => value.is_string(),
                    "number" => value.is_number(),
                    "boolean" => value.is_boolean(),
                    "integer" => value.is_u64() || value.is_i64(),
                    other => panic!("type {other}"),
                };
                hold(types.iter().any(is), rule);
            }
            // A table in a list is one as it may stand alone.
            "$ref" => {
                inner.extend(faults(&referred(bound), value, path));
            }
            "enum" => hold(bound.as_array().expect("words").contains(value), rule),
            // Rust's standard library has no regular expressions; names are the parser's to judge.
            "pattern" => hold(value.as_str().is_none_or(|name| !name.is_empty()), rule),
            "minimum" => hold(number.is_none_or(|x| x >= bound.as_f64().expect("number")), rule),
            "maximum" => hold(number.is_none_or(|x| x <= bound.as_f64().expect("number")), rule),
            "exclusiveMinimum" => hold(number.is_none_or(|x| x > bound.as_f64().expect("number")), rule),
            "minItems" => hold(
                count.is_none_or(|n| n as u64 >= bound.as_u64().expect("count")),
                rule,
            ),
            "maxItems" => hold(
                count.is_none_or(|n| n as u64 <= bound.as_u64().expect("count")),
                rule,
            ),
            // Said of tables alone.
            "required" => {
                for key in bound.as_array().expect("keys") {
                    let key = key.as_str().expect("a key");
                    hold(
                        !value.is_object() || value.get(key).is_some(),
                        &format!("required {key}"),
                    );
                }
            }
            "items" => {
                for (k, element) in value.as_array().into_iter().flatten().enumerate() {
                    inner.extend(faults(bound, element, &format!("{path}[{k}]")));
                }
            }
            "properties" => {
                for (key, element) in value.as_object().into_iter().flatten() {
                    match bound.get(key) {
                        Some(schema) => inner.extend(faults(schema, element, &format!("{path}.{key}"))),
                        None => hold(
                            schema["additionalProperties"] != json!(false),
                            &format!("unknown {key}"),
                        ),
                    }
                }
            }
            "anyOf" => {
                let any = bound.as_array().expect("schemas").iter();
                hold(
                    any.clone().any(|schema| faults(schema, value, path).is_empty()),
                    rule,
                );
            }
            "$schema" | "title" | "description" | "additionalProperties" => {}
            other => panic!("the test does not know {other}"),
        }
    }
    found.extend(inner);
    found
}

/// What is at a place of the schema.
fn referred(place: &Value) -> Value {
    let place = place.as_str().and_then(|place| place.strip_prefix('#'));
    let schema = schema::schema();
    schema
        .pointer(place.expect("a place"))
        .expect("it is there")
        .clone()
}

fn airframe(text: &str) -> Value {
    serde_json::to_value(text.parse::<toml::Table>().expect("TOML")).expect("JSON")
}

#[test]
fn the_committed_schema_is_that_of_the_parser() {
    let held = fs::read_to_string(root().join("docs/airframe.schema.json")).expect("committed");
    assert_eq!(
        held,
        schema::text(),
        "cargo mixer schema -o docs/airframe.schema.json"
    );
}

#[test]
fn airframes_are_valid() {
    let folders = ["airframes", "tests/fixtures", "mixer-compiler/tests/warnings"];
    let mut count = 0;
    for folder in folders {
        for entry in fs::read_dir(root().join(folder)).expect("folder") {
            let path = entry.expect("entry").path();
            if path.extension().is_some_and(|extension| extension == "toml") {
                let text = fs::read_to_string(&path).expect("text");
                let found = faults(&schema::schema(), &airframe(&text), "");
                assert_eq!(found, [""; 0], "{}", path.display());
                count += 1;
            }
        }
    }
    assert!(count > 20, "{count}");
}

/// Every kind of fault that the schema knows is refused by the parser, too, and what the schema
/// takes at the ends of its ranges the parser takes.
#[test]
fn the_parser_agrees_key_by_key() {
    const UNIT: &str = "[[unit]]\nposition_m = [0.3, 0.0, 0.0]\nupper_spin = \"cw\"\nchannels = [0, 1]\naxis = [0.0, 0.0, -1.0]\n";
    let pair = fs::read_to_string(root().join("tools/mixer-files/src/new/stand-in.toml")).expect("pair");
    let other = "torque_points = [[12.8, 0.8], [14.8, 1.0], [16.8, 1.2]]\nthrust_exponent = 1.8\n";
    let points = "thrust_points = [[12.8, 0.8], [14.8, 1.0], [16.8, 1.2]]\ntorque_exponent = 1.8\n";
    let layout = "[layout]\narm_m = 0.45\nunits = 4\nfirst_angle_deg = 45.0\nspins = [\"cw\", \"ccw\", \"cw\", \"ccw\"]\n\
                  channels = [[0, 4], [1, 5], [2, 6], [3, 7]]\n[vehicle]\nmass_kg = 3.0\ninertia_kg_m2 = [0.1, 0.1, 0.2]\nrotor_inertia_kg_m2 = 3e-4\n[inverse]\nmethod = \"auto\"\n\
                  [air]\nreference_density_kg_m3 = 1.2\nrange_kg_m3 = [0.7, 1.4]\nthrust_exponent = 0.75\ntorque_exponent = 0.75\n";
    let alone = "[pair.lower_out]\nthrust_n = [1.0, 10.0, 0.0]\ntorque_nm = [-0.01, -0.2, 0.0]\n\
                 [pair.upper_out]\nthrust_n = [1.0, 10.0, 0.0]\ntorque_nm = [0.01, 0.2, 0.0]\n\
                 [pair.power]\npower_w = [0, 0, 0, 0, 0, 260, 30, 20, 240, 20, -10, 40, 2, 3, 4]\n\
                 [pair.uncertainty]\nthrust_percent = 1.5\ntorque_percent = 100\nsource = \"bench\"\n";
    let own = |of: &str, law: &str| {
        format!(
            "[{of}.voltage]\nreference_v = 14.8\nrange_v = [12.8, 16.8]\n{law}\
             [{of}.air]\nreference_density_kg_m3 = 1.2\nrange_kg_m3 = [0.7, 1.4]\nthrust_exponent = 0.75\ntorque_exponent = 0.75\n"
        )
    };
    let air = "[air]\nreference_density_kg_m3 = 1.2\nrange_kg_m3 = [0.7, 1.4]\nthrust_exponent = 0.75\ntorque_exponent = 0.75\n";
    let single = |law: &str| {
        format!(
            "name = \"single\"\n{pair}\n{}[[rotor]]\nname = \"single\"\nthrust_n = [1.0, 10.0, 0.0]\ntorque_nm = [0.01, 0.2, 0.0]\n\
             bench_v = [14.0, 15.0]\n[rotor.uncertainty]\nthrust_percent = 1.5\ntorque_percent = 3.0\nsource = \"bench\"\n{}{air}\
             [[unit]]\nposition_m = [-0.3, 0.0, 0.0]\nupper_spin = \"cw\"\nchannels = [2]\nrotor = \"single\"\n{UNIT}",
            own("pair", law),
            own("rotor", law)
        )
    };
    let forms = [
        format!(
            "name = \"one\"\ndescription = \"x\"\n{}{UNIT}pair = \"front\"\n[inverse]\nthrust_tolerance_n = 0.1\ntorque_tolerance_nm = 0.01\n\
             method = \"polynomial\"\ndegree = 9\n[allocation]\nairmode = \"disabled\"\naxes = [\"yaw\", \"thrust\"]\nyaw_reserve_nm = 0.0\n\
             power_bias_nm_per_n = 0.004\n",
            pair.replacen("[pair]", "[pair]\nname = \"front\"", 1)
        ),
        format!(
            "name = \"two\"\n{}{layout}{alone}",
            pair.replace(
                "upper_spin",
                "bench_options = [\"--swap\"]\nbench_v = [14.0, 15.0]\nstronger = \"lower\"\nupper_spin"
            )
        ),
        format!("name = \"three\"\n{}{layout}", with_law(&pair, points)),
        format!(
            "name = \"several\"\n{}{layout}",
            pair.replacen("[pair]", "[[pair]]\nname = \"front\"", 1).replacen(
                "[voltage]",
                &format!("{}\n[voltage]", another(&pair)),
                1
            )
        )
        .replacen(
            "channels",
            "pairs = [\"front\", \"rear\", \"rear\", \"front\"]\nchannels",
            1,
        ),
        single("thrust_exponent = 1.7\ntorque_exponent = 1.7\n"),
        single(points),
        single(other),
        format!(
            "name = \"four\"\n{}[layout]\narm_m = 0.45\nunits = 3\nfirst_angle_deg = 60\nfirst_spin = \"ccw\"\n\
             [vehicle]\nmass_kg = 3.0\nrotor_lag_s = 0.05\nrotor_brakes = false\n",
            with_law(&pair, other)
        ),
    ];
    let schema = schema::schema();
    let mut judged = std::collections::BTreeSet::new();
    for form in &forms {
        let good = airframe(form);
        assert_eq!(faults(&schema, &good, ""), [""; 0], "{form}");
        assert!(is_parsed(&good), "{form}");
        for (path, spoilt) in spoilt(&schema, &good, "") {
            assert!(
                !faults(&schema, &spoilt, "").is_empty(),
                "{path}: the schema takes {spoilt:#}"
            );
            assert!(!is_parsed(&spoilt), "{path}: the parser takes {spoilt:#}");
            judged.insert(path.split(' ').next().unwrap_or_default().to_owned());
        }
    }
    let keys = keys(&schema, "");
    let missed: Vec<&String> = keys.iter().filter(|key| !judged.contains(*key)).collect();
    assert!(missed.is_empty(), "keys that no form has: {missed:?}");
}

/// Its table of the pair, as that of another one.
fn another(pair: &str) -> String {
    let (_, table) = pair.split_once("[pair]").expect("a pair");
    let table = table.split("\n[").next().unwrap_or_default();
    format!("[[pair]]\nname = \"rear\"{table}")
}

/// The pair's file with this law of voltage.
fn with_law(pair: &str, law: &str) -> String {
    let kept = pair.lines().filter(|line| !line.contains("_exponent"));
    let text: Vec<&str> = kept.collect();
    format!("{}\n{law}", text.join("\n"))
}

/// Whether the file's shape and its values are accepted.
fn is_parsed(value: &Value) -> bool {
    let text = toml::to_string(value).expect("TOML");
    Airframe::read(&Source::new("schema.toml", text)).is_ok()
}

/// All keys of the schema by their paths.
fn keys(schema: &Value, path: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (key, inner) in schema["properties"].as_object().into_iter().flatten() {
        let path = format!("{path}.{key}");
        found.extend(keys(inner, &path));
        found.extend(keys(&inner["items"], &path));
        found.push(path);
    }
    found
}

/// `value` with one fault each that breaks one rule of the schema, by the key's path and the rule.
fn spoilt(schema: &Value, value: &Value, path: &str) -> Vec<(String, Value)> {
    if let Some(place) = schema.get("$ref") {
        return spoilt(&referred(place), value, path);
    }
    let mut found = Vec::new();
    let mut put = |rule: &str, spoilt: Value| found.push((format!("{path} {rule}"), spoilt));
    if !path.is_empty() {
        put("type", if value.is_string() { json!(7) } else { json!("7") });
    }
    for (rule, bound) in schema.as_object().expect("a schema") {
        match rule.as_str() {
            "enum" => put(rule, json!("none-of-these")),
            "pattern" => put(rule, json!("")),
            "minimum" => put(rule, json!(bound.as_f64().expect("bound") - 1.0)),
            "maximum" => put(rule, json!(bound.as_f64().expect("bound") + 1.0)),
            "exclusiveMinimum" => put(rule, bound.clone()),
            "minItems"
                if value
                    .as_array()
                    .is_some_and(|list| list.iter().all(Value::is_number)) =>
            {
                put(rule, Value::Array(Vec::new()));
            }
            "maxItems" => {
                let mut list = value.as_array().expect("list").clone();
                let most = bound.as_u64().expect("count") as usize;
                while list.len() <= most {
                    list.push(list[0].clone());
                }
                put(rule, Value::Array(list));
            }
            "required" if value.is_object() => {
                for key in bound.as_array().expect("keys") {
                    let mut table = value.as_object().expect("table").clone();
                    table.remove(key.as_str().expect("key"));
                    put(rule, Value::Object(table));
                }
            }
            _ => {}
        }
    }
    if let Some(table) = value.as_object() {
        let mut more = table.clone();
        more.insert("nonsense".to_owned(), json!(1));
        put("unknown", Value::Object(more));
        for (key, inner) in table {
            for (path, spoilt) in spoilt(&schema["properties"][key], inner, &format!("{path}.{key}")) {
                let mut table = table.clone();
                table.insert(key.clone(), spoilt);
                found.push((path, Value::Object(table)));
            }
        }
    }
    if let (Some(list), Some(items)) = (value.as_array(), schema.get("items")) {
        for (path, spoilt) in spoilt(items, &list[0], path) {
            let mut list = list.clone();
            list[0] = spoilt;
            found.push((path, Value::Array(list)));
        }
    }
    found
}
