//! Keys that fields of the page set.
#![allow(missing_docs)]

use mixer_web::edit::set;

const TEXT: &str = "name = \"a\"\n\n[allocation]\nairmode = \"disabled\"   # as PX4\n";

#[test]
fn a_key_is_set_and_the_rest_stays() {
    let cases = [
        (
            "allocation",
            "airmode",
            "\"roll-pitch\"",
            "name = \"a\"\n\n[allocation]\nairmode = \"roll-pitch\"   # as PX4\n",
        ),
        (
            "vehicle",
            "mass_kg",
            "3.2",
            "name = \"a\"\n\n[allocation]\nairmode = \"disabled\"   # as PX4\n\n[vehicle]\nmass_kg = 3.2\n",
        ),
        ("allocation", "airmode", "", "name = \"a\"\n\n[allocation]\n"),
        ("vehicle", "mass_kg", "", TEXT),
    ];
    for (table, key, value, expected) in cases {
        assert_eq!(
            set(TEXT, table, key, value).as_deref(),
            Ok(expected),
            "{table}.{key} = {value}"
        );
    }
}

#[test]
fn what_is_none_is_told() {
    assert!(
        set("[", "vehicle", "mass_kg", "3")
            .unwrap_err()
            .starts_with("the file is no TOML yet")
    );
    assert!(
        set(TEXT, "vehicle", "mass_kg", "3 kg")
            .unwrap_err()
            .starts_with("3 kg is no value")
    );
    assert_eq!(
        set(TEXT, "name", "mass_kg", "3"),
        Err("`name` is no table".to_owned())
    );
}
