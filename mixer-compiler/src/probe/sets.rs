//! Probes of the attainable set's two descriptions and of level flight, which wrenches alone reach
//! only here and there.

use mixer_rt::tables::{Border, Corner, Inverse};

use super::physics::Physics;
use super::{Probe, UnitModel, words};
use crate::desaturation::attainable::{border_area, moments};

/// Border points per edge of the throttle box.
const SAMPLES: usize = 256;

/// Thrusts at which the sides are probed.
const SECTIONS: usize = 192;

/// Share of a unit's largest effort by which efforts on the border may be missed, beside the tolerance.
/// Where the set bends inwards chords are outside by a little, most on maps next to their fold.
const BORDER: f64 = 2e-3;

/// Share of the attainable set's area by which a description may be smaller than stated.
const AREA: f64 = 5e-3;

/// Share of an axis' authority by which stored level flight may be off level.
const LEVEL: f64 = 3e-3;

impl Probe<'_> {
    /// The polygon, the sides and stored level flight.
    pub(super) fn sets(&self, unit: &UnitModel) -> Result<(), String> {
        let area = border_area(&unit.map.scaled_border(SAMPLES));
        self.polygon(unit, area)?;
        self.sides(unit, area)?;
        self.level(unit)
    }

    /// The efforts are attained by the emitted inverse; else the words for what they are of.
    fn attained(&self, unit: &UnitModel, efforts: [f32; 2], of: &str) -> Result<(), String> {
        let tables = self.tables;
        let throttles = (&tables.inverse).throttles(&tables.view().pair, &tables.throttle, efforts);
        let (given, scale) = (unit.map.efforts(throttles.map(f64::from)), unit.scale);
        for k in 0..2 {
            let missed = (given[k] - f64::from(efforts[k])).abs();
            let is_near = missed <= 2.0 * f64::from(tables.tolerance.efforts[k]) + BORDER * scale[k];
            if !is_near {
                return Err(format!(
                    "the emitted {of} is not attainable: f {:.4} N, Q {:.5} N m gives f {:.4} N, Q {:.5} N m",
                    efforts[0], efforts[1], given[0], given[1]
                ));
            }
        }
        Ok(())
    }

    fn polygon(&self, unit: &UnitModel, area: f64) -> Result<(), String> {
        let table = &self.tables.attainable;
        let polygon = table.polygon();
        let n = polygon.len();
        for (k, corner) in polygon.iter().enumerate() {
            let (before, next) = ((k + n - 1) % n, (k + 1) % n);
            let [from, to] = [before, next].map(|k| polygon[k].at);
            if *corner != Corner::between(from, corner.at, to, [next as u8, before as u8]) {
                return Err(format!(
                    "edges of corner {k} of the emitted polygon do not meet its neighbours"
                ));
            }
        }
        for corner in table.corners() {
            self.attained(unit, corner, "polygon's corner")?;
        }
        let scale = unit.scale;
        let corners: Vec<[f64; 2]> = table
            .corners()
            .iter()
            .map(|corner| [0, 1].map(|k| f64::from(corner[k]) / scale[k]))
            .collect();
        smaller("polygon", moments(&corners).0 / area, self.lost_area.total)
    }

    fn sides(&self, unit: &UnitModel, area: f64) -> Result<(), String> {
        let (Some(table), Some(lost)) = (&self.tables.closed_form, self.lost_between_sides) else {
            return Ok(());
        };
        let border: Border<'_> = table.border.view();
        let [least, most] = table.thrust_n;
        let step = (most - least) / SECTIONS as f32;
        let mut between = 0.0;
        for k in 0..SECTIONS {
            let f = least + (k as f32 + 0.5) * step;
            let [middle, half] = border.torques(f);
            // Where the set is a point but for rounding, there is nothing to give.
            if half > 0.0 {
                self.attained(unit, [f, middle + half], "upper side")?;
                self.attained(unit, [f, middle - half], "lower side")?;
                between += 2.0 * f64::from(half) * f64::from(step);
            }
        }
        // `area` is twice that of the set, in shares of the scales.
        let [thrust, torque] = unit.scale;
        smaller("sides", 2.0 * between / (thrust * torque * area), lost)
    }

    fn level(&self, unit: &UnitModel) -> Result<(), String> {
        let table = &self.tables.level;
        let physics = Physics {
            airframe: self.airframe,
            map: unit.map,
        };
        let scale = self.tables.attainable.scale;
        let authority = unit.scale;
        for end in 0..2 {
            let efforts = table
                .efforts
                .iter()
                .map(|ends| [0, 1].map(|k| f64::from(ends[end][k] * scale[k])));
            let wrench = physics.wrench_of(efforts, [1.0; 2]);
            for axis in self.airframe.allocation.axes.iter().map(|axis| *axis as usize) {
                let asked = if axis == 3 && !table.efforts.is_empty() {
                    f64::from(table.thrust_n[end])
                } else {
                    0.0
                };
                let allowed = LEVEL * self.effectiveness.largest(axis, authority)
                    + f64::from(self.tables.tolerance.wrench[axis]);
                let is_level = (wrench[axis] - asked).abs() <= allowed;
                if !is_level {
                    return Err(format!(
                        "the emitted level flight is not level: {}",
                        words(&wrench)
                    ));
                }
            }
        }
        Ok(())
    }
}

/// A description that covers the share `covered` of the attainable set, where `lost` is stated.
fn smaller(of: &str, covered: f64, lost: f64) -> Result<(), String> {
    if covered >= 1.0 - lost - AREA {
        return Ok(());
    }
    Err(format!(
        "the emitted {of} loses {:.2} % of the attainable set's area, {:.2} % is stated",
        100.0 * (1.0 - covered),
        100.0 * lost
    ))
}
