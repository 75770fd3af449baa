//! Names that are no names of a C library.

use std::collections::BTreeMap;

use crate::library::airframe::Airframe;

/// Headers that a program includes by these names, where `M.h` would be found in their stead: those
/// of C and of POSIX, then what glibc, newlib with libstdc++, and compilers have beside them. (Those
/// of single sets of instructions are left out, as `avx2intrin.h`; nothing is called so. Other
/// headers of C++ have no `.h`, those of Linux a folder.)
const HEADERS: &str = "
    assert complex ctype errno fenv float inttypes iso646 limits locale math setjmp signal stdalign stdarg
    stdatomic stdbit stdbool stdckdint stddef stdint stdio stdlib stdnoreturn string tgmath threads time
    uchar wchar wctype
    aio cpio devctl dirent dlfcn endian fcntl fmtmsg fnmatch ftw glob grp iconv langinfo libgen libintl
    monetary mqueue ndbm netdb nl_types poll pthread pwd regex sched search semaphore spawn strings stropts
    syslog tar termios trace ucontext ulimit unistd utime utmpx varargs wait wordexp
    aliases alloca ar argp argz byteswap elf envz err error execinfo features fstab fts gconv getopt gshadow
    ifaddrs lastlog link malloc mcheck memory mntent nss obstack paths printf proc_service pty re_comp
    regexp resolv sgtty shadow stab stdio_ext syscall sysexits termio thread_db ttyent utmp values
    cxxabi envlock fastmath ieeefp newlib reent regdef unctrl
    altivec arm_acle arm_bf16 arm_cde arm_cmse arm_fp16 arm_mve arm_mve_types arm_neon arm_sme arm_sve
    arm_vector_types cpuid gcov immintrin mm_malloc omp ompt openacc quadmath stdfix syslimits unwind x86intrin
";

/// Libraries of toolchains, `libM.a`.
const LIBRARIES: &str = "
    anl asan atomic backtrace c c_nano c_nonshared crypt dl g g_nano gcc gcc_eh gcc_s gcov gloss gomp hwasan
    itm lsan m mcheck mvec nosys nsl nss_files omp pthread pthread_nonshared quadmath rdimon rdimon_nano rdpmon
    resolv rt semihost ssp ssp_nonshared thread_db tsan ubsan unwind util
";

/// Targets that CMake keeps for itself.
const TARGETS: &str = "
    all clean depend edit_cache help install package package_source preinstall rebuild_cache test
";

/// What the shared header and its macros are called.
const SHARED: &str = "coaxial_mixer mixer";

/// Whether every airframe can have a library, and one of its own.
pub(crate) fn check(airframes: &[Airframe]) -> Result<(), String> {
    let mut files = BTreeMap::new();
    for Airframe { module, file, .. } in airframes {
        let taken = [
            (HEADERS, "a header of the C compiler or its library"),
            (LIBRARIES, "a library of the C compiler"),
            (TARGETS, "a target of CMake"),
            (SHARED, "what all airframes share, coaxial_mixer.h"),
        ];
        let is_among = |names: &str| names.split_whitespace().any(|name| name == module);
        if let Some((_, what)) = taken.into_iter().find(|(names, _)| is_among(names)) {
            return Err(format!(
                "{file}: the airframe's name gives `{module}`, which is {what}; call it {module}-x8 or the like"
            ));
        }
        if let Some(other) = files.insert(module, file) {
            return Err(format!(
                "{other} and {file} are both `{module}`: give one of them another name"
            ));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_hold_modules_once() {
        let lists = [HEADERS, LIBRARIES, TARGETS, SHARED];
        for list in lists {
            let mut names: Vec<&str> = list.split_whitespace().collect();
            let legal = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
            assert!(names.iter().all(|name| name.chars().all(legal)), "{names:?}");
            names.sort_unstable();
            assert!(names.windows(2).all(|pair| pair[0] != pair[1]), "{names:?}");
        }
    }
}
