//! Whether there is a stdout to write to.

use std::sync::atomic::{AtomicBool, Ordering};

static CLOSED: AtomicBool = AtomicBool::new(false);

/// Whether stdout was closed when the program began (`>&-`). The standard library opens `/dev/null`
/// in its place before `main`, and what is written there is lost without an error. Known on Linux
/// only.
pub(crate) fn was_closed() -> bool {
    CLOSED.load(Ordering::Relaxed)
}

/// Run by the loader before the standard library.
#[cfg(target_os = "linux")]
#[allow(unsafe_code, reason = "after this there is nothing left to see")]
#[used]
#[unsafe(link_section = ".init_array")]
static LOOK: extern "C" fn() = {
    extern "C" fn look() {
        // SAFETY: reads the flags of a descriptor, open or not, and no memory.
        let flags = unsafe { libc::fcntl(libc::STDOUT_FILENO, libc::F_GETFD) };
        CLOSED.store(flags == -1, Ordering::Relaxed);
    }
    look
};
