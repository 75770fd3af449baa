//! The bits of answers, so that no change of them goes unnoticed. That a microcontroller has the same is
//! shown by `tests/firmware.rs` of the project, on requests of its own.
#![allow(missing_docs)]

mod common;

use common::{Random, tilted, x8};

/// Digests with none, one and two rotors out. Where a change of bits is meant, the test prints what
/// belongs here.
const X8: [u64; 3] = [0x90821a6853dbf632, 0xfe2fb2725958433e, 0x90eb4b682191fbf4];
const TILTED: [u64; 3] = [0x9198ab00e5d9dae5, 0x12cecb92f32c14ff, 0x375993fcc14361c9];

/// Requests per digest.
const REQUESTS: usize = 400;

/// FNV-1a.
fn digest(bits: impl Iterator<Item = u32>) -> u64 {
    bits.flat_map(u32::to_le_bytes)
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        })
}

#[test]
fn bits_are_those_held() {
    let digests = [x8(), tilted()].map(|frame| {
        [0, 1, 2].map(|out| {
            let mut random = Random::new(100);
            let answers = (0..REQUESTS).map(|index| {
                let request = if index % 16 == 0 {
                    frame.draw_wild(&mut random, out)
                } else {
                    frame.draw(&mut random, out)
                };
                frame.mix(&request)
            });
            digest(answers.flat_map(|answer| {
                let values = answer.throttle.into_iter().chain(answer.achieved);
                values.map(f32::to_bits).collect::<Vec<_>>()
            }))
        })
    });
    let held = [X8, TILTED];
    let list = |digests: [u64; 3]| digests.map(|digest| format!("0x{digest:016x}")).join(", ");
    assert!(
        digests == held,
        "other bits; if that is meant:\nconst X8: [u64; 3] = [{}];\nconst TILTED: [u64; 3] = [{}];",
        list(digests[0]),
        list(digests[1])
    );
}
