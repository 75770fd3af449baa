//! The types that firmware logs have `defmt::Format`. A frame can only be decoded with the image's
//! symbols, hence no text is compared.
#![allow(missing_docs)]

use mixer_rt::{Axis, Direction, Health, Mix, Saturation, SetpointError, Wrench};

fn is_logged<T: defmt::Format>() {}

#[test]
fn results_and_errors_are_logged() {
    is_logged::<Wrench>();
    is_logged::<Axis>();
    is_logged::<Direction>();
    is_logged::<Saturation>();
    is_logged::<Health>();
    is_logged::<Mix<8>>();
    is_logged::<Result<Mix<8>, SetpointError>>();
}
