mixer_macros::airframe!("several-faults.toml");

fn main() {
    // The module is there all the same: no further error hides the one that matters.
    let _ = several_faults::mix(&mixer_rt::Wrench::default(), 15.0);
    let _ = several_faults::mix_with_health(&mixer_rt::Wrench::default(), 15.0, mixer_rt::Health::GOOD);
}
