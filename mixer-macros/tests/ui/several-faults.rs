mixer_macros::airframe!("several-faults.toml");

use mixer_rt::{Airframe, Health, Wrench};

fn main() {
    // The module is there all the same, by the name in the file: no further error hides the one
    // that matters.
    let _ = many_faults::mix(&Wrench::default(), 15.0);
    let _ = many_faults::mix_with_health(&Wrench::default(), 15.0, Health::GOOD);
    let _ = many_faults::ManyFaults::mix(&Wrench::default(), 15.0);
    let _ = many_faults::ManyFaults::mix_with_health(&Wrench::default(), 15.0, Health::GOOD);
}
