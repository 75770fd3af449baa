// Arithmetic of IEEE 754 binary32 in integers, rounded to nearest even, subnormal numbers included:
// the bits of a floating-point unit. A NaN is `NAN`, whatever its operands' are.
//
// Part of every object for a processor without that unit. LLVM calls the functions by the names of
// the Arm run-time ABI (RTABI32, tables 4 to 9), which `support.rs` gives them.

const SIGN: u32 = 1 << 31;
const INFINITY: u32 = 0xff << 23;
const NAN: u32 = 0x7fc0_0000;
/// The significand's leading bit, which is not stored.
const LEADING: u32 = 1 << 23;
/// Bits below the significand while it is not rounded; the last is set where anything below is.
const EXTRA: u32 = 3;

/// Stored exponent and significand of a number that is neither infinite nor NaN.
#[inline(always)]
fn parts(magnitude: u32) -> (i32, u32) {
    match magnitude >> 23 {
        0 => (1, magnitude),
        exponent => (exponent as i32, magnitude & (LEADING - 1) | LEADING),
    }
}

/// The same with the leading bit set, for any number but zero.
#[inline(always)]
fn normal_parts(magnitude: u32) -> (i32, u32) {
    let (exponent, significand) = parts(magnitude);
    let shift = significand.leading_zeros() - LEADING.leading_zeros();
    (exponent - shift as i32, significand << shift)
}

/// `value >> shift`, the last bit set where any bit that falls out was.
#[inline(always)]
fn shift_right(value: u32, shift: u32) -> u32 {
    if shift > 31 {
        return u32::from(value != 0);
    }
    value >> shift | u32::from(value & !(u32::MAX << shift) != 0)
}

/// A significand with its extra bits to nearest even. Below the leading bit the exponent is 1.
#[inline(always)]
fn round(sign: u32, exponent: i32, significand: u32) -> u32 {
    if exponent >= 255 {
        return sign | INFINITY;
    }
    // The leading bit counts the exponent up by one; so does a carry.
    let cut = ((exponent as u32 - 1) << 23) + (significand >> EXTRA);
    let below = significand & ((1 << EXTRA) - 1);
    let half = 1 << (EXTRA - 1);
    sign | (cut + u32::from(below > half || below == half && cut & 1 == 1))
}

/// The same with any exponent and the leading bit set.
#[inline(always)]
fn round_any(sign: u32, exponent: i32, significand: u32) -> u32 {
    if exponent < 1 {
        round(sign, 1, shift_right(significand, (1 - exponent) as u32))
    } else {
        round(sign, exponent, significand)
    }
}

pub(super) extern "C" fn add(a: u32, b: u32) -> u32 {
    // The larger one first.
    let (a, b) = if b & !SIGN > a & !SIGN { (b, a) } else { (a, b) };
    let (large, small) = (a & !SIGN, b & !SIGN);
    let is_difference = (a ^ b) & SIGN != 0;
    if large >= INFINITY {
        let is_nan = large > INFINITY || is_difference && small == INFINITY;
        return if is_nan { NAN } else { a };
    }
    if small == 0 {
        return if large == 0 { a & b } else { a };
    }
    let ((mut exponent, significand), (lower, smaller)) = (parts(large), parts(small));
    let significand = significand << EXTRA;
    let smaller = shift_right(smaller << EXTRA, (exponent - lower) as u32);
    if !is_difference {
        let sum = significand + smaller;
        return if sum >= LEADING << (EXTRA + 1) {
            round(a & SIGN, exponent + 1, shift_right(sum, 1))
        } else {
            round(a & SIGN, exponent, sum)
        };
    }
    let difference = significand - smaller;
    if difference == 0 {
        return 0;
    }
    let missing = difference.leading_zeros() - (LEADING << EXTRA).leading_zeros();
    let shift = missing.min(exponent as u32 - 1);
    exponent -= shift as i32;
    round(a & SIGN, exponent, difference << shift)
}

pub(super) extern "C" fn subtract(a: u32, b: u32) -> u32 {
    add(a, b ^ SIGN)
}

pub(super) extern "C" fn subtract_from(a: u32, b: u32) -> u32 {
    add(b, a ^ SIGN)
}

pub(super) extern "C" fn multiply(a: u32, b: u32) -> u32 {
    let sign = (a ^ b) & SIGN;
    let (a, b) = (a & !SIGN, b & !SIGN);
    if a >= INFINITY || b >= INFINITY {
        let is_nan = a > INFINITY || b > INFINITY || a == 0 || b == 0;
        return if is_nan { NAN } else { sign | INFINITY };
    }
    if a == 0 || b == 0 {
        return sign;
    }
    let ((exponent_a, a), (exponent_b, b)) = (normal_parts(a), normal_parts(b));
    let exponent = exponent_a + exponent_b - 127;
    // In [2^46, 2^48): its upper 27 or 28 bits, and whether any is set below.
    let product = u64::from(a) * u64::from(b);
    let upper = (product >> 20) as u32 | u32::from(product as u32 & 0xf_ffff != 0);
    if upper >= LEADING << (EXTRA + 1) {
        round_any(sign, exponent + 1, shift_right(upper, 1))
    } else {
        round_any(sign, exponent, upper)
    }
}

