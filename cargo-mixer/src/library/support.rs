//! Functions of the C compiler's run-time library that an object would call, as its own: the object
//! then has no undefined symbol, and its bits do not depend on the library that is linked.
//!
//! LLVM emits calls of memory functions on every target, and of arithmetic where the processor has
//! no instruction for it. The functions are Rust. Assembly gives each the name that LLVM calls, as
//! a symbol local to the object.

#[cfg(test)]
#[allow(dead_code, reason = "each is called where a target calls it")]
mod integer;
#[cfg(test)]
#[allow(dead_code, reason = "each is called where a target calls it")]
mod soft_float;

/// A name that LLVM calls and the function.
type Alias = (&'static str, &'static str);

/// Run-time ABI for the Arm architecture, section 4.3.4; `memcpy` and `memset` are called there,
/// too.
const MEMORY_ARM: &[Alias] = &[
    ("__aeabi_memclr", "memory::clear"),
    ("__aeabi_memclr4", "memory::clear"),
    ("__aeabi_memclr8", "memory::clear"),
    ("__aeabi_memcpy", "memory::copy"),
    ("__aeabi_memcpy4", "memory::copy"),
    ("__aeabi_memcpy8", "memory::copy"),
    ("__aeabi_memset", "memory::set_arm"),
    ("__aeabi_memset4", "memory::set_arm"),
    ("__aeabi_memset8", "memory::set_arm"),
];

const MEMORY: &[Alias] = &[("memcpy", "memory::copy"), ("memset", "memory::set")];

/// Run-time ABI for the Arm architecture, sections 4.1.2 and 4.2; `__clzsi2` is GCC's and LLVM's.
const ARITHMETIC: &[Alias] = &[
    ("__aeabi_fadd", "soft_float::add"),
    ("__aeabi_fsub", "soft_float::subtract"),
    ("__aeabi_frsub", "soft_float::subtract_from"),
    ("__aeabi_fmul", "soft_float::multiply"),
    ("__aeabi_fdiv", "soft_float::divide"),
    ("__aeabi_fcmpeq", "soft_float::is_equal"),
    ("__aeabi_fcmplt", "soft_float::is_less"),
    ("__aeabi_fcmple", "soft_float::is_less_or_equal"),
    ("__aeabi_fcmpgt", "soft_float::is_greater"),
    ("__aeabi_fcmpge", "soft_float::is_greater_or_equal"),
    ("__aeabi_fcmpun", "soft_float::is_unordered"),
    ("__aeabi_f2iz", "soft_float::to_signed"),
    ("__aeabi_f2uiz", "soft_float::to_unsigned"),
    ("__aeabi_i2f", "soft_float::from_signed"),
    ("__aeabi_ui2f", "soft_float::from_unsigned"),
    ("__aeabi_ul2f", "soft_float::from_long"),
    ("__aeabi_lmul", "integer::multiply_long"),
    ("__aeabi_llsl", "integer::shift_left_long"),
    ("__aeabi_llsr", "integer::shift_right_long"),
    ("__aeabi_uidiv", "integer::divide_unsigned"),
    ("__aeabi_uidivmod", "integer::divide_unsigned"),
    ("__clzsi2", "integer::leading_zeros"),
];

/// The functions that LLVM may call by name and that [`rust`] has.
fn all() -> impl Iterator<Item = &'static Alias> {
    [MEMORY_ARM, MEMORY, ARITHMETIC].into_iter().flatten()
}

/// Whether [`rust`] has a function of this name.
pub(super) fn has(name: &str) -> bool {
    all().any(|(alias, _)| *alias == name)
}

/// Rust that gives an object for `target` the functions whose names are in `calls`.
pub(super) fn rust(target: &str, calls: &[String]) -> String {
    let needed: Vec<&Alias> = all()
        .filter(|(name, _)| calls.iter().any(|call| call == name))
        .collect();
    // An alias of a Thumb function says so, or a call would switch to Arm instructions.
    let set = if target.starts_with("thumb") {
        ".thumb_set"
    } else {
        ".set"
    };
    let aliases: String = needed
        .iter()
        .map(|(name, function)| {
            format!("core::arch::global_asm!(\"{set} {name}, {{function}}\", function = sym {function});\n")
        })
        .collect();
    let modules = [
        ("integer", include_str!("support/integer.rs")),
        ("memory", include_str!("support/memory.rs")),
        ("soft_float", include_str!("support/soft_float.rs")),
    ];
    let used = modules.into_iter().filter(|(module, _)| {
        needed
            .iter()
            .any(|(_, function)| function.split_once("::").is_some_and(|(of, _)| of == *module))
    });
    let modules: String = used
        .map(|(module, text)| format!("mod {module} {{\n{text}}}\n"))
        .collect();
    modules + &aliases
}

#[cfg(test)]
mod tests {
    use super::{integer, soft_float};

