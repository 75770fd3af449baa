//! Compiles, with what `cargo mixer check` warns of.

mixer_macros::airframe!("tests/warned/idle-high.toml");

fn main() {
    let _ = x8::CHANNELS;
}
