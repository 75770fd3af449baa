//! The square root, correctly rounded on every target, hence the same bits everywhere.
//!
//! `core` has no stable square root. Cores with an IEEE 754 square root instruction use it; the
//! rest compute the same bits with integers. WebAssembly has the instruction, but stable Rust has
//! no way to it.

/// The correctly rounded square root of `x >= 0`. Negative numbers, which the runtime never passes,
/// give NaN.
#[inline(always)]
pub fn sqrt(x: f32) -> f32 {
    hardware::sqrt(x)
}

#[cfg(all(target_arch = "arm", target_abi = "eabihf"))]
mod hardware {
    #[inline(always)]
    #[allow(unsafe_code)]
    pub(super) fn sqrt(x: f32) -> f32 {
        // Through a core register: on stable, `asm!` does not know that the target has FPU
        // registers to name as operands.
        let bits: u32;
        // SAFETY: reads and writes the named registers only. The hard-float ABI implies the FPU.
        unsafe {
            core::arch::asm!("vmov s0, {bits}", "vsqrt.f32 s0, s0", "vmov {bits}, s0",
                bits = inlateout(reg) x.to_bits() => bits, out("s0") _,
                options(pure, nomem, nostack, preserves_flags));
        }
        f32::from_bits(bits)
    }
}

#[cfg(target_arch = "aarch64")]
mod hardware {
    #[inline(always)]
    #[allow(unsafe_code)]
    pub(super) fn sqrt(x: f32) -> f32 {
        let root: f32;
        // SAFETY: FSQRT reads and writes the named registers only.
        unsafe {
            core::arch::asm!("fsqrt {root:s}, {x:s}", root = out(vreg) root, x = in(vreg) x,
                options(pure, nomem, nostack, preserves_flags));
        }
        root
    }
}

#[cfg(target_arch = "x86_64")]
mod hardware {
    use core::arch::x86_64::{_mm_cvtss_f32, _mm_set_ss, _mm_sqrt_ss};

    #[inline(always)]
    #[allow(unsafe_code)]
    pub(super) fn sqrt(x: f32) -> f32 {
        // SAFETY: SSE is part of x86-64.
        unsafe { _mm_cvtss_f32(_mm_sqrt_ss(_mm_set_ss(x))) }
    }
}

#[cfg(all(any(target_arch = "riscv32", target_arch = "riscv64"), target_feature = "f"))]
mod hardware {
    #[inline(always)]
    #[allow(unsafe_code)]
    pub(super) fn sqrt(x: f32) -> f32 {
        let root: f32;
        // SAFETY: FSQRT.S reads and writes the named registers, and the exception flags.
        unsafe {
            core::arch::asm!("fsqrt.s {root}, {x}", root = out(freg) root, x = in(freg) x,
                options(pure, nomem, nostack));
        }
        root
    }
}

#[cfg(not(any(
    all(target_arch = "arm", target_abi = "eabihf"),
    target_arch = "aarch64",
    target_arch = "x86_64",
    all(any(target_arch = "riscv32", target_arch = "riscv64"), target_feature = "f"),
)))]
use software as hardware;

#[allow(dead_code, reason = "the tests compare it with the hardware's")]
mod software {
    /// One result bit per round: the largest integer r with r^2 <= m, where x = m 2^(2e) and m has
    /// 48 bits or so, then round to nearest. (A root is never half-way between two floats.)
    pub(super) fn sqrt(x: f32) -> f32 {
        if x == 0.0 || x.is_nan() || x == f32::INFINITY {
            return x;
        }
        if x < 0.0 {
            return f32::NAN;
        }
        let bits = x.to_bits();
        let (mut exponent, mut mantissa) = ((bits >> 23) as i32, u64::from(bits & 0x7f_ffff));
        if exponent == 0 {
            let shift = mantissa.leading_zeros() as i32 - 40;
            mantissa <<= shift;
            exponent = 1 - shift;
        } else {
            mantissa |= 1 << 23;
        }
        // x = mantissa 2^(exponent - 150) with mantissa in [2^23, 2^24)
        let mut power = exponent - 150;
        if power & 1 != 0 {
            mantissa <<= 1;
            power -= 1;
        }
        mantissa <<= 26; // the root has 25 or 26 bits: one or two more than a float keeps
        power -= 26;
        let (mut root, mut bit) = (0u64, 1u64 << 26);
        while bit != 0 {
            let trial = root | bit;
            if trial * trial <= mantissa {
                root = trial;
            }
            bit >>= 1;
        }
        let sticky = u64::from(root * root != mantissa);
        // x >= 2^-149 gives a root >= 2^-75: always normal, so rounding is on the 24 leading bits.
        let width = 64 - root.leading_zeros() as i32;
        let drop = width - 24;
        let half = 1u64 << (drop - 1);
        let rest = root & ((1 << drop) - 1);
        let mut kept = root >> drop;
        if rest > half || (rest == half && (sticky == 1 || kept & 1 == 1)) {
            kept += 1; // may reach 2^24, whose bits below carry into the exponent as they should
        }
        let exponent = (power / 2 + drop + 150) as u32;
        f32::from_bits((exponent << 23) + (kept as u32 - (1 << 23)))
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    #[test]
    fn software_root_has_the_hardwares_bits() {
        // The least, and two million of all others: a prime number apart.
        for bits in (0..4096).chain((0..=0x7fff_ffff).step_by(1069)) {
            let x = f32::from_bits(bits);
            if x.is_nan() {
                continue;
            }
            assert_eq!(super::software::sqrt(x).to_bits(), x.sqrt().to_bits(), "{x:e}");
            assert_eq!(super::sqrt(x).to_bits(), x.sqrt().to_bits(), "{x:e}");
        }
        assert!(super::software::sqrt(-1.0).is_nan());
    }
}