    /// Every kind of number: zeros, the least and the largest of the subnormal and the normal ones,
    /// halves between neighbours, infinity, NaN; then random bits.
    fn numbers() -> Vec<u32> {
        let magnitudes = [
            0,
            1,
            2,
            3,
            0x7f_fffe,
            0x7f_ffff,
            0x80_0000,
            0x80_0001,
            0xff_ffff,
            0x100_0000,
            0x3300_0000,
            0x337f_ffff,
            0x3380_0000,
            0x3380_0001,
            0x3eaa_aaab,
            0x3f00_0000,
            0x3f7f_ffff,
            0x3f80_0000,
            0x3f80_0001,
            0x3fff_ffff,
            0x4000_0000,
            0x4b7f_ffff,
            0x4b80_0000,
            0x4eff_ffff,
            0x4f00_0000,
            0x4f7f_ffff,
            0x4f80_0000,
            0x7f00_0000,
            0x7f7f_ffff,
            0x7f80_0000,
            0x7f80_0001,
            0x7fc0_0000,
        ];
        let mut numbers: Vec<u32> = magnitudes
            .into_iter()
            .flat_map(|bits| [bits, bits | 1 << 31])
            .collect();
        let mut random = Random(7);
        numbers.extend((0..200).map(|_| random.next() as u32));
        // Of the same size, where addition cancels.
        numbers.extend((0..200).map(|_| random.next() as u32 & 0x81ff_ffff | 0x3f00_0000));
        numbers
    }

    struct Random(u64);

    impl Random {
        fn next(&mut self) -> u64 {
            self.0 = self
                .0
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            self.0.rotate_left(29) ^ self.0 >> 17
        }
    }

    #[track_caller]
    fn assert_same(bits: u32, expected: f32, what: [u32; 2]) {
        let is_same = if expected.is_nan() {
            f32::from_bits(bits).is_nan()
        } else {
            bits == expected.to_bits()
        };
        assert!(is_same, "{what:x?}: {bits:x}, not {:x}", expected.to_bits());
    }

    #[track_caller]
    fn assert_pair(a: u32, b: u32) {
        let (x, y) = (f32::from_bits(a), f32::from_bits(b));
        assert_same(soft_float::add(a, b), x + y, [a, b]);
        assert_same(soft_float::subtract(a, b), x - y, [a, b]);
        assert_same(soft_float::subtract_from(a, b), y - x, [a, b]);
        assert_same(soft_float::multiply(a, b), x * y, [a, b]);
        assert_same(soft_float::divide(a, b), x / y, [a, b]);
        let compared = [
            soft_float::is_equal(a, b),
            soft_float::is_less(a, b),
            soft_float::is_less_or_equal(a, b),
            soft_float::is_greater(a, b),
            soft_float::is_greater_or_equal(a, b),
            soft_float::is_unordered(a, b),
        ];
        let expected = [x == y, x < y, x <= y, x > y, x >= y, x.is_nan() || y.is_nan()];
        assert_eq!(compared, expected.map(i32::from), "{a:x} {b:x}");
    }

    #[test]
    fn floats_in_integers_have_the_bits_of_the_processor() {
        let numbers = numbers();
        for &a in &numbers {
            for &b in &numbers {
                assert_pair(a, b);
            }
            let value = f32::from_bits(a);
            assert_eq!(soft_float::to_unsigned(a), value as u32, "{a:x}");
            assert_eq!(soft_float::to_signed(a), value as i32, "{a:x}");
            assert_same(soft_float::from_unsigned(a), a as f32, [a, 0]);
            assert_same(soft_float::from_signed(a as i32), a as i32 as f32, [a, 0]);
        }
        let mut random = Random(1);
        for _ in 0..1_000_000 {
            let bits = random.next();
            assert_pair(bits as u32, (bits >> 32) as u32);
        }
    }

    #[test]
    fn words_of_64_bits_are_made_of_words_of_32() {
        let mut random = Random(3);
        for round in 0..100_000 {
            // Of every length.
            let [a, b] = [0, 6].map(|turn| random.next() >> (round >> turn & 63));
            assert_eq!(integer::multiply_long(a, b), a.wrapping_mul(b));
            let shift = random.next() as u32 & 63;
            assert_eq!(integer::shift_left_long(a, shift), a << shift);
            assert_eq!(integer::shift_right_long(a, shift), a >> shift);
            assert_same(soft_float::from_long(a), a as f32, [a as u32, (a >> 32) as u32]);
            let [a, b] = [a as u32, (b as u32).max(1)];
            assert_eq!(integer::leading_zeros(a), a.leading_zeros());
            let both = u64::from(a % b) << 32 | u64::from(a / b);
            assert_eq!(integer::divide_unsigned(a, b), both);
        }
        assert_eq!(integer::leading_zeros(0), 32);
    }
}
