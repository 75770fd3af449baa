//! A folder per flight stack: what `import` reads of its files, what `params` writes for it, what `review` reads in its
//! logs.

pub(crate) mod ardupilot;
pub(crate) mod betaflight;
pub(crate) mod px4;
pub(crate) mod stack;

use crate::params::writer::Writer;
use stack::Stack;

/// How a stack's parameters are written.
pub(crate) fn writer(stack: Stack) -> &'static Writer {
    match stack {
        Stack::Px4 => &px4::params::WRITER,
        Stack::Ardupilot => &ardupilot::params::WRITER,
        Stack::Betaflight => &betaflight::params::WRITER,
    }
}
