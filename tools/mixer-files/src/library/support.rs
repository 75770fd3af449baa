//! Functions of the C compiler's run-time library that an object calls.
//!
//! LLVM emits calls of memory functions on every target. The object brings them as its own, and so
//! has no undefined symbol. Assembly gives each function the name that LLVM calls, as a symbol local
//! to the object.
//!
//! On a processor without a floating-point unit LLVM calls a function for every operation. Those
//! stay undefined: every toolchain of such a processor links its run-time library, and arithmetic of
//! IEEE 754 has the same bits in all of them.

/// A name that LLVM calls and the function.
type Alias = (&'static str, &'static str);

/// Run-time ABI for the Arm architecture, section 4.3.4; `memcpy` and `memset` are called there,
/// too.
const MEMORY: [Alias; 11] = [
    ("__aeabi_memclr", "memory::clear"),
    ("__aeabi_memclr4", "memory::clear"),
    ("__aeabi_memclr8", "memory::clear"),
    ("__aeabi_memcpy", "memory::copy"),
    ("__aeabi_memcpy4", "memory::copy"),
    ("__aeabi_memcpy8", "memory::copy"),
    ("__aeabi_memset", "memory::set_arm"),
    ("__aeabi_memset4", "memory::set_arm"),
    ("__aeabi_memset8", "memory::set_arm"),
    ("memcpy", "memory::copy"),
    ("memset", "memory::set"),
];

/// Arithmetic for LLVM beside the names of the Arm run-time ABI.
const ARITHMETIC: [&str; 2] = ["__clzsi2", "__ctzsi2"];

/// Whether [`rust`] has a function of this name.
pub(crate) fn has(name: &str) -> bool {
    MEMORY.iter().any(|(alias, _)| *alias == name)
}

/// Whether an object for `target` may leave this name to the C compiler's run-time library.
pub(crate) fn is_linked(target: &str, name: &str) -> bool {
    let is_soft = target.starts_with("thumb") && target.ends_with("eabi");
    is_soft && (name.starts_with("__aeabi_") || ARITHMETIC.contains(&name))
}

/// Rust that gives an object for `target` the functions whose names are in `calls`.
pub(crate) fn rust(target: &str, calls: &[String]) -> String {
    if calls.is_empty() {
        return String::new();
    }
    // An alias of a Thumb function says so, or a call would switch to Arm instructions.
    let is_thumb = target.starts_with("thumb");
    let set = if is_thumb { ".thumb_set" } else { ".set" };
    let called = MEMORY
        .iter()
        .filter(|(name, _)| calls.iter().any(|call| call == name));
    let aliases: String = called
        .map(|(name, function)| {
            format!("core::arch::global_asm!(\"{set} {name}, {{function}}\", function = sym {function});\n")
        })
        .collect();
    let memory = include_str!("support/memory.rs");
    format!("mod memory {{\n{memory}}}\n{aliases}")
}
