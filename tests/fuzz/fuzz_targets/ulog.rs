//! Any bytes behind the mark of PX4's log: a flight, or a sentence; no panic.
#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use mixer_compiler::{Compiled, Source};
use mixer_files::review::Flight;

static X8: LazyLock<Compiled> = LazyLock::new(|| {
    let text = include_str!("../../../examples/simulator/x8.toml");
    mixer_compiler::compile(&Source::new("x8.toml", text)).expect("an airframe")
});

fuzz_target!(|bytes: &[u8]| {
    let log = [b"ULog\x01\x12\x35\x01", bytes].concat();
    if let Err(refused) = Flight::read("log", &log, &X8.airframe, None) {
        assert!(!refused.is_empty());
    }
});
