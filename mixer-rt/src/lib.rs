//! Runtime of compiled coaxial mixers.
#![no_std]
