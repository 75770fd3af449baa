//! The field of the options.
#![allow(missing_docs)]

use mixer_web::make::words;

#[test]
fn words_are_those_of_a_shell() {
    let of = |line| words(line).unwrap();
    assert_eq!(
        of("  --cells 6 --unit 'thrust (kg)=gf'  "),
        ["--cells", "6", "--unit", "thrust (kg)=gf"]
    );
    assert_eq!(of("--column lower=\"ESC B\""), ["--column", "lower=ESC B"]);
    assert!(of(" ").is_empty());
    assert_eq!(
        words("--unit 'thrust=gf"),
        Err("a quote is open in --unit 'thrust=gf".to_owned())
    );
}
