mixer_macros::airframe!("several-faults.toml");

fn main() {
    // The module is there all the same: no further error hides the one that matters.
    let _ = several_faults::mix(&mixer_rt::Wrench::default(), 15.0);
}
