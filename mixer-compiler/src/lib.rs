//! Compiler of coaxial mixers.
