//! The border of a unit's attainable set, as the closed form reads it.

use mixer_rt::tables::{Border, Cell, Grid, Outline};

/// [`Border`] with its cells.
#[derive(Clone, Debug, PartialEq)]
pub struct BorderTable {
    /// As in [`Border`].
    pub corners_n: [f32; 2],
    /// As in [`Border`].
    pub grids: [Grid; 3],
    /// As in [`Border`].
    pub cells: Vec<Cell>,
    /// As in [`Border`].
    pub outlines: [Outline; 2],
    /// As in [`Border`].
    pub lost_nm: f32,
}

impl BorderTable {
    /// The border as `mixer-rt` reads it.
    pub(crate) fn view(&self) -> Border<'_> {
        Border {
            corners_n: self.corners_n,
            grids: self.grids,
            cells: &self.cells,
            outlines: self.outlines,
            lost_nm: self.lost_nm,
        }
    }
}
