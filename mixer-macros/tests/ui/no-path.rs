mixer_macros::airframe!();

fn main() {}
