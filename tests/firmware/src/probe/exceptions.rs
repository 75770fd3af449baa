//! Exceptions of the floating-point unit: the cumulative bits of FPSCR (Armv7-M Architecture
//! Reference Manual, B1.4.5).

use core::arch::asm;

/// Invalid operation (IOC), division by zero (DZC) and overflow (OFC).
const TRAPPED: u32 = 0b111;

/// Those of the three exceptions that `work` raises, as bits in this order.
pub fn exceptions(work: impl FnOnce()) -> u32 {
    let before: u32;
    // SAFETY: reads and clears cumulative bits, which no code looks at but this one.
    unsafe {
        asm!("vmrs {before}, fpscr", "bic {cleared}, {before}, #7", "vmsr fpscr, {cleared}",
            before = out(reg) before, cleared = out(reg) _);
    }
    work();
    let after: u32;
    // SAFETY: sets bits that were set before.
    unsafe {
        asm!("vmrs {after}, fpscr", "orr {both}, {after}, {before}", "vmsr fpscr, {both}",
            after = out(reg) after, both = out(reg) _, before = in(reg) before & TRAPPED);
    }
    after & TRAPPED
}
