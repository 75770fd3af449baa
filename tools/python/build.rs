//! The linker of macOS has to be told that Python has the symbols.

fn main() {
    pyo3_build_config::add_extension_module_link_args();
}
