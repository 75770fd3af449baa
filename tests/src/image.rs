//! What an image consists of.

use std::path::Path;

use object::{Object, ObjectSection, ObjectSymbol};

/// Sizes and symbols of one image.
pub struct Image {
    /// Bytes of `.text`: instructions and the literals between them.
    pub code: u64,
    /// Bytes of `.rodata` and `.data`.
    pub tables: u64,
    /// Bytes of `.data` and `.bss`.
    pub ram: u64,
    /// Names of functions and objects, as the linker knows them.
    pub symbols: Vec<String>,
}

impl Image {
    /// Reads an ELF file.
    ///
    /// # Errors
    ///
    /// If it cannot be read, is no ELF file or has been stripped of its symbols.
    pub fn read(path: &Path) -> Result<Image, String> {
        let fault = |what: String| format!("{}: {what}", path.display());
        let bytes = std::fs::read(path).map_err(|e| fault(e.to_string()))?;
        let elf = object::File::parse(bytes.as_slice()).map_err(|e| fault(e.to_string()))?;
        let size = |name| elf.section_by_name(name).map_or(0, |section| section.size());
        let symbols: Vec<String> = elf
            .symbols()
            .filter_map(|symbol| symbol.name().ok())
            .map(str::to_owned)
            .collect();
        if !symbols.iter().any(|symbol| symbol == "main") {
            return Err(fault("no symbol `main`: stripped?".into()));
        }
        Ok(Image {
            code: size(".text"),
            tables: size(".rodata") + size(".data"),
            ram: size(".data") + size(".bss"),
            symbols,
        })
    }

    /// Symbols of helpers that a mixer has no need of: arithmetic in software, copying and filling
    /// of memory.
    pub fn helper_symbols(&self) -> Vec<&str> {
        let helper = |symbol: &&str| {
            symbol.starts_with("__aeabi_")
                || [
                    "memcpy", "memmove", "memset", "memclr", "__addsf3", "__mulsf3", "__divsf3", "__adddf3",
                    "__muldf3",
                ]
                .contains(symbol)
        };
        self.symbols.iter().map(String::as_str).filter(helper).collect()
    }

    /// Symbols of Rust's panic machinery, and of what leads to it only.
    pub fn panic_symbols(&self) -> Vec<&str> {
        let tell_tale = [
            "panic",
            "rust_begin_unwind",
            "unwrap_failed",
            "expect_failed",
            "slice_index_fail",
        ];
        let panics = |symbol: &&str| tell_tale.iter().any(|part| symbol.contains(part));
        self.symbols.iter().map(String::as_str).filter(panics).collect()
    }
}
