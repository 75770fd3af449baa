//! Batteries by their cells: what voltages a vehicle sees.

use clap::ValueEnum;

/// `--cells`, `--chemistry`.
#[derive(clap::Args, Clone, Debug)]
pub struct PackArgs {
    /// Cells in series of the pack: `range_v` of `[voltage]` is then the pack's, not what the bench
    /// had
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=100))]
    pub cells: Option<u8>,
    /// Chemistry of the cells
    #[arg(long, value_enum, default_value_t = Chemistry::Lipo, requires = "cells")]
    pub chemistry: Chemistry,
}

/// Chemistry of a cell, with its voltages under load when empty and when full.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Chemistry {
    /// Lithium polymer, 3.2 to 4.2 V.
    Lipo,
    /// Lithium polymer for high voltage, 3.2 to 4.35 V.
    Lihv,
    /// Lithium ion, 2.8 to 4.2 V.
    LiIon,
    /// Lithium iron phosphate, 2.8 to 3.65 V.
    Lifepo4,
}

impl Chemistry {
    /// Voltage of one cell, empty and full, V.
    fn cell_v(self) -> [f64; 2] {
        match self {
            Chemistry::Lipo => [3.2, 4.2],
            Chemistry::Lihv => [3.2, 4.35],
            Chemistry::LiIon => [2.8, 4.2],
            Chemistry::Lifepo4 => [2.8, 3.65],
        }
    }
}

impl PackArgs {
    /// Voltage of the empty and of the full pack, V.
    pub fn range_v(&self) -> Option<[f64; 2]> {
        let cells = f64::from(self.cells?);
        let hundredths = |volts: f64| (100.0 * volts).round() / 100.0;
        Some(self.chemistry.cell_v().map(|volts| hundredths(cells * volts)))
    }
}
