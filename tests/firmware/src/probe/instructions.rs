//! Instructions counted with a timer of the board under QEMU's instruction counter.
//!
//! With `-icount shift=10` every instruction takes 2^10 = 1024 ns of virtual time, and timer 0 of
//! the MPS2 board (Arm CMSDK APB timer) counts down at 25 MHz, one tick per 40 ns. A stretch of n
//! instructions therefore lasts n * 25.6 ticks, and n = ticks * 40 / 1024 rounded to the nearest
//! whole number. A reading is less than one tick off at either end, far below the 12.8 ticks that
//! would round wrongly, so the count is exact to the instruction. The timer has 32 bits: 167
//! million instructions. (SysTick's 24 bits come round after 655,360.)
//!
//! Both readings and what lies between them stand in one piece of assembly: the compiler can
//! schedule nothing of its own into the stretch. Two readings that follow one another directly are
//! one instruction apart, the second reading itself; this cost is measured once and subtracted.
//! [`Counter::new`] then counts one hundred `nop`s and accepts no other answer.

use core::arch::{asm, naked_asm};

use mixer_rt::Wrench;

const TICK_NS: u64 = 40;
const INSTRUCTION_NS: u64 = 1024;
/// Registers of timer 0: CTRL, VALUE, RELOAD, INTSTATUS.
const TIMER: *mut u32 = 0x4000_0000 as *mut u32;
/// Length of the stretch that [`Counter::new`] checks itself with.
pub const NOPS: u32 = 100;

/// A mixer behind the C calling convention, so that assembly can call it: setpoint (`T`, whatever
/// else it is asked by), where to write the result, voltage.
pub type Mixer<T = Wrench> = unsafe extern "C" fn(*const T, *mut (), f32);

/// The timer, running, with the cost of a measurement known.
pub struct Counter {
    current: *const u32,
    overhead: u32,
}

/// The counter does not count instructions: not in QEMU, or without `-icount shift=10`.
pub struct Inexact {
    /// Instructions counted over [`NOPS`] of them.
    pub counted: u32,
}

/// Ticks over `$work`, between two readings in one `asm!` block.
macro_rules! ticks {
    ($current:expr, $work:literal) => {{
        let (start, end): (u32, u32);
        asm!(
            "ldr {start}, [{current}]",
            $work,
            "ldr {end}, [{current}]",
            start = out(reg) start,
            end = lateout(reg) end,
            current = in(reg) $current,
            options(nostack, preserves_flags),
        );
        start.wrapping_sub(end)
    }};
}

impl Counter {
    /// Starts the timer, measures an empty stretch, and checks the count of one hundred `nop`s.
    pub fn new() -> Result<Counter, Inexact> {
        // SAFETY: device registers that nothing else in these images uses; two loads of one that
        // may be read at any time; `nop` touches nothing.
        let (current, empty, nops) = unsafe {
            let [control, value, reload] = [TIMER, TIMER.add(1), TIMER.add(2)];
            reload.write_volatile(u32::MAX);
            value.write_volatile(u32::MAX);
            control.write_volatile(1);
            let current = value.cast_const();
            (
                current,
                ticks!(current, ""),
                ticks!(current, ".rept 100\nnop\n.endr"),
            )
        };
        let overhead = instructions(empty);
        let counted = instructions(nops).saturating_sub(overhead);
        if counted == NOPS {
            Ok(Counter { current, overhead })
        } else {
            Err(Inexact { counted })
        }
    }

    /// Mixes once and counts the instructions from the call to the return, both included.
    ///
    /// # Safety
    ///
    /// `output` must be what `mix` writes its result to.
    pub unsafe fn count<T>(&self, mix: Mixer<T>, setpoint: &T, output: *mut (), voltage_v: f32) -> u32 {
        let (mix, setpoint) = (mix as *const (), (&raw const *setpoint).cast());
        // SAFETY: the timer may be read at any time; the setpoint is what `mix` takes, and the
        // caller answers for `output`.
        let ticks = unsafe { ticks_of_call(mix, setpoint, output, self.current, voltage_v) };
        instructions(ticks).saturating_sub(self.overhead)
    }

    /// Instructions of an empty measurement, already subtracted from every count.
    pub fn overhead(&self) -> u32 {
        self.overhead
    }
}

/// Reads the timer at `current`, calls `mix`, reads again; returns the difference.
#[unsafe(naked)]
unsafe extern "C" fn ticks_of_call(
    mix: *const (),
    setpoint: *const (),
    output: *mut (),
    current: *const u32,
    voltage_v: f32,
) -> u32 {
    // The voltage is in s0 already.
    naked_asm!(
        "push {{r4, r5, r6, lr}}",
        "mov r4, r3",
        "mov r3, r0",
        "mov r0, r1",
        "mov r1, r2",
        "ldr r5, [r4]",
        "blx r3",
        "ldr r0, [r4]",
        "sub r0, r5, r0",
        "pop {{r4, r5, r6, pc}}",
    )
}

fn instructions(ticks: u32) -> u32 {
    ((u64::from(ticks) * TICK_NS + INSTRUCTION_NS / 2) / INSTRUCTION_NS) as u32
}