pub(super) extern "C" fn divide(a: u32, b: u32) -> u32 {
    let sign = (a ^ b) & SIGN;
    let (a, b) = (a & !SIGN, b & !SIGN);
    if a > INFINITY || b > INFINITY || a == b && (a == 0 || a == INFINITY) {
        return NAN;
    }
    if a == INFINITY || b == 0 {
        return sign | INFINITY;
    }
    if a == 0 || b == INFINITY {
        return sign;
    }
    let ((exponent_a, mut rest), (exponent_b, b)) = (normal_parts(a), normal_parts(b));
    let mut exponent = exponent_a - exponent_b + 127;
    if rest < b {
        rest <<= 1;
        exponent -= 1;
    }
    // Bit by bit, the leading one first.
    let mut quotient = 0u32;
    for _ in 0..24 + EXTRA {
        quotient <<= 1;
        if rest >= b {
            rest -= b;
            quotient |= 1;
        }
        rest <<= 1;
    }
    round_any(sign, exponent, quotient | u32::from(rest != 0))
}

/// A number in the order of the real line; both zeros are one.
#[inline(always)]
fn ordered(value: u32) -> i32 {
    let magnitude = (value & !SIGN) as i32;
    if value & SIGN != 0 { -magnitude } else { magnitude }
}

pub(super) extern "C" fn is_unordered(a: u32, b: u32) -> i32 {
    i32::from(a & !SIGN > INFINITY || b & !SIGN > INFINITY)
}

pub(super) extern "C" fn is_equal(a: u32, b: u32) -> i32 {
    i32::from(is_unordered(a, b) == 0 && ordered(a) == ordered(b))
}

pub(super) extern "C" fn is_less(a: u32, b: u32) -> i32 {
    i32::from(is_unordered(a, b) == 0 && ordered(a) < ordered(b))
}

pub(super) extern "C" fn is_less_or_equal(a: u32, b: u32) -> i32 {
    i32::from(is_unordered(a, b) == 0 && ordered(a) <= ordered(b))
}

pub(super) extern "C" fn is_greater(a: u32, b: u32) -> i32 {
    is_less(b, a)
}

pub(super) extern "C" fn is_greater_or_equal(a: u32, b: u32) -> i32 {
    is_less_or_equal(b, a)
}

/// Towards zero; the nearest integer there is, and 0 for NaN.
pub(super) extern "C" fn to_unsigned(value: u32) -> u32 {
    if value & SIGN != 0 || value > INFINITY {
        return 0;
    }
    match (value >> 23) as i32 - 127 {
        exponent if exponent < 0 => 0,
        exponent if exponent > 31 => u32::MAX,
        exponent => (value << 8 | SIGN) >> (31 - exponent),
    }
}

/// As [`to_unsigned`].
pub(super) extern "C" fn to_signed(value: u32) -> i32 {
    let limit = i32::MAX as u32 + u32::from(value & SIGN != 0);
    let magnitude = to_unsigned(value & !SIGN).min(limit);
    if value & SIGN != 0 {
        magnitude.wrapping_neg() as i32
    } else {
        magnitude as i32
    }
}

pub(super) extern "C" fn from_unsigned(value: u32) -> u32 {
    if value == 0 {
        return 0;
    }
    let zeros = value.leading_zeros();
    // The leading bit to bit 31, then to its place above the extra bits.
    let significand = shift_right(value << zeros, 8 - EXTRA);
    round(0, 127 + 31 - zeros as i32, significand)
}

pub(super) extern "C" fn from_signed(value: i32) -> u32 {
    (value as u32 & SIGN) | from_unsigned(value.unsigned_abs())
}

pub(super) extern "C" fn from_long(value: u64) -> u32 {
    let (high, low) = ((value >> 32) as u32, value as u32);
    if high == 0 {
        return from_unsigned(low);
    }
    let zeros = high.leading_zeros();
    // Funnel of both words, without a shift of 64 bits, which may be a call.
    let upper = if zeros == 0 {
        high
    } else {
        high << zeros | low >> (32 - zeros)
    };
    let lower = low << zeros;
    let significand = shift_right(upper | u32::from(lower != 0), 8 - EXTRA);
    round(0, 127 + 63 - zeros as i32, significand)
}
