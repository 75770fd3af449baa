//! The bits of answers, so that no change of them goes unnoticed. That a microcontroller has the same is
//! shown by `tests/firmware.rs` of the project, on requests of its own.
#![allow(missing_docs)]

mod common;

use common::{Frame, Random, tilted, x8};
use mixer_rt::tables::Airmode;

/// Digests with none, one and two rotors out. Where a change of bits is meant, the test prints what
/// belongs here.
const X8: [u64; 3] = [0x90821a6853dbf632, 0xe704839ac433d27c, 0x98a6e2ca389f927f];
const TILTED: [u64; 3] = [0x01f2c526cf073a7b, 0x0af1e3a3b1076167, 0x6bfa948b5d6719f2];

/// The same with all rotors: with a reserve, which empties the ranges of the null space near the corners, and with a
/// power bias.
const X8_RESERVE: u64 = 0x4be5ae7308aed53f;
const BIASED: [u64; 2] = [0x506cbb7b4cffff8d, 0xe5b01373f2f5a93d];

/// Requests per digest.
const REQUESTS: usize = 400;

/// FNV-1a.
fn digest(bits: impl Iterator<Item = u32>) -> u64 {
    bits.flat_map(u32::to_le_bytes)
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        })
}

/// Of answers of a frame with `out` rotors out.
fn of_frame(frame: &Frame, requests: usize, out: usize) -> u64 {
    let mut random = Random::new(100);
    let answers = (0..requests).map(|index| {
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
}

#[test]
fn bits_with_a_reserve_and_with_a_power_bias_are_those_held() {
    let frame = x8();
    let kept = frame.with(Airmode::RollPitch, 0.1 * frame.authority()[2]);
    let reserve = of_frame(&kept, 10 * REQUESTS, 0);
    let biased = [x8(), tilted()].map(|mut frame| {
        frame.tables.power_bias_nm_per_n = 0.004;
        of_frame(&frame, 4 * REQUESTS, 0)
    });
    assert!(
        (reserve, biased) == (X8_RESERVE, BIASED),
        "other bits; if that is meant:\nconst X8_RESERVE: u64 = 0x{reserve:016x};\nconst BIASED: [u64; 2] = [0x{:016x}, 0x{:016x}];",
        biased[0],
        biased[1]
    );
}

#[test]
fn bits_are_those_held() {
    let digests = [x8(), tilted()].map(|frame| [0, 1, 2].map(|out| of_frame(&frame, REQUESTS, out)));
    let held = [X8, TILTED];
    let list = |digests: [u64; 3]| digests.map(|digest| format!("0x{digest:016x}")).join(", ");
    assert!(
        digests == held,
        "other bits; if that is meant:\nconst X8: [u64; 3] = [{}];\nconst TILTED: [u64; 3] = [{}];",
        list(digests[0]),
        list(digests[1])
    );
}
