//! Any bytes as an airframe file: an airframe, or faults that can be shown; no panic.
//!
//! `mixer-compiler/tests/robustness.rs` does the same with fixed mutations of good files.
#![no_main]

use libfuzzer_sys::fuzz_target;
use mixer_compiler::Source;

fuzz_target!(|bytes: &[u8]| {
    let compiled = Source::from_bytes("airframe.toml", bytes.to_vec())
        .and_then(|source| mixer_compiler::compile(&source));
    match compiled {
        Ok(compiled) => assert!(!compiled.tokens().is_empty()),
        Err(faults) => assert!(!faults.to_string().is_empty()),
    }
});
