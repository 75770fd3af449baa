//! High-water mark of the stack: paint below the stack pointer, call, look how deep the paint is
//! gone.

use core::arch::naked_asm;

use crate::Mixer;

/// Depth that is painted, bytes. Far deeper than any mixer may go.
const PAINTED: usize = 8192;
/// As a float this is a NaN, which no mixer stores.
const PAINT: u32 = 0x7fc0_5ac4;

/// Mixes once and returns how many bytes below the caller's stack pointer were written: the mixer's
/// own frame, its saved registers and everything it calls. The result is the caller's and not
/// counted.
///
/// # Safety
///
/// `output` must be what `mix` writes its result to, and no interrupt may be enabled.
pub unsafe fn high_water<T>(mix: Mixer<T>, setpoint: &T, output: *mut (), voltage_v: f32) -> usize {
    let (mix, setpoint) = (mix as *const (), (&raw const *setpoint).cast());
    // SAFETY: paints free memory, far above the lower end of the 4 MiB of RAM; the caller answers
    // for the rest.
    let top = unsafe { painted_call(mix, setpoint, output, voltage_v) };
    let mut at = top - PAINTED;
    // SAFETY: the same stretch of RAM, in words as it was painted.
    while at < top && unsafe { (at as *const u32).read_volatile() } == PAINT {
        at += 4;
    }
    top - at
}

/// Paints below its own frame, calls `mix`, and returns where that frame ends: the stack pointer at
/// the call.
#[unsafe(naked)]
unsafe extern "C" fn painted_call(
    mix: *const (),
    setpoint: *const (),
    output: *mut (),
    voltage_v: f32,
) -> usize {
    // The voltage is in s0 already.
    naked_asm!(
        "push {{r4, lr}}",
        "mov r4, r0",
        "movw r3, #({paint} & 0xffff)",
        "movt r3, #({paint} >> 16)",
        "sub r0, sp, #{painted}",
        "2:",
        "str r3, [r0], #4",
        "cmp r0, sp",
        "bne 2b",
        "mov r0, r1",
        "mov r1, r2",
        "blx r4",
        "mov r0, sp",
        "pop {{r4, pc}}",
        paint = const PAINT,
        painted = const PAINTED,
    )
}
