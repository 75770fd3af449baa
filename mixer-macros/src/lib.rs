//! `airframe!`.
