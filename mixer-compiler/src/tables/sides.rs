//! The sides of an attainable set.

use mixer_rt::{Knot, Polyline, Side, TorqueLimit};

/// One side of the attainable set.
#[derive(Clone, Debug, PartialEq)]
pub enum SideTable {
    /// Two arcs.
    Arcs(Side),
    /// A polyline of any shape.
    Polyline(Vec<Knot>),
}

/// [`SideTable`] as `mixer-rt` reads it.
#[derive(Clone, Copy, Debug)]
pub enum SideView<'a> {
    /// Two arcs.
    Arcs(Side),
    /// A polyline of any shape.
    Polyline(Polyline<'a>),
}

impl SideTable {
    pub(super) fn view(&self) -> SideView<'_> {
        match self {
            SideTable::Arcs(side) => SideView::Arcs(*side),
            SideTable::Polyline(knots) => SideView::Polyline(Polyline(knots)),
        }
    }

    pub(super) fn floats(&self) -> usize {
        match self {
            SideTable::Arcs(_) => 15,
            // With the slice's address and length.
            SideTable::Polyline(knots) => 2 + 4 * knots.len(),
        }
    }

    /// The side in f64: the torque (N m) at a thrust (N).
    pub(crate) fn torque(&self, f: f64) -> f64 {
        match self {
            SideTable::Arcs(side) => {
                let [below, above] = &side.arcs;
                let arc = if f < f64::from(side.corner_n) {
                    below
                } else {
                    above
                };
                let [offset, slope, bend, shift] =
                    [arc.offset, arc.slope, arc.bend, arc.shift].map(f64::from);
                offset + slope * f + bend * (f + shift).max(0.0).sqrt()
            }
            SideTable::Polyline(knots) => {
                let passed = knots.partition_point(|knot| f64::from(knot.thrust_n) <= f);
                let knot = &knots[passed.max(1) - 1];
                f64::from(knot.torque_nm) + f64::from(knot.slope) * (f - f64::from(knot.thrust_n))
            }
        }
    }
}

impl TorqueLimit for SideView<'_> {
    fn tangent(&self, f: f32) -> (f32, f32) {
        match self {
            SideView::Arcs(side) => side.tangent(f),
            SideView::Polyline(side) => side.tangent(f),
        }
    }

    fn knots(&self) -> &[Knot] {
        match self {
            SideView::Arcs(side) => side.knots(),
            SideView::Polyline(side) => side.knots(),
        }
    }

    fn corner_n(&self) -> Option<f32> {
        match self {
            SideView::Arcs(side) => side.corner_n(),
            SideView::Polyline(side) => side.corner_n(),
        }
    }
}
