//! Why there is no library.

use std::fmt;

/// Why there is no library.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// An airframe's name is no name of a C library, or two airframes have one name.
    Name(String),
    /// This machine has no compiler for the target, or libraries are not made for it.
    Toolchain(String),
    /// The compiler failed, or its object is not one function without undefined symbols.
    Build(String),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Error::Name(message) | Error::Toolchain(message) | Error::Build(message)) = self;
        f.write_str(message)
    }
}

impl std::error::Error for Error {}
