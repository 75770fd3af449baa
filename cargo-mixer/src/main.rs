//! `cargo mixer`.
fn main() {}
