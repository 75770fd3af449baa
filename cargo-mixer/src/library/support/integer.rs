// Integer arithmetic that a Cortex-M0 has no instructions for, in those that it has.

pub(super) extern "C" fn leading_zeros(mut value: u32) -> u32 {
    let mut zeros = 0u32;
    for bits in [16, 8, 4, 2, 1] {
        if value >> (32 - bits) == 0 {
            zeros += bits;
            value <<= bits;
        }
    }
    zeros + u32::from(value == 0)
}

/// The lower 64 bits of the product.
pub(super) extern "C" fn multiply_long(a: u64, b: u64) -> u64 {
    let (a_high, a_low) = ((a >> 32) as u32, a as u32);
    let (b_high, b_low) = ((b >> 32) as u32, b as u32);
    // Of the lower words all 64 bits, by halves of 16 bits. One half is opaque: LLVM takes the
    // whole for a product of 64 bits otherwise, which is a call of this function.
    let a1 = core::hint::black_box(a_low >> 16) & 0xffff;
    let (a0, b1, b0) = (a_low & 0xffff, b_low >> 16, b_low & 0xffff);
    let middle = a1 * b0 + ((a0 * b0) >> 16);
    let carry = a0 * b1 + (middle & 0xffff);
    let low = a_low.wrapping_mul(b_low);
    let high = (a1 * b1 + (middle >> 16) + (carry >> 16))
        .wrapping_add(a_high.wrapping_mul(b_low))
        .wrapping_add(a_low.wrapping_mul(b_high));
    u64::from(high) << 32 | u64::from(low)
}

/// `value << shift`, the shift below 64.
pub(super) extern "C" fn shift_left_long(value: u64, shift: u32) -> u64 {
    let (high, low) = ((value >> 32) as u32, value as u32);
    let (high, low) = match shift {
        0 => (high, low),
        1..32 => (high << shift | low >> (32 - shift), low << shift),
        _ => (low << (shift & 31), 0),
    };
    u64::from(high) << 32 | u64::from(low)
}

/// `value >> shift`, the shift below 64.
pub(super) extern "C" fn shift_right_long(value: u64, shift: u32) -> u64 {
    let (high, low) = ((value >> 32) as u32, value as u32);
    let (high, low) = match shift {
        0 => (high, low),
        1..32 => (high >> shift, low >> shift | high << (32 - shift)),
        _ => (0, high >> (shift & 31)),
    };
    u64::from(high) << 32 | u64::from(low)
}

/// Quotient in the lower word, remainder in the upper one: r0 and r1.
pub(super) extern "C" fn divide_unsigned(a: u32, b: u32) -> u64 {
    let (mut quotient, mut rest) = (0u32, 0u32);
    for bit in (0..32).rev() {
        // A rest of 32 bits carries into the next.
        let carry = rest >> 31;
        rest = rest << 1 | a >> bit & 1;
        quotient <<= 1;
        if carry != 0 || rest >= b {
            rest = rest.wrapping_sub(b);
            quotient |= 1;
        }
    }
    u64::from(rest) << 32 | u64::from(quotient)
}
