mixer_macros::airframe!("one-fault.toml");

fn main() {
    // The module is there all the same: no further error hides the one that matters.
    let _ = one_fault::mix(&mixer_rt::Wrench::default(), 15.0);
}
