// Copying and filling. The accesses are volatile: a plain loop would become a call of the very
// function.

pub(super) unsafe extern "C" fn copy(to: *mut u8, from: *const u8, bytes: usize) -> *mut u8 {
    let mut at = 0;
    if (to as usize | from as usize) & 3 == 0 {
        while bytes - at >= 4 {
            unsafe { to.add(at).cast::<u32>().write_volatile(from.add(at).cast::<u32>().read_volatile()) };
            at += 4;
        }
    }
    while at < bytes {
        unsafe { to.add(at).write_volatile(from.add(at).read_volatile()) };
        at += 1;
    }
    to
}

#[inline(always)]
unsafe fn fill(to: *mut u8, byte: u8, bytes: usize) {
    let mut at = 0;
    if to as usize & 3 == 0 {
        let word = u32::from_ne_bytes([byte; 4]);
        while bytes - at >= 4 {
            unsafe { to.add(at).cast::<u32>().write_volatile(word) };
            at += 4;
        }
    }
    while at < bytes {
        unsafe { to.add(at).write_volatile(byte) };
        at += 1;
    }
}

/// `memset` of C.
pub(super) unsafe extern "C" fn set(to: *mut u8, byte: i32, bytes: usize) -> *mut u8 {
    unsafe { fill(to, byte as u8, bytes) };
    to
}

/// `__aeabi_memset`: the byte comes last.
pub(super) unsafe extern "C" fn set_arm(to: *mut u8, bytes: usize, byte: i32) {
    unsafe { fill(to, byte as u8, bytes) };
}

/// `__aeabi_memclr`.
pub(super) unsafe extern "C" fn clear(to: *mut u8, bytes: usize) {
    unsafe { fill(to, 0, bytes) };
}
