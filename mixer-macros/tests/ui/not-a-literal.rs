const PATH: &str = "one-fault.toml";

mixer_macros::airframe!(PATH);

fn main() {}
