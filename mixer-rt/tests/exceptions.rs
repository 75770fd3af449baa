//! No floating-point exception: a flight stack on a host may trap them. `cargo-mixer` tests the same of its
//! libraries for C.
#![allow(missing_docs)]
#![cfg(all(target_arch = "x86_64", target_os = "linux", target_env = "gnu"))]

mod common;

use std::ffi::c_int;
use std::hint::black_box;

use common::{AIRMODES, Random, tilted, x8};

/// Invalid operation, division by zero, overflow: the values of glibc's `fenv.h` on x86.
const EXCEPTIONS: c_int = 0x01 | 0x04 | 0x08;

#[link(name = "m")]
#[allow(unsafe_code)]
unsafe extern "C" {
    safe fn feclearexcept(exceptions: c_int) -> c_int;
    safe fn fetestexcept(exceptions: c_int) -> c_int;
}

/// The flags are read after every mix in place of a trap, which could not tell the request.
#[test]
fn no_request_raises_an_exception() {
    black_box(black_box(1.0_f32) / black_box(0.0));
    assert_ne!(fetestexcept(EXCEPTIONS), 0, "exceptions are not seen");
    for (frame, out) in [x8(), tilted()].into_iter().flat_map(|frame| {
        let all = frame.channels() as usize;
        (0..=all).map(move |out| (frame.clone(), out))
    }) {
        let mut random = Random::new(6);
        for index in 0..5_000 {
            let frame = if frame.name == "isae_x8" && out == 0 {
                frame.clone()
            } else {
                frame.with(AIRMODES[index % 3], frame.tables.priorities.yaw_reserve_nm)
            };
            let request = if index % 2 == 0 {
                frame.draw_wild(&mut random, out)
            } else {
                frame.draw(&mut random, out)
            };
            feclearexcept(EXCEPTIONS);
            let answer = black_box(frame.mix(black_box(&request)));
            let raised = fetestexcept(EXCEPTIONS);
            assert_eq!(raised, 0, "{}: {request:?} -> {answer:?}", frame.name);
        }
    }
}
