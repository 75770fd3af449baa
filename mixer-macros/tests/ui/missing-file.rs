mixer_macros::airframe!("airframes/nowhere.toml");

fn main() {
    // The module is there all the same: no further error hides the one that matters.
    let _ = nowhere::mix(&mixer_rt::Wrench::default(), 15.0);
}
